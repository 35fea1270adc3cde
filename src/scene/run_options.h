// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the command line says to every run.
#pragma once

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

struct caller_observables;
struct fit_file;
struct sampling_engine;
struct json_word;
struct watcher;

/// How much a run says. Warnings are of its results, which nobody may miss in a batch job.
enum run_words {
    RUN_SAYS_ALL,
    RUN_WARNS,       ///< --quiet
    RUN_SAYS_NOTHING ///< a watcher is told, or another rank says it
};

/// Who starts another engine for a fit: a run file names no command, since what a stranger has
/// written must run nothing.
struct engine_door {
    const char *command; ///< NULL: none was named
    /// Fails: BAD_INPUT for a scene that it cannot sample; NO_MEMORY.
    /// @param[in] resume  the fit goes on, so that what lies in its folder is its own
    enum status (*open)(const char *command, const struct fit_file *fit, const char *folder,
                        bool resume, const struct sampling_engine **engine);
    /// Say for what a fit that was stopped waits, into `text`; false if it does not.
    bool (*waits)(const struct sampling_engine *engine, char *text, size_t size);
    void (*close)(const struct sampling_engine *engine); ///< of NULL: nothing
};

/// Options that all runs share, from the command line.
struct run_options {
    const char *folder; ///< -o, or NULL: `out` beside the input file
    int threads;
    bool has_threads; ///< they were asked for
    bool has_seed;
    uint64_t seed; ///< --seed, instead of the input file's
    enum run_words quiet;
    bool resume;
    bool force;                    ///< replace the results that are in the folder
    bool no_figures;               ///< none are drawn in the folder
    const struct json_word *words; ///< about the run file (io/json.h), shape [word_count]; borrowed
    size_t word_count;
    const struct engine_door *engine; ///< for inversions, or NULL; borrowed
    const atomic_bool *stop;          ///< ends the run as Ctrl-C does, or NULL; borrowed
    /// What a simulation measures besides (observe/caller_observable.h), or NULL; borrowed.
    const struct caller_observables *callers;
    const struct watcher *watcher; ///< who watches the run (report/watcher.h), or NULL; borrowed
};
