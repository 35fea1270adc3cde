// SPDX-License-Identifier: GPL-3.0-or-later
//
// Algorithms of NLopt (S. G. Johnson, The NLopt nonlinear-optimization package) by ask and tell.
// NLopt owns its loop, so it runs in a coroutine, and its own random numbers are of that thread. A
// checkpoint keeps the errors that were told: a new state runs the algorithm again on them, in
// milliseconds, and arrives at the same candidate. Rounds are of one candidate. Inside, variables
// are fractions of their range.
#include "base/rng.h"
#include "optimise/coroutine.h"
#include "optimise/optimiser.h"

#include <nlopt.h>

#include <string.h>

enum { MAX_EVALUATIONS = 1000000 };

/// Parallel to the names of the field.
static const struct algorithm {
    nlopt_algorithm number;
    bool local;  ///< ends once its steps are small
    bool models; ///< interpolates errors
} algorithms[] = {
    {NLOPT_GN_ESCH, false, false},  {NLOPT_GN_CRS2_LM, false, false},
    {NLOPT_GN_ISRES, false, false}, {NLOPT_GN_DIRECT_L_RAND, false, false},
    {NLOPT_LN_SBPLX, true, false},  {NLOPT_LN_BOBYQA, true, true},
    {NLOPT_LN_COBYLA, true, true},
};

static const char *const names[] = {"GN_ESCH",  "GN_CRS2_LM", "GN_ISRES",  "GN_DIRECT_L_RAND",
                                    "LN_SBPLX", "LN_BOBYQA",  "LN_COBYLA", NULL};

enum { SBPLX = 4 }; ///< index of the default

#define MEMBER(name) .offset = offsetof(struct nlopt_parameters, name)
const struct field mf_nlopt_fields[] = {
    {"algorithm", FIELD_CHOICE, MEMBER(algorithm), .choices = names, .initial = SBPLX, .unit = "",
     .help = "algorithm; GN_: global, LN_: local"},
    {"evaluations", FIELD_INTEGER, MEMBER(evaluations), .initial = 1000, .minimum = 1,
     .maximum = MAX_EVALUATIONS, .unit = "", .help = "most evaluations"},
    {"step", FIELD_NUMBER, MEMBER(step), .initial = 0.2, .minimum = FIELD_ABOVE_ZERO,
     .maximum = 0.5, .unit = "", .help = "first step of LN_, as a fraction of the range"},
    {"tolerance", FIELD_NUMBER, MEMBER(tolerance), .initial = 1e-6, .minimum = 0, .maximum = 1,
     .unit = "", .help = "change of all variables at which LN_ ends, likewise"},
    FIELD_END,
};

/// Candidates that spread looks at.
enum { RECENT = 16 };

struct state {
    struct nlopt_parameters parameters;
    struct optimiser_space space;
    double *start;     ///< shape [variables], fractions
    double *told;      ///< errors, shape [evaluations]
    double *variables; ///< the candidate, shape [variables]
    double *best;      ///< shape [variables]
    double *recent;    ///< the last candidates, a ring, shape [RECENT, variables]
    struct progress {
        uint64_t told;
        double best_error; ///< OPTIMISER_FAILED: none
    } progress;
    struct coroutine *loop; ///< the algorithm, or NULL
    uint64_t played;        ///< told errors that it knows
    bool is_over;           ///< whether it had no question when it was asked last
    nlopt_result result;    ///< what it says then
};

// Inside the coroutine ----------------------------------------------------------------------------

/// What NLopt's function sees.
struct call {
    struct coroutine *self;
    nlopt_opt optimiser;
    bool models;
    double min, max; ///< of the errors that could be measured
};

/// A failed candidate tells a model that it is as far above the worst as that is above the best:
/// 1e9 would bend the whole model.
static double seen_error(struct call *call, double error) {
    if (error < OPTIMISER_FAILED) {
        call->min = fmin(call->min, error);
        call->max = fmax(call->max, error);
        return error;
    }
    const bool measured = call->max >= call->min;
    return call->models && measured ? 2 * call->max - call->min : OPTIMISER_FAILED;
}

static double measure(unsigned variables, const double *x, double *gradient, void *context) {
    struct call *call = context;
    double error = OPTIMISER_FAILED;
    (void)variables;
    (void)gradient;
    if (!mf_coroutine_measure(call->self, x, &error))
        nlopt_force_stop(call->optimiser);
    return seen_error(call, error);
}

/// An algorithm as the parameters want it; NULL if there is no memory.
static nlopt_opt prepare(const struct state *state, struct call *call) {
    const struct algorithm *algorithm = &algorithms[state->parameters.algorithm];
    nlopt_opt o = nlopt_create(algorithm->number, (unsigned)state->space.variables);
    if (o == NULL)
        return NULL;
    call->optimiser = o;
    call->models = algorithm->models;
    if (nlopt_set_lower_bounds1(o, 0) < 0 || nlopt_set_upper_bounds1(o, 1) < 0 ||
        nlopt_set_initial_step1(o, state->parameters.step) < 0 ||
        nlopt_set_xtol_abs1(o, algorithm->local ? state->parameters.tolerance : 0) < 0 ||
        nlopt_set_maxeval(o, (int)state->parameters.evaluations) < 0 ||
        nlopt_set_min_objective(o, measure, call) < 0) {
        nlopt_destroy(o);
        return NULL;
    }
    return o;
}

/// The algorithm from its beginning to its end. However it ends, the best candidate stands;
/// `result` tells whether its steps had become small.
static void body(struct coroutine *self, void *context) {
    struct state *state = context;
    struct call call = {.self = self, .min = HUGE_VAL, .max = -HUGE_VAL};
    nlopt_opt optimiser = prepare(state, &call);
    const struct rng_block seed = mf_rng_philox(state->space.seed, RNG_INITIAL, 0, 0, 0);
    double *x = mf_memory_zeroed(state->space.variables, sizeof *x), min;
    if (optimiser && x) {
        memcpy(x, state->start, state->space.variables * sizeof *x);
        nlopt_srand(seed.word[0]); // it takes 32 bits: all 64 are mixed into them
        state->result = nlopt_optimize(optimiser, x, &min);
    }
    mf_memory_free(x);
    nlopt_destroy(optimiser);
}

// Outside -----------------------------------------------------------------------------------------

static uint32_t max_rounds(const void *parameters, size_t variables) {
    (void)variables;
    return (uint32_t)((const struct nlopt_parameters *)parameters)->evaluations;
}

static void destroy(void *memory) {
    struct state *state = memory;
    mf_coroutine_end(state->loop);
    mf_memory_free(state->start);
    mf_memory_free(state->told);
    mf_memory_free(state->variables);
    mf_memory_free(state->best);
    mf_memory_free(state->recent);
    *state = (struct state){0};
}

static enum status create(void *memory, const struct optimiser_space *space,
                          const void *parameters) {
    struct state *state = memory;
    state->parameters = *(const struct nlopt_parameters *)parameters;
    TRY(mf_optimiser_check_space(space));
    state->space = *space;
    state->space.start = NULL;
    state->progress.best_error = OPTIMISER_FAILED;
    TRY_ARRAY(state->start, space->variables);
    TRY_ARRAY(state->told, (size_t)state->parameters.evaluations);
    TRY_ARRAY(state->variables, space->variables);
    TRY_ARRAY(state->best, space->variables);
    TRY_ARRAY(state->recent, RECENT * space->variables);
    for (size_t k = 0; k < space->variables; k++)
        state->start[k] = mf_optimiser_start(space, k);
    return STATUS_OK;
}

/// The algorithm's next candidate as fractions, NULL if it has finished. Begins the algorithm if it
/// has not begun, and tells it what it has not been told: the last error, or, after a restart, all.
static enum status catch_up(struct state *state, const double **question) {
    if (state->loop == NULL)
        state->loop = mf_coroutine_begin(body, state);
    if (state->loop == NULL)
        return STATUS_NO_MEMORY;
    for (*question = mf_coroutine_question(state->loop); *question != NULL;
         *question = mf_coroutine_question(state->loop)) {
        if (state->played == state->progress.told)
            break;
        mf_coroutine_answer(state->loop, state->told[state->played++]);
    }
    if (*question == NULL && state->played == 0)
        return mf_status_fail(STATUS_BAD_INPUT, "nlopt: %s cannot begin with %zu variables",
                              names[state->parameters.algorithm], state->space.variables);
    return STATUS_OK;
}

static enum status ask(void *memory, struct optimiser_round *round) {
    struct state *state = memory;
    const double *question = NULL;
    *round = (struct optimiser_round){state->variables, 0};
    if (state->progress.told >= (uint64_t)state->parameters.evaluations)
        return STATUS_OK;
    TRY(catch_up(state, &question));
    for (size_t k = 0; question && k < state->space.variables; k++)
        state->variables[k] = optimiser_variable(&state->space, question[k]);
    round->count = question != NULL;
    state->is_over = question == NULL;
    return STATUS_OK;
}

static enum status tell(void *memory, const double *errors, const double *variances) {
    struct state *state = memory;
    struct optimiser_round round;
    const size_t row = state->space.variables * sizeof(double);
    (void)variances; // NLopt's algorithms know no noise
    TRY(ask(state, &round));
    if (round.count == 0)
        return STATUS_OK;
    const double error = optimiser_error(errors[0]);
    if (error < state->progress.best_error) {
        state->progress.best_error = error;
        memcpy(state->best, state->variables, row);
    }
    memcpy(state->recent + (state->progress.told % RECENT) * state->space.variables,
           state->variables, row);
    state->told[state->progress.told++] = error;
    return STATUS_OK;
}

static bool best_candidate(const void *memory, double *variables) {
    const struct state *state = memory;
    if (state->progress.best_error >= OPTIMISER_FAILED)
        return false;
    memcpy(variables, state->best, state->space.variables * sizeof *variables);
    return true;
}

/// Standard deviation of a variable over the last candidates, a mean over variables.
static double spread(const void *memory) {
    const struct state *state = memory;
    const size_t n = state->space.variables;
    const size_t known = state->progress.told < RECENT ? state->progress.told : RECENT;
    double sum = 0;
    for (size_t variable = 0; variable < n && known > 0; variable++) {
        double mean = 0, squares = 0;
        for (size_t k = 0; k < known; k++)
            mean += state->recent[k * n + variable] / (double)known;
        for (size_t k = 0; k < known; k++) {
            const double away = state->recent[k * n + variable] - mean;
            squares += away * away;
        }
        sum += sqrt(squares / (double)known);
    }
    return sum / (double)n / (state->space.maximum - state->space.minimum);
}

/// Each error decides where these algorithms go next.
static double discard_above(const void *memory) {
    (void)memory;
    return HUGE_VAL;
}

/// It asks for nothing any more although it might: steps below the tolerance, or below rounding.
static bool settled(const void *memory) {
    const struct state *state = memory;
    return state->is_over && state->progress.told < (uint64_t)state->parameters.evaluations &&
           (state->result == NLOPT_XTOL_REACHED || state->result == NLOPT_FTOL_REACHED);
}

/// It stopped before its steps were small: the noise of errors is rounding to it.
static bool gave_up(const void *memory) {
    const struct state *state = memory;
    return state->is_over && state->progress.told < (uint64_t)state->parameters.evaluations &&
           !settled(memory);
}

static size_t spans(void *memory, struct memory_span *span) {
    struct state *state = memory;
    const size_t row = state->space.variables * sizeof(double);
    size_t n = 0;
    span[n++] = (struct memory_span){&state->progress, sizeof state->progress};
    span[n++] =
        (struct memory_span){state->told, (size_t)state->parameters.evaluations * sizeof(double)};
    span[n++] = (struct memory_span){state->best, row};
    span[n++] = (struct memory_span){state->recent, RECENT * row};
    return n;
}

const struct optimiser mf_nlopt_optimiser = {
    .name = "nlopt",
    .tables = (const struct field *const[]){mf_nlopt_fields, NULL},
    .parameters_size = sizeof(struct nlopt_parameters),
    .budget = "evaluations",
    OPTIMISER_RECORD,
    .gave_up = gave_up,
};
