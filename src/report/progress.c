// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/progress.h"

#include "base/clock.h"

#include <stdarg.h>
#include <stdio.h>
#include <unistd.h>

/// Least time between two lines [s].
static const double terminal_interval = 0.2, pipe_interval = 5;

struct progress mf_progress_begin(bool quiet) {
    return (struct progress){
        .quiet = quiet, .terminal = isatty(STDERR_FILENO), .started = clock_seconds()};
}

double mf_progress_seconds(const struct progress *progress) {
    return clock_seconds() - progress->started;
}

static void format_duration(double seconds, char text[32]) {
    if (seconds < 100)
        snprintf(text, 32, "%.0f s", seconds);
    else if (seconds < 6000)
        snprintf(text, 32, "%.0f min", seconds / 60);
    else
        snprintf(text, 32, "%.1f h", seconds / 3600);
}

void mf_progress_tell(struct progress *progress, uint64_t done, uint64_t total, const char *unit,
                      const char *text) {
    const double now = clock_seconds();
    const double interval = progress->terminal ? terminal_interval : pipe_interval;
    if (progress->quiet || (now - progress->last < interval && done < total))
        return;
    progress->last = now;
    const double elapsed = now - progress->started;
    const double fresh = (double)(done - progress->done_before);
    char left[32] = "?";
    if (fresh > 0)
        format_duration(elapsed * (double)(total - done) / fresh, left);
    fprintf(stderr, "%s%s  %3.0f %%  %.3g %s/s  %s%s left%s", progress->terminal ? "\r\033[K" : "",
            text, 100 * (double)done / (double)total, elapsed > 0 ? fresh / elapsed : 0, unit,
            progress->may_end_early ? "at most " : "", left, progress->terminal ? "" : "\n");
    fflush(stderr);
    progress->open_line = progress->terminal;
}

void mf_progress_say(struct progress *progress, const char *format, ...) {
    if (progress->quiet)
        return;
    if (progress->open_line)
        fputs("\r\033[K", stderr);
    progress->open_line = false;
    va_list arguments;
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fputc('\n', stderr);
}

void mf_progress_say_scale(struct progress *progress, const struct units *units) {
    char line[UNITS_LINE_SIZE];
    mf_units_tell(units, line);
    if (mf_units_speaks(units))
        mf_progress_say(progress, "%s", line);
}
