// SPDX-License-Identifier: GPL-3.0-or-later
#include "matching/asynchronous.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "base/ranks.h"
#include "base/rng.h"

#include <math.h>
#include <string.h>

/// What a simulation of a candidate leaves.
struct streamed {
    struct evaluate_result result;
    double numbers[]; ///< features, then where it ended as population.position
};

enum status mf_asynchronous_check(const struct population_parameters *parameters) {
    const char *name = parameters->warm_start            ? "warm_start"
                       : parameters->common_noise        ? "common_noise"
                       : parameters->evaluate.racing > 0 ? "racing"
                                                         : NULL;
    if (name)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "\"%s\" is of rounds, which an \"asynchronous\" search does not have",
                              name);
    return STATUS_OK;
}

enum status mf_asynchronous_init(struct asynchronous *asynchronous, struct population *population,
                                 struct individuals *individuals, const struct optimiser *optimiser,
                                 void *optimiser_state) {
    enum status status = STATUS_OK;
    const size_t variables = population->parametrisation->variables;
    *asynchronous = (struct asynchronous){.population = population,
                                          .individuals = individuals,
                                          .optimiser = optimiser,
                                          .optimiser_state = optimiser_state};
    asynchronous->candidate = mf_memory_zeroed(1, optimiser_candidate_size(variables));
    CHECK(asynchronous->candidate ? STATUS_OK : STATUS_NO_MEMORY);
    NEW_ARRAY(asynchronous->variables, POPULATION_MOST * variables);
done:
    return status;
}

void mf_asynchronous_clear(struct asynchronous *asynchronous) {
    mf_parallel_stream_end(asynchronous->threads);
    mf_memory_free(asynchronous->candidate);
    mf_memory_free(asynchronous->variables);
    *asynchronous = (struct asynchronous){0};
}

/// In a thread of the stream. It reads of the population what never changes.
static enum status measure_one(void *context, const void *task, void *memory) {
    const struct population *population = ((const struct asynchronous *)context)->population;
    const struct optimiser_candidate *candidate = task;
    struct streamed *streamed = memory;
    const struct population_task one = {
        .parameters = &population->parameters.evaluate,
        .seed = mf_rng_child_seed(population->parametrisation->unknowns.problem->seed,
                                  RNG_EVALUATION, (uint32_t)candidate->number, 0),
        .discard_above = HUGE_VAL,
        .threads = 1,
        .features = streamed->numbers,
        .end = streamed->numbers + population->surrogate.features,
    };
    return mf_population_simulate(population, candidate->numbers, &one, &streamed->result);
}

static enum status begin_threads(struct asynchronous *asynchronous) {
    const struct population *population = asynchronous->population;
    const size_t numbers = population->surrogate.features + mf_population_coordinates(population);
    return mf_parallel_stream_begin(
        &asynchronous->threads,
        &(struct parallel_stream_tasks){
            .threads = population->parametrisation->unknowns.problem->threads,
            .task_size = optimiser_candidate_size(population->parametrisation->variables),
            .result_size = sizeof(struct streamed) + numbers * sizeof(double),
            .run = measure_one,
            .context = asynchronous});
}

/// Give each idle thread a candidate, as long as the optimiser wants some.
static void give(struct asynchronous *asynchronous) {
    while (mf_parallel_stream_has_idle(asynchronous->threads) &&
           asynchronous->optimiser->stream->ask(asynchronous->optimiser_state,
                                                asynchronous->candidate)) {
        asynchronous->candidate->number = asynchronous->standing.asked++;
        mf_parallel_stream_give(asynchronous->threads, asynchronous->candidate);
    }
}

/// Keep what was measured, and tell the optimiser.
static enum status take(struct asynchronous *asynchronous,
                        const struct optimiser_candidate *candidate,
                        const struct streamed *streamed, bool *ended) {
    const struct evaluate_result *result = &streamed->result;
    const size_t variables = asynchronous->population->parametrisation->variables;
    mf_population_take_streamed(asynchronous->population, candidate->numbers, result,
                                streamed->numbers, asynchronous->standing.here);
    if (asynchronous->standing.here < POPULATION_MOST)
        memcpy(asynchronous->variables + asynchronous->standing.here++ * variables,
               candidate->numbers, variables * sizeof(double));
    mf_individuals_add(asynchronous->individuals, asynchronous->population->iteration,
                       candidate->numbers, result->error, candidate->parent);
    return asynchronous->optimiser->stream->tell(asynchronous->optimiser_state, candidate,
                                                 result->error, result->variance, ended);
}

static void end_round(struct asynchronous *asynchronous) {
    mf_population_show(
        asynchronous->population,
        &(struct optimiser_round){asynchronous->variables, asynchronous->standing.here});
    asynchronous->standing.here = 0;
}

/// Of a process alone, or of rank 0.
static enum status lead_round(struct asynchronous *asynchronous,
                              const struct inverse_listener *listener, bool *finished) {
    struct parallel_stream_result taken;
    bool ended = false;
    give(asynchronous);
    for (; !ended; give(asynchronous)) {
        TRY(mf_parallel_stream_take(asynchronous->threads, &taken));
        *finished = taken.task == NULL;
        if (*finished)
            break;
        TRY(take(asynchronous, taken.task, taken.result, &ended));
        if (ended)
            end_round(asynchronous);
        mf_population_report(asynchronous->population,
                             asynchronous->optimiser->stream->round(asynchronous->optimiser_state),
                             listener);
    }
    return STATUS_OK;
}

enum status mf_asynchronous_take_round(struct asynchronous *asynchronous,
                                       const struct inverse_listener *listener, bool *finished) {
    enum status status = STATUS_OK;
    *finished = false;
    if (asynchronous->standing.here == 0 && asynchronous->population->survey.evaluations > 0)
        return STATUS_OK; // what came after the round was interrupted
    if (asynchronous->threads == NULL)
        TRY(mf_parallel_agree(begin_threads(asynchronous), 0));
    if (ranks_lead()) {
        mf_parallel_stream_open(asynchronous->threads);
        status = lead_round(asynchronous, listener, finished);
        mf_parallel_stream_close(asynchronous->threads);
    } else {
        mf_parallel_stream_follow(asynchronous->threads);
    }
    mf_ranks_share(finished, sizeof *finished);
    return mf_parallel_agree(status, 0);
}

size_t mf_asynchronous_spans(struct asynchronous *asynchronous, struct memory_span *spans) {
    const size_t variables = asynchronous->population->parametrisation->variables;
    spans[0] = (struct memory_span){&asynchronous->standing, sizeof asynchronous->standing};
    spans[1] =
        (struct memory_span){asynchronous->variables, POPULATION_MOST * variables * sizeof(double)};
    return ASYNCHRONOUS_SPANS;
}
