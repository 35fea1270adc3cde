// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/progress_pace.h"

#include <math.h>
#include <stdbool.h>

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
