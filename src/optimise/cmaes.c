// SPDX-License-Identifier: GPL-3.0-or-later
//
// CMA-ES by ask and tell. Inside, variables are fractions of their range.
//
// Bounds: the distribution knows none; a candidate beyond one is measured at its mirror image
// inside (mf_optimiser_reflect). To the strategy the error is an even, periodic function, so there
// is no penalty to scale, which noise and failed candidates would spoil, and an optimum at a bound
// is in the middle of its neighbourhood.
//
// Noise: as UH-CMA-ES (N. Hansen et al., IEEE Trans. Evol. Comput. 13, 180 (2009)) it acts when
// ranks are noise; but that shows from the told variances, and needs no candidate twice. The share
// of the variance among a round's errors that the noise of their measurement explains is smoothed
// over rounds; above a half of it the population grows, below a quarter it shrinks back: its mean
// then sees what no single candidate shows.
#include "optimise/cmaes.h"

#include "base/rng.h"
#include "base/statistics.h"
#include "optimise/optimiser.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double square(double x) {
    return x * x;
}

/// µ_eff = (Σ w)²/Σ w² of the ranks from `begin` on, before `end`.
static double effective(const double *weights, size_t begin, size_t end) {
    double sum = 0, squares = 0;
    for (size_t k = begin; k < end; k++) {
        sum += weights[k];
        squares += square(weights[k]);
    }
    return squares > 0 ? square(sum) / squares : 0;
}

/// Rates of the covariance (eq. 56–58, α_cov = 2).
static void set_rates(struct cmaes_strategy *s, double n) {
    const double eff = s->effective;
    s->path = (4 + eff / n) / (n + 4 + 2 * eff / n);
    s->rank_one = 2 / (square(n + 1.3) + eff);
    s->rank_mu = fmin(1 - s->rank_one, 2 * (0.25 + eff + 1 / eff - 2) / (square(n + 2) + eff));
}

/// Positive weights add up to 1, negative ones to as much as keeps the covariance positive
/// (eq. 50–53).
static void scale_weights(struct cmaes_strategy *s, double n, double effective_negative) {
    double positive = 0, negative = 0;
    for (size_t k = 0; k < s->population; k++) {
        positive += fmax(s->weights[k], 0);
        negative += fmax(-s->weights[k], 0);
    }
    const double by_rates = 1 + s->rank_one / s->rank_mu;
    const double by_effective = 1 + 2 * effective_negative / (s->effective + 2);
    const double by_definiteness = (1 - s->rank_one - s->rank_mu) / (n * s->rank_mu);
    const double min = fmin(by_rates, fmin(by_effective, by_definiteness));
    s->weights_sum = 0;
    for (size_t k = 0; k < s->population; k++) {
        s->weights[k] *= s->weights[k] >= 0 ? 1 / positive : min / negative;
        s->weights_sum += s->weights[k];
    }
}

void mf_cmaes_strategy_set(struct cmaes_strategy *s, size_t variables) {
    const double n = (double)variables;
    s->parents = s->population / 2;
    for (size_t k = 0; k < s->population; k++)
        s->weights[k] = log(((double)s->population + 1) / 2) - log((double)k + 1); // eq. 49
    s->effective = effective(s->weights, 0, s->parents);
    const double effective_negative = effective(s->weights, s->parents, s->population);
    s->path_sigma = (s->effective + 2) / (n + s->effective + 5); // eq. 55
    s->damping = 1 + 2 * fmax(0, sqrt((s->effective - 1) / (n + 1)) - 1) + s->path_sigma;
    s->length = sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n * n));
    set_rates(s, n);
    scale_weights(s, n, effective_negative);
}

#define MEMBER(name) .offset = offsetof(struct cmaes_parameters, name)
const struct field mf_cmaes_fields[] = {
    {"population", FIELD_INTEGER, MEMBER(population), .initial = 0, .minimum = 0, .maximum = 1e5,
     .unit = "", .help = "candidates of a round, at least 4; 0: 4 + 3 ln(variables)"},
    {"step", FIELD_NUMBER, MEMBER(step), .initial = 0.3, .minimum = FIELD_ABOVE_ZERO, .maximum = 1,
     .unit = "", .help = "initial standard deviation, as a fraction of the range"},
    {"rounds", FIELD_INTEGER, MEMBER(rounds), .initial = 500, .minimum = 1, .maximum = 1e6,
     .unit = "", .help = "most rounds"},
    {"tolerance", FIELD_NUMBER, MEMBER(tolerance), .initial = 1e-12, .minimum = 0,
     .maximum = DBL_MAX, .unit = "error", .help = "change of the error at which it ends"},
    FIELD_END,
};

/// Usual population times this is the most that noise makes of it.
enum { MAX_GROWTH = 16 };

/// Constants of the reaction to noise. On a sphere of 10 variables with noise of 0.01, 10,000
/// measurements lead to 0.0055 without a reaction, to 0.0007 with these, and to 0.009 with a longer
/// step instead, as UH-CMA-ES has it when it cannot measure for longer.
static const double noise_memory = 0.8, noise_grows = 0.5, noise_shrinks = 0.25, growth = 1.1;

struct state {
    struct cmaes_parameters parameters;
    struct optimiser_space space;
    struct cmaes_distribution distribution;
    struct cmaes_strategy strategy;
    size_t max;        ///< candidates of a round, at most; there is room for them
    double *steps;     ///< of the candidates, shape [most, variables]
    double *variables; ///< the candidates, shape [most, variables]
    double *errors;    ///< shape [most]: scratch
    double *record;    ///< variables of `record_error`, shape [variables]
    double *history;   ///< least errors of the last rounds, a ring, shape [max_history]
    uint64_t sampled;  ///< the round whose candidates these are, counted from 1; 0: none yet
    struct progress {
        uint64_t rounds; ///< told
        uint64_t history_count;
        double population;   ///< not yet rounded
        double noise;        ///< smoothed share of noise among errors
        double record_error; ///< of the best candidate
        double discard_above;
        int64_t noisy, over, settled, known;
    } progress;
};

static size_t usual_population(const struct cmaes_parameters *p, size_t variables) {
    return p->population > 0 ? (size_t)p->population : 4 + (size_t)(3 * log((double)variables));
}

/// Rounds within which errors must stand still: 10 + 30 n/λ (tutorial, B.3).
static size_t history_rounds(const struct state *state, size_t population) {
    return 10 + (size_t)ceil(30 * (double)state->space.variables / (double)population);
}

static size_t max_history(const struct state *state) {
    return history_rounds(state, usual_population(&state->parameters, state->space.variables));
}

static uint32_t max_rounds(const void *parameters, size_t variables) {
    (void)variables;
    return (uint32_t)((const struct cmaes_parameters *)parameters)->rounds;
}

static void destroy(void *memory) {
    struct state *state = memory;
    mf_cmaes_clear(&state->distribution);
    mf_memory_free(state->strategy.weights);
    mf_memory_free(state->steps);
    mf_memory_free(state->variables);
    mf_memory_free(state->errors);
    mf_memory_free(state->record);
    mf_memory_free(state->history);
    *state = (struct state){0};
}

/// Numbers of the strategy, which no checkpoint keeps since they follow from the population.
static void follow_population(struct state *state) {
    if (state->strategy.population == (size_t)state->progress.population)
        return;
    state->strategy.population = (size_t)state->progress.population;
    mf_cmaes_strategy_set(&state->strategy, state->space.variables);
}

/// This round's candidates: a function of the distribution, the seed and the round, so no
/// checkpoint keeps them.
static void sample(struct state *state) {
    const size_t n = state->space.variables;
    if (state->sampled == state->progress.rounds + 1)
        return;
    state->sampled = state->progress.rounds + 1;
    follow_population(state);
    for (size_t row = 0; row < state->strategy.population; row++) {
        double *step = state->steps + row * n;
        mf_cmaes_sample(&state->distribution, state->space.seed, (uint32_t)state->progress.rounds,
                        (uint32_t)row, step);
        for (size_t k = 0; k < n; k++) {
            const double x =
                state->distribution.mean[k] + state->distribution.moments.sigma * step[k];
            state->variables[row * n + k] =
                optimiser_variable(&state->space, mf_optimiser_reflect(x));
        }
    }
}

static enum status create(void *memory, const struct optimiser_space *space,
                          const void *parameters) {
    struct state *state = memory;
    state->parameters = *(const struct cmaes_parameters *)parameters;
    TRY(mf_optimiser_check_space(space));
    if (state->parameters.population > 0 && state->parameters.population < 4)
        TRY(mf_status_fail(STATUS_BAD_INPUT, "cma-es: a population of %d is below 4",
                           (int)state->parameters.population));
    state->space = *space;
    state->space.start = NULL;
    const size_t usual = usual_population(&state->parameters, space->variables);
    TRY(mf_optimiser_check_round(space, usual));
    state->max = MAX_GROWTH * usual;
    if (space->max > 0 && state->max > space->max)
        state->max = space->max;
    TRY_ARRAY(state->strategy.weights, state->max);
    TRY_ARRAY(state->steps, state->max * space->variables);
    TRY_ARRAY(state->variables, state->max * space->variables);
    TRY_ARRAY(state->errors, state->max);
    TRY_ARRAY(state->record, space->variables);
    TRY_ARRAY(state->history, max_history(state));
    TRY(mf_cmaes_init(&state->distribution, space->variables));
    state->progress.record_error = state->progress.discard_above = HUGE_VAL;
    state->progress.population = (double)usual;
    mf_cmaes_begin(&state->distribution, state->parameters.step);
    for (size_t k = 0; k < space->variables; k++)
        state->distribution.mean[k] = mf_optimiser_start(space, k);
    return STATUS_OK;
}

static enum status ask(void *memory, struct optimiser_round *round) {
    struct state *state = memory;
    const bool over = state->progress.over != 0;
    sample(state);
    *round = (struct optimiser_round){state->variables, over ? 0 : state->strategy.population};
    return STATUS_OK;
}

// Tell --------------------------------------------------------------------------------------------

static int compare_numbers(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/// Share of the variance among errors that is the variance of each: 1 if ranks are noise alone.
static void watch_noise(struct state *state, const double *variances) {
    struct running_mean errors = {0}, noise = {0};
    for (size_t k = 0; k < state->strategy.population; k++) {
        if (state->errors[k] >= OPTIMISER_FAILED)
            continue;
        mf_statistics_add(&errors, state->errors[k]);
        mf_statistics_add(&noise, variances[k] > 0 && variances[k] < HUGE_VAL ? variances[k] : 0);
    }
    if (errors.count < 2)
        return;
    const double among = errors.squares / (double)(errors.count - 1);
    const double share = among > 0 ? fmin(1, noise.mean / among) : noise.mean > 0;
    state->progress.noise = noise_memory * state->progress.noise + (1 - noise_memory) * share;
    state->progress.noisy = state->progress.noisy || noise.mean > 0;
}

static void react_to_noise(struct state *state) {
    struct progress *p = &state->progress;
    const double usual = (double)usual_population(&state->parameters, state->space.variables);
    if (p->noise > noise_grows)
        p->population = fmin(p->population * growth, (double)state->max);
    else if (p->noise < noise_shrinks)
        p->population = fmax(p->population / growth, usual);
}

/// Keep the best candidate.
static void keep_best(struct state *state) {
    const size_t n = state->space.variables;
    for (size_t k = 0; k < state->strategy.population; k++) {
        if (state->errors[k] >= fmin(state->progress.record_error, OPTIMISER_FAILED))
            continue;
        state->progress.record_error = state->errors[k];
        memcpy(state->record, state->variables + k * n, n * sizeof(double));
    }
}

static void mean_variables(const struct state *state, double *variables) {
    for (size_t k = 0; k < state->space.variables; k++)
        variables[k] =
            optimiser_variable(&state->space, mf_optimiser_reflect(state->distribution.mean[k]));
}

/// The least error of the round, and the one above which a candidate changes nothing; sorts the
/// errors.
static void survey(struct state *state) {
    struct progress *p = &state->progress;
    const struct cmaes_strategy *s = &state->strategy;
    qsort(state->errors, s->population, sizeof(double), compare_numbers);
    p->discard_above = state->errors[s->parents - 1];
    state->history[p->history_count++ % max_history(state)] = state->errors[0];
}

/// Whether errors of this round, sorted, and the least of the last ones are all the same.
static bool stands_still(const struct state *state) {
    const struct progress *p = &state->progress;
    const size_t rounds = history_rounds(state, state->strategy.population);
    if (p->history_count < rounds)
        return false;
    double min = state->errors[0], max = state->errors[state->strategy.population - 1];
    for (size_t k = 1; k <= rounds; k++) {
        const double error = state->history[(p->history_count - k) % max_history(state)];
        min = fmin(min, error);
        max = fmax(max, error);
    }
    return max - min <= state->parameters.tolerance;
}

/// Largest standard deviation of a variable.
static double widest(const struct state *state) {
    double max = 0;
    for (size_t k = 0; k < state->space.variables; k++)
        max = fmax(max, mf_cmaes_deviation(&state->distribution, k));
    return max;
}

/// No variable spreads beyond its whole range: mirrors would only hide it.
static void limit_step(struct state *state) {
    const double max = widest(state);
    if (max > 1)
        state->distribution.moments.sigma /= max;
}

/// Whether the distribution has become too narrow or too oblong for double precision.
static bool is_degenerate(const struct state *state) {
    return widest(state) < 1e-12 || mf_cmaes_axis_ratio(&state->distribution) > 1e7;
}

/// What follows a round, whose errors are sorted.
static void go_on(struct state *state) {
    struct progress *p = &state->progress;
    p->settled = stands_still(state) || is_degenerate(state);
    p->over = ++p->rounds >= (uint64_t)state->parameters.rounds || p->settled;
    if (!p->over)
        react_to_noise(state);
}

static enum status tell(void *memory, const double *errors, const double *variances) {
    struct state *state = memory;
    sample(state);
    const size_t population = state->strategy.population;
    double min = OPTIMISER_FAILED;
    for (size_t k = 0; k < population; k++) {
        state->errors[k] = optimiser_error(errors[k]);
        min = fmin(min, state->errors[k]);
    }
    if (min < OPTIMISER_FAILED) { // a round in which all failed says nothing
        TRY(mf_cmaes_update(&state->distribution, &state->strategy, state->steps, state->errors));
        limit_step(state);
        state->progress.known = true;
    }
    watch_noise(state, variances);
    if (!state->progress.noisy)
        keep_best(state);
    survey(state);
    go_on(state);
    return STATUS_OK;
}

// What it knows -----------------------------------------------------------------------------------

static bool best_candidate(const void *memory, double *variables) {
    const struct state *state = memory;
    const struct progress *p = &state->progress;
    if (!p->known)
        return false;
    if (p->noisy)
        mean_variables(state, variables);
    else
        memcpy(variables, state->record, state->space.variables * sizeof *variables);
    return true;
}

static double spread(const void *memory) {
    const struct state *state = memory;
    double sum = 0;
    for (size_t k = 0; k < state->space.variables; k++)
        sum += mf_cmaes_deviation(&state->distribution, k);
    return sum / (double)state->space.variables;
}

static double discard_above(const void *memory) {
    return ((const struct state *)memory)->progress.discard_above;
}

static bool settled(const void *memory) {
    return ((const struct state *)memory)->progress.settled != 0;
}

static size_t spans(void *memory, struct memory_span *span) {
    struct state *state = memory;
    struct cmaes_distribution *d = &state->distribution;
    const size_t n = d->variables, row = n * sizeof(double);
    size_t count = 0;
    state->sampled = 0; // another round may be read into the spans
    span[count++] = (struct memory_span){&state->progress, sizeof state->progress};
    span[count++] = (struct memory_span){&d->moments, sizeof d->moments};
    span[count++] = (struct memory_span){state->history, max_history(state) * sizeof(double)};
    span[count++] = (struct memory_span){state->record, row};
    span[count++] = (struct memory_span){d->mean, row};
    span[count++] = (struct memory_span){d->path_sigma, row};
    span[count++] = (struct memory_span){d->path, row};
    span[count++] = (struct memory_span){d->covariance, n * row};
    span[count++] = (struct memory_span){d->axes, n * row};
    span[count++] = (struct memory_span){d->lengths, row};
    return count;
}

const struct optimiser mf_cmaes_optimiser = {
    .name = "cma-es",
    .tables = (const struct field *const[]){mf_cmaes_fields, NULL},
    .parameters_size = sizeof(struct cmaes_parameters),
    .budget = "rounds",
    OPTIMISER_RECORD,
};
