// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The unknowns of a problem as curves: their points, names and tables.
///
/// All methods need these; those that move variables make the curves by problem/parametrisation.h.
#pragma once

#include "problem/numbers.h"
#include "problem/omega_grid.h"
#include "problem/potential_grid.h"

struct unknowns {
    const struct inverse_problem *problem;
    struct potential_grid potential;   ///< of pairs and groups, if any is unknown
    struct omega_grid omega[UNKNOWNS]; ///< of friction weights that are unknown
};

/// Fails: NO_MEMORY; BAD_INPUT as mf_potential_grid_init.
enum status mf_unknowns_init(struct unknowns *unknowns,
                             const struct inverse_problem *problem) MUST_USE;
void mf_unknowns_clear(struct unknowns *unknowns);

/// Points of an unknown's curve; 0 if it is known. And where they are [λ], of angles [degrees].
size_t mf_unknowns_points(const struct unknowns *unknowns, enum unknown_kind kind);
const double *mf_unknowns_r(const struct unknowns *unknowns, enum unknown_kind kind);

/// The curves that an unknown is made of, one after the other: potentials are one for each pair
/// type, and one for each group of bonds, angles and dihedrals.
size_t mf_unknowns_curve_count(const struct unknowns *unknowns, enum unknown_kind kind);

/// Whether one of them is looked for: not the potential of pairs of which no g(r) is given.
bool mf_unknowns_is_sought(const struct unknowns *unknowns, enum unknown_kind kind, size_t curve);

/// The points of one of them.
struct unknowns_part {
    size_t first, points;
};
struct unknowns_part mf_unknowns_part(const struct unknowns *unknowns, enum unknown_kind kind,
                                      size_t curve);

/// Whether a point is fitted: not in a core, not at the cutoff, and not beyond what a target knows.
bool mf_unknowns_fits(const struct unknowns *unknowns, enum unknown_kind kind, size_t point);

/// What the first column of a curve's table is called: "r[lambda]", "theta[degrees]".
const char *mf_unknowns_heading(const struct unknowns *unknowns, enum unknown_kind kind,
                                size_t curve);

/// Unit of the values, as headings have it.
const char *mf_unknowns_unit(enum unknown_kind kind);

/// What files call an unknown, "omega" or "memory_slow", and one of its curves, "potential_A-B" in
/// a mixture, "bonds_backbone" of a group.
enum { UNKNOWNS_NAME_SIZE = COMPOSITION_PAIR_NAME_SIZE + 48 };
void mf_unknowns_kind_name(const struct unknowns *unknowns, enum unknown_kind kind,
                           char name[UNKNOWNS_NAME_SIZE]);
void mf_unknowns_curve_name(const struct unknowns *unknowns, enum unknown_kind kind, size_t curve,
                            char name[UNKNOWNS_NAME_SIZE]);

/// The curve that a fit begins with, shape [points]: that of the run file, or the potential of mean
/// force and a friction weight that falls linearly from the middle of its range.
void mf_unknowns_start(const struct unknowns *unknowns, enum unknown_kind kind, double *curve);

/// Whether the run file gives the curve that a fit begins with, of a mixture for any pair type.
bool mf_unknowns_has_start(const struct unknowns *unknowns, enum unknown_kind kind);

/// What a simulation of some curves and numbers is made of: the problem with these numbers in its
/// scene; tables for the kernels of the curves that are given, and of the scene's laws where
/// `curve` is NULL. What was made must be cleared with mf_unknowns_laws_clear, even after a
/// failure; it points into itself and may not be copied.
/// @param[in] curve   shape [UNKNOWNS][points]
/// @param[in] number  shape [problem->numbers]
/// Fails: NO_MEMORY; BAD_INPUT as mf_numbers_apply.
struct unknowns_laws {
    struct inverse_problem problem;
    struct numbers_own own;              ///< zero for what is the scene's
    const struct table *table[UNKNOWNS]; ///< those of memory also stand in the scene of `problem`
    struct molecules molecules;          ///< with what is fitted, if any group is unknown
    struct many_body many_body;          ///< likewise
    const struct potential_grid *grid;   ///< of these; borrowed
};
enum status mf_unknowns_laws_make(const struct unknowns *unknowns,
                                  const double *const curve[UNKNOWNS], const double *number,
                                  struct unknowns_laws *laws) MUST_USE;
void mf_unknowns_laws_clear(struct unknowns_laws *laws);

/// The same of the curves and numbers that a fit begins with. As mf_unknowns_laws_make.
enum status mf_unknowns_laws_start(const struct unknowns *unknowns,
                                   struct unknowns_laws *laws) MUST_USE;
