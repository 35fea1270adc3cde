// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How long samples remember, by all runs of a fit together.
#pragma once

#include <math.h>
#include <stdbool.h>

/// Twice the correlation time of a pair type or group [sweeps], and the sweeps of each replica that
/// have shown it.
struct inversion_seen {
    double sweeps;
    double run;
};

struct inversion_memory {
    struct inversion_seen runs; ///< mean of the runs before, and how much it counts
    struct inversion_seen last; ///< of the present run
};

/// Samples that count as one independent, of a run in which so many were found to: it and the runs
/// before tell of one memory, each by its length, as what outlasts a short run is hardly seen by
/// it, and what one run has found scatters as much as its replicas are few. As the potential
/// changes, each counts half of what the next one does; and what a run has found itself counts as
/// half of it at least, as a few replicas tell it within a factor of two. With one correlation time
/// τ, samples h apart have 1 + 2 Σ exp(−kh/τ), k from 1 on, which is coth(h/2τ).
/// Tested: test_inversion_memory.
/// @param[in] every  sweeps between samples
/// @param[in] run    sweeps of each replica, in place of what was said of this run before
static inline double mf_inversion_memory_find(struct inversion_memory *memory, double every,
                                              double run, double found) {
    const struct inversion_seen *before = &memory->runs;
    memory->last = (struct inversion_seen){found > 1 ? every / atanh(1 / found) : 0, run};
    const double mean =
        (before->run * before->sweeps + run * memory->last.sweeps) / (before->run + run);
    return fmax(mean > 0 ? 1 / tanh(every / mean) : 1, 0.5 * found);
}

/// The next run begins; that of a potential that was given up does not count.
static inline void mf_inversion_memory_begin_run(struct inversion_memory *memory, bool given_up) {
    static const double kept = 0.5;
    struct inversion_seen *runs = &memory->runs, *last = &memory->last;
    const double run = runs->run + last->run;
    if (!given_up && last->run > 0) {
        runs->sweeps = (runs->run * runs->sweeps + last->run * last->sweeps) / run;
        runs->run = kept * run;
    }
    *last = (struct inversion_seen){0};
}
