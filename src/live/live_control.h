// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the page wishes of the work: begin, pause, step, go on, stop, not so fast,
/// another temperature.
///
/// Threads of the server put wishes; the work takes them, in the calls of its watcher and between
/// runs, where alone it waits. Tested: test_live_feed.
#pragma once

#include "base/status.h"
#include "io/output.h"

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>

/// What is to be run.
struct live_order {
    char file[OUTPUT_PATH_SIZE];
    char *text;                    ///< of the file, as edited; to be freed with free()
    char folder[OUTPUT_PATH_SIZE]; ///< for the results; "": as the command line says
    bool resume, force;
};

/// What a run is to go on with, in units of its file; NaN: as it is.
struct live_change {
    double temperature, time_step; ///< of a simulation
    double damping;                ///< of a fit
};

struct live_control {
    pthread_mutex_t lock; ///< of all that follows
    pthread_cond_t changed;
    bool ordered; ///< there is an order that was not taken
    struct live_order order;
    bool going; ///< a run was ordered, and has not ended
    bool paused, stopped;
    int64_t steps; ///< that may pass though it is paused
    double speed;  ///< steps a second at most; 0: any
    bool changes;  ///< there is one that was not taken
    struct live_change change;
};

enum status mf_live_control_init(struct live_control *control) MUST_USE;
void mf_live_control_clear(struct live_control *control);

/// @name For threads of the server
/// Put an order, whose text is given away; none may be waiting.
void mf_live_control_order(struct live_control *control, struct live_order *order);
void mf_live_control_pause(struct live_control *control, bool paused);
void mf_live_control_step(struct live_control *control, int64_t steps);
void mf_live_control_stop(struct live_control *control);
void mf_live_control_speed(struct live_control *control, double speed);
void mf_live_control_change(struct live_control *control, const struct live_change *change);

/// @name For the work
/// Wait for an order, a tenth of a second at most; false if there is none.
bool mf_live_control_take(struct live_control *control, struct live_order *order);

/// A run has ended: forget what was wished of it, also that to stop.
void mf_live_control_reset(struct live_control *control);

/// Whether the last run was stopped from the page.
bool mf_live_control_stopped(struct live_control *control);

double mf_live_control_speed_now(struct live_control *control);

/// Take the change that was wished last; false if there is none.
bool mf_live_control_take_change(struct live_control *control, struct live_change *change);

/// What the work should do before its next step.
struct live_pause {
    bool paused;   ///< it waits
    bool stepping; ///< it is paused, but for this step
    double speed;
};

/// Wait while the run is paused, a tenth of a second at most, and take one step of those allowed.
struct live_pause mf_live_control_wait(struct live_control *control);
