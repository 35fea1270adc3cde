// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/thread_count.h"

#include <stdlib.h>

void mf_thread_count_init(struct thread_count *count, int max) {
    *count = (struct thread_count){
        .max = max, .now = max, .better = max, .next_interval = THREAD_COUNT_INTERVAL};
}

static int compare_ticks(const void *left, const void *right) {
    const uint64_t a = *(const uint64_t *)left, b = *(const uint64_t *)right;
    return (a > b) - (a < b);
}

/// The median: a step in which lists were built, or that another process cut short, does not count.
static uint64_t usual_ticks(uint64_t *tried) {
    qsort(tried, THREAD_COUNT_TRIED, sizeof *tried, compare_ticks);
    return tried[THREAD_COUNT_TRIED / 2];
}

static void end_trial(struct thread_count *count) {
    const int better =
        usual_ticks(count->tried[0]) <= usual_ticks(count->tried[1]) ? count->max : 1;
    if (better != count->better)
        count->next_interval = THREAD_COUNT_INTERVAL;
    count->interval = count->next_interval;
    if (2 * count->next_interval <= THREAD_COUNT_LONGEST)
        count->next_interval *= 2;
    count->better = count->now = better;
    count->steps = 0;
}

static void begin_trial(struct thread_count *count) {
    count->interval = 0;
    count->now = count->max;
    count->steps = 0;
}

void mf_thread_count_update(struct thread_count *count, uint64_t ticks) {
    if (count->max <= 1)
        return;
    const int step = count->steps++;
    if (count->interval > 0) {
        if (count->steps >= count->interval)
            begin_trial(count);
        return;
    }
    count->tried[step >= THREAD_COUNT_TRIED][step % THREAD_COUNT_TRIED] = ticks;
    count->now = count->steps < THREAD_COUNT_TRIED ? count->max : 1;
    if (count->steps == 2 * THREAD_COUNT_TRIED)
        end_trial(count);
}
