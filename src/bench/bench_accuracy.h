// SPDX-License-Identifier: GPL-3.0-or-later
/// @file `mesofit bench accuracy`: the work-precision diagram of a scene.
#pragma once

#include "report/run_folder.h"

struct bench_accuracy_options {
    const char *output;     ///< a TSV file, which figures are drawn of beside it, or NULL
    const char *error;      ///< |Δg| that is wanted, or NULL: 0.005
    const char *time;       ///< of a point [τ], or NULL: by the scene
    const char *time_steps; ///< "0.01,0.02", growing [τ], or NULL: from a quarter of the scene's on
    const char *integrators; ///< "aboba,shardlow", or NULL: all that suit
    bool json;               ///< instead of tables for people
};

/// Run the scene with every integrator that suits it, at time steps that grow until one is
/// unstable, and print what each costs and spoils. The simulations run side by side, one a thread;
/// all results but the seconds are the same for any number of threads.
/// @param[in] common  threads, seed and quiet count
/// Fails: BAD_INPUT, IO, NO_MEMORY; UNSTABLE if the reference is; INTERRUPTED, and nothing is kept.
/// Tested: tests/cli/test_bench_accuracy.c.
enum status mf_bench_accuracy(const char *file, const struct run_options *common,
                              const struct bench_accuracy_options *options) MUST_USE;
