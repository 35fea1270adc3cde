// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tasks that only sleep, shared among ranks: how long they take against the model of
// work/fit_tasks.h. Sleeping needs no processor, so that more ranks than a machine has processors
// can be tried. Prints a line, and ends with 1 if the model is off by more than 10 % or a result is
// wrong. With a number it is one process of as many threads: the same tasks in rounds, and one by
// one without rounds.
#include "base/clock.h"
#include "base/parallel.h"
#include "base/parallel_stream.h"
#include "base/ranks.h"
#include "base/rng.h"
#include "work/fit_tasks.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { TASKS = 32, ROUNDS = 6 };
static const double mean = 0.1, spread = 0.05; // [s]

struct round {
    int number;
    double found[TASKS]; ///< of each task, from whoever has done it
    double taken[TASKS];
};

/// Seconds of a task, log-normal.
static double duration(int round, size_t task) {
    const double width = sqrt(log1p(spread * spread / (mean * mean)));
    double normal[4];
    mf_rng_normal4(mf_rng_philox(2, RNG_INITIAL, (uint32_t)round, (uint32_t)task, 0), normal);
    return mean * exp(width * (normal[0] - width / 2));
}

static enum status run_task(void *context, size_t task, void *result) {
    struct round *round = context;
    const double seconds = duration(round->number, task);
    const struct timespec time = {.tv_nsec = (long)(1e9 * seconds)};
    nanosleep(&time, NULL);
    round->found[task] = *(double *)result = seconds;
    return STATUS_OK;
}

static void take(void *context, size_t task, const void *result) {
    ((struct round *)context)->taken[task] += *(const double *)result;
}

static size_t list_found(void *context, size_t task, struct memory_span *span) {
    *span = (struct memory_span){&((struct round *)context)->found[task], sizeof(double)};
    return 1;
}

/// Do all rounds with so many threads of this process. Returns seconds; 0 if a task has failed.
static double in_rounds(int threads) {
    const double begin = clock_seconds();
    for (int number = 0; number < ROUNDS; number++) {
        struct round round = {.number = number};
        if (mf_parallel_try(&(struct parallel_tasks){.count = TASKS,
                                                     .threads = threads,
                                                     .run = run_task,
                                                     .result_size = sizeof(double),
                                                     .context = &round}) != STATUS_OK)
            return 0;
    }
    return clock_seconds() - begin;
}

/// Task number of all rounds.
static enum status run_streamed(void *context, const void *task, void *result) {
    const size_t number = *(const size_t *)task;
    struct round round = {.number = (int)(number / TASKS)};
    (void)context;
    return run_task(&round, number % TASKS, result);
}

/// Do the tasks of all rounds one by one.
static double without_rounds(int threads) {
    const double begin = clock_seconds();
    struct parallel_stream *stream;
    struct parallel_stream_result taken;
    if (mf_parallel_stream_begin(&stream,
                                 &(struct parallel_stream_tasks){.threads = threads,
                                                                 .task_size = sizeof(size_t),
                                                                 .result_size = sizeof(double),
                                                                 .run = run_streamed}) != STATUS_OK)
        return 0;
    size_t given = 0;
    for (int left = ROUNDS * TASKS; left > 0; left--) {
        for (; given < ROUNDS * TASKS && mf_parallel_stream_has_idle(stream); given++)
            mf_parallel_stream_give(stream, &given);
        if (mf_parallel_stream_take(stream, &taken) != STATUS_OK)
            return 0;
    }
    mf_parallel_stream_end(stream);
    return clock_seconds() - begin;
}

/// Both beside the model. Returns whether it is right.
static bool compare_threads(int threads) {
    double seconds[ROUNDS * TASKS], rounds_model = 0;
    for (int k = 0; k < ROUNDS * TASKS; k++)
        seconds[k] = duration(k / TASKS, (size_t)k % TASKS);
    for (int number = 0; number < ROUNDS; number++)
        rounds_model += mf_fit_tasks_schedule(seconds + (ptrdiff_t)number * TASKS, TASKS, threads);
    const double model = mf_fit_tasks_schedule(seconds, ROUNDS * TASKS, threads);
    const double rounds = in_rounds(threads), streamed = without_rounds(threads);
    printf(
        "%d threads: in rounds %.3f s, by the model %.3f s; without %.3f s, by the model %.3f s\n",
        threads, rounds, rounds_model, streamed, model);
    return fabs(rounds / rounds_model - 1) < 0.1 && fabs(streamed / model - 1) < 0.1;
}

int main(int count, char **word) {
    if (count > 1)
        return compare_threads(atoi(word[1])) ? 0 : 1;
    double waited = 0, model = 0, serial = 0;
    bool right = mf_ranks_begin(NULL) == STATUS_OK;
    for (int number = 0; right && number < ROUNDS; number++) {
        struct round round = {.number = number};
        const double begin = clock_seconds();
        right = mf_parallel_try(&(struct parallel_tasks){.count = TASKS,
                                                         .threads = 1,
                                                         .run = run_task,
                                                         .take = take,
                                                         .result_size = sizeof(double),
                                                         .context = &round,
                                                         .spans = list_found}) == STATUS_OK;
        waited += clock_seconds() - begin;
        model += mf_fit_tasks_schedule(round.found, TASKS, mf_ranks_count());
        for (size_t task = 0; task < TASKS; task++) {
            serial += round.found[task];
            right = right && round.found[task] == duration(number, task) &&
                    round.taken[task] == duration(number, task);
        }
    }
    right = mf_parallel_agree(right ? STATUS_OK : STATUS_UNCONVERGED, 0) == STATUS_OK;
    const int ranks = mf_ranks_count();
    const bool near = fabs(waited / model - 1) < 0.1;
    if (ranks_lead())
        printf("%d ranks: %.3f s, by the model %.3f s (%+.1f %%); %.0f %% of the ranks' time\n",
               ranks, waited, model, 100 * (model / waited - 1), 100 * serial / waited / ranks);
    mf_ranks_end();
    return right && near ? 0 : 1;
}
