// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Which failure of several tasks counts.
#pragma once

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/// The failure that counts so far, with its message, which else belongs to a thread.
struct parallel_failure {
    enum status status;
    size_t task; ///< the number of tasks while there is none
    char message[STATUS_MESSAGE_SIZE];
};

/// Whether a task may still begin: one behind a failure need not.
static inline bool parallel_failure_allows(const struct parallel_failure *failure, size_t task) {
    return failure->status != STATUS_INTERRUPTED && task < failure->task;
}

/// Keep a failure if it comes before the one that is known.
static inline void parallel_failure_note(struct parallel_failure *failure, enum status status,
                                         size_t task, const char *message) {
    const bool interrupted = status == STATUS_INTERRUPTED,
               before = failure->status == STATUS_INTERRUPTED;
    if (interrupted != before ? !interrupted : task >= failure->task)
        return;
    failure->status = status;
    failure->task = task;
    snprintf(failure->message, sizeof failure->message, "%s", message);
}

static inline enum status parallel_failure_status(const struct parallel_failure *failure) {
    return failure->status == STATUS_OK ? STATUS_OK
                                        : mf_status_fail(failure->status, "%s", failure->message);
}
