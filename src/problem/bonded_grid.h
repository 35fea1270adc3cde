// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The points at which the fitted U(q) of a group of bonds, angles or dihedrals is known.
///
/// They are the centres of the target's bins: those from the first to the last in which it is seen,
/// and some on both sides, where U goes on so that nothing is lost there: as a parabola that rises
/// from the last slope, as one about its minimum would. Beyond the last point it is a straight line
/// (curves/bonded_table.h). A dihedral has all bins of the circle, and the first once more.
///
/// Of several states the points are those of all: a bin is known if one state has seen it.
#pragma once

#include "problem/inverse.h"

/// In fewer bins no potential is seen.
enum { BONDED_GRID_FEWEST_BINS = 5 };

struct bonded_grid {
    const struct bonded_unknown *unknown; ///< borrowed
    const double *target;                 ///< p of its bins, shape [unknown->bins.count]; borrowed
    double temperature;                   ///< [k_B T_0]
    int dimensions;                       ///< of space
    size_t first;                         ///< bin of the target that is known first
    size_t known;                         ///< bins from there on that have a value of their own
    size_t seen_first, seen;              ///< those of them that this target has seen
    size_t below;                         ///< points before the first known one
    size_t points;                        ///< of all
    bool is_level; ///< f of densities beside potentials of all pairs, which have its slope
};

/// @param[in] unknown  one of the problem's
/// Fails: BAD_INPUT, naming the group, if hardly any bin is seen, or a dihedral's do not go round.
enum status mf_bonded_grid_init(struct bonded_grid *grid, const struct inverse_problem *problem,
                                const struct bonded_unknown *unknown) MUST_USE;

/// q of a point [λ] or [degrees].
double mf_bonded_grid_place(const struct bonded_grid *grid, size_t point);

/// Add the constant to the known values of U with which the least of them is 0: no distribution
/// sees it.
void mf_bonded_grid_level(const struct bonded_grid *grid, double *energy);

/// −k_B T ln(p/J) of the bins that the target has seen, with J the mean Jacobian of a bin and the
/// least value 0, shape [points], completed.
void mf_bonded_grid_start(const struct bonded_grid *grid, double *energy);

/// Complete U, shape [points], from its known values.
void mf_bonded_grid_complete(const struct bonded_grid *grid, double *energy);

/// The curve of completed values, to be cleared with mf_bonded_clear. Fails: NO_MEMORY.
enum status mf_bonded_grid_curve(const struct bonded_grid *grid, const double *energy,
                                 struct bonded_curve *curve) MUST_USE;

/// The same of f(ρ), to be cleared with mf_density_energy_clear. Fails: NO_MEMORY.
enum status mf_bonded_grid_density(const struct bonded_grid *grid, const double *energy,
                                   struct density_energy *density) MUST_USE;

/// Whether p of a bin of the target, of one state at least, is above this part of its peak.
bool mf_bonded_grid_is_above(const struct bonded_grid *grid, const struct inverse_problem *problem,
                             size_t bin, double part);

/// What a unit at one of the known points makes of U, whose curve is a spline through all points,
/// in the mean over a known bin: M_ab of bin a and point b, shape [known, known]. Σ_b M_ab is 1
/// but at the ends. Fails: NO_MEMORY. Tested: test_bonded_grid.
enum status mf_bonded_grid_means(const struct bonded_grid *grid, double *means) MUST_USE;

/// Mean of p over the known bins.
double mf_bonded_grid_mean(const struct bonded_grid *grid);
