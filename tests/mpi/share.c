// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tasks that only sleep, shared among ranks: how long they take against the model of
// work/fit_tasks.h. Sleeping needs no processor, so that more ranks than a machine has processors
// can be tried. Prints a line, and ends with 1 if the model is off by more than 10 % or a result is
// wrong.
#include "base/clock.h"
#include "base/parallel.h"
#include "base/ranks.h"
#include "base/rng.h"
#include "work/fit_tasks.h"

#include <math.h>
#include <stdio.h>

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

int main(void) {
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
