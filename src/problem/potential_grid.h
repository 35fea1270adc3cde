// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The points at which the fitted potentials are known, one block for each pair of types.
///
/// In each block the bin centres of the target, in three parts: the core, where the target is 0 and
/// the potential is continued (mf_core_fill); the known bins; and the cutoff, the upper edge of the
/// last bin, where the potential is 0. A block has one point more than bins.
#pragma once

#include "problem/inverse.h"

struct potential_grid {
    size_t pairs;        ///< of types: blocks
    size_t bins;         ///< of a block
    size_t points;       ///< of all blocks: pairs · (bins + 1)
    size_t *core;        ///< shape [pairs]: points in the core = the first known bin
    size_t *known_of;    ///< shape [pairs]: bins with a value of their own
    size_t known;        ///< bins with a value of their own, of all blocks
    size_t *known_point; ///< shape [known]: where they are among the points …
    size_t *known_bin;   ///< … and among the bins of all blocks, pairs · bins
    double *r;           ///< shape [points] [λ]
    double stiffness;
};

/// Fails: NO_MEMORY; BAD_INPUT if a target is nowhere above the threshold.
enum status mf_potential_grid_init(struct potential_grid *grid,
                                   const struct inverse_problem *problem) MUST_USE;
void mf_potential_grid_clear(struct potential_grid *grid);

/// First point of a block.
size_t mf_potential_grid_block(const struct potential_grid *grid, size_t pair);

/// Whether a point is in the core of its block.
bool mf_potential_grid_in_core(const struct potential_grid *grid, size_t point);

/// Complete phi, shape [points], from its known values: core below, 0 at the cutoff.
void mf_potential_grid_complete(const struct potential_grid *grid, double *phi);

/// Table for the kernels from a completed phi. Fails: NO_MEMORY.
enum status mf_potential_grid_table(const struct potential_grid *grid, const double *phi,
                                    struct table *table) MUST_USE;

/// Where a fit begins: the problem's start curves, or the potentials of mean force −k_B T ln g*.
void mf_potential_grid_start(const struct potential_grid *grid,
                             const struct inverse_problem *problem, double *phi);

/// The virial of pairs, by the bin that they are in and the value that makes it: the mean over a
/// bin's shell of −r ∂Φ'(r)/∂Φ_b, so that W = Σ_a S_a Σ_b virial_ab Φ_b + what the core's stiffness
/// adds. Through the tables that the kernels read, so that spline and core are those of a
/// simulation. g(r) counts as constant in a bin.
/// @param[in]  phi     completed, shape [points]
/// @param[out] virial  shape [pairs · bins, known], row-major
/// Fails: NO_MEMORY. Tested: test_potential_grid, test_inversion_pressure.
enum status mf_potential_grid_virials(const struct potential_grid *grid,
                                      const struct rdf_bins *bins, int dimensions,
                                      const double *phi, double *virial) MUST_USE;

/// Whether the target has so many pairs in a bin, g* > 0.1, that it tells the potential there.
bool mf_potential_grid_well_known(const struct inverse_problem *problem, size_t bin);

/// The ramp 1 − r/r_c, which moves the pressure and hardly g(r), at a point of the grid.
double mf_potential_grid_ramp(const struct potential_grid *grid, size_t point);
