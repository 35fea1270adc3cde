// SPDX-License-Identifier: GPL-3.0-or-later
/// @file `mesofit bench stability`: which time step goes with which friction and which stiffness.
#pragma once

#include "report/run_folder.h"

struct bench_stability_options {
    const char *output;      ///< a TSV file, which a figure is drawn of beside it, or NULL
    const char *time;        ///< of a run [τ], or NULL: 5
    const char *integrators; ///< "aboba,shardlow", or NULL: all that suit
};

/// Run a scene with every integrator that suits it at time steps from a sixteenth of its own to
/// five times that, with friction ω² from a quarter to 256 times, and with potentials from a
/// quarter to 64 times as strong as it says, and print how far both temperatures are off, and where
/// runs end as unstable. The same for any number of threads.
/// @param[in] file  a scene, or NULL: the fluid of Groot and Warren, 375 beads
/// Fails: BAD_INPUT, IO, NO_MEMORY, INTERRUPTED. Tested: cli/test_bench_stability.
enum status mf_bench_stability(const char *file, const struct run_options *common,
                               const struct bench_stability_options *options) MUST_USE;
