// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The watcher that publishes a run on the live view, and does what the page wishes.
///
/// It publishes while somebody looks, and spends at most a five-hundredth of the time on each kind
/// of news: what took long comes less often. The run's results are the same bits with it.
#pragma once

#include "live/live_folder.h"
#include "live/live_view.h"
#include "report/watcher.h"

struct live_pace {
    double next; ///< clock before which nothing is published [s]
};

struct live_watch {
    struct live_view *view;
    struct watcher watcher; ///< to be given to a run
    struct watcher_run run;
    struct live_pace progress, particles, numbers, tables, candidate;
    struct live_bytes bytes; ///< of particles
    uint64_t frame_step;     ///< of the particles that were published last
    bool frame_energies;     ///< with their energies
    struct live_scratch now; ///< for tables of a simulation
    char *log;               ///< the last lines
    bool paused;             ///< as the page was told
    bool changes;            ///< the page has wished for what follows, and it can be
    struct simulation_change change;
    double damping;    ///< that the page has wished of a fit; NaN: none
    double last_clock; ///< of the last word of a simulation [s]
    uint64_t last_step;
    double rate; ///< steps a second between the last two words
};

void mf_live_watch_init(struct live_watch *watch, struct live_view *view);

/// The run has ended, or has failed to begin: its borrowed pointers are cleared.
void mf_live_watch_end(struct live_watch *watch);
void mf_live_watch_clear(struct live_watch *watch);
