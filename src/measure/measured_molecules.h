// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What is measured of the molecules of a trajectory, by the observables of simulations: bond
/// lengths, angles, dihedrals, sizes. The configuration that they are told has the beads of a
/// frame, each molecule whole, in a box without end.
#pragma once

#include "forces/molecules.h"
#include "trajectory/mapping.h"

/// Molecules that a trajectory may have, as a file tells of them. Borrowed.
struct measured_molecules_plan {
    struct molecules *molecules; ///< whose topology is not completed
    const struct composition *types;
    const char *file;
};

/// All zero: there are none.
struct measured_molecules {
    struct molecules *molecules; ///< completed; borrowed
    const struct mapping *mapping;
    size_t *bead; ///< shape [particles], by the id that the topology gives: number in the
                  ///< mapping
    struct particles particles; ///< the beads where the mapping has them
    size_t max_beads;           ///< of a molecule
    int *order, *parent;        ///< shape [kinds, max_beads]: mf_topology_walk
    uint32_t (*excluded)[2];    ///< shape [excluded_count]: pairs of beads, as the mapping has them
    size_t excluded_count;
};

/// Find the molecules among the beads. Fails: BAD_INPUT, naming the file and the bead that does not
/// fit; NO_MEMORY. Tested: test_molecule_match.
enum status mf_measured_molecules_begin(struct measured_molecules *measured,
                                        const struct measured_molecules_plan *plan,
                                        const struct mapping *mapping,
                                        const struct composition *composition) MUST_USE;

/// Make room for the beads, and let groups of bonds rest at their mean lengths in a frame, by which
/// it is known how far lengths go. Fails: NO_MEMORY.
enum status mf_measured_molecules_start(struct measured_molecules *measured,
                                        const struct trajectory_frame *beads) MUST_USE;

/// Make the molecules of a frame of beads whole. Tested: cli/test_measure_molecules.
void mf_measured_molecules_place(struct measured_molecules *measured,
                                 const struct trajectory_frame *beads);
void mf_measured_molecules_clear(struct measured_molecules *measured);
