// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What is measured of the molecules of a trajectory, by the observables of simulations: bond
/// lengths, angles, dihedrals, sizes. The configuration that they are told has the beads of a
/// frame, each molecule whole, in a box without end.
#pragma once

#include "measure/molecule_match.h"
#include "observe/bonded_distribution.h"
#include "observe/measure.h"

/// Molecules that a trajectory may have, as a file tells of them. Borrowed.
struct measured_molecules_plan {
    struct molecules *molecules; ///< whose topology is not completed
    const struct composition *types;
    const char *file;
};

enum { MEASURED_MOLECULES_MAX = (int)BONDED_KINDS + 1 };

/// All zero: there are none.
struct measured_molecules {
    struct molecules *molecules; ///< completed; borrowed
    const struct mapping *mapping;
    struct molecule_match match;
    const struct composition *composition; ///< borrowed
    struct particles particles;            ///< the beads where the mapping has them
    struct configuration configuration;    ///< of them
    size_t max_beads;                      ///< of a molecule
    int *order, *parent;                   ///< shape [kinds, max_beads]: mf_topology_walk
    uint32_t (*excluded)[2]; ///< shape [excluded_count]: pairs of beads, as the mapping has them
    size_t excluded_count;
    struct observable_use use[MEASURED_MOLECULES_MAX + 1]; ///< ended by one without an observable
};

/// Find the molecules among the beads. Fails: as mf_molecule_match.
enum status mf_measured_molecules_begin(struct measured_molecules *measured,
                                        const struct measured_molecules_plan *plan,
                                        const struct mapping *mapping,
                                        const struct composition *composition) MUST_USE;

/// Begin to measure with a frame of beads, by whose bonds it is known how far lengths go.
/// @param[in] interval  between frames [ps]; NAN: not known, so that nothing is told of time
/// Fails: NO_MEMORY.
enum status mf_measured_molecules_start(struct measured_molecules *measured,
                                        const struct trajectory_frame *beads,
                                        double interval) MUST_USE;

/// Add a frame of beads. Fails: NO_MEMORY. Tested: cli/test_measure_molecules.
enum status mf_measured_molecules_add(struct measured_molecules *measured,
                                      const struct trajectory_frame *beads) MUST_USE;

/// When all frames have been added: bins as wide as the distributions ask for.
void mf_measured_molecules_end(struct measured_molecules *measured);

/// How wide the distribution of a group is, of an order of which there are groups.
/// Fails: NO_MEMORY.
enum status mf_measured_molecules_moments(const struct measured_molecules *measured, int order,
                                          int group, struct bonded_moments *moments) MUST_USE;
void mf_measured_molecules_clear(struct measured_molecules *measured);
