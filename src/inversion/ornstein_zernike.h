// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Direct correlations of a liquid whose g(r) is known up to a range and whose potential ends
/// there.
#pragma once

#include "base/status.h"

#include <stddef.h>

/// Transform of 1 for r < edge, 0 beyond: 4π (sin x − x cos x)/q³, x = q edge.
double mf_ornstein_zernike_ball(double q, double edge);

/// Cells of constant h and c, from r = 0 to the range.
struct ornstein_zernike {
    size_t cells, waves;
    double density;
    double *edge;      ///< shape [cells + 1] [λ]
    double *volume;    ///< of the shells, shape [cells] [λ³]
    double *transform; ///< of 1 in a cell, at each wave: shape [waves, cells]
    double *weight;    ///< q² dq/2π² of each wave, shape [waves]
    double *c;         ///< direct correlations, shape [cells]; kept as the start of the next solve
};

/// @param[in] edge  shape [cells + 1], from 0 on
/// Must be cleared, also after a failure. Fails: NO_MEMORY.
enum status mf_ornstein_zernike_init(struct ornstein_zernike *oz, const double *edge, size_t cells,
                                     double density) MUST_USE;
void mf_ornstein_zernike_clear(struct ornstein_zernike *oz);

/// Find c in the cells from h there, with c = 0 beyond the range and h beyond it as it follows from
/// Ornstein and Zernike's equation ĥ = ĉ + ρ ĉ ĥ: a g(r) that ends before its oscillations do is so
/// continued (Verlet's extension: L. Verlet, Phys. Rev. 165, 201 (1968); for measured g(r) M. Dixon
/// and P. Hutchinson, Mol. Phys. 33, 1663 (1977)). Differs from them: h − c in each cell is its
/// mean there, and the equations are solved by Newton's method with a line search, not by
/// iteration, which diverges for liquids.
/// @param[in]  h  shape [cells]
/// @param[out] compressibility  S(0) = 1/(1 − ρ ĉ(0)) = ρ k_B T κ_T; not positive, or NaN, if there
///                              is no stable liquid with this h
/// Fails: NO_MEMORY. Tested: test_ornstein_zernike, against the exact solution for hard spheres.
enum status mf_ornstein_zernike_solve(struct ornstein_zernike *oz, const double *h,
                                      double *compressibility) MUST_USE;
