// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What finished tasks have left: records one behind another, for who did not do them.
///
/// Other ranks replay the log of rank 0 (base/ranks.h). So does a fit that goes on after an
/// interruption: work that begins from the same state comes to the same tasks, and those that are
/// in the log are not done again. A checkpoint is the state before an iteration and the log of
/// its tasks, whatever the method; a task that is not in it is done again, with the same bits.
#pragma once

#include "base/parallel_call.h"

#include <stdbool.h>

/// A head with the bytes of a task's result and of its part of the context behind it, or with the
/// message of its failure.
struct task_record {
    uint64_t call;  ///< of mf_parallel_try since the log began
    uint64_t task;  ///< its number
    uint64_t bytes; ///< behind this head
    double seconds; ///< of processor time
    int64_t status;
};

/// Zeroed: empty.
struct task_log {
    uint64_t size; ///< of the records [bytes]; the first span
    size_t capacity;
    char *records;
    uint64_t calls; ///< of mf_parallel_try since the log began
};

void mf_task_log_clear(struct task_log *log);

/// From now on mf_parallel_try logs its tasks there and does not do those that are there, if they
/// have `spans` and are no part of another task; NULL: it does not. Calls are numbered from here.
void mf_task_log_use(struct task_log *log);

/// What goes with a checkpoint: two spans. The length of the second is the first: after it was
/// restored there is to be made room. Tested: test_task_log.
enum { TASK_LOG_SPANS = 2 };
size_t mf_task_log_spans(struct task_log *log, struct memory_span *spans);
enum status mf_task_log_reserve(struct task_log *log) MUST_USE;

/// @name For mf_parallel_try

/// Give the call what the log in use has of its tasks. That log is none of tasks within them.
/// Fails: NO_MEMORY; BAD_INPUT for a log of other tasks.
enum status mf_task_log_begin(struct parallel_call *call) MUST_USE;
void mf_task_log_end(struct parallel_call *call);

/// Log a task of this call. One that takes too much memory is left out: it saves no more than time.
void mf_task_log_note(const struct parallel_call *call, size_t task, const void *result);

static inline const char *task_record_bytes(const struct task_record *record) {
    return (const char *)(record + 1);
}

/// With the head: whole words.
static inline size_t task_record_size(const struct task_record *record) {
    return (sizeof *record + record->bytes + sizeof(uint64_t) - 1) / sizeof(uint64_t) *
           sizeof(uint64_t);
}

/// A record with this head, to be freed by mf_memory_free; NULL without memory. With the message of
/// its thread if it failed, else with its result and the spans of `tasks`.
struct task_record *mf_task_record_create(const struct task_record *head,
                                          const struct parallel_tasks *tasks, const void *result);

/// Put what a task left into the context; false if it does not fit. *result is in the record.
bool mf_task_record_restore(const struct task_record *record, const struct parallel_tasks *tasks,
                            const void **result);

/// Beyond so many bytes a log takes too much memory, and time to save it.
enum { TASK_LOG_MAX = 1 << 28 };

/// Fails: NO_MEMORY.
enum status mf_task_log_add(struct task_log *log, const struct task_record *record) MUST_USE;

/// Put what the records of this call have into the context, from its first one, and note in `done`
/// which they are, unless that is NULL. False if they do not fit.
bool mf_task_log_replay(const struct parallel_call *call);
