// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a stream is made of: its own threads (parallel_stream.c) and, on rank 0, those of
/// other ranks (parallel_stream_ranks.c).
#pragma once

#include "base/letter.h"
#include "base/parallel_stream.h"
#include "base/ranks_pause.h"

enum stream_work { STREAM_IDLE, STREAM_GIVEN, STREAM_DONE };

/// A thread and its task. All but `work` belongs to the thread while the task is GIVEN, and else to
/// the owner of the stream.
struct stream_worker {
    struct parallel_stream *stream;
    pthread_t thread;
    pthread_cond_t given;
    enum stream_work work;
    void *task, *result;
    double seconds;
    enum status status;
    char message[STATUS_MESSAGE_SIZE];
};

/// Rank 0's view of the others. It belongs to the owner of the stream.
struct stream_others {
    uint64_t turn;
    struct ranks_watch watch;
    bool closing;        ///< the others leave
    int present, ready;  ///< ranks that have come, and that have left
    uint64_t told;       ///< results that those who have left have told of in this turn
    uint64_t heard;      ///< that have come in this turn
    size_t open;         ///< tasks that were given and whose results were not taken
    uint64_t *given;     ///< shape [ranks]: tasks in this turn
    size_t *idle;        ///< shape [ranks]: threads without a task
    struct stream_mail { ///< a result that was not taken
        struct stream_mail *next;
        struct letter *letter;
    } * first, *last;
    struct letter *taken; ///< that the owner looks at
};

struct parallel_stream {
    struct parallel_stream_tasks tasks;
    pthread_mutex_t lock;     ///< of `work` of all, `over` and the pause
    struct ranks_pause pause; ///< of the owner, until a task is done
    bool over;
    int begun; ///< threads
    struct stream_worker *worker;
    struct stream_others *others; ///< NULL: alone, or not rank 0
};

/// A task that has ended.
struct stream_outcome {
    const void *task, *result;
    double seconds;
    enum status status;
    const char *message;
};

/// What a thread of this rank has done, which is idle then; false: none.
bool mf_parallel_stream_take_own(struct parallel_stream *stream, struct stream_outcome *outcome);

/// Threads of this rank that have neither a task nor a result that was not taken.
size_t mf_parallel_stream_count_idle(struct parallel_stream *stream);

/// Give a task to a thread of this rank, which must be idle.
void mf_parallel_stream_give_own(struct parallel_stream *stream, const void *task);

/// @name Rank 0 and the threads of others

enum status mf_parallel_stream_others_begin(struct parallel_stream *stream) MUST_USE;
void mf_parallel_stream_others_end(struct stream_others *others);
bool mf_parallel_stream_others_have_idle(const struct stream_others *others);

/// Give a task to an idle thread of the rank that has most of them.
void mf_parallel_stream_others_give(struct parallel_stream *stream, const void *task);

/// Look at all letters that have come, and at what signals wish.
void mf_parallel_stream_others_listen(struct parallel_stream *stream);

/// What a thread of another rank has done; false: no letter says so.
bool mf_parallel_stream_others_take(struct parallel_stream *stream, struct stream_outcome *outcome);
