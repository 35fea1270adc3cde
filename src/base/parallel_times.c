// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel_times.h"

static struct parallel_times seen;

/// The entry of this number of tasks, a new one, or the nearest.
static struct parallel_size *find(size_t tasks) {
    size_t nearest = 0;
    for (size_t k = 0; k < seen.sizes; k++) {
        const size_t other = seen.size[nearest].tasks, own = seen.size[k].tasks;
        const size_t before = other > tasks ? other - tasks : tasks - other;
        const size_t now = own > tasks ? own - tasks : tasks - own;
        if (now < before)
            nearest = k;
    }
    if (seen.sizes == 0 ||
        (seen.size[nearest].tasks != tasks && seen.sizes < PARALLEL_MOST_SIZES)) {
        nearest = seen.sizes++;
        seen.size[nearest].tasks = tasks;
    }
    return &seen.size[nearest];
}

void mf_parallel_times_add(size_t tasks, const struct running_mean *seconds, double waited) {
#pragma omp critical
    {
        struct parallel_size *size = find(tasks);
        size->rounds++;
        size->waited += waited;
        size->done += seconds->count;
        size->seconds += seconds->count * seconds->mean;
        if (seconds->mean > 0)
            size->squares += seconds->squares / (seconds->mean * seconds->mean);
    }
}

struct parallel_times mf_parallel_times(void) {
    struct parallel_times times;
#pragma omp critical
    times = seen;
    return times;
}
