// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The wish to stop, seen by every long loop: the user's (Ctrl-C), the machine's (SIGTERM),
/// or since nobody listens any more (SIGHUP, SIGPIPE).
#pragma once

#include <stdatomic.h>
#include <stdbool.h>

/// Catch SIGINT and SIGTERM from now on, a second one of which ends the program at once, and SIGHUP
/// and SIGPIPE unless they are ignored. Tested: test_signals.
void mf_interrupt_install(void);

/// Ask to stop as a user does with Ctrl-C, or take that back; what a signal has asked for stays.
/// From any thread. Tested: test_live_feed.
void mf_interrupt_wish(bool stop);

/// True once the user has asked to stop. Any thread may ask, as often as it likes.
bool mf_interrupt_requested(void);

/// The same, or once who owns the work has set `cancel`, unless that is NULL.
bool mf_interrupt_wanted(const atomic_bool *cancel);
