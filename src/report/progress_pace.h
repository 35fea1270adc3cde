// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How long work still takes, from how long its parts took so far.
///
/// Parts may come in periods, as the simulations of an iteration that end all at once. The pace is
/// that of whole periods, from the half of what is done on, as the first ones may be other than the
/// rest; inside a period the time left runs down with the clock, and once the period takes longer
/// than those before, the rate ages.
#pragma once

#include <stdint.h>

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
