// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Someone who watches a run while it works.
///
/// A run tells of itself through the calls of a watcher, and reads nothing back but how soon the
/// next word is wanted, and whether a person has changed its temperature, time step or damping:
/// without such a change its results are the same bits with a watcher and without. A call may wait;
/// the run then waits, too.
#pragma once

#include "dynamics/simulation_change.h"
#include "observe/measure.h"
#include "problem/unknowns.h"
#include "report/run_folder.h"

#include <stdint.h>

/// A run that has begun. Borrowed until its end.
struct watcher_run {
    enum run_kind kind;
    const char *folder;            ///< of its results
    const struct units *units;     ///< of its files
    struct simulation *simulation; ///< and what follows: NULL of a fit
    const struct measure_plan *plan;
    const struct observable_use *observables; ///< ended by one without an observable
    const struct unknowns *unknowns;          ///< and what follows: of a fit, else NULL
    const struct targets *targets;
    const double *damping; ///< of an inversion; NULL: there is none
};

/// How far it is.
struct watcher_progress {
    uint64_t done, total;
    const char *unit, *text;                   ///< of what `done` counts; what else there is to say
    double rate;                               ///< parts a second
    const struct inverse_candidate *candidate; ///< of a fit that has one
    bool open;                                 ///< the total is unknown
};

/// All but `report` and `print` may be NULL.
struct watcher {
    void *context;
    void (*begin)(void *context, const struct watcher_run *run);
    /// From one thread at a time, of a simulation between two of its steps.
    void (*report)(void *context, const struct watcher_progress *progress);
    void (*print)(void *context, const char *line); ///< a line for the person
    void (*write)(void *context);                   ///< tables of the folder are new
    /// Steps of a simulation until the next word at most; 0: as many as it likes.
    int64_t (*steps)(void *context);
    /// Whether a simulation is to go on with another temperature or time step, asked for after each
    /// word: one that mf_simulation_check_change allows, given once.
    bool (*change)(void *context, struct simulation_change *change);
    /// Whether an inversion is to go on with another damping, above 0 and at most 1, asked for
    /// before each iteration and given once.
    bool (*damp)(void *context, double *damping);
};
