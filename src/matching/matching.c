// SPDX-License-Identifier: GPL-3.0-or-later
//
// Matching: variables → curves → simulation → observables → distance from the targets, which an
// optimiser makes small. A. G. Baydin (thesis on DPD coarse-graining by evolutionary optimisation,
// 2008) does it with a genetic algorithm; the optimiser is a record of its own here.
#include "problem/inverse.h"

#include "base/memory.h"
#include "matching/individuals.h"
#include "matching/matchings.h"
#include "matching/population.h"
#include "problem/parametrisation.h"
#include "optimise/genetic.h"
#include "optimise/optimiser.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

struct parameters {
    struct population_parameters population;
    int64_t checks, check_length, agreements;
    int surrogate;
};

/// The same with the parameters of each optimiser after it: struct genetic_settings and so on.
#define SETTINGS(record, name, summary)                                                            \
    struct record##_settings {                                                                     \
        struct parameters common;                                                                  \
        struct record##_parameters optimiser;                                                      \
    };
OPTIMISERS(SETTINGS)

/// What a method has of its own: what it drives, and where the parameters of that are.
struct driven {
    const struct optimiser *optimiser;
    size_t parameters;
};

struct state {
    struct parameters parameters;
    const struct inverse_problem *problem;
    const struct optimiser *optimiser;
    void *optimiser_state;
    bool created;
    struct parametrisation parametrisation;
    struct population population;
    struct individuals individuals;
    double *best_candidate;               ///< shape [variables]: what is thought best
    double *best;                         ///< shape [variables]: the best by fresh measurements
    struct parametrisation_curves curves; ///< of the best, with errors by the linear model
    struct progress {
        uint32_t iteration;
        int stage;            ///< enum check_stage
        uint64_t checked;     ///< evaluations when the best candidate was last measured
        uint32_t last_better; ///< iteration in which the error fell last
        uint32_t met;         ///< checks after which it agreed with the targets but for their noise
        int64_t length;       ///< of the measurements of the best, in units of "check_length"
        bool known;           ///< whether there is a best
        double error, noise;  ///< of the best: the mean of its fresh measurements
        double variance;      ///< of that mean
    } progress;
};

/// Of `check`.
enum check_stage { NOTHING, INCUMBENT, SURROGATE, LONGER };

/// What becomes of the best of a linear model.
enum { UNUSED, TRIED, JOINS };
static const char *const surrogates[] = {"no", "yes", "join", NULL};

#define MEMBER(name) .offset = offsetof(struct parameters, name)
static const struct field own_fields[] = {
    {"racing", FIELD_NUMBER, MEMBER(population.evaluate.racing), .initial = 0, .minimum = 0,
     .maximum = 100, .unit = "standard errors",
     .help = "significance at which a losing simulation is stopped; 0: never"},
    {"checks", FIELD_INTEGER, MEMBER(checks), .initial = 2, .minimum = 1, .maximum = POPULATION_MAX,
     .unit = "", .help = "repeated measurements of an apparent best"},
    {"check_length", FIELD_INTEGER, MEMBER(check_length), .initial = 1, .minimum = 1,
     .maximum = 1000, .unit = "", .help = "length of these simulations, in units of a round's"},
    {"surrogate", FIELD_CHOICE, MEMBER(surrogate), .choices = surrogates, .initial = TRIED,
     .unit = "",
     .help = "try the optimum of a linear model, too; join: add it to the genetic population"},
    {"agreements", FIELD_INTEGER, MEMBER(agreements), .initial = 8, .minimum = 0, .maximum = 1e6,
     .unit = "",
     .help = "measurements of the best within noise of the targets that end the fit; 0: none"},
    FIELD_END,
};

static_assert(offsetof(struct parameters, population) == 0, "the first, says population.h");

static const char *const columns[] = {"least[1]", "mean[1]", "diversity[1]", "failures", NULL};

/// Evaluations of an iteration whose rounds are of one candidate, so that a history stays readable.
static const size_t min_evaluations = 10;

/// How far the linear model may go from what was measured, as a part of a variable's range.
static const double reach = 0.3;

/// Rounds, of which an iteration takes at least one, and a last iteration for the best candidate.
static uint32_t max_iterations(const struct inverse_method *method,
                               const struct inverse_problem *problem, const void *parameters) {
    const struct driven *driven = method->own;
    return driven->optimiser->max_rounds((const char *)parameters + driven->parameters,
                                         mf_parametrisation_count(problem)) +
           1;
}

static void destroy(void *memory) {
    struct state *state = memory;
    if (state->created)
        state->optimiser->destroy(state->optimiser_state);
    mf_memory_free(state->optimiser_state);
    mf_population_clear(&state->population);
    mf_individuals_clear(&state->individuals);
    mf_parametrisation_clear(&state->parametrisation);
    mf_memory_free(state->best_candidate);
    mf_memory_free(state->best);
    mf_parametrisation_curves_clear(&state->curves);
}

static enum status create_optimiser(struct state *state, const void *parameters) {
    OWNED double *start = NULL;
    OWNED size_t *block = NULL;
    TRY_ARRAY(start, state->parametrisation.variables);
    TRY_ARRAY(block, state->parametrisation.variables);
    TRY(mf_parametrisation_start(&state->parametrisation, start));
    const struct optimiser_space space = {
        .variables = state->parametrisation.variables,
        .minimum = 0,
        .maximum = 1,
        .start = start,
        .seed = state->problem->seed,
        .max = POPULATION_MAX,
        .blocks = mf_parametrisation_blocks(&state->parametrisation, block),
        .block = block};
    state->optimiser_state = mf_memory_zeroed(1, state->optimiser->state_size);
    TRY(state->optimiser_state ? STATUS_OK : STATUS_NO_MEMORY);
    TRY(state->optimiser->create(state->optimiser_state, &space, parameters));
    state->created = true;
    return STATUS_OK;
}

static enum status create(void *memory, const struct inverse_method *method,
                          const struct inverse_problem *problem, const void *parameters) {
    struct state *state = memory;
    const struct driven *driven = method->own;
    state->parameters = *(const struct parameters *)parameters;
    state->problem = problem;
    state->optimiser = driven->optimiser;
    state->progress.error = NAN;
    state->progress.length = 1;
    TRY(mf_parametrisation_init(&state->parametrisation, problem));
    TRY_ARRAY(state->best_candidate, state->parametrisation.variables);
    TRY_ARRAY(state->best, state->parametrisation.variables);
    TRY(mf_parametrisation_curves_init(&state->parametrisation, &state->curves));
    TRY(create_optimiser(state, (const char *)parameters + driven->parameters));
    TRY(mf_population_init(&state->population, &state->parametrisation,
                           &state->parameters.population));
    TRY(mf_individuals_init(&state->individuals, state->parametrisation.variables));
    state->population.singles = min_evaluations;
    state->population.iterations = max_iterations(method, problem, parameters);
    return STATUS_OK;
}

/// Whether an iteration has the evaluations that it should.
static bool is_full(const struct population_survey *survey, size_t next_round) {
    return survey->evaluations >= (next_round == 1 ? min_evaluations : 1);
}

/// Keep the round for individuals.tsv, with its parents, of which telling makes others.
static void keep_individuals(struct state *state, const struct optimiser_round *round) {
    for (size_t k = 0; k < round->count; k++) {
        uint64_t parent[2] = {0, 0};
        if (state->optimiser->parents)
            state->optimiser->parents(state->optimiser_state, k, parent);
        mf_individuals_add(&state->individuals, state->progress.iteration,
                           round->variables + k * state->parametrisation.variables,
                           state->population.errors[k], parent);
    }
}

/// One round of the optimiser: measure what it asks for and tell it.
static enum status take_round(struct state *state, const struct optimiser_round *round,
                              const struct inverse_listener *listener) {
    TRY(mf_population_measure(&state->population, round,
                              state->optimiser->discard_above(state->optimiser_state), listener));
    keep_individuals(state, round);
    TRY(state->optimiser->tell(state->optimiser_state, state->population.errors,
                               state->population.variances));
    mf_population_next_round(&state->population);
    return STATUS_OK;
}

/// Whether what is thought best is to be measured: something new, and not more than one evaluation
/// in ten goes into such measurements but for the last, or as much as into the rounds where they
/// have become longer.
static bool wants_check(const struct state *state, bool last) {
    const size_t bytes = state->parametrisation.variables * sizeof(double);
    if (state->progress.known && memcmp(state->best_candidate, state->best, bytes) == 0)
        return false;
    const uint64_t since = state->population.totals.evaluations - state->progress.checked;
    const int64_t length = state->progress.length / state->population.totals.length;
    const int64_t each = length > 5 ? 2 * length : 10;
    return last || !state->progress.known || since >= (uint64_t)(each * state->parameters.checks);
}

static enum status measure_afresh(struct state *state, const double *variables,
                                  struct population_check *check) {
    return mf_population_check(&state->population, variables, (size_t)state->parameters.checks,
                               state->parameters.check_length * state->progress.length, check);
}

static void take(struct progress *progress, const struct population_check *check) {
    progress->known = check->error < OPTIMISER_FAILED;
    progress->error = progress->known ? check->error : NAN;
    progress->noise = check->noise;
    progress->variance = check->variance;
}

/// Measure the best candidate afresh and keep it if it is better than the best so far, or as good
/// within `slack` standard errors.
static enum status check_best_candidate(struct state *state, double slack) {
    struct population_check check;
    TRY(measure_afresh(state, state->best_candidate, &check));
    if (check.error >= OPTIMISER_FAILED ||
        (state->progress.known &&
         check.error > state->progress.error + slack * sqrt(check.variance)))
        return STATUS_OK;
    memcpy(state->best, state->best_candidate, state->parametrisation.variables * sizeof(double));
    if (!state->progress.known || check.error < state->progress.error)
        state->progress.last_better = state->progress.iteration;
    take(&state->progress, &check);
    return STATUS_OK;
}

/// Try what a linear model of all measurements near the best thinks better. It rests on many
/// simulations and what is best so far on few, so it need only be as good within the noise.
static enum status try_surrogate(struct state *state) {
    enum status status = STATUS_OK;
    struct surrogate_model model = {0};
    bool known = false;
    mf_population_expect(&state->population, state->progress.error, state->progress.noise);
    if (state->progress.known)
        CHECK(mf_surrogate_fit(&state->population.surrogate, state->best, reach, &model, &known));
    CHECK(mf_parametrisation_curves_bands(&state->parametrisation, state->best,
                                          known ? model.covariance : NULL, &state->curves));
    if (!known || !state->parameters.surrogate)
        goto done;
    memcpy(state->best_candidate, model.best, state->parametrisation.variables * sizeof(double));
    CHECK(check_best_candidate(state, 1));
    if (state->parameters.surrogate == JOINS && state->optimiser->suggest)
        state->optimiser->suggest(state->optimiser_state, state->best_candidate);
done:
    mf_surrogate_model_clear(&model);
    return status;
}

/// Whether the fit has been at the noise of its targets for long enough: these then tell no
/// candidate from another, and its linear model has learnt from many of them.
static bool rests(const struct state *state) {
    return state->parameters.agreements > 0 &&
           state->progress.met >= (uint64_t)state->parameters.agreements;
}

/// Whether the best is off by no more than noise, as it was measured last.
static bool agrees(const struct progress *progress) {
    static const double chance = 2; // standard errors of the error
    return progress->known &&
           progress->error - chance * sqrt(progress->variance) <= progress->noise;
}

/// Whether the larger part of the noise is that of the fit's own simulations: agreement then says
/// little, and they have to be longer.
static bool hides(const struct state *state) {
    const double own = mf_targets_own_noise(&state->problem->targets);
    return state->parameters.agreements > 0 &&
           state->progress.noise * state->progress.noise > 2 * own * own;
}

/// Whether noise of a round's own simulations hides what would be better: it is larger than that of
/// the targets, and more than half of what the best is off beyond noise.
static bool hides_better(const struct state *state) {
    enum { LONGEST = 64 };
    const struct parameters *p = &state->parameters;
    const int64_t length = state->population.totals.length;
    const int64_t checked = p->checks * p->check_length * state->progress.length / length;
    const double own = pow(mf_targets_own_noise(&state->problem->targets), 2);
    const double noise = pow(state->progress.noise, 2), of_round = (noise - own) * (double)checked;
    return state->progress.known && length < LONGEST && of_round > own &&
           pow(state->progress.error, 2) - noise < 4 * of_round;
}

/// Measure the best again, as it has not been chosen by: the error by which it was is too small.
static enum status measure_longer(struct state *state) {
    struct population_check check;
    TRY(measure_afresh(state, state->best, &check));
    take(&state->progress, &check);
    return STATUS_OK;
}

static void rest(const struct state *state, struct inverse_step *step) {
    step->exhausted = true;
    snprintf(step->reason, sizeof step->reason,
             "its best has agreed with the targets but for noise %d times (\"agreements\"), in "
             "simulations whose own noise is no larger than that of the targets",
             (int)state->parameters.agreements);
}

/// An optimiser has converged if it ended by itself; what has used its budget up, or come to the
/// noise, has just ended.
static void conclude(const struct state *state, struct inverse_step *step) {
    const struct optimiser *optimiser = state->optimiser;
    step->finished = true;
    if (!state->progress.known)
        mf_population_report_failure(&state->population,
                                     "but what seemed best failed when it was measured again",
                                     step->reason);
    else if (optimiser->settled && optimiser->settled(state->optimiser_state) &&
             !(optimiser->go_on && hides_better(state)))
        step->converged = true;
    else if (optimiser->gave_up && optimiser->gave_up(state->optimiser_state))
        mf_inverse_give_up(step);
    else if (rests(state))
        rest(state, step);
    else
        mf_inverse_exhaust(step, optimiser->budget, state->progress.last_better);
}

static void describe(struct state *state, struct inverse_step *step, bool finished) {
    const struct population_survey *survey = &state->population.survey;
    *step = (struct inverse_step){
        .iteration = state->progress.iteration,
        .evaluations = state->population.totals.evaluations,
        .engine_steps = state->population.totals.steps,
        .error = state->progress.error,
        .noise = state->progress.noise,
        .variance = state->progress.variance,
        .extra = {survey->min, survey->alive.count > 0 ? survey->alive.mean : NAN,
                  state->optimiser->spread(state->optimiser_state), (double)survey->failures},
    };
    if (finished)
        conclude(state, step);
    mf_parametrisation_curves_show(&state->parametrisation,
                                   state->progress.known ? state->best : state->population.first,
                                   &state->curves, step);
}

/// Measure what the optimiser, and then the linear model, thinks best. Each stage is done once,
/// also if an interruption comes between them.
static enum status check(struct state *state, bool last) {
    struct progress *progress = &state->progress;
    if (!state->optimiser->best_candidate(state->optimiser_state, state->best_candidate))
        return STATUS_OK;
    if (progress->stage == NOTHING && wants_check(state, last))
        progress->stage = INCUMBENT;
    if (progress->stage == INCUMBENT) {
        TRY(check_best_candidate(state, 0));
        progress->stage = SURROGATE;
    }
    if (progress->stage == SURROGATE) {
        TRY(try_surrogate(state));
        const bool met = agrees(progress), longer = met && hides(state);
        progress->stage = longer ? LONGER : NOTHING;
        progress->length *= longer ? 2 : 1;
        progress->met += met && !longer;
        progress->checked = state->population.totals.evaluations;
    }
    if (progress->stage == LONGER) {
        TRY(measure_longer(state));
        progress->stage = NOTHING;
        progress->checked = state->population.totals.evaluations;
    }
    return STATUS_OK;
}

/// Whether an optimiser that has settled goes on, with simulations that are longer.
static bool goes_on(struct state *state) {
    const struct optimiser *const by = state->optimiser;
    void *const memory = state->optimiser_state;
    if (!by->go_on || !by->settled(memory) || !hides_better(state) || !by->go_on(memory))
        return false;
    state->population.totals.length *= 2;
    state->progress.length *= 2;
    state->progress.stage = LONGER;
    return true;
}

static size_t spans(void *memory, struct memory_span *span) {
    struct state *state = memory;
    const size_t bytes = state->parametrisation.variables * sizeof(double);
    size_t n = 0;
    span[n++] = (struct memory_span){&state->progress, sizeof state->progress};
    span[n++] = (struct memory_span){state->best, bytes};
    n += mf_parametrisation_curves_spans(&state->parametrisation, &state->curves, span + n);
    n += mf_population_spans(&state->population, span + n);
    n += mf_individuals_spans(&state->individuals, span + n);
    n += state->optimiser->spans(state->optimiser_state, span + n);
    return n;
}

static enum status iterate(void *memory, struct inverse_step *step,
                           const struct inverse_listener *listener) {
    struct state *state = memory;
    struct optimiser_round round;
    state->population.iteration = state->progress.iteration;
    state->population.best = state->progress.error;
    TRY(state->optimiser->ask(state->optimiser_state, &round));
    while (round.count > 0 && !is_full(&state->population.survey, round.count)) {
        TRY(take_round(state, &round, listener));
        TRY(state->optimiser->ask(state->optimiser_state, &round));
    }
    const bool ended = round.count == 0;
    TRY(check(state, ended));
    const bool ends = ended && !goes_on(state);
    if (!ends && rests(state))
        TRY(check(state, true));
    describe(state, step, ends || rests(state));
    mf_population_reset_survey(&state->population);
    state->progress.iteration++;
    return STATUS_OK;
}

static enum status write(const void *memory, const struct inverse_folder *folder) {
    const struct state *state = memory;
    TRY(mf_individuals_write(&state->individuals, &state->parametrisation, folder));
    return mf_population_write(&state->population, folder);
}

#define MATCHING(record, its_name, its_summary)                                                    \
    const struct inverse_method mf_matching_##record = {                                           \
        .name = its_name,                                                                          \
        .summary = its_summary,                                                                    \
        POPULATION_RECORD,                                                                         \
        .own = &(const struct driven){&mf_##record##_optimiser,                                    \
                                      offsetof(struct record##_settings, optimiser)},              \
        .tables =                                                                                  \
            (const struct inverse_table[]){                                                        \
                {mf_##record##_fields, offsetof(struct record##_settings, optimiser), NULL},       \
                {mf_population_fields, 0, "candidates"},                                           \
                {mf_population_round_fields, 0, NULL},                                             \
                {own_fields, 0, "searches"},                                                       \
                {NULL, 0, NULL}},                                                                  \
        .parameters_size = sizeof(struct record##_settings),                                       \
        .state_size = sizeof(struct state),                                                        \
        .knows_molecules = true,                                                                   \
        .write = write,                                                                            \
    };
OPTIMISERS(MATCHING)
