// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/task_log.h"

#include "base/growing.h"

#include <stdio.h>
#include <string.h>

/// The log in use, of the thread that hands out tasks: fits may run side by side. Set between tasks
/// alone.
static _Thread_local struct task_log *used;

// Records -----------------------------------------------------------------------------------------

/// The bytes after a head: a message, or the result and each span after its length.
static void write_bytes(FILE *stream, const struct task_record *head,
                        const struct parallel_tasks *tasks, const void *result) {
    struct memory_span span[PARALLEL_MAX_SPANS];
    if (head->status != STATUS_OK) {
        fwrite(mf_status_marked(), 1, strlen(mf_status_marked()) + 1, stream);
        return;
    }
    if (tasks->result_size > 0)
        fwrite(result, 1, tasks->result_size, stream);
    const size_t spans = tasks->spans(tasks->context, head->task, span);
    for (size_t k = 0; k < spans; k++) {
        const uint64_t bytes = span[k].bytes;
        fwrite(&bytes, sizeof bytes, 1, stream);
        if (bytes > 0)
            fwrite(span[k].memory, 1, bytes, stream);
    }
}

struct task_record *mf_task_record_create(const struct task_record *head,
                                          const struct parallel_tasks *tasks, const void *result) {
    static const uint64_t padding;
    char *bytes = NULL;
    size_t size = 0, whole;
    FILE *stream = open_memstream(&bytes, &size);
    bool written = stream != NULL;
    if (stream) {
        fwrite(head, sizeof *head, 1, stream);
        write_bytes(stream, head, tasks, result);
        written = fflush(stream) == 0;
        whole = size;
        fwrite(&padding, 1, sizeof padding, stream);
        written = fclose(stream) == 0 && written;
    }
    if (!written) {
        mf_status_fail(STATUS_NO_MEMORY, "out of memory");
        mf_memory_free(bytes);
        return NULL;
    }
    struct task_record *record = (struct task_record *)(void *)bytes;
    record->bytes = whole - sizeof *record;
    return record;
}

/// Lengths may follow from the spans before, so that they are listed again for each.
static bool restore_span(const struct parallel_tasks *tasks, uint64_t task, size_t number,
                         const char **from, size_t *left) {
    struct memory_span span[PARALLEL_MAX_SPANS];
    uint64_t bytes;
    if (*left < sizeof bytes)
        return false;
    memcpy(&bytes, *from, sizeof bytes);
    if (number >= tasks->spans(tasks->context, task, span) || span[number].bytes != bytes ||
        *left - sizeof bytes < bytes)
        return false;
    if (bytes > 0)
        memcpy(span[number].memory, *from + sizeof bytes, bytes);
    *from += sizeof bytes + bytes;
    *left -= sizeof bytes + bytes;
    return true;
}

bool mf_task_record_restore(const struct task_record *record, const struct parallel_tasks *tasks,
                            const void **result) {
    const char *from = task_record_bytes(record) + tasks->result_size;
    if (record->task >= tasks->count || record->bytes < tasks->result_size)
        return false;
    size_t left = record->bytes - tasks->result_size;
    *result = tasks->result_size > 0 ? task_record_bytes(record) : NULL;
    for (size_t number = 0; left > 0; number++)
        if (!restore_span(tasks, record->task, number, &from, &left))
            return false;
    return true;
}

// The log -----------------------------------------------------------------------------------------

void mf_task_log_clear(struct task_log *log) {
    mf_memory_free(log->records);
    *log = (struct task_log){0};
}

size_t mf_task_log_spans(struct task_log *log, struct memory_span *spans) {
    spans[0] = (struct memory_span){&log->size, sizeof log->size};
    spans[1] = (struct memory_span){log->records, log->size};
    return TASK_LOG_SPANS;
}

static enum status reserve(struct task_log *log, size_t wanted) {
    enum { FIRST_ROOM = 1 << 16 };
    return mf_growing_reserve(&log->records, &log->capacity, log->capacity, wanted, 1, FIRST_ROOM);
}

enum status mf_task_log_reserve(struct task_log *log) {
    return reserve(log, log->size);
}

enum status mf_task_log_add(struct task_log *log, const struct task_record *record) {
    const size_t size = task_record_size(record);
    TRY(reserve(log, log->size + size));
    memcpy(log->records + log->size, record, size);
    log->size += size;
    return STATUS_OK;
}

bool mf_task_log_replay(const struct parallel_call *call) {
    const struct parallel_tasks *tasks = call->tasks;
    const void *result;
    for (uint64_t at = call->begin; at < call->log->size;) {
        const struct task_record *record =
            (const struct task_record *)(const void *)(call->log->records + at);
        at += task_record_size(record);
        if (record->call != call->number)
            continue;
        if (!mf_task_record_restore(record, tasks, &result))
            return false;
        if (call->done)
            call->done[record->task] = true;
        if (tasks->take)
            tasks->take(tasks->context, record->task, result);
    }
    return true;
}

// The log in use ----------------------------------------------------------------------------------

void mf_task_log_use(struct task_log *log) {
    used = log;
    if (log)
        log->calls = 0;
}

enum status mf_task_log_begin(struct parallel_call *call) {
    enum status status = STATUS_OK;
    if (used == NULL || call->tasks->spans == NULL)
        return STATUS_OK;
    call->log = used;
    call->number = used->calls++;
    NEW_ARRAY(call->done, call->tasks->count);
    if (!mf_task_log_replay(call))
        CHECK(mf_status_fail(
            STATUS_BAD_INPUT,
            "the checkpoint belongs to another fit; start again with --force instead of --resume"));
    for (size_t task = 0; task < call->tasks->count; task++)
        call->left -= call->done[task];
    call->begin = used->size;
    used = NULL;
done:
    if (status != STATUS_OK)
        mf_memory_free(call->done);
    return status;
}

void mf_task_log_end(struct parallel_call *call) {
    if (call->done)
        used = call->log;
    mf_memory_free(call->done);
}

void mf_task_log_note(const struct parallel_call *call, size_t task, const void *result) {
    struct task_record *record = mf_task_record_create(
        &(struct task_record){.call = call->number, .task = task}, call->tasks, result);
    if (record && call->log->size + task_record_size(record) <= TASK_LOG_MAX)
        (void)!mf_task_log_add(call->log, record);
    mf_memory_free(record);
}
