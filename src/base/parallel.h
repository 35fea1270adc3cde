// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Loops shared between threads.
///
/// Threads meet a dozen times in a step, and libgomp lets them turn in circles until all are there:
/// on busy cores for longer than the work takes. The program mesofit (mf_program_begin_again) sets
/// GOMP_SPINCOUNT for itself; another one that uses the library with threads is started with
/// GOMP_SPINCOUNT=1000 or OMP_WAIT_POLICY=passive in its environment, which are read before its
/// main begins.
#pragma once

#include "base/memory.h"
#include "base/status.h"

#include <stddef.h>
#include <stdint.h>

/// Call `body` for stretches begin … end − 1 that make up 0 … count − 1, each thread for pieces of
/// one that its caches hold.
///
/// The stretches depend on the number of threads: a body whose elements do not touch each other
/// gives the same bits for any number.
void mf_parallel_for(size_t count, int threads,
                     void (*body)(void *context, size_t begin, size_t end), void *context);

/// Σ of body(begin, end) over blocks of 0 … count − 1 that are the same for any number of threads,
/// added in order. Blocks are large, and few enough that their sums stay on the stack.
double mf_parallel_sum(size_t count, int threads,
                       double (*body)(const void *context, size_t begin, size_t end),
                       const void *context);

/// Call `body` for parts 0 … parts − 1, each by whichever thread is free. Tested: test_parallel.
void mf_parallel_parts(int parts, int threads, void (*body)(void *context, int part),
                       void *context);

enum { PARALLEL_MAX_RING = 64 };

/// Call `body` for parts 0 … parts − 1 ≤ PARALLEL_MAX_RING that follow each other in a ring: one,
/// or an even number of at least 4. A part touches what is its own and what is the next one's. Even
/// parts, which never meet, come first, and each odd one when those beside it are done, so that all
/// is touched in the same order by any number of threads. Tested: test_parallel.
void mf_parallel_ring(int parts, int threads, void (*body)(void *context, int part), void *context);

enum { PARALLEL_MAX_SPANS = 256 };

/// Independent tasks 0 … count − 1 that may fail. What a task finds is either its own part of
/// `context`, which no other task touches, or a result of some bytes that is taken over.
struct parallel_tasks {
    size_t count;
    int threads;
    /// Do one task; several run at once. `result` is zeroed, of result_size bytes; NULL for none.
    enum status (*run)(void *context, size_t task, void *result);
    /// After each task that succeeded, from one thread at a time and in any order; or NULL. It may
    /// not begin tasks of its own.
    void (*take)(void *context, size_t task, const void *result);
    size_t result_size;
    void *context;
    /// List the part of `context` that a task has changed, for the ranks that did not do it and for
    /// who begins again after an interruption (base/task_log.h), at most PARALLEL_MAX_SPANS;
    /// returns their number. Lengths may follow from the spans before: it is asked again after each
    /// that has arrived. NULL: every rank does all tasks itself.
    size_t (*spans)(void *context, size_t task, struct memory_span *spans);
};

/// Do all tasks, each once.
///
/// The failure of the lowest number is returned with its message, though it came from another
/// thread, so that status and message are the same for any number of threads: tasks beyond one
/// that failed do not begin, those before it are all done. INTERRUPTED comes before other failures:
/// then no further task begins at all, and what succeeded has been taken.
///
/// Ranks (base/ranks.h) share the tasks if these have `spans`: each takes the next one when a
/// thread of it is free, and all have all results, the same status and message at the end. Rank 0
/// takes results as they come, the others then, in the same order. Fails: as the tasks; NO_MEMORY.
/// Tested: test_parallel, check_mpi.sh.
enum status mf_parallel_try(const struct parallel_tasks *tasks) MUST_USE;
