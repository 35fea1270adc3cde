// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The pair forces the slow way, an oracle of the pair kernels.
#pragma once

#include "forces/pair.h"

/// Forces from all pairs, nearest image by division, double precision, library random numbers.
/// Reads `velocity` (not kernel_motion) and writes `force` [k_B T_0 / λ].
/// @param[out] sums  energy and virial, or NULL
void all_pairs_forces(const struct pair_law *law, struct particles *particles, uint64_t step,
                      struct pair_sums *sums);

/// Separation of the nearest images of particles i and j; returns its length.
double all_pairs_separation(const struct particles *particles, size_t i, size_t j, double r_ij[3]);

/// Whether the pair of two ids is excluded. NULL: no molecules.
bool all_pairs_excludes(const struct topology *topology, uint32_t i, uint32_t j);
