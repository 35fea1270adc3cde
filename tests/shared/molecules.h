// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Molecules for tests.
#pragma once

#include "dynamics/simulation.h"
#include "forces/molecules.h"

/// A chain of beads one after the other, all of whose terms of an order up to `highest` are of
/// group 0.
struct topology_kind molecules_chain(int64_t count, const int *types, int beads, int highest,
                                     int exclude);

/// A topology of one or two kinds (the second with a count of 0: none), of `types` types of beads,
/// with single beads of each; returns the composition.
struct composition molecules_topology(struct topology *topology, struct topology_kind first,
                                      struct topology_kind second, int types,
                                      const int64_t *single);

/// A number of a law; the last of a list has no name.
struct molecules_number {
    const char *name;
    double value;
};

/// Add a group of a law with these numbers.
void molecules_add_group(struct molecules *molecules, int order, const struct bonded_law *law,
                         const struct molecules_number *numbers);

/// Let a setup be of molecules: its composition, count and interactions.
void molecules_enter(struct simulation_setup *setup, const struct molecules *molecules,
                     const struct composition *composition);
