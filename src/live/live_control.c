// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_control.h"

#include "base/clock.h"
#include "base/interrupt.h"

#include <stdlib.h>

enum status mf_live_control_init(struct live_control *control) {
    *control = (struct live_control){0};
    if (pthread_mutex_init(&control->lock, NULL) != 0 ||
        pthread_cond_init(&control->changed, NULL) != 0)
        return mf_status_fail(STATUS_NO_MEMORY, "no lock for the live view");
    return STATUS_OK;
}

void mf_live_control_clear(struct live_control *control) {
    free(control->order.text);
    pthread_cond_destroy(&control->changed);
    pthread_mutex_destroy(&control->lock);
}

static void leave(struct live_control *control) {
    pthread_cond_broadcast(&control->changed);
    pthread_mutex_unlock(&control->lock);
}

void mf_live_control_order(struct live_control *control, struct live_order *order) {
    pthread_mutex_lock(&control->lock);
    control->order = *order;
    control->ordered = control->going = true;
    order->text = NULL;
    leave(control);
}

void mf_live_control_pause(struct live_control *control, bool paused) {
    pthread_mutex_lock(&control->lock);
    control->paused = paused;
    control->steps = 0;
    leave(control);
}

void mf_live_control_step(struct live_control *control, int64_t steps) {
    pthread_mutex_lock(&control->lock);
    control->paused = true;
    control->steps = steps;
    leave(control);
}

void mf_live_control_stop(struct live_control *control) {
    pthread_mutex_lock(&control->lock);
    if (control->going) {
        control->stopped = true;
        control->paused = false;
        mf_interrupt_request(true);
    }
    leave(control);
}

void mf_live_control_speed(struct live_control *control, double speed) {
    pthread_mutex_lock(&control->lock);
    control->speed = speed;
    leave(control);
}

void mf_live_control_change(struct live_control *control, const struct live_change *change) {
    pthread_mutex_lock(&control->lock);
    control->change = *change;
    control->changes = true;
    leave(control);
}

/// Wait for a change, a tenth of a second at most: a signal may ask to stop meanwhile.
static void wait_briefly(struct live_control *control) {
    mf_clock_wait(&control->changed, &control->lock, clock_seconds() + 0.1);
}

bool mf_live_control_take(struct live_control *control, struct live_order *order) {
    pthread_mutex_lock(&control->lock);
    if (!control->ordered)
        wait_briefly(control);
    const bool taken = control->ordered;
    if (taken) {
        *order = control->order;
        control->order = (struct live_order){0};
        control->ordered = false;
    }
    pthread_mutex_unlock(&control->lock);
    return taken;
}

void mf_live_control_reset(struct live_control *control) {
    pthread_mutex_lock(&control->lock);
    control->going = control->paused = control->stopped = control->changes = false;
    control->steps = 0;
    mf_interrupt_request(false);
    pthread_mutex_unlock(&control->lock);
}

bool mf_live_control_stopped(struct live_control *control) {
    pthread_mutex_lock(&control->lock);
    const bool stopped = control->stopped;
    pthread_mutex_unlock(&control->lock);
    return stopped;
}

double mf_live_control_speed_now(struct live_control *control) {
    pthread_mutex_lock(&control->lock);
    const double speed = control->speed;
    pthread_mutex_unlock(&control->lock);
    return speed;
}

bool mf_live_control_take_change(struct live_control *control, struct live_change *change) {
    pthread_mutex_lock(&control->lock);
    const bool taken = control->changes;
    *change = control->change;
    control->changes = false;
    pthread_mutex_unlock(&control->lock);
    return taken;
}

struct live_pause mf_live_control_wait(struct live_control *control) {
    pthread_mutex_lock(&control->lock);
    if (control->paused && control->steps == 0 && !control->stopped)
        wait_briefly(control);
    const bool steps = control->paused && control->steps > 0;
    if (steps)
        control->steps--;
    const struct live_pause pause = {control->paused && !steps && !control->stopped, steps,
                                     control->speed};
    pthread_mutex_unlock(&control->lock);
    return pause;
}
