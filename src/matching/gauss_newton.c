// SPDX-License-Identifier: GPL-3.0-or-later
//
// Gauss-Newton steps on what simulations show: around the best curves so far, candidates are spread
// over a region; a linear model of their observables (matching/surrogate.h) says where in it the
// targets would be met best; and by what that place measures, the region is moved, widened or
// narrowed (a trust region: J. Nocedal and S. J. Wright, Numerical Optimization (2nd ed., 2006),
// algorithm 4.1). Optimisers see one number of a simulation, this sees all of g(r) and E(t, r_0).
#include "problem/inverse.h"

#include "base/memory.h"
#include "base/rng.h"
#include "matching/matchings.h"
#include "matching/population.h"
#include "observe/kirkwood_buff.h"
#include "observe/rdf_observable.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/// The region's radius is multiplied by these after a step that helped and one that did harm, and
/// never gets wider than the last [variable].
static const double widen = 1.4, narrow = 0.7, widest = 0.3;

/// The error is at its noise up to this multiple of it, which is known to a tenth or two. What is
/// there for so many iterations, and where the model hardly wants to go on, or has not fallen by
/// more than chance for so many, has settled: a D whose error went below its noise in iteration 6
/// wandered about in it for 13 more.
static const double noise_margin = 1.1;

/// The model hardly wants to go on if its step is at most this many standard errors of its place,
/// rms over variables. An error whose noise is that of many loose points is small far from where
/// the sharp ones want to be: a number found from S(q) stopped 5 of its errors away.
static const double small_step = 1;
enum { SETTLED_AT_NOISE = 2, SETTLED_IDLE = 10 };

/// Candidates are spread by this part of the radius, so that the model is asked for little beyond.
static const double spread_part = 0.7;

struct parameters {
    struct population_parameters population;
    int64_t iterations, spread, checks;
    double reach, tolerance;
    int pressure; ///< PRESSURE_…
};

enum { PRESSURE_WEIGHED, PRESSURE_CONSTRAINT };
static const char *const pressures[] = {"weighed", "constraint", NULL};

struct state {
    struct parameters own;
    const struct inverse_problem *problem;
    struct parametrisation parametrisation;
    struct population population;
    double *round;                        ///< shape [candidates, variables]: spread about the best
    double *proposal;                     ///< shape [variables]
    double *best;                         ///< shape [variables]: the centre of the region
    struct parametrisation_curves curves; ///< of the best
    bool has_model;                       ///< whether the last iteration had one
    struct progress {
        uint32_t iteration;
        bool known;                    ///< whether the best has been measured
        double reach;                  ///< radius of the region [variable]
        double error, variance, noise; ///< of the best
        double min;                    ///< of the errors that the best has had
        uint32_t at_noise;             ///< iterations since the error is no more than noise
        uint32_t idle;                 ///< since it fell by more than chance,
        double reference;              ///< from this
    } progress;
};

#define OWN(name) .offset = offsetof(struct parameters, name)
static const struct field own_fields[] = {
    {"iterations", FIELD_INTEGER, OWN(iterations), .initial = 20, .minimum = 1, .maximum = 10000,
     .unit = "", .help = "most iterations"},
    {"spread", FIELD_INTEGER, OWN(spread), .initial = 0, .minimum = 0, .maximum = POPULATION_MAX,
     .unit = "", .help = "candidates around the best in an iteration; 0: 1.5 for each variable"},
    {"reach", FIELD_NUMBER, OWN(reach), .initial = 0.15, .minimum = FIELD_ABOVE_ZERO, .maximum = 1,
     .unit = "", .help = "initial trust radius, as a fraction of the range"},
    {"checks", FIELD_INTEGER, OWN(checks), .initial = 4, .minimum = 1, .maximum = POPULATION_MAX,
     .unit = "", .help = "measurements of the model's optimum"},
    {"tolerance", FIELD_NUMBER, OWN(tolerance), .initial = 0.1, .minimum = FIELD_ABOVE_ZERO,
     .maximum = 1, .unit = "", .help = "trust radius at the end, as a fraction of the first"},
    {"pressure", FIELD_CHOICE, OWN(pressure), .choices = pressures, .initial = PRESSURE_WEIGHED,
     .unit = "", .help = "a fitted pressure: weighted, or met exactly by the linear model"},
    FIELD_END,
};

static_assert(offsetof(struct parameters, population) == 0, "the first, says population.h");

static const char *const columns[] = {"least[1]", "mean[1]", "reach[1]", "failures", NULL};

/// Candidates of an iteration, an even number; the first must be enough for a model.
static size_t round_size(const struct state *state) {
    const size_t variables = state->parametrisation.variables;
    const size_t wanted =
        state->own.spread > 0 ? (size_t)state->own.spread : (3 * variables + 1) / 2;
    // Some may fail.
    const size_t min =
        state->progress.iteration == 0 ? 11 * mf_surrogate_min_rows(variables) / 10 : 4;
    return ((wanted > min ? wanted : min) + 1) / 2 * 2;
}

static size_t max_candidates(const struct state *state) {
    const size_t variables = state->parametrisation.variables,
                 min = 11 * mf_surrogate_min_rows(variables) / 10;
    const size_t wanted = state->own.spread > 0 ? (size_t)state->own.spread : 2 * variables;
    return ((wanted > min ? wanted : min) + 1) / 2 * 2;
}

static void destroy(void *memory) {
    struct state *state = memory;
    mf_population_clear(&state->population);
    mf_parametrisation_clear(&state->parametrisation);
    mf_memory_free(state->round);
    mf_memory_free(state->proposal);
    mf_memory_free(state->best);
    mf_parametrisation_curves_clear(&state->curves);
}

/// The pressure, one of the features, is met exactly.
static enum status constrain_pressure(struct state *state) {
    struct targets up_to = state->problem->targets;
    if (!targets_ask(&state->problem->targets, TARGET_PRESSURE))
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "method.pressure: \"constraint\" needs a target.pressure that is fitted");
    for (int kind = TARGET_PRESSURE + 1; kind < TARGETS; kind++)
        up_to.target[kind].count = 0;
    state->population.surrogate.exact = mf_targets_features(&up_to) - 1;
    return STATUS_OK;
}

static enum status create(void *memory, const struct inverse_method *method,
                          const struct inverse_problem *problem, const void *parameters) {
    enum status status = STATUS_OK;
    struct state *state = memory;
    state->own = *(const struct parameters *)parameters;
    state->problem = problem;
    state->progress = (struct progress){.reach = state->own.reach,
                                        .error = NAN,
                                        .noise = NAN,
                                        .min = INFINITY,
                                        .reference = INFINITY};
    CHECK(mf_parametrisation_init(&state->parametrisation, problem));
    if (max_candidates(state) > POPULATION_MAX) {
        status =
            mf_status_fail(STATUS_BAD_INPUT,
                           "method.name: \"%s\" needs %zu candidates in a round for %zu variables, "
                           "and %d are the most",
                           method->name, mf_surrogate_min_rows(state->parametrisation.variables),
                           state->parametrisation.variables, POPULATION_MAX);
        goto done;
    }
    NEW_ARRAY(state->round, max_candidates(state) * state->parametrisation.variables);
    NEW_ARRAY(state->proposal, state->parametrisation.variables);
    NEW_ARRAY(state->best, state->parametrisation.variables);
    CHECK(mf_parametrisation_curves_init(&state->parametrisation, &state->curves));
    CHECK(mf_parametrisation_start(&state->parametrisation, state->best));
    CHECK(mf_population_init(&state->population, &state->parametrisation, &state->own.population));
    state->population.iterations = (uint32_t)((const struct parameters *)parameters)->iterations;
    if (state->own.pressure == PRESSURE_CONSTRAINT)
        CHECK(constrain_pressure(state));
done:
    return status;
}

/// Pairs on opposite sides of the best, normally distributed.
static void spread(struct state *state, size_t count) {
    const size_t variables = state->parametrisation.variables;
    for (size_t pair = 0; pair < count / 2; pair++)
        for (size_t n = 0; n < variables; n++) {
            double normal[4];
            mf_rng_normal4(mf_rng_philox(state->problem->seed, RNG_SELECTION,
                                         state->progress.iteration, (uint32_t)pair, (uint32_t)n),
                           normal);
            const double step = spread_part * state->progress.reach * normal[0];
            double *one = state->round + 2 * pair * variables + n;
            one[0] = fmin(1, fmax(0, state->best[n] + step));
            one[variables] = fmin(1, fmax(0, state->best[n] - step));
        }
}

/// Take a measured place for the best.
static void move(struct state *state, const double *variables,
                 const struct population_check *check) {
    struct progress *progress = &state->progress;
    memcpy(state->best, variables, state->parametrisation.variables * sizeof *variables);
    progress->known = true;
    progress->error = check->error;
    progress->noise = check->noise;
    progress->variance = check->variance;
    progress->min = fmin(progress->min, check->error);
}

/// Compare the proposal's measurement with the best's: go there unless it failed or is worse by
/// more than chance than the least so far, and trust the model in a wider or narrower region. By
/// chance alone, taken from one best to the next, a fit would climb step by step.
static void assess(struct state *state, const struct population_check *check) {
    struct progress *progress = &state->progress;
    const double chance = sqrt(check->variance + progress->variance);
    const bool better = !progress->known || check->error < progress->min + chance;
    if (check->error < OPTIMISER_FAILED && better) {
        if (progress->known && check->error < progress->error - chance)
            progress->reach = fmin(widest, widen * progress->reach);
        move(state, state->proposal, check);
    } else {
        progress->reach *= narrow;
    }
}

/// Step that the model proposes from the best, in its standard errors, rms over variables.
static double step_in_errors(const struct state *state, const struct surrogate_model *model) {
    const size_t variables = state->parametrisation.variables;
    double squares = 0;
    for (size_t n = 0; n < variables; n++) {
        const double step = model->best[n] - state->best[n];
        squares += step * step / model->covariance[n * variables + n];
    }
    return sqrt(squares / (double)variables);
}

/// Count the iterations at the noise, and those without progress.
static void watch(struct progress *progress, double step) {
    const bool rests = progress->error <= noise_margin * progress->noise && step <= small_step;
    progress->at_noise = rests ? progress->at_noise + 1 : 0;
    progress->idle++;
    if (!(progress->error > progress->reference - sqrt(2 * progress->variance))) {
        progress->reference = progress->error;
        progress->idle = 0;
    }
}

/// Measure what the model says, if enough simulations succeeded to have one.
static enum status propose(struct state *state) {
    CLEARED_BY(mf_surrogate_model_clear) struct surrogate_model model = {0};
    bool known;
    mf_population_expect(&state->population, state->progress.error, state->progress.noise);
    TRY(mf_surrogate_fit(&state->population.surrogate, state->best, state->progress.reach, &model,
                         &known));
    if (known) {
        const double step = step_in_errors(state, &model);
        memcpy(state->proposal, model.best, state->parametrisation.variables * sizeof *model.best);
        struct population_check check;
        TRY(mf_population_check(&state->population, state->proposal, (size_t)state->own.checks, 1,
                                &check));
        assess(state, &check);
        if (state->progress.known)
            watch(&state->progress, step);
    }
    state->has_model = known;
    return mf_parametrisation_curves_bands(&state->parametrisation, state->best,
                                           known ? model.covariance : NULL, &state->curves);
}

/// Why there is no result, or why it is not the last word.
static void report_reason(const struct state *state, char reason[INVERSE_REASON_SIZE]) {
    const struct progress *progress = &state->progress;
    char why[128];
    if (progress->known) {
        snprintf(reason, INVERSE_REASON_SIZE,
                 "stopped at the limit of %lld iterations: the error is %.2g (statistical error "
                 "%.2g), and the trust region %.2g wide, but \"tolerance\" is %.2g",
                 (long long)state->own.iterations, progress->error, progress->noise,
                 progress->reach, state->own.tolerance * state->own.reach);
        return;
    }
    if (state->has_model)
        snprintf(why, sizeof why, "but none of the linear model's optimum");
    else
        snprintf(
            why, sizeof why,
            "too few for a linear model of %zu variables, which needs %zu: more \"iterations\" or "
            "\"spread\" would do",
            state->parametrisation.variables,
            mf_surrogate_min_rows(state->parametrisation.variables));
    mf_population_report_failure(&state->population, why, reason);
}

/// Whether some potential meets all that is fitted: g(r) and the pressure, and the distributions of
/// groups. What moves may be out of reach of any friction.
static bool can_be_met(const struct inverse_problem *problem) {
    const struct targets *targets = &problem->targets;
    for (int kind = 0; mf_targets_name(kind); kind++) {
        const bool of_pairs = kind == TARGET_RDF || kind == mf_rdf_intermolecular_kind() ||
                              kind == TARGET_PRESSURE || kind == mf_kirkwood_buff_kind();
        const bool of_groups = mf_bonded_distribution_order(kind) < BONDED_KINDS;
        if (targets_ask(targets, kind) &&
            !(of_pairs && problem->unknown[UNKNOWN_POTENTIAL].wanted) &&
            !(of_groups && problem->unknown[UNKNOWN_BONDED].wanted))
            return false;
    }
    return true;
}

static bool has_narrowed(const struct state *state) {
    return state->progress.reach < state->own.tolerance * state->own.reach;
}

/// It goes no further: at its noise it has converged, and elsewhere that is no success unless what
/// is fitted cannot be met.
static void settle(const struct state *state, struct inverse_step *step) {
    const struct progress *progress = &state->progress;
    const struct targets *targets = &state->problem->targets;
    const char *what = mf_targets_count(targets) > 1      ? "the weighted error of all targets is"
                       : targets_ask(targets, TARGET_RDF) ? "g(r) is still off by"
                                                          : "the target is still off by";
    char why[64] = "its steps have become small";
    step->finished = true;
    step->converged = progress->error <= mf_inverse_noise_margin * progress->noise;
    step->exhausted = !step->converged && !can_be_met(state->problem);
    if (step->converged)
        return;
    if (!has_narrowed(state))
        snprintf(why, sizeof why, "its error has not fallen in %u iterations", progress->idle);
    snprintf(step->reason, sizeof step->reason,
             "%s, but %s %.2g (statistical error %.2g): try more \"coefficients\", a wider range "
             "of the curve or another start%s",
             why, what, progress->error, progress->noise,
             step->exhausted ? ", if the target can be met at all" : "");
}

static void describe(struct state *state, struct inverse_step *step) {
    const struct population_survey *survey = &state->population.survey;
    const struct progress *progress = &state->progress;
    const bool settled =
        progress->known && (has_narrowed(state) || progress->at_noise >= SETTLED_AT_NOISE ||
                            progress->idle >= SETTLED_IDLE);
    const bool last = progress->iteration + 1 >= (uint32_t)state->own.iterations;
    *step = (struct inverse_step){
        .iteration = progress->iteration,
        .evaluations = state->population.totals.evaluations,
        .engine_steps = state->population.totals.steps,
        .error = progress->error,
        .noise = progress->noise,
        .variance = progress->variance,
        .extra = {survey->min, survey->alive.count > 0 ? survey->alive.mean : NAN, progress->reach,
                  (double)survey->failures},
        .finished = last || has_narrowed(state),
    };
    if (settled)
        settle(state, step);
    else if (step->finished)
        report_reason(state, step->reason);
    mf_parametrisation_curves_show(&state->parametrisation, state->best, &state->curves, step);
}

static enum status iterate(void *memory, struct inverse_step *step,
                           const struct inverse_listener *listener) {
    struct state *state = memory;
    struct population *population = &state->population;
    const struct optimiser_round round = {state->round, round_size(state)};
    population->iteration = state->progress.iteration;
    population->best = state->progress.error;
    if (population->survey.evaluations == 0) {
        spread(state, round.count);
        TRY(mf_population_measure(population, &round, HUGE_VAL, listener));
    }
    TRY(propose(state));
    describe(state, step);
    mf_population_next_round(population);
    mf_population_reset_survey(population);
    state->progress.iteration++;
    return STATUS_OK;
}

static size_t spans(void *memory, struct memory_span *span) {
    struct state *state = memory;
    size_t n = 0;
    span[n++] = (struct memory_span){&state->progress, sizeof state->progress};
    span[n++] =
        (struct memory_span){state->best, state->parametrisation.variables * sizeof(double)};
    n += mf_parametrisation_curves_spans(&state->parametrisation, &state->curves, span + n);
    return n + mf_population_spans(&state->population, span + n);
}

const struct inverse_method mf_gauss_newton = {
    .name = "gauss-newton",
    .summary = "linear models of all observables in a trust region; J. Nocedal and S. J. Wright "
               "(2006)",
    POPULATION_RECORD,
    .tables = (const struct inverse_table[]){{own_fields, 0, NULL},
                                             {mf_population_fields, 0, "candidates"},
                                             {mf_population_round_fields, 0, NULL},
                                             {NULL, 0, NULL}},
    .parameters_size = sizeof(struct parameters),
    .state_size = sizeof(struct state),
    .knows_molecules = true,
};
