// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel_times.h"

#include "base/process_lock.h"

#include <stdlib.h>

static struct parallel_times seen;

/// The entry of this number of tasks, a new one, or the nearest.
static struct parallel_size *find(size_t tasks) {
    struct parallel_size *nearest = NULL;
    for (struct parallel_size *at = seen.size; at < seen.size + seen.sizes; at++)
        if (nearest == NULL ||
            llabs((long long)(at->tasks - tasks)) < llabs((long long)(nearest->tasks - tasks)))
            nearest = at;
    if ((nearest == NULL || nearest->tasks != tasks) && seen.sizes < PARALLEL_MAX_SIZES) {
        nearest = &seen.size[seen.sizes++];
        nearest->tasks = tasks;
    }
    return nearest;
}

void mf_parallel_times_add(size_t tasks, const struct running_mean *seconds, double waited) {
    mf_process_lock();
    struct parallel_size *size = find(tasks);
    size->rounds++;
    size->waited += waited;
    size->done += seconds->count;
    size->seconds += seconds->count * seconds->mean;
    if (seconds->mean > 0)
        size->squares += seconds->squares / (seconds->mean * seconds->mean);
    mf_process_unlock();
}

struct parallel_times mf_parallel_times(void) {
    mf_process_lock();
    const struct parallel_times times = seen;
    mf_process_unlock();
    return times;
}
