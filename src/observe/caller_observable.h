// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Observables of who calls the library: a function of positions and velocities, whose means
/// become a table. Scene files do not know them.
#pragma once

#include "observe/observable.h"

/// What a function is told of a sample, by the ids of the particles, in the units of the scene.
struct caller_sample {
    size_t count;
    int dimensions;
    const double *position; ///< shape [count, dimensions], in the box [λ]
    const double *velocity; ///< the same [λ/τ]; NULL of dynamics without
    const int32_t *type;    ///< shape [count], from 0 on
    const double *edge;     ///< of the box, shape [dimensions] [λ]
};

/// Write its values, if there is room for them. @return how many there are, below 0 if it failed
typedef ptrdiff_t caller_function(void *context, const struct caller_sample *sample, size_t room,
                                  double *values);

struct caller_observable {
    const char *name; ///< and of its table
    caller_function *function;
    void *context;
};

enum { CALLER_OBSERVABLES_MAX = 16 };

struct caller_observables {
    size_t count;
    struct caller_observable item[CALLER_OBSERVABLES_MAX];
};

/// Refuse names that no table can have, that tables of the program have, and that come twice.
/// Fails: BAD_INPUT. Tested: test_run_observables.
enum status mf_caller_observables_check(const struct caller_observables *observables) MUST_USE;

/// One of them is its settings. It samples as the plan says; fails also with BAD_INPUT, by what the
/// function answers.
extern const struct observable mf_caller_observable;
