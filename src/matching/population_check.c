// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "matching/population.h"

#include <math.h>

/// Fresh measurements of one candidate.
struct fresh {
    const struct population *population;
    const double *variables;
    struct evaluate_parameters parameters;
    struct evaluate_result *results; ///< shape [count]
    double *features;                ///< shape [count, features]
    struct observed *observed;       ///< shape [count]
};

static enum status fresh_init(struct fresh *fresh, size_t count, int64_t length) {
    const struct population *population = fresh->population;
    fresh->parameters = population->parameters.evaluate;
    fresh->parameters.plan.equilibration *= length;
    fresh->parameters.plan.samples *= length;
    fresh->parameters.precision = 0;
    TRY_ARRAY(fresh->results, count);
    TRY_ARRAY(fresh->features, count * population->surrogate.features);
    TRY_ARRAY(fresh->observed, count);
    for (size_t k = 0; k < count; k++)
        TRY(mf_measurement_values_init(&fresh->observed[k],
                                       &population->parametrisation->unknowns.problem->targets));
    return STATUS_OK;
}

static void fresh_clear(struct fresh *fresh, size_t count) {
    for (size_t k = 0; fresh->observed && k < count; k++)
        mf_measurement_values_clear(&fresh->observed[k]);
    mf_memory_free(fresh->observed);
    mf_memory_free(fresh->features);
    mf_memory_free(fresh->results);
}

static enum status measure_one(void *context, size_t k, void *end) {
    const struct fresh *fresh = context;
    const struct population *population = fresh->population;
    const struct population_task task = {
        .parameters = &fresh->parameters,
        .seed = mf_rng_child_seed(population->parametrisation->unknowns.problem->seed,
                                  RNG_REMEASUREMENT, (uint32_t)population->totals.remeasured,
                                  (uint32_t)k),
        .discard_above = HUGE_VAL,
        .threads = 1,
        .features = fresh->features + k * population->surrogate.features,
        .observed = &fresh->observed[k],
        .end = end,
    };
    return mf_population_simulate(population, fresh->variables, &task, &fresh->results[k]);
}

/// What a measurement has left.
static size_t list_measured(void *context, size_t k, struct memory_span *span) {
    const struct fresh *fresh = context;
    const size_t features = fresh->population->surrogate.features;
    span[0] = (struct memory_span){&fresh->results[k], sizeof *fresh->results};
    span[1] = (struct memory_span){fresh->features + k * features, features * sizeof(double)};
    return 2 + mf_measurement_values_spans(
                   &fresh->observed[k],
                   &fresh->population->parametrisation->unknowns.problem->targets, span + 2);
}

static struct target_distance mean_distance(const struct evaluate_result *results, size_t count,
                                            int kind) {
    struct target_distance mean = {.count = results[0].distance[kind].count};
    for (size_t k = 0; k < count; k++) {
        mean.rms += results[k].distance[kind].rms / (double)count;
        mean.noise += results[k].distance[kind].noise / (double)count;
    }
    return mean;
}

/// The mean of all, as one measurement.
static enum status compare_mean(const struct fresh *fresh, size_t count,
                                struct population_check *check) {
    const struct targets *targets = &fresh->population->parametrisation->unknowns.problem->targets;
    struct target_distance distance[TARGETS];
    CLEARED_BY(mf_measurement_values_clear) struct observed mean = {0};
    TRY(mf_measurement_values_init(&mean, targets));
    mf_measurement_mean(fresh->observed, count, targets, &mean);
    mf_measurement_distance(&mean, targets, distance);
    check->error = mf_targets_error(targets, distance);
    check->noise = mf_targets_noise(targets, distance);
    check->variance = mf_targets_variance(targets, distance);
    return STATUS_OK;
}

enum status mf_population_check(struct population *population, const double *variables,
                                size_t count, int64_t length, struct population_check *check) {
    enum status status = STATUS_OK;
    struct fresh fresh = {.population = population, .variables = variables};
    bool failed = false;
    *check = (struct population_check){.error = OPTIMISER_FAILED};
    CHECK(fresh_init(&fresh, count, length));
    CHECK(mf_parallel_try(&(struct parallel_tasks){
        .count = count,
        .threads = population->parametrisation->unknowns.problem->threads,
        .run = measure_one,
        .result_size = mf_population_coordinates(population) * sizeof(double),
        .context = &fresh,
        .spans = list_measured}));
    population->totals.remeasured++;
    for (size_t k = 0; k < count; k++) {
        const struct evaluate_result *result = &fresh.results[k];
        failed = failed || result->error >= OPTIMISER_FAILED;
        mf_population_remember(population, variables, result->error,
                               fresh.features + k * population->surrogate.features);
        population->totals.evaluations++;
        population->totals.steps += result->engine_steps;
        mf_population_add_failure(&population->totals.failures, result);
    }
    for (int kind = 0; kind < TARGETS; kind++)
        check->each[kind] = mean_distance(fresh.results, count, kind);
    if (!failed)
        CHECK(compare_mean(&fresh, count, check));
done:
    fresh_clear(&fresh, count);
    return status;
}

void mf_population_expect(struct population *population, double error, double noise) {
    const double beyond = error > noise ? sqrt(error * error - noise * noise) : 0;
    mf_targets_spread_error(&population->parametrisation->unknowns.problem->targets, beyond,
                            population->excess);
}

// The start of all candidates ---------------------------------------------------------------------

/// What settles, and what it leaves.
struct settling {
    struct population *population;
    const double *variables;
    uint32_t number;
    uint64_t steps;
};

static enum status settle_one(void *context, size_t task, void *result) {
    struct settling *settling = context;
    struct population *population = settling->population;
    const struct inverse_problem *problem = population->parametrisation->unknowns.problem;
    struct unknowns_laws laws;
    double *column[3] = {NULL};
    (void)task, (void)result;
    mf_population_split(population, population->position, column);
    enum status status =
        mf_parametrisation_laws(population->parametrisation, settling->variables, &laws);
    const struct evaluate_candidate candidate = {
        .potential = laws.table[UNKNOWN_POTENTIAL],
        .omega = laws.table[UNKNOWN_OMEGA],
        .threads = mf_population_threads_inside(problem),
        .seed = mf_rng_child_seed(problem->seed, RNG_EVALUATION, UINT32_MAX, settling->number),
    };
    if (status == STATUS_OK)
        status = mf_evaluate_settle(&laws.problem, &candidate,
                                    population->parameters.evaluate.plan.equilibration, column,
                                    &settling->steps);
    mf_unknowns_laws_clear(&laws);
    return status;
}

static size_t list_settled(void *context, size_t task, struct memory_span *span) {
    struct settling *settling = context;
    (void)task;
    span[0] = (struct memory_span){settling->population->position,
                                   mf_population_coordinates(settling->population) *
                                       sizeof *settling->population->position};
    span[1] = (struct memory_span){&settling->steps, sizeof settling->steps};
    return 2;
}

/// Candidates of one potential have one equilibrium; those of others find beads of it where they
/// want none.
static bool share_equilibrium(const struct inverse_problem *problem) {
    bool share = true;
    for (int kind = 0; kind < UNKNOWNS; kind++)
        share = share && (unknown_is_omega(kind) || !problem->unknown[kind].wanted);
    return share;
}

enum status mf_population_settle(struct population *population,
                                 const struct optimiser_round *round) {
    enum { MAX = 4 }; // a round of which none settles is at fault as a whole
    struct population_totals *totals = &population->totals;
    const bool wanted = population->parameters.warm_start && totals->evaluations == 0 &&
                        share_equilibrium(population->parametrisation->unknowns.problem);
    for (size_t k = 0; wanted && k < round->count && k < MAX && !totals->warm; k++) {
        struct settling settling = {.population = population,
                                    .variables = round->variables +
                                                 k * population->parametrisation->variables,
                                    .number = (uint32_t)k};
        const enum status status = mf_parallel_try(&(struct parallel_tasks){.count = 1,
                                                                            .threads = 1,
                                                                            .run = settle_one,
                                                                            .context = &settling,
                                                                            .spans = list_settled});
        if (status != STATUS_OK && status != STATUS_UNSTABLE)
            return status;
        totals->steps += settling.steps;
        totals->warm = status == STATUS_OK;
    }
    return STATUS_OK;
}
