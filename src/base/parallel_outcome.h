// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How several tasks have ended.
#pragma once

#include "base/statistics.h"
#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

struct parallel_outcome {
    enum status status; ///< the failure that counts so far, with its message, which else belongs
    size_t task;        ///< to a thread; the number of tasks while there is none
    char message[STATUS_MESSAGE_SIZE];
    struct running_mean seconds; ///< of processor time of a task
};

/// Whether a task may still begin: one behind a failure need not.
static inline bool parallel_outcome_allows(const struct parallel_outcome *outcome, size_t task) {
    return outcome->status != STATUS_INTERRUPTED && task < outcome->task;
}

/// A task has ended. Its failure counts if it comes before the one that is known.
static inline void parallel_outcome_add(struct parallel_outcome *outcome, size_t task,
                                        enum status status, const char *message, double seconds) {
    const bool interrupted = status == STATUS_INTERRUPTED,
               before = outcome->status == STATUS_INTERRUPTED;
    mf_statistics_add(&outcome->seconds, seconds);
    if (status == STATUS_OK || (interrupted != before ? !interrupted : task >= outcome->task))
        return;
    outcome->status = status;
    outcome->task = task;
    snprintf(outcome->message, sizeof outcome->message, "%s", message);
}

static inline enum status parallel_outcome_status(const struct parallel_outcome *outcome) {
    return outcome->status == STATUS_OK ? STATUS_OK
                                        : mf_status_fail(outcome->status, "%s", outcome->message);
}
