// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Time. All of it is by clocks that are never set back.
#pragma once

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>
#include <sys/resource.h>
#include <time.h>

/// Seconds since some moment in the past, never set back.
static inline double clock_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/// Wait until the condition is signalled, or clock_seconds() is `until`: false then. The lock is
/// held. Tested: tests/stress/test_clock.c.
bool mf_clock_wait(pthread_cond_t *condition, pthread_mutex_t *lock, double until);

/// Seconds of processor time that this thread has had.
static inline double clock_thread_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/// Seconds of processor time that all threads of this process have had.
static inline double clock_process_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/// Seconds of processor time that programs have had which this one has started and which have
/// ended.
static inline double clock_children_seconds(void) {
    struct rusage used;
    getrusage(RUSAGE_CHILDREN, &used);
    return (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           1e-6 * (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

/// Ticks of the processor's time-stamp counter, a few nanoseconds to read; nanoseconds where there
/// is none.
static inline uint64_t clock_ticks(void) {
#if defined(__x86_64__)
    return __builtin_ia32_rdtsc();
#else
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
#endif
}
