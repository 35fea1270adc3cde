// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A call of mf_parallel_try: which tasks are to be done, and how they have ended.
#pragma once

#include "base/parallel.h"
#include "base/statistics.h"

#include <locale.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>

struct parallel_call {
    const struct parallel_tasks *tasks;
    size_t left;          ///< tasks that are to be done
    struct task_log *log; ///< of tasks with `spans`, if one is in use; its part by this call:
    uint64_t number;      ///< of the call
    uint64_t begin;       ///< of its records in the log [bytes]
    bool *done;           ///< shape [tasks]: in the log from before; NULL: none
    enum status status;   ///< the failure that counts so far, with its message, which else belongs
    size_t failed;        ///< to a thread; the number of tasks while there is none
    char message[STATUS_MESSAGE_SIZE];
    struct running_mean seconds; ///< of processor time of a task
    pthread_mutex_t lock;        ///< of all that follows a task, where one process has all tasks
    locale_t locale;             ///< of who calls: threads have one each
};

/// Run a task, in whatever thread, with the locale of who called.
static inline enum status parallel_call_run(const struct parallel_call *call, size_t task,
                                            void *result) {
    const locale_t before = uselocale(call->locale);
    const enum status status = call->tasks->run(call->tasks->context, task, result);
    uselocale(before);
    return status;
}

/// Whether a task may begin: one after a failure need not.
static inline bool parallel_call_wants(const struct parallel_call *call, size_t task) {
    return call->status != STATUS_INTERRUPTED && task < call->failed &&
           !(call->done && call->done[task]);
}

/// A task has ended. Its failure counts if it comes before the one that is known.
static inline void parallel_call_end_task(struct parallel_call *call, size_t task,
                                          enum status status, const char *message, double seconds) {
    const bool interrupted = status == STATUS_INTERRUPTED,
               before = call->status == STATUS_INTERRUPTED;
    mf_statistics_add(&call->seconds, seconds);
    if (status == STATUS_OK || (interrupted != before ? !interrupted : task >= call->failed))
        return;
    call->status = status;
    call->failed = task;
    snprintf(call->message, sizeof call->message, "%s", message);
}
