// SPDX-License-Identifier: GPL-3.0-or-later
#include "matching/population.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "observe/rdf_force.h"

#include <math.h>
#include <string.h>

/// An error that has not been measured yet.
#define UNMEASURED (-1.0)

static const char *const no_or_yes[] = {"no", "yes", NULL};

#define MEMBER(name) .offset = offsetof(struct population_parameters, name)
const struct field mf_population_fields[] = {
    {"equilibration", FIELD_INTEGER, MEMBER(evaluate.plan.equilibration), .initial = 350,
     .minimum = 10, .maximum = 1e9, .unit = "steps", .help = "equilibration of a simulation"},
    {"samples", FIELD_INTEGER, MEMBER(evaluate.plan.samples), .initial = 45, .minimum = 1,
     .maximum = 1e8, .unit = "", .help = "samples of g(r) and pressure"},
    {"every", FIELD_INTEGER, MEMBER(evaluate.plan.every), .initial = 50, .minimum = 1,
     .maximum = 1e9, .unit = "steps", .help = "interval between samples"},
    {"temperature_tolerance", FIELD_NUMBER, MEMBER(evaluate.temperature_tolerance), .initial = 0.1,
     .minimum = FIELD_ABOVE_ZERO, .maximum = 1, .unit = "",
     .help = "largest relative deviation of the temperature after equilibration"},
    {"estimator", FIELD_CHOICE, MEMBER(evaluate.estimator), .choices = mf_rdf_force_estimators,
     .initial = RDF_FORCE_NOT_USED, .unit = "",
     .help = "estimator of g(r); force: less noise, biased by a large time step"},
    {"precision", FIELD_NUMBER, MEMBER(evaluate.precision), .initial = 0, .minimum = 0,
     .maximum = 1, .unit = "",
     .help = "relative standard error of the error that ends a simulation; 0: none"},
    FIELD_END,
};

const struct field mf_population_round_fields[] = {
    {"warm_start", FIELD_CHOICE, MEMBER(warm_start), .choices = no_or_yes, .initial = 0, .unit = "",
     .help = "begin where the last round's best simulation ended"},
    FIELD_END,
};

struct inverse_sampling mf_population_sampling(const void *parameters) {
    const struct evaluate_parameters *evaluate =
        &((const struct population_parameters *)parameters)->evaluate;
    return (struct inverse_sampling){.every = evaluate->plan.every,
                                     .rdf_force = evaluate->estimator == RDF_FORCE_USED,
                                     .samples = evaluate->plan.samples};
}

size_t mf_population_coordinates(const struct population *population) {
    const struct simulation_setup *scene = &population->parametrisation->unknowns.problem->scene;
    return (size_t)scene->box.dimensions * (size_t)scene->placement.count;
}

enum status mf_population_init(struct population *population,
                               const struct parametrisation *parametrisation,
                               const struct population_parameters *parameters) {
    *population = (struct population){
        .parametrisation = parametrisation, .parameters = *parameters, .best = NAN};
    TRY_ARRAY(population->errors, POPULATION_MAX);
    TRY_ARRAY(population->variances, POPULATION_MAX);
    TRY_ARRAY(population->distances, POPULATION_MAX * TARGETS);
    TRY_ARRAY(population->first, parametrisation->variables);
    TRY_ARRAY(population->shown, POPULATION_MAX * parametrisation->variables);
    TRY_ARRAY(population->shown_error, POPULATION_MAX);
    const struct targets *targets = &parametrisation->unknowns.problem->targets;
    const size_t features = mf_targets_features(targets);
    TRY_ARRAY(population->features, POPULATION_MAX * features);
    TRY_ARRAY(population->target, features);
    TRY_ARRAY(population->target_error, features);
    TRY_ARRAY(population->excess, features);
    mf_targets_take_features(targets, NULL, population->target, population->target_error);
    TRY(mf_surrogate_init(&population->surrogate, parametrisation->variables, features,
                          POPULATION_MAX, population->target, population->target_error,
                          population->excess));
    TRY_ARRAY(population->position, mf_population_coordinates(population));
    TRY_ARRAY(population->best_position, mf_population_coordinates(population));
    mf_population_next_round(population);
    mf_population_reset_survey(population);
    population->totals.rounds = 0;
    population->totals.length = 1;
    return STATUS_OK;
}

void mf_population_clear(struct population *population) {
    mf_memory_free(population->errors);
    mf_memory_free(population->variances);
    mf_memory_free(population->distances);
    mf_memory_free(population->first);
    mf_memory_free(population->shown);
    mf_memory_free(population->shown_error);
    mf_memory_free(population->features);
    mf_memory_free(population->target);
    mf_memory_free(population->target_error);
    mf_memory_free(population->excess);
    mf_surrogate_clear(&population->surrogate);
    mf_memory_free(population->position);
    mf_memory_free(population->best_position);
    *population = (struct population){0};
}

void mf_population_next_round(struct population *population) {
    struct population_totals *totals = &population->totals;
    for (size_t k = 0; k < POPULATION_MAX; k++)
        population->errors[k] = UNMEASURED;
    if (population->parameters.warm_start && totals->best_error < OPTIMISER_FAILED) {
        memcpy(population->position, population->best_position,
               mf_population_coordinates(population) * sizeof *population->position);
        totals->warm = totals->evaluations > 0;
    }
    totals->best_error = OPTIMISER_FAILED;
    totals->rounds++;
}

void mf_population_reset_survey(struct population *population) {
    population->survey = (struct population_survey){.min = INFINITY};
}

struct evaluate_parameters mf_population_evaluate(const struct population *population) {
    struct evaluate_parameters evaluate = population->parameters.evaluate;
    evaluate.plan.samples *= population->totals.length;
    evaluate.precision /= sqrt((double)population->totals.length);
    return evaluate;
}

void mf_population_split(const struct population *population, double *position, double *column[3]) {
    const struct simulation_setup *scene = &population->parametrisation->unknowns.problem->scene;
    for (int d = 0; d < scene->box.dimensions; d++)
        column[d] = position + (size_t)d * (size_t)scene->placement.count;
}

enum status mf_population_simulate(const struct population *population, const double *variables,
                                   const struct population_task *task,
                                   struct evaluate_result *result) {
    struct unknowns_laws laws;
    double *begin_column[3] = {NULL}, *end_column[3] = {NULL};
    mf_population_split(population, population->position, begin_column);
    mf_population_split(population, task->end, end_column);
    enum status status = mf_parametrisation_laws(population->parametrisation, variables, &laws);
    const struct evaluate_candidate candidate = {
        .potential = laws.table[UNKNOWN_POTENTIAL],
        .omega = laws.table[UNKNOWN_OMEGA],
        .position = population->totals.warm ? (const double *const *)begin_column : NULL,
        .discard_above = task->discard_above,
        .threads = task->threads,
        .seed = task->seed,
    };
    if (status == STATUS_OK)
        status = mf_evaluate(&laws.problem, &candidate, task->parameters, task->features,
                             task->observed, end_column, result);
    if (status == STATUS_UNSTABLE || (status == STATUS_OK && !isfinite(result->error))) {
        result->error = OPTIMISER_FAILED;
        result->variance = 0;
        status = STATUS_OK;
    }
    mf_unknowns_laws_clear(&laws);
    return status;
}

/// Add one error to a survey.
static void add(struct population_survey *survey, double error) {
    survey->evaluations++;
    if (error >= OPTIMISER_FAILED)
        survey->failures++;
    else
        mf_statistics_add(&survey->alive, error);
    if (error < OPTIMISER_FAILED)
        survey->min = fmin(survey->min, error);
}

/// Tell what this iteration knows.
static void report(const struct population *population, size_t count,
                   const struct inverse_candidate *candidate, const struct inverse_listener *to) {
    struct population_survey survey = population->survey;
    for (size_t k = 0; k < count; k++)
        if (population->errors[k] != UNMEASURED)
            add(&survey, population->errors[k]);
    const bool single = count == 1 && population->singles > 0;
    const struct inverse_progress progress = {
        .iteration = population->iteration,
        .iterations = population->iterations,
        .done = survey.evaluations - (single ? 0 : population->survey.evaluations),
        .total = single ? population->singles : count,
        .best = population->best,
        .min = survey.min,
        .mean = survey.alive.count > 0 ? survey.alive.mean : NAN,
        .failures = survey.failures,
        .candidate = candidate,
    };
    to->report(to->context, &progress);
}

/// Take over a measurement. Called by one thread at a time, in any order.
static void take(struct population *population, size_t index, const struct evaluate_result *result,
                 const double *end) {
    struct population_totals *totals = &population->totals;
    population->errors[index] = result->error;
    population->variances[index] = result->variance;
    memcpy(population->distances + index * TARGETS, result->distance, sizeof result->distance);
    totals->evaluations++;
    totals->steps += result->engine_steps;
    mf_population_add_failure(&totals->failures, result);
    const bool better = result->error < totals->best_error ||
                        (result->error == totals->best_error && index < totals->best_index);
    if (!better || result->error >= OPTIMISER_FAILED)
        return;
    totals->best_error = result->error;
    totals->best_index = index;
    memcpy(population->best_position, end, mf_population_coordinates(population) * sizeof *end);
}

/// How many candidates of a round before one are the same.
static uint32_t copies_before(const struct optimiser_round *round, size_t variables, size_t index) {
    uint32_t copies = 0;
    for (size_t k = 0; k < index; k++)
        copies += memcmp(round->variables + k * variables, round->variables + index * variables,
                         variables * sizeof *round->variables) == 0;
    return copies;
}

static uint64_t seed_of(const struct population *population, size_t index) {
    return mf_rng_child_seed(population->parametrisation->unknowns.problem->seed, RNG_EVALUATION,
                             (uint32_t)population->totals.rounds, (uint32_t)index);
}

/// What a simulation of a candidate leaves.
struct measured {
    struct evaluate_result result;
    double end[]; ///< as population.position, and then values of g(r) if that is a target
};

static const struct target *rdf_of(const struct population *population) {
    return &population->parametrisation->unknowns.problem->targets.target[TARGET_RDF];
}

/// Candidates of a round that have not been measured yet, as before an interruption.
struct work {
    struct population *population;
    const struct optimiser_round *round;
    const struct inverse_listener *listener;
    struct evaluate_parameters parameters;
    double discard_above;
    int threads; ///< inside a simulation
    size_t count, index[POPULATION_MAX];
};

static enum status measure_one(void *context, size_t task, void *memory) {
    const struct work *work = context;
    const struct population *population = work->population;
    struct measured *measured = memory;
    const size_t index = work->index[task];
    CLEARED_BY(mf_measurement_values_clear) struct observed observed = {0};
    TRY(mf_measurement_values_init(&observed,
                                   &population->parametrisation->unknowns.problem->targets));
    const struct population_task one = {
        .parameters = &work->parameters,
        .seed = seed_of(population, index),
        .discard_above = work->discard_above,
        .threads = work->threads,
        .features = population->features + index * population->surrogate.features,
        .observed = &observed,
        .end = measured->end,
    };
    TRY(mf_population_simulate(
        population, work->round->variables + index * population->parametrisation->variables, &one,
        &measured->result));
    if (rdf_of(population)->count > 0)
        memcpy(measured->end + mf_population_coordinates(population), observed.value[TARGET_RDF],
               rdf_of(population)->count * sizeof(double));
    return STATUS_OK;
}

/// A candidate of a round, for who looks.
struct looked_at {
    const struct parametrisation *parametrisation;
    const double *variables;
};

static void make_curve(const void *context, enum unknown_kind kind, double *curve) {
    const struct looked_at *candidate = context;
    mf_parametrisation_curve(candidate->parametrisation, kind, candidate->variables, curve);
}

static void take_one(void *context, size_t task, const void *memory) {
    const struct work *work = context;
    const struct measured *measured = memory;
    const struct population *population = work->population;
    const struct evaluate_result *result = &measured->result;
    const size_t index = work->index[task], variables = population->parametrisation->variables;
    const struct looked_at looked_at = {population->parametrisation,
                                        work->round->variables + index * variables};
    const bool failed = result->error >= OPTIMISER_FAILED;
    const struct inverse_candidate candidate = {
        .number = index + 1,
        .error = failed ? NAN : result->error,
        .temperature = result->temperature,
        .rdf = rdf_of(population)->count > 0 && !failed
                   ? measured->end + mf_population_coordinates(population)
                   : NULL,
        .curve = make_curve,
        .context = &looked_at,
    };
    take(work->population, index, result, measured->end);
    report(population, work->round->count, &candidate, work->listener);
}

/// Besides its result a simulation leaves its candidate's features.
static size_t list_features(void *context, size_t task, struct memory_span *span) {
    const struct work *work = context;
    const size_t features = work->population->surrogate.features;
    *span = (struct memory_span){work->population->features + work->index[task] * features,
                                 features * sizeof *work->population->features};
    return 1;
}

int mf_population_threads_inside(const struct inverse_problem *problem) {
    enum { PARTICLES_PER_THREAD = 1000 };
    const int64_t max = problem->scene.placement.count / PARTICLES_PER_THREAD;
    if (max < 1)
        return 1;
    return max < problem->threads ? (int)max : problem->threads;
}

void mf_population_remember(struct population *population, const double *variables, double error,
                            const double *features) {
    if (error < OPTIMISER_FAILED)
        mf_surrogate_add(&population->surrogate, variables, features);
}

/// Keep a round to be written, but for copies, which are a challenger measured again.
static void show(struct population *population, const struct optimiser_round *round) {
    enum { MIN = 8 };
    const size_t bytes = population->parametrisation->variables * sizeof(double);
    size_t distinct = 0;
    for (size_t k = 0; k < round->count; k++)
        distinct += copies_before(round, population->parametrisation->variables, k) == 0;
    if (distinct < MIN)
        return;
    population->shown_count = 0;
    for (size_t k = 0; k < round->count; k++) {
        if (copies_before(round, population->parametrisation->variables, k) > 0)
            continue;
        memcpy((char *)population->shown + population->shown_count * bytes,
               (const char *)round->variables + k * bytes, bytes);
        population->shown_error[population->shown_count++] = population->errors[k];
    }
}

enum status mf_population_measure(struct population *population,
                                  const struct optimiser_round *round, double discard_above,
                                  const struct inverse_listener *listener) {
    const struct inverse_problem *problem = population->parametrisation->unknowns.problem;
    struct work work = {.population = population,
                        .round = round,
                        .listener = listener,
                        .parameters = mf_population_evaluate(population),
                        .discard_above = discard_above,
                        .threads = 1};
    if (round->count > POPULATION_MAX)
        return mf_status_fail(STATUS_BAD_INPUT, "a round of %zu candidates: at most %d",
                              round->count, POPULATION_MAX);
    TRY(mf_population_settle(population, round));
    if (round->count == 1)
        work.threads = mf_population_threads_inside(problem);
    memcpy(population->first, round->variables,
           population->parametrisation->variables * sizeof *round->variables);
    for (size_t k = 0; k < round->count; k++)
        if (population->errors[k] == UNMEASURED)
            work.index[work.count++] = k;
    TRY(mf_parallel_try(&(struct parallel_tasks){
        .count = work.count,
        .threads = problem->threads,
        .run = measure_one,
        .take = take_one,
        .result_size =
            sizeof(struct measured) +
            (mf_population_coordinates(population) + rdf_of(population)->count) * sizeof(double),
        .context = &work,
        .spans = list_features}));
    for (size_t k = 0; k < round->count; k++) {
        add(&population->survey, population->errors[k]);
        mf_population_remember(
            population, round->variables + k * population->parametrisation->variables,
            population->errors[k], population->features + k * population->surrogate.features);
    }
    show(population, round);
    return STATUS_OK;
}

size_t mf_population_spans(struct population *population, struct memory_span *span) {
    const size_t positions = mf_population_coordinates(population) * sizeof(double);
    const size_t errors = POPULATION_MAX * sizeof(double);
    size_t n = 0;
    span[n++] = (struct memory_span){&population->survey, sizeof population->survey};
    span[n++] = (struct memory_span){&population->totals, sizeof population->totals};
    span[n++] = (struct memory_span){population->errors, errors};
    span[n++] = (struct memory_span){population->variances, errors};
    span[n++] = (struct memory_span){population->distances,
                                     POPULATION_MAX * TARGETS * sizeof *population->distances};
    span[n++] = (struct memory_span){population->position, positions};
    span[n++] = (struct memory_span){population->best_position, positions};
    span[n++] = (struct memory_span){population->first,
                                     population->parametrisation->variables * sizeof(double)};
    span[n++] = (struct memory_span){
        population->features, POPULATION_MAX * population->surrogate.features * sizeof(double)};
    span[n++] = (struct memory_span){population->shown, POPULATION_MAX *
                                                            population->parametrisation->variables *
                                                            sizeof(double)};
    span[n++] = (struct memory_span){population->shown_error, errors};
    span[n++] = (struct memory_span){&population->shown_count, sizeof population->shown_count};
    n += mf_surrogate_spans(&population->surrogate, span + n);
    return n;
}
