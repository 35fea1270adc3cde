// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Particles in cells from which each can be taken and put back, for moves that go farther
/// than a list of neighbours reaches. In three dimensions.
#pragma once

#include "forces/pair.h"

struct reptation_grid {
    int cells[3];   ///< along each axis, no narrower than the cutoff
    int32_t *first; ///< shape [cells]: a particle of each cell, −1: none
    int32_t *next;  ///< shape [particles]: the next one of its cell, −1: none
};

/// Room for all particles. Must be cleared. Fails: NO_MEMORY.
enum status mf_reptation_grid_init(struct reptation_grid *grid, size_t particles) MUST_USE;
void mf_reptation_grid_clear(struct reptation_grid *grid);

/// Put all particles where they are.
void mf_reptation_grid_fill(struct reptation_grid *grid, const struct particles *particles,
                            double cutoff);

void mf_reptation_grid_remove(struct reptation_grid *grid, const struct particles *particles,
                              int32_t k);
void mf_reptation_grid_insert(struct reptation_grid *grid, const struct particles *particles,
                              int32_t k);

/// Σ Φ of a particle that is not in the grid with all that are, but those excluded [k_B T_0].
/// @param[in] excluded  shape [count]: numbers of particles
/// Tested: test_reptation.
double mf_reptation_grid_energy(const struct reptation_grid *grid, const struct pair_law *law,
                                const struct particles *particles, int32_t k,
                                const int32_t *excluded, int count);
