// SPDX-License-Identifier: GPL-3.0-or-later
//
// Several targets without weights: NSGA-II (optimise/nsga2.h) on the distance from each. What comes
// of it is a front, on which one target is only met better if another is met worse; the weighted
// error of the targets chooses from it.
#include "pareto_state.h"

#include "base/memory.h"
#include "matching/matchings.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#define OWN(name) .offset = offsetof(struct pareto_parameters, name)
static const struct field own_fields[] = {
    {"checks", FIELD_INTEGER, OWN(checks), .initial = 2, .minimum = 1, .maximum = POPULATION_MAX,
     .unit = "", .help = "repeated measurements of the chosen one"},
    {"surrogate", FIELD_INTEGER, OWN(surrogate), .initial = 4, .minimum = 0,
     .maximum = NSGA2_INJECTED, .unit = "",
     .help = "children of a generation from linear models of the simulations"},
    FIELD_END,
};

static_assert(offsetof(struct pareto_parameters, population) == 0, "the first, says population.h");

static const char *const columns[] = {"least[1]", "mean[1]", "diversity[1]", "failures", NULL};

/// How far the linear model may go from the chosen, as a part of a variable's range: the first
/// child so far, each of the others half as far as the one before.
static const double reach = 0.3;

static void destroy(void *memory) {
    struct pareto_state *state = memory;
    mf_nsga2_clear(&state->nsga2);
    mf_population_clear(&state->population);
    mf_parametrisation_clear(&state->parametrisation);
    mf_memory_free(state->value);
    mf_memory_free(state->log);
    mf_parametrisation_curves_clear(&state->curves);
}

size_t mf_pareto_log_width(const struct pareto_state *state) {
    return LOG_OBJECTIVES + state->objectives;
}

/// Every measurement and every front: at most twice the population in a round, and once.
static size_t log_rows(const struct pareto_state *state) {
    return 3 * state->nsga2.population * (size_t)state->own.nsga2.generations;
}

static enum status create_nsga2(struct pareto_state *state) {
    OWNED double *start = NULL;
    TRY_ARRAY(start, state->parametrisation.variables);
    TRY(mf_parametrisation_start(&state->parametrisation, start));
    const struct nsga2_space space = {.genes = state->parametrisation.variables,
                                      .objectives = state->objectives,
                                      .start = start,
                                      .seed = state->problem->seed};
    return mf_nsga2_init(&state->nsga2, &state->own.nsga2, &space);
}

static enum status create(void *memory, const struct inverse_method *method,
                          const struct inverse_problem *problem, const void *parameters) {
    struct pareto_state *state = memory;
    state->own = *(const struct pareto_parameters *)parameters;
    state->problem = problem;
    for (int kind = 0; kind < TARGETS; kind++)
        if (targets_ask(&problem->targets, kind))
            state->target[state->objectives++] = kind;
    if (state->objectives < 2)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "method.name: \"%s\" needs two fitted targets at least",
                              method->name);
    TRY(mf_parametrisation_init(&state->parametrisation, problem));
    TRY(create_nsga2(state));
    TRY_ARRAY(state->value, POPULATION_MAX * state->objectives);
    TRY_ARRAY(state->log, log_rows(state) * mf_pareto_log_width(state));
    TRY(mf_parametrisation_curves_init(&state->parametrisation, &state->curves));
    TRY(mf_population_init(&state->population, &state->parametrisation, &state->own.population));
    state->population.iterations =
        (uint32_t)((const struct pareto_parameters *)parameters)->nsga2.generations;
    state->progress.min = OPTIMISER_FAILED;
    return STATUS_OK;
}

double mf_pareto_error(const struct pareto_state *state, const double *value) {
    struct target_distance distance[TARGETS] = {0};
    for (size_t m = 0; m < state->objectives; m++) {
        if (value[m] >= OPTIMISER_FAILED)
            return OPTIMISER_FAILED;
        distance[state->target[m]].rms = value[m];
    }
    return mf_targets_error(&state->problem->targets, distance);
}

/// Distances of a measurement as a row of objectives.
static void take_distances(const struct pareto_state *state, double error,
                           const struct target_distance distance[TARGETS], double *value) {
    for (size_t m = 0; m < state->objectives; m++)
        value[m] = error < OPTIMISER_FAILED ? distance[state->target[m]].rms : OPTIMISER_FAILED;
}

const double *mf_pareto_value(const struct pareto_state *state, size_t parent) {
    return state->nsga2.value + parent * state->objectives;
}

bool mf_pareto_is_member(const struct pareto_state *state, size_t parent) {
    return state->nsga2.rank[parent] == 1 && mf_pareto_value(state, parent)[0] < OPTIMISER_FAILED;
}

static void add_to_log(struct pareto_state *state, enum pareto_log_kind kind, const double *value) {
    double *row = state->log + state->progress.rows * mf_pareto_log_width(state);
    const double error = mf_pareto_error(state, value);
    if (error >= OPTIMISER_FAILED || state->progress.rows >= log_rows(state))
        return;
    row[LOG_ITERATION] = state->progress.iteration;
    row[LOG_KIND] = kind;
    row[LOG_ERROR] = error;
    memcpy(row + LOG_OBJECTIVES, value, state->objectives * sizeof *row);
    state->progress.rows++;
}

static enum status take_round(struct pareto_state *state, const struct inverse_listener *listener) {
    const struct optimiser_round round = mf_nsga2_ask(&state->nsga2);
    struct population *population = &state->population;
    TRY(mf_population_measure(population, &round, HUGE_VAL, listener));
    for (size_t k = 0; k < round.count; k++) {
        double *value = state->value + k * state->objectives;
        take_distances(state, population->errors[k], population->distances + k * TARGETS, value);
        add_to_log(state, LOG_MEASURED, value);
    }
    TRY(mf_nsga2_tell(&state->nsga2, state->value));
    mf_population_next_round(population);
    return STATUS_OK;
}

static bool is_checked(const struct pareto_state *state, size_t parent) {
    return state->nsga2.measured[parent] > (double)state->own.checks;
}

/// Member of the front of the least error; false if there is none.
static bool find_best(const struct pareto_state *state, size_t *best) {
    double min = OPTIMISER_FAILED;
    for (size_t k = 0; k < mf_nsga2_parents(&state->nsga2); k++) {
        const double error = mf_pareto_error(state, mf_pareto_value(state, k));
        if (!mf_pareto_is_member(state, k) || error >= min)
            continue;
        min = error;
        *best = k;
    }
    return min < OPTIMISER_FAILED;
}

/// Measure a parent until it is checked.
static enum status check_one(struct pareto_state *state, size_t parent) {
    struct population_check check;
    double value[TARGETS];
    TRY(mf_population_check(&state->population, mf_nsga2_parent(&state->nsga2, parent),
                            (size_t)state->own.checks, 1, &check));
    take_distances(state, check.error, check.each, value);
    for (size_t m = 0; m < state->objectives && check.error < OPTIMISER_FAILED; m++)
        state->progress.noise[m] = check.each[state->target[m]].noise;
    if (check.error < OPTIMISER_FAILED)
        state->progress.variance = check.variance;
    // The mean of some measurements counts as many times.
    for (int64_t k = 0; k < state->own.checks; k++)
        TRY(mf_nsga2_add_measurement(&state->nsga2, parent, value));
    return STATUS_OK;
}

/// Choose from the front: by fresh measurements, since what seems best on one is a lucky draw. They
/// go on until the best has been checked.
static enum status choose(struct pareto_state *state) {
    size_t best = 0;
    while (find_best(state, &best) && !is_checked(state, best))
        TRY(check_one(state, best));
    struct progress *progress = &state->progress;
    progress->known = find_best(state, &best);
    progress->chosen = best;
    if (progress->known && mf_pareto_error(state, mf_pareto_value(state, best)) < progress->min) {
        progress->min = mf_pareto_error(state, mf_pareto_value(state, best));
        progress->last_better = progress->iteration;
    }
    return STATUS_OK;
}

/// Standard errors of the curves, and children where the linear model sees the targets met best.
static enum status ask_surrogate(struct pareto_state *state) {
    CLEARED_BY(mf_surrogate_model_clear) struct surrogate_model model = {0};
    bool known = state->progress.known;
    const double *chosen = mf_nsga2_parent(&state->nsga2, state->progress.chosen);
    TRY(mf_parametrisation_curves_bands(&state->parametrisation, chosen, NULL, &state->curves));
    for (int64_t k = 0; known && (k == 0 || k < state->own.surrogate); k++) {
        mf_surrogate_model_clear(&model);
        TRY(mf_surrogate_fit(&state->population.surrogate, chosen, ldexp(reach, (int)-k), &model,
                             &known));
        if (known && k == 0)
            TRY(mf_parametrisation_curves_bands(&state->parametrisation, chosen, model.covariance,
                                                &state->curves));
        if (known && k < state->own.surrogate)
            mf_nsga2_inject(&state->nsga2, model.best);
    }
    return STATUS_OK;
}

static void describe(struct pareto_state *state, struct inverse_step *step) {
    const struct population_survey *survey = &state->population.survey;
    const struct progress *progress = &state->progress;
    *step = (struct inverse_step){
        .iteration = progress->iteration,
        .evaluations = state->population.totals.evaluations,
        .engine_steps = state->population.totals.steps,
        .error = progress->known ? mf_pareto_error(state, mf_pareto_value(state, progress->chosen))
                                 : NAN,
        .noise = progress->known ? mf_pareto_error(state, progress->noise) : NAN,
        .variance = progress->variance,
        .extra = {survey->min, survey->alive.count > 0 ? survey->alive.mean : NAN,
                  mf_nsga2_diversity(&state->nsga2), (double)survey->failures},
        .finished = mf_nsga2_is_over(&state->nsga2),
    };
    if (step->finished && progress->known)
        mf_inverse_exhaust(step, "generations", progress->last_better);
    else if (step->finished)
        mf_population_report_failure(&state->population,
                                     "but what seemed best failed when it was measured again",
                                     step->reason);
    mf_parametrisation_curves_show(&state->parametrisation,
                                   progress->known
                                       ? mf_nsga2_parent(&state->nsga2, progress->chosen)
                                       : state->population.first,
                                   &state->curves, step);
}

static void log_front(struct pareto_state *state) {
    for (size_t k = 0; k < mf_nsga2_parents(&state->nsga2); k++)
        if (mf_pareto_is_member(state, k))
            add_to_log(state,
                       state->progress.known && k == state->progress.chosen ? LOG_CHOSEN
                                                                            : LOG_FRONT,
                       mf_pareto_value(state, k));
}

/// A round, and then the choice: each is done once, also if an interruption comes between them.
static enum status iterate(void *memory, struct inverse_step *step,
                           const struct inverse_listener *listener) {
    enum { ROUND, CHOICE };
    struct pareto_state *state = memory;
    state->population.iteration = state->progress.iteration;
    state->population.best = state->progress.min < OPTIMISER_FAILED ? state->progress.min : NAN;
    if (state->progress.stage == ROUND) {
        TRY(take_round(state, listener));
        state->progress.stage = CHOICE;
    }
    TRY(choose(state));
    TRY(ask_surrogate(state));
    log_front(state);
    describe(state, step);
    mf_population_reset_survey(&state->population);
    state->progress.stage = ROUND;
    state->progress.iteration++;
    return STATUS_OK;
}

static size_t spans(void *memory, struct memory_span *span) {
    struct pareto_state *state = memory;
    size_t n = 0;
    span[n++] = (struct memory_span){&state->progress, sizeof state->progress};
    span[n++] = (struct memory_span){state->log,
                                     log_rows(state) * mf_pareto_log_width(state) * sizeof(double)};
    n += mf_parametrisation_curves_spans(&state->parametrisation, &state->curves, span + n);
    n += mf_nsga2_spans(&state->nsga2, span + n);
    return n + mf_population_spans(&state->population, span + n);
}

const struct inverse_method mf_pareto = {
    .name = "pareto",
    .summary = "Pareto front of all targets by NSGA-II, without weights; K. Deb et al. (2002)",
    POPULATION_RECORD,
    .tables = (const struct inverse_table[]){{mf_nsga2_fields,
                                              offsetof(struct pareto_parameters, nsga2), NULL},
                                             {own_fields, 0, NULL},
                                             {mf_population_fields, 0, "candidates"},
                                             {mf_population_round_fields, 0, NULL},
                                             {NULL, 0, NULL}},
    .parameters_size = sizeof(struct pareto_parameters),
    .state_size = sizeof(struct pareto_state),
    .knows_molecules = true,
    .write = mf_pareto_write_tables,
};
