// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/interrupt.h"

#include <signal.h>
#include <stddef.h>

static volatile sig_atomic_t requested;
static atomic_bool wished;

static void remember(int signal_number) {
    (void)signal_number;
    requested = 1;
}

/// What the caller of the program set aside, as nohup does with SIGHUP, stays so.
static bool is_ignored(int signal_number) {
    struct sigaction action;
    return sigaction(signal_number, NULL, &action) == 0 && action.sa_handler == SIG_IGN;
}

void mf_interrupt_install(void) {
    // A second wish of the user ends the program; a terminal that is gone may say so twice, and a
    // closed pipe with every word.
    static const struct {
        int number;
        bool once, may_be_ignored;
    } signals[] = {{SIGINT, true, false},
                   {SIGTERM, true, false},
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

void mf_interrupt_wish(bool stop) {
    atomic_store(&wished, stop);
}

bool mf_interrupt_requested(void) {
    return requested != 0 || atomic_load_explicit(&wished, memory_order_relaxed);
}

bool mf_interrupt_wanted(const atomic_bool *cancel) {
    return mf_interrupt_requested() || (cancel && atomic_load(cancel));
}
