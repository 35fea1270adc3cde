// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/interrupt.h"

#include <signal.h>
#include <stddef.h>

static volatile sig_atomic_t received; ///< the first signal; 0: none
static atomic_bool wanted, deferred, planned;
static atomic_int common; ///< the signal by which all stop; 0: none

static void remember(int signal_number) {
    if (received == 0)
        received = signal_number;
}

/// What the caller of the program set aside, as nohup does with SIGHUP, stays so.
static bool is_ignored(int signal_number) {
    struct sigaction action;
    return sigaction(signal_number, NULL, &action) == 0 && action.sa_handler == SIG_IGN;
}

void mf_interrupt_install(void) {
    // A second request of the user ends the program; a terminal that is gone may say so twice, and
    // a closed pipe with every word.
    static const struct {
        int number;
        bool once, may_be_ignored;
    } signals[] = {{SIGINT, true, false},
                   {SIGTERM, true, false},
                   {SIGUSR1, false, true},
                   {SIGHUP, false, true},
                   {SIGPIPE, false, true}};
    for (size_t k = 0; k < sizeof signals / sizeof *signals; k++) {
        struct sigaction action = {.sa_handler = remember,
                                   .sa_flags = signals[k].once ? (int)SA_RESETHAND : 0};
        sigemptyset(&action.sa_mask);
        if (!signals[k].may_be_ignored || !is_ignored(signals[k].number))
            sigaction(signals[k].number, &action, NULL);
    }
}

void mf_interrupt_request(bool stop) {
    atomic_store(&wanted, stop);
}

int mf_interrupt_signal(void) {
    if (received != 0)
        return received;
    return atomic_load_explicit(&wanted, memory_order_relaxed) ? SIGINT : 0;
}

void mf_interrupt_defer(void) {
    atomic_store(&deferred, true);
}

void mf_interrupt_stop_by(int signal_number) {
    atomic_store(&common, signal_number);
}

/// The signal by which this process is to stop.
static int reason(void) {
    return atomic_load_explicit(&deferred, memory_order_relaxed)
               ? atomic_load_explicit(&common, memory_order_relaxed)
               : mf_interrupt_signal();
}

bool mf_interrupt_requested(void) {
    return reason() != 0;
}

bool mf_interrupt_was_planned(void) {
    return atomic_load(&planned) || reason() == SIGTERM || reason() == SIGUSR1;
}

void mf_interrupt_plan(void) {
    atomic_store(&planned, true);
}

bool mf_interrupt_wanted(const atomic_bool *cancel) {
    return mf_interrupt_requested() || (cancel && atomic_load(cancel));
}
