// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/ranks_pause.h"

#include "base/clock.h"
#include "base/condition.h"

#include <math.h>

/// Processor time of a task, as of the last few on this rank and, on rank 0, elsewhere [s].
static double task_seconds;

void mf_ranks_pause_init(struct ranks_pause *pause, pthread_mutex_t *lock) {
    *pause = (struct ranks_pause){.lock = lock};
    mf_condition_init(&pause->spoken);
}

void mf_ranks_pause_clear(struct ranks_pause *pause) {
    pthread_cond_destroy(&pause->spoken);
}

void mf_ranks_pause_note(double seconds) {
    enum { FEW = 8 };
    task_seconds += (seconds - task_seconds) / FEW;
}

void mf_ranks_pause_end(struct ranks_pause *pause) {
    pause->has_spoken = true;
    pthread_cond_signal(&pause->spoken);
}

/// LOOK: 0.055 of a core's time went into 2800 looks a second.
static double seconds(bool soon) {
    static const double LOOK = 2e-5, SHORTEST = 3e-4, LONGEST = 5e-3;
    return soon ? SHORTEST : fmin(fmax(sqrt(2 * LOOK * task_seconds), SHORTEST), LONGEST);
}

void mf_ranks_pause(struct ranks_pause *pause, bool soon) {
    pthread_mutex_lock(pause->lock);
    if (!pause->has_spoken)
        mf_condition_wait(&pause->spoken, pause->lock, clock_seconds() + seconds(soon));
    pause->has_spoken = false;
    pthread_mutex_unlock(pause->lock);
}
