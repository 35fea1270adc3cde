// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel.h"

#include "base/clock.h"
#include "base/memory.h"
#include "base/parallel_keep.h"
#include "base/parallel_ranks.h"
#include "base/parallel_times.h"
#include "base/ranks.h"

/// Where part `number` of `parts` begins, at a multiple of 16: parts share no cache line.
static size_t part_begin(size_t count, int number, int parts) {
    return number == parts ? count : count * (size_t)number / (size_t)parts / 16 * 16;
}

void mf_parallel_for(size_t count, int threads,
                     void (*body)(void *context, size_t begin, size_t end), void *context) {
    if (threads <= 1) {
        body(context, 0, count);
        return;
    }
#pragma omp parallel for schedule(static) num_threads(threads)
    for (int part = 0; part < threads; part++)
        body(context, part_begin(count, part, threads), part_begin(count, part + 1, threads));
}

double mf_parallel_sum(size_t count, int threads,
                       double (*body)(const void *context, size_t begin, size_t end),
                       const void *context) {
    enum { MOST_BLOCKS = 64, SMALLEST_BLOCK = 4096 };
    const size_t wanted = (count + SMALLEST_BLOCK - 1) / SMALLEST_BLOCK;
    const int blocks = wanted < MOST_BLOCKS ? (int)wanted : MOST_BLOCKS;
    double sums[MOST_BLOCKS], total = 0;
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
    for (int block = 0; block < blocks; block++)
        sums[block] =
            body(context, part_begin(count, block, blocks), part_begin(count, block + 1, blocks));
    for (int block = 0; block < blocks; block++)
        total += sums[block];
    return total;
}

static bool may_begin(const struct parallel_failure *failure, size_t task) {
    bool may;
#pragma omp critical
    may = parallel_failure_allows(failure, task);
    return may;
}

/// Run a task, and take its result or keep its failure.
static void try_one(const struct parallel_tasks *tasks, size_t task,
                    struct parallel_failure *failure) {
    void *result = NULL;
    enum status status = STATUS_OK;
    if (tasks->result_size > 0 && (result = mf_memory_zeroed(1, tasks->result_size)) == NULL)
        status = STATUS_NO_MEMORY;
    const double begin = clock_thread_seconds();
    if (status == STATUS_OK)
        status = tasks->run(tasks->context, task, result);
    if (tasks->spans)
        mf_parallel_times_add(tasks->count, clock_thread_seconds() - begin);
#pragma omp critical
    {
        if (status == STATUS_OK && tasks->take) {
            tasks->take(tasks->context, task, result);
        } else if (status != STATUS_OK) {
            parallel_failure_note(failure, status, task, mf_status_message());
        }
    }
    mf_memory_free(result);
}

static enum status try_alone(const struct parallel_tasks *tasks) {
    struct parallel_failure failure = {.status = STATUS_OK, .task = tasks->count};
    // Threads take the numbers in their order: all below one that failed have begun.
#pragma omp parallel for schedule(dynamic)                                                         \
    num_threads(tasks->threads) if (tasks->threads > 1 && tasks->count > 1)
    for (size_t task = 0; task < tasks->count; task++)
        if (may_begin(&failure, task))
            try_one(tasks, task, &failure);
    return parallel_failure_status(&failure);
}

static enum status try_all(const struct parallel_tasks *tasks) {
    const double begin = clock_seconds();
    const enum status status =
        tasks->spans && mf_ranks_count() > 1 ? mf_parallel_try_together(tasks) : try_alone(tasks);
    if (tasks->spans)
        mf_parallel_times_end(tasks->count, clock_seconds() - begin);
    return status;
}

enum status mf_parallel_try(const struct parallel_tasks *tasks) {
    return mf_parallel_keep_try(tasks, try_all);
}
