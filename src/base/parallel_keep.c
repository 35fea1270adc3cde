// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel_keep.h"

#include "base/letter.h"

#include <string.h>

/// Where letters are kept now. Set between tasks alone.
static struct parallel_kept *keeping;

/// Beyond it letters are not kept: they save time, and take memory and that of saving.
enum { MOST_BYTES = 1 << 28, FIRST_ROOM = 1 << 16 };

void mf_parallel_kept_clear(struct parallel_kept *kept) {
    mf_memory_free(kept->letters);
    *kept = (struct parallel_kept){0};
}

void mf_parallel_keep(struct parallel_kept *kept) {
    keeping = kept;
    if (kept)
        kept->calls = 0;
}

size_t mf_parallel_kept_spans(struct parallel_kept *kept, struct memory_span *spans) {
    spans[0] = (struct memory_span){&kept->size, sizeof kept->size};
    spans[1] = (struct memory_span){kept->letters, kept->size};
    return PARALLEL_KEPT_SPANS;
}

static enum status grow(struct parallel_kept *kept, uint64_t wanted) {
    enum status status = STATUS_OK;
    uint64_t room = kept->room > 0 ? kept->room : FIRST_ROOM;
    char *letters = NULL;
    while (room < wanted)
        room *= 2;
    NEW_ARRAY(letters, room);
    if (kept->room > 0)
        memcpy(letters, kept->letters, kept->room);
    mf_memory_free(kept->letters);
    kept->letters = letters;
    kept->room = room;
done:
    return status;
}

enum status mf_parallel_kept_make_room(struct parallel_kept *kept) {
    return kept->size > kept->room ? grow(kept, kept->size) : STATUS_OK;
}

/// Tasks of a call that are left to be done.
struct rest {
    const struct parallel_tasks *tasks;
    struct parallel_kept *kept;
    uint64_t call;
    bool *done;    ///< shape [tasks]
    size_t *index; ///< shape [rest]: their numbers among the tasks
};

/// Keep what a task has left, if there is room.
static void keep(const struct rest *rest, uint64_t task, const void *result) {
    struct parallel_kept *kept = rest->kept;
    const struct letter head = mf_letter_sized(
        &(struct letter){.kind = LETTER_RESULT, .turn = rest->call, .task = task}, rest->tasks);
    const uint64_t size = kept->size + letter_room(&head);
    if (size > MOST_BYTES || (size > kept->room && grow(kept, size) != STATUS_OK))
        return;
    struct letter *letter = (struct letter *)(void *)(kept->letters + kept->size);
    *letter = head;
    mf_letter_write(letter, rest->tasks, result);
    kept->size = size;
}

static enum status run(void *context, size_t task, void *result) {
    const struct rest *rest = context;
    return rest->tasks->run(rest->tasks->context, rest->index[task], result);
}

static void take(void *context, size_t task, const void *result) {
    const struct rest *rest = context;
    keep(rest, rest->index[task], result);
    if (rest->tasks->take)
        rest->tasks->take(rest->tasks->context, rest->index[task], result);
}

static size_t spans(void *context, size_t task, struct memory_span *span) {
    const struct rest *rest = context;
    return rest->tasks->spans(rest->tasks->context, rest->index[task], span);
}

/// Put what letters of this call tell into its place.
static enum status recall(struct rest *rest) {
    const struct parallel_tasks *tasks = rest->tasks;
    for (uint64_t at = 0; at < rest->kept->size;) {
        const struct letter *letter =
            (const struct letter *)(const void *)(rest->kept->letters + at);
        const void *result;
        if (letter->turn == rest->call) {
            if (letter->task >= tasks->count || !mf_letter_read(letter, tasks, &result))
                return mf_status_fail(STATUS_BAD_INPUT,
                                      "the checkpoint has tasks of another fit; begin anew with "
                                      "--force instead of --resume");
            rest->done[letter->task] = true;
            if (tasks->take)
                tasks->take(tasks->context, letter->task, result);
        }
        at += letter_room(letter);
    }
    return STATUS_OK;
}

/// Nested tasks are a part of those that are kept.
static enum status try_rest(struct rest *rest, enum status (*try)(const struct parallel_tasks *)) {
    struct parallel_tasks left = *rest->tasks;
    left.count = 0;
    for (size_t task = 0; task < rest->tasks->count; task++)
        if (!rest->done[task])
            rest->index[left.count++] = task;
    left.run = run;
    left.take = take;
    left.spans = spans;
    left.context = rest;
    keeping = NULL;
    const enum status status = left.count > 0 ? try(&left) : STATUS_OK;
    keeping = rest->kept;
    return status;
}

enum status mf_parallel_keep_try(const struct parallel_tasks *tasks,
                                 enum status (*try)(const struct parallel_tasks *)) {
    enum status status = STATUS_OK;
    struct rest rest = {.tasks = tasks, .kept = keeping};
    if (keeping == NULL || tasks->spans == NULL)
        return try(tasks);
    rest.call = keeping->calls++;
    NEW_ARRAY(rest.done, tasks->count);
    NEW_ARRAY(rest.index, tasks->count);
    CHECK(recall(&rest));
    status = try_rest(&rest, try);
done:
    mf_memory_free(rest.done);
    mf_memory_free(rest.index);
    return status;
}
