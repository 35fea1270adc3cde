// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel_stream.h"

#include "base/clock.h"
#include "base/memory.h"
#include "base/parallel_times.h"

#include <pthread.h>
#include <stdio.h>
#include <string.h>

enum work { IDLE, GIVEN, DONE };

/// A thread and its task. All but `work` belongs to the thread while the task is GIVEN, and else to
/// the owner of the stream.
struct worker {
    struct parallel_stream *stream;
    pthread_t thread;
    pthread_cond_t given;
    enum work work;
    void *task, *result;
    double seconds;
    enum status status;
    char message[STATUS_MESSAGE_SIZE];
};

struct parallel_stream {
    struct parallel_stream_tasks tasks;
    pthread_mutex_t lock; ///< of `work` of all, and `over`
    pthread_cond_t done;
    bool over;
    int begun; ///< threads
    struct worker *worker;
};

static void do_task(struct worker *worker) {
    const struct parallel_stream_tasks *tasks = &worker->stream->tasks;
    const double begin = clock_thread_seconds();
    memset(worker->result, 0, tasks->result_size);
    worker->status = tasks->run(tasks->context, worker->task, worker->result);
    worker->seconds = clock_thread_seconds() - begin;
    if (worker->status != STATUS_OK)
        snprintf(worker->message, sizeof worker->message, "%s", mf_status_message());
}

static void *work(void *memory) {
    struct worker *worker = memory;
    struct parallel_stream *stream = worker->stream;
    pthread_mutex_lock(&stream->lock);
    for (;;) {
        while (worker->work != GIVEN && !stream->over)
            pthread_cond_wait(&worker->given, &stream->lock);
        if (stream->over)
            break;
        pthread_mutex_unlock(&stream->lock);
        do_task(worker);
        pthread_mutex_lock(&stream->lock);
        worker->work = DONE;
        pthread_cond_signal(&stream->done);
    }
    pthread_mutex_unlock(&stream->lock);
    return NULL;
}

static enum status begin_worker(struct parallel_stream *stream) {
    enum status status = STATUS_OK;
    struct worker *worker = &stream->worker[stream->begun];
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
    pthread_cond_init(&stream->done, NULL);
    *made = stream;
    NEW_ARRAY(stream->worker, (size_t)tasks->threads);
    for (int k = 0; k < tasks->threads; k++)
        CHECK(begin_worker(stream));
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
    pthread_cond_destroy(&stream->done);
    pthread_mutex_destroy(&stream->lock);
    mf_memory_free(stream->worker);
    mf_memory_free(stream);
}

static struct worker *find_idle(const struct parallel_stream *stream) {
    for (int k = 0; k < stream->begun; k++)
        if (stream->worker[k].work == IDLE) // which the owner alone makes it, or changes
            return &stream->worker[k];
    return NULL;
}

bool mf_parallel_stream_has_idle(struct parallel_stream *stream) {
    pthread_mutex_lock(&stream->lock);
    const bool has = find_idle(stream) != NULL;
    pthread_mutex_unlock(&stream->lock);
    return has;
}

void mf_parallel_stream_give(struct parallel_stream *stream, const void *task) {
    pthread_mutex_lock(&stream->lock);
    struct worker *worker = find_idle(stream);
    memcpy(worker->task, task, stream->tasks.task_size);
    worker->work = GIVEN;
    pthread_cond_signal(&worker->given);
    pthread_mutex_unlock(&stream->lock);
}

/// One that is done, or NULL; `open` is how many have a task or a result.
static struct worker *find_done(const struct parallel_stream *stream, int *open) {
    struct worker *done = NULL;
    *open = 0;
    for (int k = 0; k < stream->begun; k++) {
        struct worker *worker = &stream->worker[k];
        *open += worker->work != IDLE;
        if (worker->work == DONE)
            done = worker;
    }
    return done;
}

enum status mf_parallel_stream_take(struct parallel_stream *stream,
                                    struct parallel_stream_result *taken) {
    const double begin = clock_seconds();
    int open;
    struct worker *worker;
    *taken = (struct parallel_stream_result){NULL, NULL};
    pthread_mutex_lock(&stream->lock);
    while ((worker = find_done(stream, &open)) == NULL && open > 0)
        pthread_cond_wait(&stream->done, &stream->lock);
    if (worker)
        worker->work = IDLE;
    pthread_mutex_unlock(&stream->lock);
    if (worker == NULL)
        return STATUS_OK;
    mf_parallel_times_add_streamed(worker->seconds, clock_seconds() - begin);
    *taken = (struct parallel_stream_result){worker->task, worker->result};
    return worker->status == STATUS_OK ? STATUS_OK
                                       : mf_status_fail(worker->status, "%s", worker->message);
}
