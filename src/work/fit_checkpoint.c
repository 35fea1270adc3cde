// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/fit_checkpoint.h"

#include "base/ranks.h"
#include "io/checkpoint.h"

#include <string.h>

enum { MAX_SPANS = INVERSE_MAX_SPANS + HISTORY_SPANS + TASK_LOG_SPANS + FIT_CHECKPOINT_OWN };

/// On these spans lengths depend: the size of the log, and the iterations of the history.
static const size_t sizes[] = {0, TASK_LOG_SPANS};
enum { SIZES = sizeof sizes / sizeof *sizes };

void mf_fit_checkpoint_add(struct fit_checkpoint *checkpoint, void *memory, size_t bytes) {
    if (bytes > 0)
        checkpoint->own[checkpoint->owns++] = (struct memory_span){memory, bytes};
}

/// All but the method's state.
static size_t list(struct fit_checkpoint *checkpoint, struct memory_span *spans) {
    size_t n = mf_task_log_spans(&checkpoint->tasks, spans);
    n += mf_history_spans(checkpoint->history, spans + n);
    memcpy(spans + n, checkpoint->own, checkpoint->owns * sizeof *spans);
    return n + checkpoint->owns;
}

static size_t list_all(struct fit_checkpoint *checkpoint, struct memory_span *spans) {
    const size_t n = list(checkpoint, spans);
    return n + checkpoint->method->spans(checkpoint->state, spans + n);
}

static enum status reserve(struct fit_checkpoint *checkpoint) {
    TRY(mf_task_log_reserve(&checkpoint->tasks));
    return mf_history_reserve(checkpoint->history);
}

static enum status remember(struct fit_checkpoint *checkpoint) {
    struct memory_span spans[INVERSE_MAX_SPANS];
    return mf_memory_image_take(&checkpoint->before, spans,
                                checkpoint->method->spans(checkpoint->state, spans));
}

enum status mf_fit_checkpoint_begin(struct fit_checkpoint *checkpoint) {
    mf_task_log_clear(&checkpoint->tasks);
    return remember(checkpoint);
}

enum status mf_fit_checkpoint_save(struct fit_checkpoint *checkpoint, const char *file,
                                   uint64_t digest) {
    struct memory_span spans[MAX_SPANS];
    const struct memory_image *before = &checkpoint->before;
    const size_t n = list(checkpoint, spans);
    memcpy(spans + n, before->span, before->count * sizeof *spans);
    return mf_checkpoint_save(file, digest, spans, n + before->count);
}

enum status mf_fit_checkpoint_load(struct fit_checkpoint *checkpoint, const char *file,
                                   uint64_t digest) {
    struct memory_span spans[MAX_SPANS];
    list(checkpoint, spans);
    for (int k = 0; k < SIZES; k++)
        TRY(mf_checkpoint_load_span(file, digest, sizes[k], &spans[sizes[k]]));
    TRY(reserve(checkpoint));
    TRY(mf_checkpoint_load(file, digest, spans, list_all(checkpoint, spans)));
    return remember(checkpoint);
}

enum status mf_fit_checkpoint_share(struct fit_checkpoint *checkpoint) {
    struct memory_span spans[MAX_SPANS];
    list(checkpoint, spans);
    for (int k = 0; k < SIZES; k++)
        mf_ranks_broadcast(&spans[sizes[k]], 1);
    TRY(mf_ranks_check(reserve(checkpoint), 0));
    mf_ranks_broadcast(spans, list_all(checkpoint, spans));
    return STATUS_OK;
}

void mf_fit_checkpoint_clear(struct fit_checkpoint *checkpoint) {
    mf_memory_image_clear(&checkpoint->before);
    mf_task_log_clear(&checkpoint->tasks);
}
