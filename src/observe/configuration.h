// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A configuration: what observables are told, whoever made it.
///
/// Its source is a simulation of ours, which has all that observables ask for, or a trajectory, of
/// which there are no more than places, in a box of any shape, and what files tell of molecules,
/// masses and times. What a source has not is NULL or NAN. An observable that goes by what all
/// sources have is `of_places` (observe/observable.h).
#pragma once

#include "dynamics/simulation.h"
#include "forces/molecules.h"
#include "system/box_vectors.h"

/// How many pairs there are at which distance, as a source has counted them.
struct configuration_counts {
    const uint64_t *all, *apart; ///< shape [pair types, stride]: of all beads that are pairs, and
                                 ///< of those of different molecules
    size_t stride;
    const double *share; ///< shape [pair types]: of a type's pairs that `all` looks at
};

struct configuration {
    struct simulation *simulation; ///< whose it is; NULL: of a trajectory
    int dimensions, threads;       ///< threads: that a sample may take
    size_t count;                  ///< of beads
    struct box_vectors box;
    const struct composition *composition; ///< types of the beads by their ids
    const struct molecules *molecules;     ///< that the beads are, or NULL
    double temperature;                    ///< of noise and moves [k_B T_0]; 0: not known
    double time_step; ///< between the steps that plans count [τ]; NAN: unknown
    bool sweeps;      ///< these steps are sweeps of Monte Carlo: there is no time
    /// The beads: ids, places, masses. Those of molecules of a trajectory are made whole, in a box
    /// without end; NULL: the trajectory tells of no molecules.
    const struct particles *particles;
    int32_t *const *fraction; ///< shape [3][count], of beads in the order of types: their places in
                              ///< the box (system/box_vectors.h); NULL of a simulation
    const uint32_t *molecule; ///< of these, shape [count]: pairs of one are none; NULL: those that
                              ///< topologies exclude are not
    const struct configuration_counts *counts; ///< in the bins of g(r); NULL of a simulation
    const double *mass; ///< of these, shape [count] [u]; NULL: not all are known, or of a
                        ///< simulation
};

/// What a simulation holds now, until it goes on. Tested: test_configuration.
struct configuration mf_configuration_of(struct simulation *simulation);

/// Types and numbers of the beads, also of those that are alike.
struct composition mf_configuration_types(const struct configuration *configuration);

/// Where the beads are along a vector of the box, as parts of its length; whole boxes are left out
/// only of a trajectory. @param[out] share  shape [count], in the order of types
/// Tested: test_configuration.
void mf_configuration_shares(const struct configuration *configuration, int axis, double *share);

/// Whether beads of these ids, or numbers in the order of types, are no pair. Tested:
/// test_configuration.
bool mf_configuration_leaves_out(const struct configuration *configuration, uint32_t a, uint32_t b);
