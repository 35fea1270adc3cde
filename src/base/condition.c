// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/condition.h"

#include <errno.h>
#include <math.h>
#include <time.h>

bool mf_condition_init(pthread_cond_t *condition) {
    pthread_condattr_t steady;
    if (pthread_condattr_init(&steady) != 0)
        return false;
    pthread_condattr_setclock(&steady, CLOCK_MONOTONIC);
    const bool made = pthread_cond_init(condition, &steady) == 0;
    pthread_condattr_destroy(&steady);
    return made;
}

bool mf_condition_wait(pthread_cond_t *condition, pthread_mutex_t *lock, double until) {
    const double whole = floor(until);
    const struct timespec time = {.tv_sec = (time_t)whole,
                                  .tv_nsec = (long)(1e9 * (until - whole))};
    return pthread_cond_timedwait(condition, lock, &time) != ETIMEDOUT;
}
