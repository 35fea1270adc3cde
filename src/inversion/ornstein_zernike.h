// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Direct correlations of a liquid whose g(r) is known up to a range and whose potential ends
/// there.
#pragma once

#include "base/status.h"
#include "system/composition.h"

#include <stdbool.h>
#include <stddef.h>

/// Transform of 1 for r < edge, 0 beyond: 4π (sin x − x cos x)/q³, x = q edge.
double mf_ornstein_zernike_ball(double q, double edge);

/// Cells of constant h and c of each pair type, from r = 0 to the range.
struct ornstein_zernike {
    struct composition composition;
    double density[COMPOSITION_MAX_TYPES]; ///< of each type [1/λ³]
    size_t types, pairs, cells, waves;
    double *edge;      ///< shape [cells + 1] [λ]
    double *volume;    ///< of the shells, shape [cells] [λ³]
    double *transform; ///< of 1 in a cell, at each wave: shape [waves, cells]
    double *weight;    ///< q² dq/2π² of each wave, shape [waves]
    double
        *intramolecular; ///< Ω of each wave, shape [waves, types, types], 1 at first: single beads
    double *inverse;     ///< Ω⁻¹
    double *softness;    ///< h may be missed by this times c, shape [pairs, cells], 0 at first
    double *c; ///< direct correlations, shape [pairs, cells]; kept as the start of the next solve
};

/// @param[in] edge    shape [cells + 1], from 0 on
/// @param[in] volume  of the box [λ³]
/// Must be cleared, also after a failure. Fails: NO_MEMORY.
enum status mf_ornstein_zernike_init(struct ornstein_zernike *oz, const double *edge, size_t cells,
                                     const struct composition *composition, double volume) MUST_USE;
void mf_ornstein_zernike_clear(struct ornstein_zernike *oz);

/// After Ω was given: find its inverse. False if some Ω has an eigenvalue that is not positive.
bool mf_ornstein_zernike_set_molecules(struct ornstein_zernike *oz) MUST_USE;

/// Find c in the cells from h there, with c = 0 beyond the range and h beyond it as it follows from
/// Ornstein and Zernike's equation, H = Ω C Ω + Ω C H with the matrices of hnc_closure.h, so that
/// S = Ω + H = (Ω⁻¹ − C)⁻¹: a g(r) that ends before its oscillations do is so continued (Verlet's
/// extension: L. Verlet, Phys. Rev. 165, 201 (1968); for measured g(r) M. Dixon and P. Hutchinson,
/// Mol. Phys. 33, 1663 (1977)). Differs from them: h − c in each cell is its mean there, and the
/// equations are solved by Newton's method with a line search, not by iteration, which diverges
/// for liquids. They make ∫ ln det S d³q as large as it can be with this h in the cells, which is
/// concave: of all liquids that have this g up to the range it is the one that is least ordered
/// beyond, the only one whose c ends there, and there is none where Newton's method finds none.
/// With a softness in all cells there is always one.
/// @param[in]  h          shape [pairs, cells]
/// @param[out] structure  S(q → 0), shape [types, types], of one component of single beads
///                        1/(1 − ρ ĉ(0)) = ρ k_B T κ_T; NaN if there is no stable liquid with
///                        this h
/// Fails: NO_MEMORY. Tested: test_ornstein_zernike, against exact solutions for hard spheres.
enum status mf_ornstein_zernike_solve(struct ornstein_zernike *oz, const double *h,
                                      double *structure) MUST_USE;
