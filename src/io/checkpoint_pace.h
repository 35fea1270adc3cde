// SPDX-License-Identifier: GPL-3.0-or-later
/// @file When to save: not more often than wanted, and so seldom that it takes a hundredth of a
/// run's time at most, however large the state or slow the disk. Seconds are those of the run.
#pragma once

struct checkpoint_pace {
    double interval; ///< at least so long between two [s]
    double next;     ///< when it is time again
};

static inline void mf_checkpoint_pace_saved(struct checkpoint_pace *pace, double begun,
                                            double ended) {
    const double work = 99 * (ended - begun);
    pace->next = ended + (work > pace->interval ? work : pace->interval);
}
