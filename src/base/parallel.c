// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel.h"

#include "base/memory.h"

#include <stdbool.h>
#include <stdio.h>

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

/// Bytes of the longest message of base/status.c.
enum { MESSAGE_SIZE = 8192 };

/// The failure that counts so far, with its message, which else belongs to a thread.
struct failure {
    enum status status;
    size_t task; ///< `count` while there is none
    char message[MESSAGE_SIZE];
};

static bool comes_before(const struct failure *failure, enum status status, size_t task) {
    const bool interrupted = status == STATUS_INTERRUPTED,
               before = failure->status == STATUS_INTERRUPTED;
    return interrupted != before ? interrupted : task < failure->task;
}

static bool may_begin(const struct failure *failure, size_t task) {
    bool may;
#pragma omp critical
    may = failure->status != STATUS_INTERRUPTED && task < failure->task;
    return may;
}

/// Run a task, and take its result or keep its failure.
static void try_one(const struct parallel_tasks *tasks, size_t task, struct failure *failure) {
    void *result = NULL;
    enum status status = STATUS_OK;
    if (tasks->result_size > 0 && (result = mf_memory_zeroed(1, tasks->result_size)) == NULL)
        status = STATUS_NO_MEMORY;
    if (status == STATUS_OK)
        status = tasks->run(tasks->context, task, result);
#pragma omp critical
    {
        if (status == STATUS_OK && tasks->take) {
            tasks->take(tasks->context, task, result);
        } else if (status != STATUS_OK && comes_before(failure, status, task)) {
            failure->status = status;
            failure->task = task;
            snprintf(failure->message, sizeof failure->message, "%s", mf_status_message());
        }
    }
    mf_memory_free(result);
}

enum status mf_parallel_try(const struct parallel_tasks *tasks) {
    struct failure failure = {.status = STATUS_OK, .task = tasks->count};
    // Threads take the numbers in their order: all below one that failed have begun.
#pragma omp parallel for schedule(dynamic)                                                         \
    num_threads(tasks->threads) if (tasks->threads > 1 && tasks->count > 1)
    for (size_t task = 0; task < tasks->count; task++)
        if (may_begin(&failure, task))
            try_one(tasks, task, &failure);
    return failure.status == STATUS_OK ? STATUS_OK
                                       : mf_status_fail(failure.status, "%s", failure.message);
}
