// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel.h"

#include "base/clock.h"
#include "base/memory.h"
#include "base/parallel_outcome.h"
#include "base/parallel_times.h"
#include "base/ranks.h"
#include "base/task_log.h"

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

static bool may_begin(const struct parallel_outcome *outcome, size_t task) {
    bool may;
#pragma omp critical
    may = parallel_outcome_allows(outcome, task);
    return may;
}

/// Run a task, and take its result or keep its failure.
static void try_one(const struct parallel_tasks *tasks, size_t task,
                    struct parallel_outcome *outcome) {
    void *result = NULL;
    enum status status = STATUS_OK;
    if (tasks->result_size > 0 && (result = mf_memory_zeroed(1, tasks->result_size)) == NULL)
        status = STATUS_NO_MEMORY;
    const double begin = clock_thread_seconds();
    if (status == STATUS_OK)
        status = tasks->run(tasks->context, task, result);
    const double seconds = clock_thread_seconds() - begin;
#pragma omp critical
    {
        if (status == STATUS_OK && tasks->take)
            tasks->take(tasks->context, task, result);
        parallel_outcome_add(outcome, task, status, mf_status_message(), seconds);
    }
    mf_memory_free(result);
}

static void try_alone(const struct parallel_tasks *tasks, struct parallel_outcome *outcome) {
    // Threads take the numbers in their order: all below one that failed have begun.
#pragma omp parallel for schedule(dynamic)                                                         \
    num_threads(tasks->threads) if (tasks->threads > 1 && tasks->count > 1)
    for (size_t task = 0; task < tasks->count; task++)
        if (may_begin(outcome, task))
            try_one(tasks, task, outcome);
}

static enum status try_all(const struct parallel_tasks *tasks) {
    const double begin = clock_seconds();
    struct parallel_outcome outcome = {.task = tasks->count};
    if (tasks->spans && mf_ranks_count() > 1)
        mf_ranks_try(tasks, &outcome);
    else
        try_alone(tasks, &outcome);
    if (tasks->spans)
        mf_parallel_times_add(tasks->count, &outcome.seconds, clock_seconds() - begin);
    return parallel_outcome_status(&outcome);
}

enum status mf_parallel_try(const struct parallel_tasks *tasks) {
    return mf_task_log_try(tasks, try_all);
}
