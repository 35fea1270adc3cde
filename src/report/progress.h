// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Progress of long work: one updating line on a terminal, a line every few seconds at most
/// in a pipe, warnings alone with --quiet, always on stderr; and while a run works for longer than
/// that, progress.json in its folder, for who looks from elsewhere.
#pragma once

#include "io/units_scale.h"
#include "problem/inverse.h"
#include "report/watcher.h"
#include "scene/run_options.h"

#include <stdbool.h>
#include <stdint.h>

/// How long work still takes, from how long its parts took so far. Parts may come in periods, as
/// the simulations of an iteration that end all at once. The pace is that of whole periods, from
/// the half of what is done on, as the first ones may be other than the rest; inside a period the
/// time left runs down with the clock, and once the period takes longer than those before, the rate
/// ages.
struct progress_mark {
    double clock; ///< [s]
    uint64_t done;
};

struct progress_pace {
    uint64_t period;                                 ///< parts; 1: each by itself
    struct progress_mark begin, half, between, last; ///< ends of periods, in this order
};

/// Begin at a time with the parts that are done already.
struct progress_pace mf_progress_pace_begin(double clock, uint64_t done, uint64_t period);

/// Tell how many parts are done; they never become fewer.
void mf_progress_pace_update(struct progress_pace *pace, double clock, uint64_t done);

/// Parts a second, over the same time as what is left is reckoned from.
double mf_progress_pace_rate(const struct progress_pace *pace, double clock, uint64_t done);

/// Seconds left until `total` parts are done; NaN if nothing is known yet.
/// Tested: test_progress.
double mf_progress_pace_left(const struct progress_pace *pace, double clock, uint64_t done,
                             uint64_t total);

enum { PROGRESS_SAID_SIZE = 192 };

struct progress {
    enum run_words quiet;
    bool terminal;
    double started;                ///< clock at the begin [s]
    double last;                   ///< clock of the last line [s]
    uint64_t written;              ///< parts that were done then
    char said[PROGRESS_SAID_SIZE]; ///< its text
    const char *folder;            ///< where progress.json is to be, or NULL; borrowed
    double next;                   ///< clock of the next one [s]
    uint64_t done_before;          ///< parts that a run before a restart had done
    struct progress_pace pace;     ///< from the first word on
    uint64_t round, reported;      ///< of a fit: parts of an iteration, and the most reported
    bool open_line;                ///< the terminal's line has no end yet
    bool may_end_early;            ///< the time left is the most that it may take
    const struct watcher *watcher; ///< gets the same, or NULL; borrowed
};

/// @param[in] watcher  NULL: nobody watches
struct progress mf_progress_begin(enum run_words quiet, const struct watcher *watcher);

/// Seconds since mf_progress_begin.
double mf_progress_seconds(const struct progress *progress);

/// Tell that `done` of `total` parts are done; `text` says the rest. Adds rate and, once a part is
/// done, time left.
void mf_progress_report(struct progress *progress, uint64_t done, uint64_t total, const char *unit,
                        const char *text);

/// The same of a fit inside an iteration, whose passes or rounds may be of any size: an iteration
/// counts as many simulations as its first one, and what is done never becomes less. While samples
/// are doubled no remaining time is reported, as it is unknown.
/// Tested: test_progress.
void mf_progress_report_iteration(struct progress *progress, const struct inverse_progress *now,
                                  const char *text);

/// A rate with three digits and no power of ten, "1.87 simulations/min": what is rare is told by
/// the minute or the hour. Tested: test_progress.
enum { PROGRESS_RATE_SIZE = 64 };
void mf_progress_rate_text(double rate, const char *unit, char text[PROGRESS_RATE_SIZE]);

/// Remove progress.json, if there is a folder for it: nothing works there any more.
void mf_progress_end(const struct progress *progress);

/// End the updating line, if there is one, and print a line of its own; if quiet, one alone that
/// begins with "mesofit: warning: ". Tested: test_progress.
void mf_progress_print(struct progress *progress, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/// Tell who watches, if anybody does, what has begun, and that tables of the folder are new. From
/// now on there is progress.json in the folder.
void mf_progress_report_run(struct progress *progress, const struct watcher_run *run);
void mf_progress_report_written(const struct progress *progress);

/// Whether who watches wants a simulation to go on with another temperature or time step.
bool mf_progress_ask_change(const struct progress *progress, struct simulation_change *change);

/// Whether who watches wants an inversion to go on with another damping.
bool mf_progress_ask_damping(const struct progress *progress, double *damping);

/// Say what the scale of a file in physical units is.
void mf_progress_print_scale(struct progress *progress, const struct units *units);
