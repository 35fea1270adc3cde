// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel.h"

#include "base/clock.h"
#include "base/memory.h"
#include "base/parallel_call.h"
#include "base/parallel_times.h"
#include "base/ranks.h"
#include "base/task_log.h"

#include <sched.h>
#include <stdatomic.h>

/// Where part `number` of `parts` begins, at a multiple of 16: parts share no cache line.
static size_t part_begin(size_t count, int number, int parts) {
    return number == parts ? count : count * (size_t)number / (size_t)parts / 16 * 16;
}

/// Piece by piece, so that a body that goes through several arrays, or through one several times,
/// finds again in the second-level cache what it has just read.
static void do_pieces(void (*body)(void *context, size_t begin, size_t end), void *context,
                      size_t begin, size_t end) {
    enum { PIECE = 1024 };
    for (; begin < end; begin += PIECE)
        body(context, begin, end - begin < PIECE ? end : begin + PIECE);
}

void mf_parallel_for(size_t count, int threads,
                     void (*body)(void *context, size_t begin, size_t end), void *context) {
    if (threads <= 1) {
        do_pieces(body, context, 0, count);
        return;
    }
#pragma omp parallel for schedule(static) num_threads(threads)
    for (int part = 0; part < threads; part++)
        do_pieces(body, context, part_begin(count, part, threads),
                  part_begin(count, part + 1, threads));
}

// A team of one thread costs as much as others, a call of the system each time: what one thread
// does has no team. (100 beads take 2.3 instead of 4.1 s, 512 2.3 instead of 2.7 s.)
void mf_parallel_parts(int parts, int threads, void (*body)(void *context, int part),
                       void *context) {
    if (threads <= 1 || parts <= 1) {
        for (int part = 0; part < parts; part++)
            body(context, part);
        return;
    }
#pragma omp parallel for schedule(dynamic) num_threads(threads)
    for (int part = 0; part < parts; part++)
        body(context, part);
}

double mf_parallel_sum(size_t count, int threads,
                       double (*body)(const void *context, size_t begin, size_t end),
                       const void *context) {
    enum { MAX_BLOCKS = 64, SMALLEST_BLOCK = 4096 };
    const size_t wanted = (count + SMALLEST_BLOCK - 1) / SMALLEST_BLOCK;
    const int blocks = wanted < MAX_BLOCKS ? (int)wanted : MAX_BLOCKS;
    double sums[MAX_BLOCKS], total = 0;
    if (blocks <= 1)
        return blocks < 1 ? 0 : body(context, 0, count);
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
    for (int block = 0; block < blocks; block++)
        sums[block] =
            body(context, part_begin(count, block, blocks), part_begin(count, block + 1, blocks));
    for (int block = 0; block < blocks; block++)
        total += sums[block];
    return total;
}

struct ring {
    int parts;
    void (*body)(void *context, int part);
    void *context;
    atomic_int begun; ///< how many
    atomic_bool done[PARALLEL_MAX_RING];
};

static void wait_for(atomic_bool *done) {
    enum { TURNS = 1000 }; // then the processor is for others, as where threads meet
    for (int turn = 0; !atomic_load_explicit(done, memory_order_acquire); turn++)
        if (turn > TURNS)
            sched_yield();
}

/// Do parts until all have begun. Whoever waits for a part knows that a thread is at it.
static void go_round(struct ring *ring) {
    for (int n; (n = atomic_fetch_add(&ring->begun, 1)) < ring->parts;) {
        const int evens = (ring->parts + 1) / 2, part = n < evens ? 2 * n : 2 * (n - evens) + 1;
        if (n >= evens) {
            wait_for(&ring->done[part - 1]);
            wait_for(&ring->done[(part + 1) % ring->parts]);
        }
        ring->body(ring->context, part);
        atomic_store_explicit(&ring->done[part], true, memory_order_release);
    }
}

void mf_parallel_ring(int parts, int threads, void (*body)(void *context, int part),
                      void *context) {
    struct ring ring = {.parts = parts, .body = body, .context = context};
    if (threads <= 1 || parts <= 1) {
        go_round(&ring);
        return;
    }
#pragma omp parallel num_threads(threads)
    go_round(&ring);
}

/// Run a task, and take its result or keep its failure.
static void try_one(struct parallel_call *call, size_t task) {
    const struct parallel_tasks *tasks = call->tasks;
    void *result = NULL;
    enum status status = STATUS_OK;
    if (tasks->result_size > 0 && (result = mf_memory_zeroed(1, tasks->result_size)) == NULL)
        status = STATUS_NO_MEMORY;
    const double begin = clock_thread_seconds();
    if (status == STATUS_OK)
        status = parallel_call_run(call, task, result);
    const double seconds = clock_thread_seconds() - begin;
    pthread_mutex_lock(&call->lock);
    if (status == STATUS_OK && call->log)
        mf_task_log_note(call, task, result);
    if (status == STATUS_OK && tasks->take)
        tasks->take(tasks->context, task, result);
    parallel_call_end_task(call, task, status, mf_status_marked(), seconds);
    pthread_mutex_unlock(&call->lock);
    mf_memory_free(result);
}

static void try_alone(struct parallel_call *call) {
    // Threads take the numbers in their order: all below one that failed have begun.
#pragma omp parallel for schedule(dynamic)                                                         \
    num_threads(call->tasks->threads) if (call->tasks->threads > 1 && call->left > 1)
    for (size_t task = 0; task < call->tasks->count; task++) {
        pthread_mutex_lock(&call->lock);
        const bool wanted = parallel_call_wants(call, task);
        pthread_mutex_unlock(&call->lock);
        if (wanted)
            try_one(call, task);
    }
}

enum status mf_parallel_try(const struct parallel_tasks *tasks) {
    const double begin = clock_seconds();
    struct parallel_call call = {.tasks = tasks,
                                 .left = tasks->count,
                                 .failed = tasks->count,
                                 .lock = PTHREAD_MUTEX_INITIALIZER,
                                 .locale = uselocale((locale_t)0)};
    TRY(mf_task_log_begin(&call));
    if (call.left > 0 && tasks->spans && mf_ranks_count() > 1)
        mf_ranks_try(&call);
    else
        try_alone(&call);
    if (call.left > 0 && tasks->spans)
        mf_parallel_times_add(call.left, &call.seconds, clock_seconds() - begin);
    mf_task_log_end(&call);
    return call.status == STATUS_OK ? STATUS_OK : mf_status_fail(call.status, "%s", call.message);
}
