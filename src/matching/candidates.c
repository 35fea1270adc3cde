// SPDX-License-Identifier: GPL-3.0-or-later
#include "matching/candidates.h"

#include "base/memory.h"
#include "base/rng.h"

#include <math.h>
#include <string.h>

/// An error that has not been measured yet.
#define UNMEASURED (-1.0)

const char *const mf_candidates_no_or_yes[] = {"no", "yes", NULL};

#define MEMBER(name) .offset = offsetof(struct candidates_settings, name)
const struct field mf_candidates_fields[] = {
    {"equilibration", FIELD_INTEGER, MEMBER(candidates.evaluate.plan.equilibration), .initial = 350,
     .minimum = 10, .maximum = 1e9, .unit = "steps", .help = "of a candidate's simulation"},
    {"samples", FIELD_INTEGER, MEMBER(candidates.evaluate.plan.samples), .initial = 45,
     .minimum = 1, .maximum = 1e8, .unit = "",
     .help = "of its g(r) and pressure; times \"every\" it is as long as all else is measured"},
    {"every", FIELD_INTEGER, MEMBER(candidates.evaluate.plan.every), .initial = 50, .minimum = 1,
     .maximum = 1e9, .unit = "steps", .help = "between samples"},
    {"temperature_tolerance", FIELD_NUMBER, MEMBER(candidates.evaluate.temperature_tolerance),
     .initial = 0.1, .minimum = FIELD_ABOVE_ZERO, .maximum = 1, .unit = "",
     .help = "relative deviation at the end of equilibration with which a candidate fails"},
    {"estimator", FIELD_CHOICE, MEMBER(candidates.evaluate.estimator),
     .choices = mf_rdf_force_estimators, .initial = RDF_FORCE_NOT_USED, .unit = "",
     .help = "of g(r): force is worth twice the samples, but a large time step puts it off"},
    {"racing", FIELD_NUMBER, MEMBER(candidates.evaluate.patience), .initial = 0, .minimum = 0,
     .maximum = 100, .unit = "standard errors",
     .help = "by which a running error must be hopeless for its simulation to stop; 0: never"},
    {"precision", FIELD_NUMBER, MEMBER(candidates.evaluate.precision), .initial = 0, .minimum = 0,
     .maximum = 1, .unit = "",
     .help = "relative standard error of an error with which its simulation stops; 0: never"},
    {"warm_start", FIELD_CHOICE, MEMBER(candidates.warm_start), .choices = mf_candidates_no_or_yes,
     .initial = 0, .unit = "", .help = "begin where the best simulation of the last round ended"},
    {"common_noise", FIELD_CHOICE, MEMBER(candidates.common_noise),
     .choices = mf_candidates_no_or_yes, .initial = 0, .unit = "",
     .help = "the same random numbers for all candidates of a round"},
    FIELD_END,
};

struct inverse_sampling mf_candidates_sampling(const void *settings) {
    const struct evaluate_parameters *evaluate =
        &((const struct candidates_settings *)settings)->candidates.evaluate;
    return (struct inverse_sampling){.every = evaluate->plan.every,
                                     .rdf_force = evaluate->estimator == RDF_FORCE_USED,
                                     .samples = evaluate->plan.samples};
}

static size_t coordinates(const struct candidates *candidates) {
    const struct simulation_setup *scene = &candidates->decoder->problem->scene;
    return (size_t)scene->box.dimensions * (size_t)scene->placement.count;
}

enum status mf_candidates_init(struct candidates *candidates, const struct decoder *decoder,
                               const struct candidates_parameters *parameters) {
    enum status status = STATUS_OK;
    *candidates = (struct candidates){.decoder = decoder, .parameters = *parameters, .best = NAN};
    NEW_ARRAY(candidates->errors, CANDIDATES_MOST);
    NEW_ARRAY(candidates->variances, CANDIDATES_MOST);
    NEW_ARRAY(candidates->distances, CANDIDATES_MOST * TARGETS);
    NEW_ARRAY(candidates->first, decoder->genes);
    const struct targets *targets = &decoder->problem->targets;
    const size_t features = mf_targets_features(targets);
    NEW_ARRAY(candidates->features, CANDIDATES_MOST * features);
    NEW_ARRAY(candidates->target, features);
    NEW_ARRAY(candidates->target_error, features);
    mf_targets_take_features(targets, NULL, candidates->target, candidates->target_error);
    CHECK(mf_surrogate_init(&candidates->surrogate, decoder->genes, features, CANDIDATES_MOST,
                            candidates->target, candidates->target_error));
    NEW_ARRAY(candidates->position, coordinates(candidates));
    NEW_ARRAY(candidates->best_position, coordinates(candidates));
    mf_candidates_next_round(candidates);
    mf_candidates_forget_survey(candidates);
    candidates->totals.rounds = 0;
done:
    return status;
}

void mf_candidates_clear(struct candidates *candidates) {
    mf_memory_free(candidates->errors);
    mf_memory_free(candidates->variances);
    mf_memory_free(candidates->distances);
    mf_memory_free(candidates->first);
    mf_memory_free(candidates->features);
    mf_memory_free(candidates->target);
    mf_memory_free(candidates->target_error);
    mf_surrogate_clear(&candidates->surrogate);
    mf_memory_free(candidates->position);
    mf_memory_free(candidates->best_position);
    *candidates = (struct candidates){0};
}

void mf_candidates_next_round(struct candidates *candidates) {
    struct candidates_totals *totals = &candidates->totals;
    for (size_t k = 0; k < CANDIDATES_MOST; k++)
        candidates->errors[k] = UNMEASURED;
    if (candidates->parameters.warm_start && totals->best_error < OPTIMISER_FAILED) {
        memcpy(candidates->position, candidates->best_position,
               coordinates(candidates) * sizeof *candidates->position);
        totals->warm = totals->evaluations > 0;
    }
    totals->best_error = OPTIMISER_FAILED;
    totals->rounds++;
}

void mf_candidates_forget_survey(struct candidates *candidates) {
    candidates->survey = (struct candidates_survey){.least = INFINITY};
}

void mf_candidates_tell_failure(const struct candidates *candidates, const char *why,
                                char reason[INVERSE_REASON_SIZE]) {
    if (candidates->surrogate.rows.added > 0)
        snprintf(reason, INVERSE_REASON_SIZE, "%llu of %llu simulations succeeded, %s",
                 (unsigned long long)candidates->surrogate.rows.added,
                 (unsigned long long)candidates->totals.evaluations, why);
}

/// Columns of positions, one a dimension.
static void split(const struct candidates *candidates, double *position, double *column[3]) {
    const struct simulation_setup *scene = &candidates->decoder->problem->scene;
    for (int d = 0; d < scene->box.dimensions; d++)
        column[d] = position + (size_t)d * (size_t)scene->placement.count;
}

/// One simulation of some genes. A failed one has the worst error.
static enum status measure(const struct candidates *candidates, const double *genes, uint64_t seed,
                           double hopeless, int threads, double *features, double *end,
                           struct evaluate_result *result) {
    struct decoder_laws laws;
    double *begin_column[3] = {NULL}, *end_column[3] = {NULL};
    split(candidates, candidates->position, begin_column);
    split(candidates, end, end_column);
    enum status status = mf_decoder_laws(candidates->decoder, genes, &laws);
    const struct evaluate_candidate candidate = {
        .potential = laws.table[UNKNOWN_POTENTIAL],
        .weight = laws.table[UNKNOWN_WEIGHT],
        .position = candidates->totals.warm ? (const double *const *)begin_column : NULL,
        .hopeless = hopeless,
        .threads = threads,
        .seed = seed,
    };
    if (status == STATUS_OK)
        status = mf_evaluate(candidates->decoder->problem, &candidate,
                             &candidates->parameters.evaluate, features, end_column, result);
    if (status == STATUS_UNSTABLE || (status == STATUS_OK && !isfinite(result->error))) {
        result->error = OPTIMISER_FAILED;
        result->variance = 0;
        status = STATUS_OK;
    }
    mf_decoder_laws_clear(&laws);
    return status;
}

/// Add one error to a survey.
static void add(struct candidates_survey *survey, double error) {
    survey->evaluations++;
    if (error >= OPTIMISER_FAILED)
        survey->failures++;
    else
        mf_statistics_add(&survey->alive, error);
    if (error < OPTIMISER_FAILED)
        survey->least = fmin(survey->least, error);
}

static void report(const struct candidates *candidates, size_t count,
                   const struct inverse_listener *to) {
    struct candidates_survey survey = candidates->survey;
    for (size_t k = 0; k < count; k++)
        if (candidates->errors[k] != UNMEASURED)
            add(&survey, candidates->errors[k]);
    const struct inverse_progress progress = {
        .iteration = candidates->iteration,
        .iterations = candidates->iterations,
        .done = survey.evaluations - candidates->survey.evaluations,
        .total = count,
        .best = candidates->best,
        .least = survey.least,
        .mean = survey.alive.count > 0 ? survey.alive.mean : NAN,
        .failures = survey.failures,
    };
    to->tell(to->context, &progress);
}

/// Take over a measurement. Called by one thread at a time, in any order.
static void take(struct candidates *candidates, size_t index, const struct evaluate_result *result,
                 const double *end) {
    struct candidates_totals *totals = &candidates->totals;
    candidates->errors[index] = result->error;
    candidates->variances[index] = result->variance;
    memcpy(candidates->distances + index * TARGETS, result->distance, sizeof result->distance);
    totals->evaluations++;
    totals->steps += result->engine_steps;
    const bool better = result->error < totals->best_error ||
                        (result->error == totals->best_error && index < totals->best_index);
    if (!better || result->error >= OPTIMISER_FAILED)
        return;
    totals->best_error = result->error;
    totals->best_index = index;
    memcpy(candidates->best_position, end, coordinates(candidates) * sizeof *end);
}

/// Equal candidates of a round are measurements of their own, also with common noise.
static uint32_t copies_before(const struct optimiser_round *round, size_t genes, size_t index) {
    uint32_t copies = 0;
    for (size_t k = 0; k < index; k++)
        copies += memcmp(round->genes + k * genes, round->genes + index * genes,
                         genes * sizeof *round->genes) == 0;
    return copies;
}

static uint64_t seed_of(const struct candidates *candidates, const struct optimiser_round *round,
                        size_t index) {
    const uint32_t number = candidates->parameters.common_noise
                                ? copies_before(round, candidates->decoder->genes, index)
                                : (uint32_t)index;
    return mf_rng_child_seed(candidates->decoder->problem->seed, RNG_EVALUATION,
                             (uint32_t)candidates->totals.rounds, number);
}

/// Measure one candidate unless it was measured before an interruption.
static enum status measure_one(struct candidates *candidates, const struct optimiser_round *round,
                               size_t index, double hopeless, int threads,
                               const struct inverse_listener *listener) {
    enum status status = STATUS_OK;
    struct evaluate_result result;
    double *end = NULL;
    if (candidates->errors[index] != UNMEASURED)
        return STATUS_OK;
    NEW_ARRAY(end, coordinates(candidates));
    CHECK(measure(candidates, round->genes + index * candidates->decoder->genes,
                  seed_of(candidates, round, index), hopeless, threads,
                  candidates->features + index * candidates->surrogate.features, end, &result));
#pragma omp critical
    {
        take(candidates, index, &result, end);
        report(candidates, round->count, listener);
    }
done:
    mf_memory_free(end);
    return status;
}

/// Threads for the simulation of a candidate alone. Particles too few to share are done before the
/// threads have met.
static int threads_inside(const struct inverse_problem *problem) {
    enum { PARTICLES_PER_THREAD = 1000 };
    const int64_t most = problem->scene.placement.count / PARTICLES_PER_THREAD;
    if (most < 1)
        return 1;
    return most < problem->threads ? (int)most : problem->threads;
}

/// What blew up has no features.
static void remember(struct candidates *candidates, const double *genes, double error,
                     const double *features) {
    if (error < OPTIMISER_FAILED)
        mf_surrogate_add(&candidates->surrogate, genes, features);
}

enum status mf_candidates_measure(struct candidates *candidates,
                                  const struct optimiser_round *round, double hopeless,
                                  const struct inverse_listener *listener) {
    enum status status = STATUS_OK;
    char reason[512] = "";
    const int threads = candidates->decoder->problem->threads;
    if (round->count > CANDIDATES_MOST)
        return mf_status_fail(STATUS_BAD_INPUT, "a round of %zu candidates: at most %d",
                              round->count, CANDIDATES_MOST);
    const int inside = round->count == 1 ? threads_inside(candidates->decoder->problem) : 1;
    memcpy(candidates->first, round->genes, candidates->decoder->genes * sizeof *round->genes);
#pragma omp parallel for schedule(dynamic) num_threads(threads) if (round->count > 1)
    for (size_t k = 0; k < round->count; k++) {
        const enum status here = measure_one(candidates, round, k, hopeless, inside, listener);
        if (here != STATUS_OK)
#pragma omp critical
        {
            status = here;
            snprintf(reason, sizeof reason, "%s", mf_status_message());
        }
    }
    if (status != STATUS_OK)
        return mf_status_fail(status, "%s", reason);
    for (size_t k = 0; k < round->count; k++) {
        add(&candidates->survey, candidates->errors[k]);
        remember(candidates, round->genes + k * candidates->decoder->genes, candidates->errors[k],
                 candidates->features + k * candidates->surrogate.features);
    }
    return STATUS_OK;
}

static struct target_distance mean_distance(const struct evaluate_result *results, size_t count,
                                            enum target_kind kind) {
    struct target_distance mean = {.count = results[0].distance[kind].count};
    for (size_t k = 0; k < count; k++) {
        mean.rms += results[k].distance[kind].rms / (double)count;
        mean.noise += results[k].distance[kind].noise / (double)count;
    }
    return mean;
}

enum status mf_candidates_remeasure(struct candidates *candidates, const double *genes,
                                    size_t count, double *error, double *noise, double *variance,
                                    struct target_distance *distance) {
    enum status status = STATUS_OK;
    struct evaluate_result *results = NULL;
    double *end = NULL, *features = NULL;
    const size_t size = coordinates(candidates), each = candidates->surrogate.features;
    const struct inverse_problem *problem = candidates->decoder->problem;
    char reason[512] = "";
    NEW_ARRAY(results, count);
    NEW_ARRAY(end, count * size);
    NEW_ARRAY(features, count * each);
#pragma omp parallel for schedule(dynamic) num_threads(problem->threads)
    for (size_t k = 0; k < count; k++) {
        const uint64_t seed = mf_rng_child_seed(
            problem->seed, RNG_REMEASUREMENT, (uint32_t)candidates->totals.remeasured, (uint32_t)k);
        const enum status here = measure(candidates, genes, seed, HUGE_VAL, 1, features + k * each,
                                         end + k * size, &results[k]);
        if (here != STATUS_OK)
#pragma omp critical
        {
            status = here;
            snprintf(reason, sizeof reason, "%s", mf_status_message());
        }
    }
    if (status != STATUS_OK) {
        mf_status_fail(status, "%s", reason);
        goto done;
    }
    candidates->totals.remeasured++;
    *error = *noise = *variance = 0;
    for (int kind = 0; kind < TARGETS && distance; kind++)
        distance[kind] = mean_distance(results, count, kind);
    for (size_t k = 0; k < count; k++) {
        *error += results[k].error / (double)count;
        *noise += results[k].noise / (double)count;
        *variance += results[k].variance / (double)(count * count);
        remember(candidates, genes, results[k].error, features + k * each);
        candidates->totals.evaluations++;
        candidates->totals.steps += results[k].engine_steps;
        if (results[k].error >= OPTIMISER_FAILED)
            *error = OPTIMISER_FAILED * (double)count;
    }
done:
    mf_memory_free(results);
    mf_memory_free(end);
    mf_memory_free(features);
    return status;
}

size_t mf_candidates_spans(struct candidates *candidates, struct memory_span *span) {
    const size_t positions = coordinates(candidates) * sizeof(double);
    const size_t errors = CANDIDATES_MOST * sizeof(double);
    size_t n = 0;
    span[n++] = (struct memory_span){&candidates->survey, sizeof candidates->survey};
    span[n++] = (struct memory_span){&candidates->totals, sizeof candidates->totals};
    span[n++] = (struct memory_span){candidates->errors, errors};
    span[n++] = (struct memory_span){candidates->variances, errors};
    span[n++] = (struct memory_span){candidates->distances,
                                     CANDIDATES_MOST * TARGETS * sizeof *candidates->distances};
    span[n++] = (struct memory_span){candidates->position, positions};
    span[n++] = (struct memory_span){candidates->best_position, positions};
    span[n++] =
        (struct memory_span){candidates->first, candidates->decoder->genes * sizeof(double)};
    span[n++] = (struct memory_span){
        candidates->features, CANDIDATES_MOST * candidates->surrogate.features * sizeof(double)};
    n += mf_surrogate_spans(&candidates->surrogate, span + n);
    return n;
}
