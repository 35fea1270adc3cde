// SPDX-License-Identifier: GPL-3.0-or-later
//
// Matching by evolution: genes → Bézier curve → potential → simulation → g(r) → distance.
// A. G. Baydin (thesis on DPD coarse-graining by evolutionary optimisation, 2008).
#include "inverse/inverse.h"

#include "base/memory.h"
#include "base/rng.h"
#include "base/statistics.h"
#include "curves/bezier.h"
#include "inverse/evaluate.h"
#include "inverse/potential_grid.h"
#include "optimise/genetic.h"

#include <assert.h>
#include <math.h>
#include <string.h>

/// An error that has not been measured yet.
#define UNMEASURED (-1.0)

struct parameters {
    struct genetic_parameters genetic;
    struct evaluate_parameters evaluate; ///< of one individual
};

struct state {
    struct parameters parameters;
    const struct inverse_problem *problem;
    struct potential_grid grid;
    double *place; ///< shape [points]: position of each grid point on the Bézier curve, 0 to 1
    struct genetic genetic;
    double *errors; ///< shape [population]; UNMEASURED while the generation is under way
    double *phi;    ///< of the elite, shape [points]
    struct progress {
        uint64_t evaluations, steps;
        double noise; ///< of the elite's measurement
    } progress;
};

#define MEMBER(name) .offset = offsetof(struct parameters, name)
static const struct field own_fields[] = {
    {"genes", FIELD_INTEGER, MEMBER(genetic.genes), .initial = 100, .minimum = 1, .maximum = 1000,
     .unit = "", .help = "control points of the Bezier curve"},
    {"gene_minimum", FIELD_NUMBER, MEMBER(genetic.gene_minimum), .initial = 0, .minimum = -DBL_MAX,
     .maximum = DBL_MAX, .unit = "k_B T_0", .help = "least gene"},
    {"gene_maximum", FIELD_NUMBER, MEMBER(genetic.gene_maximum), .initial = 6.5,
     .minimum = -DBL_MAX, .maximum = DBL_MAX, .unit = "k_B T_0", .help = "largest gene"},
    {"equilibration", FIELD_INTEGER, MEMBER(evaluate.plan.equilibration), .initial = 350,
     .minimum = 10, .maximum = 1e9, .unit = "steps", .help = "of an individual's simulation"},
    {"samples", FIELD_INTEGER, MEMBER(evaluate.plan.samples), .initial = 45, .minimum = 1,
     .maximum = 1e8, .unit = "", .help = "of its g(r)"},
    {"every", FIELD_INTEGER, MEMBER(evaluate.plan.every), .initial = 50, .minimum = 1,
     .maximum = 1e9, .unit = "steps", .help = "between samples"},
    {"temperature_tolerance", FIELD_NUMBER, MEMBER(evaluate.temperature_tolerance), .initial = 0.1,
     .minimum = FIELD_ABOVE_ZERO, .maximum = 1, .unit = "",
     .help = "relative deviation at the end of equilibration with which an individual fails"},
    {"estimator", FIELD_CHOICE, MEMBER(evaluate.estimator), .choices = rdf_force_estimators,
     .initial = RDF_FORCE_NOT_USED, .unit = "",
     .help = "of g(r): force is worth twice the samples, but a large time step puts it off"},
    FIELD_END,
};

// The optimiser's fields are offsets into a struct of its own at the beginning of ours.
static_assert(offsetof(struct parameters, genetic) == 0, "genetic_fields need it first");

static const char *const columns[] = {"best[1]", "mean[1]", "diversity[1]", "failures", NULL};

static uint32_t most_iterations(const void *parameters) {
    return (uint32_t)((const struct parameters *)parameters)->genetic.generations;
}

static struct inverse_sampling sampling(const void *parameters) {
    const struct evaluate_parameters *evaluate = &((const struct parameters *)parameters)->evaluate;
    return (struct inverse_sampling){evaluate->plan.every, evaluate->estimator == RDF_FORCE_USED};
}

static int64_t population(const struct state *state) {
    return state->parameters.genetic.population;
}

static void destroy(void *memory) {
    struct state *state = memory;
    potential_grid_clear(&state->grid);
    genetic_clear(&state->genetic);
    memory_free(state->place);
    memory_free(state->errors);
    memory_free(state->phi);
}

static void forget_errors(struct state *state) {
    for (int64_t k = 0; k < population(state); k++)
        state->errors[k] = UNMEASURED;
}

static enum status create(void *memory, const struct inverse_problem *problem,
                          const void *parameters) {
    enum status status = STATUS_OK;
    struct state *state = memory;
    state->parameters = *(const struct parameters *)parameters;
    state->problem = problem;
    CHECK(potential_grid_init(&state->grid, problem));
    const struct potential_grid *grid = &state->grid;
    NEW_ARRAY(state->place, grid->points);
    NEW_ARRAY(state->phi, grid->points);
    NEW_ARRAY(state->errors, (size_t)population(state));
    CHECK(genetic_init(&state->genetic, &state->parameters.genetic, problem->seed));
    const double begin = grid->r[grid->core], end = grid->r[grid->points - 1];
    for (size_t k = grid->core; k < grid->points; k++)
        state->place[k] = (grid->r[k] - begin) / (end - begin);
    forget_errors(state);
done:
    return status;
}

/// Potential of some genes on the grid.
static enum status decode(const struct state *state, const double *genes, double *phi) {
    const struct potential_grid *grid = &state->grid;
    TRY(bezier_values(genes, (size_t)state->parameters.genetic.genes, state->place + grid->core,
                      phi + grid->core, grid->points - grid->core));
    potential_grid_complete(grid, phi);
    return STATUS_OK;
}

/// Measure some genes by simulation number (generation, individual). A failed simulation is the
/// worst error, not a failure.
static enum status measure(const struct state *state, const double *genes, uint32_t individual,
                           struct evaluate_result *result) {
    enum status status = STATUS_OK;
    struct table table = {0};
    double *phi = NULL;
    const uint64_t seed =
        rng_child_seed(state->problem->seed, RNG_EVALUATION, state->genetic.generation, individual);
    NEW_ARRAY(phi, state->grid.points);
    CHECK(decode(state, genes, phi));
    CHECK(potential_grid_table(&state->grid, phi, &table));
    status = evaluate_potential(state->problem, &table, &state->parameters.evaluate, seed, result);
    if (status == STATUS_UNSTABLE) {
        result->error = GENETIC_FAILED;
        status = STATUS_OK;
    }
done:
    memory_free(phi);
    table_clear(&table);
    return status;
}

/// Best and mean error of what is measured so far, NaN without any, and how many failed.
static void survey(const struct state *state, double *best, double *mean, uint64_t *failures) {
    struct running_mean alive = {0};
    *best = GENETIC_FAILED;
    *failures = 0;
    for (int64_t k = 0; k < population(state); k++) {
        const double error = state->errors[k];
        if (error >= GENETIC_FAILED)
            (*failures)++;
        else if (error != UNMEASURED)
            statistics_add(&alive, error);
        if (error != UNMEASURED)
            *best = fmin(*best, error);
    }
    *mean = alive.count > 0 ? alive.mean : NAN;
    if (alive.count == 0)
        *best = NAN;
}

static void report(const struct state *state, uint64_t done, const struct inverse_listener *to) {
    struct inverse_progress progress = {
        .iteration = state->genetic.generation,
        .iterations = (uint32_t)state->parameters.genetic.generations,
        .done = done,
        .total = (uint64_t)population(state),
    };
    survey(state, &progress.best, &progress.mean, &progress.failures);
    to->tell(to->context, &progress);
}

/// Measure whoever has no error yet, in parallel. Individuals differ in cost: dynamic schedule.
static enum status measure_generation(struct state *state,
                                      const struct inverse_listener *listener) {
    enum status status = STATUS_OK;
    char reason[512] = "";
    uint64_t done = 0;
    for (int64_t k = 0; k < population(state); k++)
        done += state->errors[k] != UNMEASURED;
#pragma omp parallel for schedule(dynamic) num_threads(state->problem->threads)
    for (int64_t k = 0; k < population(state); k++) {
        struct evaluate_result result;
        if (state->errors[k] != UNMEASURED)
            continue;
        const enum status here =
            measure(state, genetic_individual(&state->genetic, k), (uint32_t)k, &result);
#pragma omp critical
        {
            if (here != STATUS_OK) {
                status = here;
                snprintf(reason, sizeof reason, "%s", status_message());
            } else {
                state->errors[k] = result.error;
                state->progress.evaluations++;
                state->progress.steps += result.engine_steps;
                report(state, ++done, listener);
            }
        }
    }
    return status == STATUS_OK ? STATUS_OK : status_fail(status, "%s", reason);
}

enum { MAX_REMEASUREMENTS = 1000 };

/// Mean of fresh measurements of a challenger.
static enum status remeasure(struct state *state, int64_t challenger, double *error,
                             double *noise) {
    const double *genes = genetic_individual(&state->genetic, challenger);
    const int64_t count = state->parameters.genetic.remeasurements;
    struct evaluate_result results[MAX_REMEASUREMENTS];
    enum status status = STATUS_OK;
#pragma omp parallel for schedule(dynamic) num_threads(state->problem->threads)
    for (int64_t k = 0; k < count; k++) {
        const enum status here =
            measure(state, genes, (uint32_t)(population(state) + k), &results[k]);
        if (here != STATUS_OK)
#pragma omp critical
            status = here;
    }
    if (status != STATUS_OK)
        return status_fail(status, status == STATUS_INTERRUPTED ? "interrupted" : "out of memory");
    *error = *noise = 0;
    for (int64_t k = 0; k < count; k++) {
        *error += results[k].error / (double)count;
        *noise += results[k].noise / (double)count;
        state->progress.evaluations++;
        state->progress.steps += results[k].engine_steps;
    }
    return STATUS_OK;
}

/// The best of this generation, the elite's own place left out.
static int64_t best_challenger(const struct state *state) {
    const int64_t first = state->genetic.elite_measured > 0 ? 1 : 0;
    int64_t best = first;
    for (int64_t k = first; k < population(state); k++)
        if (state->errors[k] < state->errors[best])
            best = k;
    return best;
}

static enum status iterate(void *memory, struct inverse_step *step,
                           const struct inverse_listener *listener) {
    struct state *state = memory;
    struct genetic *genetic = &state->genetic;
    TRY(measure_generation(state, listener));
    *step = (struct inverse_step){.iteration = genetic->generation};
    uint64_t failures;
    survey(state, &step->extra[0], &step->extra[1], &failures);
    step->extra[2] = genetic_diversity(genetic);
    step->extra[3] = (double)failures;
    const int64_t challenger = best_challenger(state);
    double error = GENETIC_FAILED, noise = 0;
    // Nothing of the state changes before the last thing that can be interrupted.
    if (state->errors[challenger] < genetic->elite_error)
        TRY(remeasure(state, challenger, &error, &noise));
    if (genetic->elite_measured > 0)
        genetic_remeasure_elite(genetic, state->errors[0]);
    if (genetic_offer(genetic, genetic_individual(genetic, challenger), error,
                      (double)state->parameters.genetic.remeasurements))
        state->progress.noise = noise;
    TRY(decode(state, genetic->elite_measured > 0 ? genetic->elite : genetic->population,
               state->phi));
    step->evaluations = state->progress.evaluations;
    step->engine_steps = state->progress.steps;
    step->error = genetic->elite_measured > 0 ? genetic->elite_error : NAN;
    step->noise = state->progress.noise;
    step->phi = state->phi;
    step->finished = step->iteration + 1 >= (uint32_t)state->parameters.genetic.generations;
    step->converged = step->finished && genetic->elite_measured > 0;
    genetic_next_generation(genetic, state->errors);
    forget_errors(state);
    return STATUS_OK;
}

static size_t spans(void *memory, struct memory_span *span) {
    struct state *state = memory;
    struct genetic *genetic = &state->genetic;
    const size_t individuals = (size_t)population(state);
    const size_t genes = (size_t)state->parameters.genetic.genes;
    size_t n = 0;
    span[n++] = (struct memory_span){&state->progress, sizeof state->progress};
    span[n++] = (struct memory_span){state->errors, individuals * sizeof(double)};
    span[n++] = (struct memory_span){&genetic->generation, sizeof genetic->generation};
    span[n++] = (struct memory_span){genetic->population, individuals * genes * sizeof(double)};
    span[n++] = (struct memory_span){genetic->elite, genes * sizeof(double)};
    span[n++] = (struct memory_span){&genetic->elite_error, sizeof genetic->elite_error};
    span[n++] = (struct memory_span){&genetic->elite_measured, sizeof genetic->elite_measured};
    return n;
}

const struct inverse_method matching = {
    .name = "genetic",
    .summary = "genetic algorithm over Bezier-smoothed spline random walks; A. G. Baydin (2008)",
    .tables = (const struct field *const[]){genetic_fields, own_fields, NULL},
    .parameters_size = sizeof(struct parameters),
    .state_size = sizeof(struct state),
    .most_iterations = most_iterations,
    .sampling = sampling,
    .keeps_parts = true,
    .columns = columns,
    .create = create,
    .destroy = destroy,
    .iterate = iterate,
    .spans = spans,
};
