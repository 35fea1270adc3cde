// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Reptation: a chain creeps along itself like a snake, as one more Metropolis move.
///
/// F. T. Wall and F. Mandel, J. Chem. Phys. 63, 4592 (1975): the last bead of a chain is taken off
/// and put before its first, or the other way round, so that the rest moves along by one bond. Were
/// moves independent of each other, the end-to-end vector would be forgotten after 2 N²/π² accepted
/// ones; in a melt chains often creep back. The new place is chosen among k with configurational
/// bias (D. Frenkel and B. Smit, Understanding Molecular Simulation, 2nd ed., 2002, ch. 13): k
/// places are drawn from densities q near exp(−U/k_B T) of bond and angle, each weighs w =
/// exp(−U/k_B T)/q, one is chosen by its weight, and k − 1 others are drawn beside the old place.
/// The move is accepted with min(1, Σ w new / Σ w old).
///
/// Only linear chains of one type of beads, all of whose bonds are of one group, and so their
/// angles and dihedrals if they have any, of REPTATION_LEAST_BEADS or more, in three dimensions.
#pragma once

#include "dynamics/reptation_draw.h"
#include "dynamics/reptation_grid.h"
#include "system/topology.h"

struct metropolis;

enum { REPTATION_LEAST_BEADS = 5 };

/// The numbers k of places that are tried: 1, 2, 4 and 8.
enum { REPTATION_CHOICES = 4 };
static inline int reptation_places(int choice) {
    return 1 << choice;
}

struct reptation_tally {
    uint64_t accepted, tried;
};

/// What one kind of molecules does.
struct reptation_kind {
    int choice; ///< k is reptation_places of it; −1: not done
    struct reptation_tally tally[REPTATION_CHOICES]; ///< since equilibration has begun or ended
};

/// A zeroed one is of no chains.
struct reptation {
    bool chains;                                     ///< a kind at least can do it
    bool can[TOPOLOGY_MOST_KINDS];                   ///< which ones
    int group[TOPOLOGY_MOST_KINDS][TOPOLOGY_ORDERS]; ///< of all terms of an order; −1: none
    struct reptation_kind kind[TOPOLOGY_MOST_KINDS]; ///< to be kept by a checkpoint
    struct reptation_grid grid;
    int32_t *bead; ///< shape [most beads]: numbers of one chain's particles, as a ring
};

/// Whether molecules of a kind are chains that can reptate, in space; whether it pays is not said.
/// Tested: test_explanation_counts_sweeps_and_names_chains.
bool mf_reptation_is_possible(const struct topology_kind *kind, int dimensions);

/// Which kinds can reptate; none does so until it has been tuned. Must be cleared. Fails:
/// NO_MEMORY. Tested: test_reptation.
enum status mf_reptation_init(struct reptation *reptation, const struct topology *topology,
                              int dimensions) MUST_USE;
void mf_reptation_clear(struct reptation *reptation);

/// Whether a kind reptates.
bool mf_reptation_is_on(const struct reptation *reptation);

/// Try to move each chain N/4k times, at least once, kind by kind, in the order in which a sweep
/// takes their first beads; then build the list anew. Fails: NO_MEMORY. Tested: test_reptation,
/// physics/test_molecule_moves.
enum status mf_reptation_pass(struct metropolis *metropolis) MUST_USE;

/// Begin to tune: tallies begin anew.
void mf_reptation_forget(struct reptation *reptation);

/// Before each sweep that tunes: try the next k.
void mf_reptation_tune(struct reptation *reptation, uint32_t sweep);

/// After the last one: of each kind take the k by which most moves were accepted for each place
/// drawn, or no reptation where that is below 1 %. Tallies begin anew.
void mf_reptation_choose(struct reptation *reptation);
