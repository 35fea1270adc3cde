// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Stop requests, which every long loop looks for: the user's (Ctrl-C), the machine's
/// (SIGTERM, SIGUSR1), or since nobody listens any more (SIGHUP, SIGPIPE).
#pragma once

#include <stdatomic.h>
#include <stdbool.h>

/// Catch SIGINT and SIGTERM from now on, a second one of which ends the program at once, and
/// SIGHUP, SIGPIPE and SIGUSR1 unless they are ignored. Tested: test_signals.
void mf_interrupt_install(void);

/// Ask to stop as a user does with Ctrl-C, or take that back; what a signal has asked for stays.
/// From any thread. Tested: test_live_feed.
void mf_interrupt_request(bool stop);

/// True once the user has asked to stop. Any thread may ask, as often as it likes.
bool mf_interrupt_requested(void);

/// The same, or once who owns the work has set `cancel`, unless that is NULL.
bool mf_interrupt_wanted(const atomic_bool *cancel);

/// Whether it was the machine that asked, as a batch system does at the end of the time that a job
/// has: this is no failure.
bool mf_interrupt_was_planned(void);

/// From now on a stop is no failure: the work waits for somebody else.
void mf_interrupt_plan(void);

/// @name Several processes that must stop at the same place
/// From now on nothing but mf_interrupt_stop_by stops this process.
void mf_interrupt_defer(void);

/// The signal that has asked this process to stop (SIGINT for mf_interrupt_request); 0: none.
int mf_interrupt_signal(void);

/// All stop, as this signal wants it; 0: not yet.
void mf_interrupt_stop_by(int signal_number);
