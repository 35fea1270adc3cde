// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Adaptive thread count: how many threads share a step, as many as pay.
///
/// Threads that meet often are slower than one thread where steps are short or other processes
/// keep the cores busy. Both are tried now and then, and what took less time is used until the next
/// trial. Only for work whose bits do not depend on the number of threads.
#pragma once

#include <stdint.h>

enum { THREAD_COUNT_TRIED = 9, THREAD_COUNT_INTERVAL = 128, THREAD_COUNT_LONGEST = 4096 };

struct thread_count {
    int max;                               ///< threads that may be used
    int now;                               ///< threads of the next step: 1 or `max`
    int better;                            ///< of the last trial
    int steps;                             ///< since the last trial ended, or of this one
    int interval;                          ///< steps from trial to trial; 0: a trial is running
    int next_interval;                     ///< doubled as long as trials agree
    uint64_t tried[2][THREAD_COUNT_TRIED]; ///< times of steps with `max` threads, with one
};

/// At most `max` threads; with one there is nothing to try.
void mf_thread_count_init(struct thread_count *count, int max);

/// A step with count->now threads took `ticks`: settle count->now for the next one.
void mf_thread_count_update(struct thread_count *count, uint64_t ticks);
