// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the command line says to every run.
#pragma once

#include <stdbool.h>
#include <stdint.h>

struct watcher;

/// Options that all runs share, from the command line.
struct run_options {
    const char *folder; ///< -o, or NULL: `out` beside the input file
    int threads;
    bool has_threads; ///< they were asked for
    bool has_seed;
    uint64_t seed; ///< --seed, instead of the input file's
    bool quiet, resume;
    bool force;                    ///< replace the results that are in the folder
    const struct watcher *watcher; ///< who watches the run (report/watcher.h), or NULL; borrowed
};
