// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Metropolis Monte Carlo of one configuration.
///
/// N. Metropolis et al., J. Chem. Phys. 21, 1087 (1953): each sweep tries to move every particle
/// once, in an order that equilibration fixes, by a uniform random vector of a cube. Same
/// particles, same neighbour search and same tables as the dynamics.
#pragma once

#include "forces/pair.h"

#include <stdatomic.h>

struct metropolis {
    struct particles particles;
    struct neighbours neighbours; ///< full list
    struct pair_law law;          ///< its potential is borrowed and may be exchanged
    uint32_t *order;              ///< ids, in the order in which a sweep moves them
    double step;                  ///< half edge of the cube of moves [λ]
    uint64_t seed;
    const atomic_bool *cancel; ///< stops the sweeps once it is set, or NULL; borrowed
    uint32_t sweep;            ///< sweeps so far: the counter of the random numbers
    uint64_t accepted, tried;
};

/// Particles on a lattice in `box`, mixed at random, ready for sweeps with `potential`.
/// Fails: NO_MEMORY; BAD_INPUT if the box is below twice the cutoff, with some room for a list.
enum status mf_metropolis_init(struct metropolis *metropolis, const struct box *box,
                               const struct composition *composition, const struct table *potential,
                               double temperature, uint64_t seed) MUST_USE;
void mf_metropolis_clear(struct metropolis *metropolis);

/// Place the particles anew, without order. Fails: NO_MEMORY.
enum status mf_metropolis_scatter(struct metropolis *metropolis) MUST_USE;

/// Sweeps whose step size is tuned towards 40 % accepted. They and all after them move the
/// particles in the order of the arrays as it is now: one by one through space, which takes a
/// liquid from state to state in fewer sweeps than an order without plan, until the particles have
/// mixed. Call mf_metropolis_refresh before. Fails: NO_MEMORY, INTERRUPTED. Tested:
/// test_metropolis.
enum status mf_metropolis_equilibrate(struct metropolis *metropolis, uint32_t sweeps) MUST_USE;

/// Sweeps with a fixed step size, as detailed balance asks. Fails: NO_MEMORY, INTERRUPTED.
enum status mf_metropolis_run(struct metropolis *metropolis, uint32_t sweeps) MUST_USE;

/// Add all pairs nearer than the cutoff to a histogram of one part, and sum Φ and r·F.
void mf_metropolis_count(const struct metropolis *metropolis,
                         const struct pair_histogram *histogram, struct pair_sums *sums);

/// Sort the particles and build the list anew from the positions alone, so that a run that
/// continues and one that was reloaded here go on with the same bits. Fails: NO_MEMORY.
enum status mf_metropolis_refresh(struct metropolis *metropolis) MUST_USE;
