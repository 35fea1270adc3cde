// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Conditions of threads that are waited for until a time, by the clock that is never set
/// back (base/clock.h).
#pragma once

#include <pthread.h>
#include <stdbool.h>

/// False without memory; else to be ended by pthread_cond_destroy.
bool mf_condition_init(pthread_cond_t *condition);

/// Wait until the condition is signalled, or clock_seconds() is `until`: false then. The lock is
/// held. Tested: tests/stress/test_clock.c.
bool mf_condition_wait(pthread_cond_t *condition, pthread_mutex_t *lock, double until);
