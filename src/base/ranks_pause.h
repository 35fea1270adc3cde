// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How long the thread that talks to other ranks pauses between two looks at its letters.
///
/// MPI has no way to sleep until a letter comes. A look takes a processor from the tasks; a pause
/// lets a rank that asks for a task wait for half of it. Both cost the same where the pause is
/// sqrt(2 LOOK τ), τ the time of a task.
#pragma once

#include <pthread.h>
#include <stdbool.h>

struct ranks_pause {
    pthread_mutex_t *lock;
    pthread_cond_t spoken;
    bool has_spoken; ///< behind the lock
};

/// `lock` is what the threads share their state behind.
void mf_ranks_pause_init(struct ranks_pause *pause, pthread_mutex_t *lock);
void mf_ranks_pause_clear(struct ranks_pause *pause);

/// A task took so long [s of a processor]. Behind the lock.
void mf_ranks_pause_note(double seconds);

/// A thread has something for the one that talks: it pauses no longer. Behind the lock.
void mf_ranks_pause_end(struct ranks_pause *pause);

/// Pause; `soon` if somebody waits for an answer. The lock must be free.
void mf_ranks_pause(struct ranks_pause *pause, bool soon);
