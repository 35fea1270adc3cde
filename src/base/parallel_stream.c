// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel_stream.h"

#include "base/clock.h"
#include "base/memory.h"
#include "base/parallel_stream_state.h"
#include "base/parallel_times.h"
#include "base/ranks.h"

#include <stdio.h>
#include <string.h>

static void do_task(struct stream_worker *worker) {
    const struct parallel_stream_tasks *tasks = &worker->stream->tasks;
    const double begin = clock_thread_seconds();
    memset(worker->result, 0, tasks->result_size);
    worker->status = tasks->run(tasks->context, worker->task, worker->result);
    worker->seconds = clock_thread_seconds() - begin;
    if (worker->status != STATUS_OK)
        snprintf(worker->message, sizeof worker->message, "%s", mf_status_message());
}

static void *work(void *memory) {
    struct stream_worker *worker = memory;
    struct parallel_stream *stream = worker->stream;
    pthread_mutex_lock(&stream->lock);
    for (;;) {
        while (worker->work != STREAM_GIVEN && !stream->over)
            pthread_cond_wait(&worker->given, &stream->lock);
        if (stream->over)
            break;
        pthread_mutex_unlock(&stream->lock);
        do_task(worker);
        pthread_mutex_lock(&stream->lock);
        worker->work = STREAM_DONE;
        mf_ranks_pause_end(&stream->pause);
    }
    pthread_mutex_unlock(&stream->lock);
    return NULL;
}

static enum status begin_worker(struct parallel_stream *stream) {
    enum status status = STATUS_OK;
    struct stream_worker *worker = &stream->worker[stream->begun];
    worker->stream = stream;
    worker->task = mf_memory_zeroed(1, stream->tasks.task_size);
    worker->result = mf_memory_zeroed(1, stream->tasks.result_size);
    CHECK(worker->task && worker->result ? STATUS_OK : STATUS_NO_MEMORY);
    pthread_cond_init(&worker->given, NULL);
    if (pthread_create(&worker->thread, NULL, work, worker) != 0) {
        pthread_cond_destroy(&worker->given);
        status =
            mf_status_fail(STATUS_NO_MEMORY, "no more than %d threads can begin", stream->begun);
        goto done;
    }
    stream->begun++;
done:
    return status;
}

enum status mf_parallel_stream_begin(struct parallel_stream **made,
                                     const struct parallel_stream_tasks *tasks) {
    enum status status = STATUS_OK;
    struct parallel_stream *stream = NULL;
    *made = NULL;
    NEW_ARRAY(stream, 1);
    stream->tasks = *tasks;
    pthread_mutex_init(&stream->lock, NULL);
    mf_ranks_pause_init(&stream->pause, &stream->lock);
    *made = stream;
    NEW_ARRAY(stream->worker, (size_t)tasks->threads);
    for (int k = 0; k < tasks->threads; k++)
        CHECK(begin_worker(stream));
    if (mf_ranks_count() > 1 && ranks_lead())
        CHECK(mf_parallel_stream_others_begin(stream));
done:
    if (status != STATUS_OK) {
        mf_parallel_stream_end(*made);
        *made = NULL;
    }
    return status;
}

void mf_parallel_stream_end(struct parallel_stream *stream) {
    if (stream == NULL)
        return;
    pthread_mutex_lock(&stream->lock);
    stream->over = true;
    for (int k = 0; k < stream->begun; k++)
        pthread_cond_signal(&stream->worker[k].given);
    pthread_mutex_unlock(&stream->lock);
    for (int k = 0; k < stream->begun; k++) {
        pthread_join(stream->worker[k].thread, NULL);
        pthread_cond_destroy(&stream->worker[k].given);
    }
    for (int k = 0; stream->worker && k < stream->tasks.threads; k++) {
        mf_memory_free(stream->worker[k].task);
        mf_memory_free(stream->worker[k].result);
    }
    mf_parallel_stream_others_end(stream->others);
    mf_ranks_pause_clear(&stream->pause);
    pthread_mutex_destroy(&stream->lock);
    mf_memory_free(stream->worker);
    mf_memory_free(stream);
}

static struct stream_worker *find(const struct parallel_stream *stream, enum stream_work work) {
    for (int k = 0; k < stream->begun; k++)
        if (stream->worker[k].work == work)
            return &stream->worker[k];
    return NULL;
}

static size_t count(struct parallel_stream *stream, enum stream_work work) {
    size_t found = 0;
    pthread_mutex_lock(&stream->lock);
    for (int k = 0; k < stream->begun; k++)
        found += stream->worker[k].work == work;
    pthread_mutex_unlock(&stream->lock);
    return found;
}

size_t mf_parallel_stream_count_idle(struct parallel_stream *stream) {
    return count(stream, STREAM_IDLE);
}

void mf_parallel_stream_give_own(struct parallel_stream *stream, const void *task) {
    pthread_mutex_lock(&stream->lock);
    struct stream_worker *worker = find(stream, STREAM_IDLE);
    memcpy(worker->task, task, stream->tasks.task_size);
    worker->work = STREAM_GIVEN;
    pthread_cond_signal(&worker->given);
    pthread_mutex_unlock(&stream->lock);
}

bool mf_parallel_stream_take_own(struct parallel_stream *stream, struct stream_outcome *outcome) {
    pthread_mutex_lock(&stream->lock);
    struct stream_worker *worker = find(stream, STREAM_DONE);
    if (worker) {
        worker->work = STREAM_IDLE;
        *outcome = (struct stream_outcome){worker->task, worker->result, worker->seconds,
                                           worker->status, worker->message};
    }
    pthread_mutex_unlock(&stream->lock);
    return worker != NULL;
}

bool mf_parallel_stream_has_idle(struct parallel_stream *stream) {
    return mf_parallel_stream_count_idle(stream) > 0 ||
           (stream->others && mf_parallel_stream_others_have_idle(stream->others));
}

void mf_parallel_stream_give(struct parallel_stream *stream, const void *task) {
    if (mf_parallel_stream_count_idle(stream) > 0)
        mf_parallel_stream_give_own(stream, task);
    else
        mf_parallel_stream_others_give(stream, task);
}

/// Wait until a thread has done its task, or for a moment where there are letters to look at.
static void wait_for_news(struct parallel_stream *stream) {
    if (stream->others) {
        mf_ranks_pause(&stream->pause, false);
        return;
    }
    pthread_mutex_lock(&stream->lock);
    while (find(stream, STREAM_DONE) == NULL)
        pthread_cond_wait(&stream->pause.spoken, &stream->lock);
    pthread_mutex_unlock(&stream->lock);
}

static bool take_any(struct parallel_stream *stream, struct stream_outcome *outcome) {
    if (stream->others && mf_parallel_stream_others_take(stream, outcome))
        return true;
    return mf_parallel_stream_take_own(stream, outcome);
}

static bool is_busy(struct parallel_stream *stream) {
    return mf_parallel_stream_count_idle(stream) < (size_t)stream->begun ||
           (stream->others && stream->others->open > 0);
}

enum status mf_parallel_stream_take(struct parallel_stream *stream,
                                    struct parallel_stream_result *taken) {
    const double begin = clock_seconds();
    struct stream_outcome outcome;
    *taken = (struct parallel_stream_result){NULL, NULL};
    if (stream->others)
        mf_parallel_stream_others_listen(stream);
    while (!take_any(stream, &outcome)) {
        if (!is_busy(stream))
            return STATUS_OK;
        wait_for_news(stream);
        if (stream->others)
            mf_parallel_stream_others_listen(stream);
    }
    if (stream->others)
        mf_ranks_pause_note(outcome.seconds);
    mf_parallel_times_add_streamed(outcome.seconds, clock_seconds() - begin);
    *taken = (struct parallel_stream_result){outcome.task, outcome.result};
    return outcome.status == STATUS_OK ? STATUS_OK
                                       : mf_status_fail(outcome.status, "%s", outcome.message);
}
