// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/progress.h"

#include "base/clock.h"
#include "base/terminal.h"
#include "io/json_write.h"
#include "io/tracked_files.h"

#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

// How long work still takes -----------------------------------------------------------------------

struct progress_pace mf_progress_pace_begin(double clock, uint64_t done, uint64_t period) {
    const struct progress_mark now = {clock, done};
    return (struct progress_pace){period, now, now, now, now};
}

void mf_progress_pace_update(struct progress_pace *pace, double clock, uint64_t done) {
    const struct progress_mark now = {clock, done};
    if (done / pace->period == pace->last.done / pace->period)
        return;
    pace->last = now;
    if (now.done - pace->between.done < pace->between.done - pace->begin.done)
        return;
    pace->half = pace->between;
    pace->between = now;
}

static double rate_between(struct progress_mark from, struct progress_mark to) {
    return to.clock > from.clock ? (double)(to.done - from.done) / (to.clock - from.clock) : 0;
}

double mf_progress_pace_rate(const struct progress_pace *pace, double clock, uint64_t done) {
    if (pace->last.done == pace->begin.done)
        return rate_between(pace->begin, (struct progress_mark){clock, done});
    // A period that is overdue makes the rate less, as if it ended now.
    const struct progress_mark next = {clock, pace->last.done + pace->period};
    return fmin(rate_between(pace->half, pace->last), rate_between(pace->half, next));
}

double mf_progress_pace_left(const struct progress_pace *pace, double clock, uint64_t done,
                             uint64_t total) {
    // A period that takes longer than those before is said to be near its end until it is there.
    static const double near = 0.1;
    const uint64_t last = pace->last.done;
    if (done >= total)
        return 0;
    const double rate = mf_progress_pace_rate(pace, clock, done);
    const double each = rate > 0 ? 1 / rate : 0;
    if (last > pace->begin.done) {
        const double now = fmin((double)pace->period, (double)(total - last));
        return fmax(each * (double)(total - last) - (clock - pace->last.clock),
                    each * ((double)(total - last) - now + near * (now - (double)(done - last))));
    }
    return done > pace->begin.done ? each * (double)(total - done) : NAN;
}

// Lines -------------------------------------------------------------------------------------------

/// Least time between two lines, and between two files [s].
static const double terminal_interval = 0.2, pipe_interval = 5, file_interval = 5;

/// Part of the time that files may take: a disk of a cluster may be slow.
static const double file_share = 1.0 / 1000;

struct progress mf_progress_begin(enum run_words quiet, const struct watcher *watcher) {
    return (struct progress){.quiet = quiet,
                             .terminal = isatty(STDERR_FILENO),
                             .started = clock_seconds(),
                             .next = clock_seconds() + file_interval,
                             .watcher = watcher};
}

double mf_progress_seconds(const struct progress *progress) {
    return clock_seconds() - progress->started;
}

/// With two digits, so that it agrees with rate and parts to be done.
static void format_duration(double seconds, char text[32]) {
    if (seconds < 99.5)
        snprintf(text, 32, "%.0f s", seconds);
    else if (seconds < 597)
        snprintf(text, 32, "%.1f min", seconds / 60);
    else if (seconds < 5970)
        snprintf(text, 32, "%.0f min", seconds / 60);
    else
        snprintf(text, 32, "%.1f h", seconds / 3600);
}

void mf_progress_rate_text(double rate, const char *unit, char text[PROGRESS_RATE_SIZE]) {
    static const struct {
        double seconds;
        const char *name;
    } times[] = {{1, "s"}, {60, "min"}, {3600, "h"}};
    int k = 0;
    while (k < 2 && rate * times[k].seconds < 0.1)
        k++;
    rate *= times[k].seconds;
    const double step = rate >= 999.5 ? pow(10, floor(log10(rate)) - 2) : 0;
    if (step > 0)
        snprintf(text, PROGRESS_RATE_SIZE, "%.0f %s/%s", step * rint(rate / step), unit,
                 times[k].name);
    else
        snprintf(text, PROGRESS_RATE_SIZE, "%.3g %s/%s", rate, unit, times[k].name);
}

static void find_file(const struct progress *progress, char path[OUTPUT_PATH_SIZE]) {
    snprintf(path, OUTPUT_PATH_SIZE, "%s/" PROGRESS_FILE, progress->folder);
}

/// Now and then. Where it cannot be written, it is tried no more: the run has more to say than
/// this.
static void write_file(struct progress *progress, const struct watcher_progress *now,
                       const char *left) {
    const double begun = clock_seconds();
    char path[OUTPUT_PATH_SIZE];
    if (progress->folder == NULL || begun < progress->next)
        return;
    struct json_writer *writer = mf_json_writer_create();
    mf_json_write_integer(writer, "done", (int64_t)now->done);
    mf_json_write_integer(writer, "total", (int64_t)now->total);
    mf_json_write_text(writer, "unit", now->unit);
    mf_json_write_number(writer, "rate", now->rate);
    if (left[0])
        mf_json_write_text(writer, "left", left);
    mf_json_write_text(writer, "text", now->text);
    find_file(progress, path);
    const bool written = mf_json_write(writer, path) == STATUS_OK;
    mf_json_writer_free(writer);
    const double ended = clock_seconds();
    progress->next = written ? ended + fmax(file_interval, (ended - begun) / file_share) : INFINITY;
}

void mf_progress_end(const struct progress *progress) {
    char path[OUTPUT_PATH_SIZE];
    if (progress->folder == NULL)
        return;
    find_file(progress, path);
    mf_tracked_files_remove(path);
}

/// Whether it was written before, but for rate and time left: in a file it would stand there twice.
static bool is_said(const struct progress *progress, const struct watcher_progress *reported) {
    return !progress->terminal && progress->last > 0 && progress->written == reported->done &&
           strncmp(progress->said, reported->text, sizeof progress->said - 1) == 0;
}

/// One line a while, the last one always.
static void write_line(struct progress *progress, const struct watcher_progress *reported,
                       const char *left) {
    const double now = clock_seconds();
    char rate[PROGRESS_RATE_SIZE];
    const double interval = progress->terminal ? terminal_interval : pipe_interval;
    const bool ends = reported->done == reported->total && progress->written != reported->total;
    if (progress->quiet || (now - progress->last < interval && !ends) ||
        is_said(progress, reported))
        return;
    progress->last = now;
    progress->written = reported->done;
    snprintf(progress->said, sizeof progress->said, "%s", reported->text);
    if (progress->terminal)
        mf_terminal_clear_line();
    fprintf(stderr, "%s  %3.0f %%", reported->text,
            100 * (double)reported->done / (double)reported->total);
    mf_progress_rate_text(reported->rate, reported->unit, rate);
    if (!reported->open && reported->rate > 0)
        fprintf(stderr, "  %s", rate);
    if (left[0])
        fprintf(stderr, "  %s left", left);
    if (!progress->terminal)
        fputc('\n', stderr);
    progress->open_line = progress->terminal;
}

/// Report to all listeners, with rate and time left unless the total is unknown.
static void report_all(struct progress *progress, struct watcher_progress reported) {
    const double now = clock_seconds();
    const struct watcher *watcher = progress->watcher;
    char time[32], left[48] = "";
    if (progress->pace.period == 0)
        progress->pace = mf_progress_pace_begin(progress->started, progress->done_before, 1);
    mf_progress_pace_update(&progress->pace, now, reported.done);
    reported.rate = mf_progress_pace_rate(&progress->pace, now, reported.done);
    const double seconds =
        mf_progress_pace_left(&progress->pace, now, reported.done, reported.total);
    if (!reported.open && !isnan(seconds)) {
        format_duration(seconds, time);
        snprintf(left, sizeof left, "%s%s", progress->may_end_early ? "at most " : "", time);
    }
    write_file(progress, &reported, left);
    if (watcher)
        watcher->report(watcher->context, &reported);
    write_line(progress, &reported, left);
}

void mf_progress_report(struct progress *progress, uint64_t done, uint64_t total, const char *unit,
                        const char *text) {
    report_all(progress,
               (struct watcher_progress){.done = done, .total = total, .unit = unit, .text = text});
}

void mf_progress_report_iteration(struct progress *progress, const struct inverse_progress *now,
                                  const char *text) {
    if (progress->round == 0) {
        progress->round = now->total;
        progress->done_before = now->iteration * now->total + now->done - 1;
        progress->pace =
            mf_progress_pace_begin(progress->started, progress->done_before, now->total);
    }
    const uint64_t done =
        now->iteration * progress->round + progress->round * now->done / now->total;
    const uint64_t total = now->iterations * progress->round;
    progress->reported = done > progress->reported ? done : progress->reported;
    report_all(progress, (struct watcher_progress){
                             .done = progress->reported,
                             .total = total > progress->reported ? total : progress->reported,
                             .unit = "simulations",
                             .text = text,
                             .candidate = now->candidate,
                             .open = now->doubling.number > 0});
}

static bool is_warning(const char *line) {
    static const char begin[] = "mesofit: warning: ";
    return strncmp(line, begin, sizeof begin - 1) == 0;
}

void mf_progress_print(struct progress *progress, const char *format, ...) {
    const struct watcher *watcher = progress->watcher;
    char line[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    if (watcher)
        watcher->print(watcher->context, line);
    if (progress->quiet > (is_warning(line) ? RUN_WARNS : RUN_SAYS_ALL))
        return;
    if (progress->open_line)
        mf_terminal_clear_line();
    progress->open_line = false;
    fprintf(stderr, "%s\n", line);
}

void mf_progress_report_run(struct progress *progress, const struct watcher_run *run) {
    progress->folder = run->folder;
    if (progress->watcher && progress->watcher->begin)
        progress->watcher->begin(progress->watcher->context, run);
}

void mf_progress_report_written(const struct progress *progress) {
    if (progress->watcher && progress->watcher->write)
        progress->watcher->write(progress->watcher->context);
}

bool mf_progress_ask_change(const struct progress *progress, struct simulation_change *change) {
    const struct watcher *watcher = progress->watcher;
    return watcher && watcher->change && watcher->change(watcher->context, change);
}

bool mf_progress_ask_damping(const struct progress *progress, double *damping) {
    const struct watcher *watcher = progress->watcher;
    return watcher && watcher->damp && watcher->damp(watcher->context, damping);
}

void mf_progress_print_scale(struct progress *progress, const struct units *units) {
    char line[UNITS_LINE_SIZE];
    mf_units_print(units, line);
    if (mf_units_are_physical(units))
        mf_progress_print(progress, "%s", line);
}
