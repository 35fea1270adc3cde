// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Pair laws, and systems of particles on which the pair kernels are tested.
#pragma once

#include "forces/pair.h"

/// The curves of these laws.
struct pairs_tables {
    struct table soft, lennard_jones, gaussian, sampled, omega, thesis_omega;
};

extern struct pairs_tables pairs_tables;

/// @name For cmocka_run_group_tests: make the tables, and clear them.

int pairs_begin(void **state);
int pairs_end(void **state);

/// Where the particles of a system are.
enum pairs_arrangement {
    PAIRS_LATTICE,
    PAIRS_RANDOM,
    PAIRS_CLUSTERED ///< within 0.6 of the corner, on all sides of it
};

struct pairs_system {
    struct box box;
    size_t count;
    enum pairs_arrangement arrangement;
    double skin;
};

/// A law of temperature 1.3 and time step 0.02; either table may be NULL.
struct pair_law pairs_law(const struct table *potential, const struct table *omega);

/// Particles with velocities, in the order of their ids.
void pairs_place(struct particles *particles, const struct pairs_system *system);

/// Particles, sorted, with their list and what the kernels read.
void pairs_make(struct particles *particles, struct neighbours *neighbours,
                const struct pairs_system *system, const struct pair_law *law);
