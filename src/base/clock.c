// SPDX-License-Identifier: GPL-3.0-or-later
#define _GNU_SOURCE // pthread_cond_clockwait
#include "base/clock.h"

#include <errno.h>
#include <math.h>

bool mf_clock_wait(pthread_cond_t *condition, pthread_mutex_t *lock, double until) {
    const double whole = floor(until);
    const struct timespec time = {.tv_sec = (time_t)whole,
                                  .tv_nsec = (long)(1e9 * (until - whole))};
    return pthread_cond_clockwait(condition, lock, CLOCK_MONOTONIC, &time) != ETIMEDOUT;
}
