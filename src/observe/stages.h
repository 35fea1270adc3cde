// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The stages of a step and what each costs, as `--explain` prints them.
#pragma once

#include "dynamics/simulation.h"
#include "io/units_scale.h"

#include <stdbool.h>

/// Nanoseconds, measured on Zen 5 with AVX-512 in mixed precision, one thread, that several stages
/// need: to make a list, of a particle and of an entry; to go through it, of an entry.
struct stages_cost {
    double sort, build, go_through;
};
extern const struct stages_cost mf_stages_cost;

enum { STAGES_MAX = 40 };

struct stage {
    const char *name;
    bool on;
    double nanoseconds; ///< of a particle and step
    char why[160];
};

struct stages {
    const struct units *units; ///< of their lengths
    struct stage stage[STAGES_MAX];
    int count;
};

/// Add a stage that takes so many nanoseconds of a particle and step, if it is on. Beyond
/// STAGES_MAX nothing is added.
void mf_stages_add(struct stages *stages, const char *name, bool on, double nanoseconds,
                   const char *format, ...) __attribute__((format(printf, 5, 6)));

/// "0.465 nm", a length in %.*g and the units that are spoken, without the name of reduced ones.
enum { STAGES_LENGTH_SIZE = 64 };
const char *mf_stages_length(const struct stages *stages, double length, int digits,
                             char text[STAGES_LENGTH_SIZE]);

/// Pairs of a particle nearer than r in a uniform fluid, each pair once.
double mf_stages_pairs_within(const struct simulation_setup *setup, double r);

/// Cutoff of the forces [λ]: the larger one of potential and friction weight.
double mf_stages_cutoff(const struct simulation_setup *setup);
