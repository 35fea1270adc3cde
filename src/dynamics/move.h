// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a Metropolis move needs of the pairs around a particle, and what a sample needs of
/// all of them: one body (src/dynamics/move_loop.h), compiled for each instruction set.
#pragma once

#include "forces/pair.h"

/// Change of potential energy when a particle goes to the fractions `to` of the box [k_B T_0]:
/// Σ_j Φ(|r' − r_j|) − Φ(|r − r_j|), from the same rows of the table as the forces, in single
/// precision. A NaN in the table shows.
/// @param[in] law         its potential and composition are read
/// @param[in] list  shape [count]: its neighbours, complete for the cutoff from both places
/// Tested: test_move.
double mf_move_energy_change(const struct pair_law *law, const struct particles *particles,
                             size_t particle, const int32_t *list, size_t count,
                             const int32_t to[3]);

/// Change of potential energy if a bead of a mixture were of the type of another one, where it is,
/// without what it has with that one; precision and NaN as above.
/// Tested: test_move.
double mf_move_type_change(const struct pair_law *law, const struct particles *particles,
                           size_t particle, size_t other, const int32_t *list, size_t count);

/// Add the pairs nearer than the potential's cutoff to the law's histogram, of one part, and sum Φ
/// and r·F.
/// @param[in] neighbours  a full list
/// Tested: test_move.
void mf_move_count_pairs(const struct pair_law *law, const struct particles *particles,
                         const struct neighbours *neighbours, struct pair_sums *sums);
