// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Tasks that come one by one, so that no thread waits for the end of a round.
///
/// One thread, which owns the stream, makes tasks and takes what was found; the threads of the
/// stream do them. Which result comes first depends on the machine. Among ranks (base/ranks.h) all
/// begin a stream of the same tasks: what rank 0's owner gives is done by threads of all of them.
#pragma once

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>

struct parallel_stream;

struct parallel_stream_tasks {
    int threads; ///< of this rank
    size_t task_size, result_size;
    /// Do one task; several run at once. `result` is zeroed, of result_size bytes.
    enum status (*run)(void *context, const void *task, void *result);
    void *context;
};

/// Begin threads, which wait for tasks. Fails: NO_MEMORY, also if there are no more threads.
enum status mf_parallel_stream_begin(struct parallel_stream **stream,
                                     const struct parallel_stream_tasks *tasks) MUST_USE;

/// Wait for the tasks that are being done here, and forget them. NULL: nothing.
void mf_parallel_stream_end(struct parallel_stream *stream);

/// @name Turns of ranks
/// Rank 0 gives and takes while the stream is open, and the others follow until it closes. Between
/// such turns ranks may do other things together; tasks that have begun go on meanwhile, and are
/// taken in a later turn. A process alone may give and take at any time.

/// Rank 0: begin a turn, once all ranks are there, and end it.
void mf_parallel_stream_open(struct parallel_stream *stream);
void mf_parallel_stream_close(struct parallel_stream *stream);

/// Another rank, in place of both: do what rank 0 gives, with all threads.
void mf_parallel_stream_follow(struct parallel_stream *stream);

/// @name Rank 0, or a process alone

/// Whether a thread has neither a task nor a result that was not taken.
bool mf_parallel_stream_has_idle(struct parallel_stream *stream);

/// Give a task of task_size bytes, which is copied, to an idle thread; there must be one.
void mf_parallel_stream_give(struct parallel_stream *stream, const void *task);

/// What a thread has done.
struct parallel_stream_result {
    const void *task, *result; ///< until the next one is given or taken; NULL: none was being done
};

/// Wait until a task is done. Fails: as the task. Tested: test_parallel_stream, tests/mpi/share.c.
enum status mf_parallel_stream_take(struct parallel_stream *stream,
                                    struct parallel_stream_result *taken) MUST_USE;
