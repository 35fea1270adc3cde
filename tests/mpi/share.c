// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tasks that only sleep, shared among ranks: how long they take against the model of
// work/fit_tasks.h. Sleeping needs no processor, so that more ranks than a machine has processors
// can be tried. In rounds, and one by one without rounds. Prints a line, and ends with 1 if the
// model is off by more than 10 % or a result is wrong. With a number it is one process of as many
// threads.
#include "base/clock.h"
#include "base/parallel.h"
#include "base/parallel_stream.h"
#include "base/ranks.h"
#include "base/rng.h"
#include "work/fit_tasks.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TASKS = 32, ROUNDS = 6 };
static const double mean = 0.1, spread = 0.05; // [s]
static const char failure[] = "a task has failed";

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

/// Do all rounds with so many threads a rank. Returns seconds; 0 if a result is wrong.
static double in_rounds(int threads) {
    const double begin = clock_seconds();
    bool right = true;
    for (int number = 0; number < ROUNDS; number++) {
        struct round round = {.number = number};
        right = mf_parallel_try(&(struct parallel_tasks){.count = TASKS,
                                                         .threads = threads,
                                                         .run = run_task,
                                                         .take = take,
                                                         .result_size = sizeof(double),
                                                         .context = &round,
                                                         .spans = list_found}) == STATUS_OK &&
                right;
        for (size_t task = 0; task < TASKS; task++)
            right = right && round.found[task] == duration(number, task) &&
                    round.taken[task] == duration(number, task);
    }
    return right ? clock_seconds() - begin : 0;
}

/// Task number of all rounds; the one behind the last fails.
static enum status run_streamed(void *context, const void *task, void *result) {
    const size_t number = *(const size_t *)task;
    struct round round = {.number = (int)(number / TASKS)};
    (void)context;
    return number < ROUNDS * TASKS ? run_task(&round, number % TASKS, result)
                                   : mf_status_fail(STATUS_UNSTABLE, "%s", failure);
}

/// What was given and taken of the tasks of all rounds.
struct streamed {
    size_t given;
    int seen[ROUNDS * TASKS];
};

static void give(struct parallel_stream *stream, struct streamed *streamed) {
    for (; streamed->given < ROUNDS * TASKS && mf_parallel_stream_has_idle(stream);
         streamed->given++)
        mf_parallel_stream_give(stream, &streamed->given);
}

/// Take as many results as a round has, while others are worked for. Returns whether each is right
/// and new.
static bool take_round(struct parallel_stream *stream, struct streamed *streamed) {
    bool right = true;
    give(stream, streamed);
    for (int left = TASKS; left > 0; left--, give(stream, streamed)) {
        struct parallel_stream_result taken;
        if (mf_parallel_stream_take(stream, &taken) != STATUS_OK || taken.task == NULL)
            return false;
        const size_t number = *(const size_t *)taken.task;
        right = right && streamed->seen[number]++ == 0 &&
                *(const double *)taken.result == duration((int)(number / TASKS), number % TASKS);
    }
    return right;
}

/// Whether each thread of each rank tells a failure with its message, and then nothing is left.
static bool tells_failures(struct parallel_stream *stream) {
    const size_t fails = ROUNDS * TASKS;
    struct parallel_stream_result taken;
    int given = 0;
    bool right = true;
    for (; mf_parallel_stream_has_idle(stream); given++)
        mf_parallel_stream_give(stream, &fails);
    for (int left = given; left > 0; left--)
        right = mf_parallel_stream_take(stream, &taken) == STATUS_UNSTABLE &&
                strcmp(mf_status_message(), failure) == 0 && right;
    right = mf_parallel_stream_take(stream, &taken) == STATUS_OK && taken.task == NULL && right;
    return right && given >= mf_ranks_count();
}

/// Do the tasks of all rounds one by one, with so many threads a rank. Results are taken in turns,
/// from each of which to the next tasks go on. Returns seconds; on rank 0, 0 if one went wrong.
static double without_rounds(int threads) {
    struct parallel_stream *stream;
    struct streamed streamed = {0};
    const double begin = clock_seconds();
    double seconds = 0;
    bool right = true;
    if (mf_parallel_stream_begin(&stream,
                                 &(struct parallel_stream_tasks){.threads = threads,
                                                                 .task_size = sizeof(size_t),
                                                                 .result_size = sizeof(double),
                                                                 .run = run_streamed}) != STATUS_OK)
        return 0;
    for (int turn = 0; turn <= ROUNDS; turn++) {
        seconds = turn == ROUNDS ? clock_seconds() - begin : 0;
        if (ranks_lead()) {
            mf_parallel_stream_open(stream);
            right =
                (turn < ROUNDS ? take_round(stream, &streamed) : tells_failures(stream)) && right;
            mf_parallel_stream_close(stream);
        } else {
            mf_parallel_stream_follow(stream);
        }
    }
    mf_parallel_stream_end(stream);
    return right ? seconds : 0;
}

/// Seconds of all tasks one by one, by the model.
static double model_without_rounds(int workers) {
    double seconds[ROUNDS * TASKS];
    for (int k = 0; k < ROUNDS * TASKS; k++)
        seconds[k] = duration(k / TASKS, (size_t)k % TASKS);
    return mf_fit_tasks_schedule(seconds, ROUNDS * TASKS, workers);
}

static double model_in_rounds(int workers) {
    double seconds[TASKS], total = 0;
    for (int number = 0; number < ROUNDS; number++) {
        for (size_t k = 0; k < TASKS; k++)
            seconds[k] = duration(number, k);
        total += mf_fit_tasks_schedule(seconds, TASKS, workers);
    }
    return total;
}

/// Print both beside the model. Returns whether it is right.
static bool compare(const char *what, int workers, double rounds, double streamed) {
    const double rounds_model = model_in_rounds(workers), model = model_without_rounds(workers);
    if (ranks_lead())
        printf(
            "%d %s: in rounds %.3f s, by the model %.3f s; without %.3f s, by the model %.3f s\n",
            workers, what, rounds, rounds_model, streamed, model);
    return !ranks_lead() ||
           (fabs(rounds / rounds_model - 1) < 0.1 && fabs(streamed / model - 1) < 0.1);
}

int main(int count, char **word) {
    if (count > 1) {
        const int threads = atoi(word[1]);
        return compare("threads", threads, in_rounds(threads), without_rounds(threads)) ? 0 : 1;
    }
    if (mf_ranks_begin(NULL) != STATUS_OK)
        return 1;
    const double rounds = in_rounds(1), streamed = without_rounds(1);
    bool right = compare("ranks", mf_ranks_count(), rounds, streamed);
    right = mf_parallel_agree(right && rounds > 0 && streamed > 0 ? STATUS_OK : STATUS_UNCONVERGED,
                              0) == STATUS_OK;
    mf_ranks_end();
    return right ? 0 : 1;
}
