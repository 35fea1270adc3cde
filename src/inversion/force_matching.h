// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Potentials from the forces of a trajectory: the method "force-matching", and a start of
/// inversions.
#pragma once

#include "problem/potential_grid.h"

/// What forces say of potentials.
struct force_potentials {
    double explained;  ///< share of Σ F² that these forces are
    double directions; ///< that the data determine
    double unknowns;   ///< out of so many
};

/// Find the potentials of all pairs and groups of a problem that has forces: Φ is 0 at the cutoff,
/// U where its target is most likely.
/// @param[out] phi    completed, shape [points of the grid]
/// @param[out] error  standard errors of its known values, shape [points]; or NULL
/// Fails: BAD_INPUT for forces of other types or groups than the problem's, or too few frames;
/// NO_MEMORY. Tested: test_force_matching.
enum status mf_force_matching_find(const struct inverse_problem *problem,
                                   const struct potential_grid *grid, double *phi, double *error,
                                   struct force_potentials *found) MUST_USE;
