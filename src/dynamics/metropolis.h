// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Metropolis Monte Carlo of one configuration.
///
/// N. Metropolis et al., J. Chem. Phys. 21, 1087 (1953): each sweep tries to move every particle
/// once, in an order that equilibration fixes, by a uniform random vector of a cube. Same
/// particles, same neighbour search and same tables as the dynamics. Beads of molecules move as
/// single ones do, with U of their bonds, angles and dihedrals, and each sweep ends with one move
/// of each molecule (dynamics/molecule_moves.h), of another kind in the next sweep.
#pragma once

#include "dynamics/molecule_moves.h"
#include "forces/pair.h"

#include <math.h>

#include <stdatomic.h>

struct metropolis {
    struct particles particles;
    struct neighbours neighbours; ///< full list
    struct pair_law law;          ///< its potential is borrowed and may be exchanged
    struct molecule_moves molecules;
    struct placement_bias bias; ///< of what is placed from now on; none at first
    uint32_t *order;            ///< ids, in the order in which a sweep moves them
    double step;                ///< half edge of the cube of moves [λ]
    uint64_t seed;
    const atomic_bool *cancel; ///< stops the sweeps once it is set, or NULL; borrowed
    uint32_t sweep;            ///< sweeps so far: the counter of the random numbers
    uint64_t accepted, tried;  ///< moves of beads
    uint32_t exchanges;        ///< of beads of different types, tried in a sweep; 0 at first
    uint64_t exchanges_accepted, exchanges_tried; ///< in the present equilibration
};

/// How far a particle may go before the list of neighbours is looked after [λ].
static inline double metropolis_reach(const struct metropolis *metropolis) {
    return 0.49 * metropolis->neighbours.skin;
}

/// The shortest box in which particles meet one image of each other, also in the skin [λ].
static inline double metropolis_shortest_box(double cutoff) {
    return 2.1 * cutoff;
}

/// The skin that its list would have in a box without end [λ].
double mf_metropolis_skin(const struct box *box, double count);

/// Half edge of the largest cube of moves: the list has room for one of each particle [λ].
static inline double metropolis_longest_step(const struct metropolis *metropolis) {
    return metropolis_reach(metropolis) / sqrt(metropolis->particles.box.dimensions);
}

/// By what a step is multiplied if so many moves were accepted, where 40 % are wanted.
static inline double metropolis_tuning(double accepted) {
    return fmin(1.1, fmax(0.9, 1 + 0.5 * (accepted - 0.4)));
}

/// Particles on a lattice in `box`, mixed at random, ready for sweeps with `potential`, or NULL:
/// without pairs.
/// Fails: NO_MEMORY; BAD_INPUT if the box is below twice the cutoff, with some room for a list.
enum status mf_metropolis_init(struct metropolis *metropolis, const struct box *box,
                               const struct composition *composition, const struct table *potential,
                               double temperature, uint64_t seed) MUST_USE;
/// The same with particles, and molecules if they have joined any, where they are now.
/// @param[in] law        its potential, composition, temperature and seed are read
/// @param[in] molecules  as of mf_metropolis_join
/// Fails: NO_MEMORY; BAD_INPUT as mf_metropolis_init.
enum status mf_metropolis_init_at(struct metropolis *metropolis, const struct particles *particles,
                                  const struct pair_law *law,
                                  const struct molecules *molecules) MUST_USE;
void mf_metropolis_clear(struct metropolis *metropolis);

/// Let the particles be molecules, placed as a scene does. Single beads pay nothing for it.
/// @param[in] molecules  of the composition; borrowed, and so may their laws be; NULL: nothing to
/// do Fails: as mf_hybrid_init.
enum status mf_metropolis_join(struct metropolis *metropolis,
                               const struct molecules *molecules) MUST_USE;

/// Place the particles again, without order; molecules as a scene does. Fails: NO_MEMORY,
/// INTERRUPTED.
enum status mf_metropolis_scatter(struct metropolis *metropolis) MUST_USE;

/// One sweep, after which the step sizes of its moves are changed towards 40 % accepted. The tally
/// starts again. Fails: NO_MEMORY, INTERRUPTED.
enum status mf_metropolis_tune(struct metropolis *metropolis) MUST_USE;

/// Let sweeps also exchange beads of different types. How many they try, one in four beads or
/// hardly any, follows from how many are accepted in each equilibration. Without effect where all
/// beads are of one type.
void mf_metropolis_exchange(struct metropolis *metropolis);

/// Sweeps of mf_metropolis_tune. They and all after them move the
/// particles in the order of the arrays as it is now: one by one through space, which takes a
/// liquid from state to state in fewer sweeps than an order without plan, until the particles have
/// mixed. Call mf_metropolis_refresh before. Fails: NO_MEMORY, INTERRUPTED. Tested:
/// test_metropolis.
enum status mf_metropolis_equilibrate(struct metropolis *metropolis, uint32_t sweeps) MUST_USE;

/// The moves of beads of one sweep. Fails: NO_MEMORY.
enum status mf_metropolis_move_beads(struct metropolis *metropolis) MUST_USE;

/// Sweeps with a fixed step size, as detailed balance asks. Fails: NO_MEMORY, INTERRUPTED.
enum status mf_metropolis_run(struct metropolis *metropolis, uint32_t sweeps) MUST_USE;

/// Add all pairs nearer than the cutoff to a histogram of one part, and sum Φ and r·F, with those
/// of bonds, angles and dihedrals. Fails: as mf_molecule_moves_add_sums.
enum status mf_metropolis_count(struct metropolis *metropolis,
                                const struct pair_histogram *histogram,
                                struct pair_sums *sums) MUST_USE;

/// Moves of all kinds that were tried since mf_metropolis_equilibrate, and how many were accepted.
void mf_metropolis_tally(const struct metropolis *metropolis, uint64_t *accepted, uint64_t *tried);

/// Sort the particles and build the list again from the positions alone, so that a run that
/// continues and one that was reloaded here go on with the same bits. Fails: NO_MEMORY.
enum status mf_metropolis_refresh(struct metropolis *metropolis) MUST_USE;
