// SPDX-License-Identifier: GPL-3.0-or-later
//
// A potential or a friction weight as a formula. First the curve: of a potential an inversion of
// g(r) with its linear response, which says how far from the target g(r) would be by any other
// potential near it; of a friction weight the start that the run file gives. Then formulas of it,
// by genetic programming (optimise/programming.h). What is simulated is their front alone, the best
// formula of each length. A formula that is short enough to be read may be far from the curve where
// g(r) hardly sees it, farther than a linear response reaches: so the best one takes the place of
// the curve, with the differences of g(r) that its simulation shows, and the next cycle begins.
#include "formulas_state.h"
#include "inversion/inversions.h"
#include "matching/matchings.h"
#include "observe/kirkwood_buff.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define OWN(name) .offset = offsetof(struct formulas_parameters, name)
static const struct field own_fields[] = {
    {"checks", FIELD_INTEGER, OWN(checks), .initial = 2, .minimum = 1, .maximum = 100, .unit = "",
     .help = "simulations of each formula of the front"},
    {"cycles", FIELD_INTEGER, OWN(cycles), .initial = 3, .minimum = 1, .maximum = 100, .unit = "",
     .help = "cycles of breeding and simulating (potential only)"},
    {"curve_particles", FIELD_INTEGER, OWN(curve_particles), .initial = 0, .minimum = 0,
     .maximum = 1e7, .unit = "",
     .help = "\"particles\" of the method auto, which finds the potential's curve"},
    {"curve_precision", FIELD_NUMBER, OWN(curve_precision), .initial = 0.004,
     .minimum = FIELD_ABOVE_ZERO, .maximum = 1, .unit = "",
     .help = "\"precision\" of the method auto"},
    FIELD_END,
};

static_assert(offsetof(struct formulas_parameters, population) == 0,
              "the first, says population.h");

static const char *const columns[] = {"stage", "cycle", "nodes", "expected", NULL};

static const struct inverse_method *const inner_method = &mf_automatic;

static void destroy(void *memory) {
    struct formulas_state *state = memory;
    struct formulas_inner *inner = &state->inner;
    if (inner->created)
        inner->method->destroy(inner->state);
    mf_memory_free(inner->state);
    mf_memory_free(inner->parameters);
    mf_programming_clear(&state->programming);
    mf_unknowns_clear(&state->unknowns);
    double *arrays[] = {state->y,     state->weight,      state->response, state->offset,
                        state->curve, state->curve_error, state->target,   state->found,
                        state->start, state->softness};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++)
        mf_memory_free(arrays[k]);
}

/// What it can do nothing with.
static enum status refuse(const struct inverse_method *method,
                          const struct inverse_problem *problem) {
    const struct unknown *omega = &problem->unknown[UNKNOWN_OMEGA];
    const bool potential = problem->unknown[UNKNOWN_POTENTIAL].wanted;
    const char *why = NULL;
    if (potential == omega->wanted || mf_inverse_unknown_count(problem) > 1)
        why = "finds the formula of one unknown: the potential, or omega";
    else if (composition_is_mixed(&problem->scene.composition))
        why = "finds the formula of beads that are all alike";
    else if (potential && problem->scene.interactions > 0)
        why = "fits only systems of pair potentials: leave out \"interactions\"";
    else if (omega->wanted && omega->start[0] == NULL)
        why = "needs the curve of which it finds a formula: unknowns.omega.start";
    return why == NULL
               ? STATUS_OK
               : mf_status_fail(STATUS_BAD_INPUT, "method.name: \"%s\" %s", method->name, why);
}

/// Set the parameter of that name in the tables of the inner method.
static void set_inner(struct formulas_inner *inner, const char *name, int64_t whole,
                      double number) {
    for (const struct inverse_table *table = inner->method->tables; table->fields; table++)
        for (const struct field *field = table->fields; field->name; field++) {
            char *place = (char *)inner->parameters + table->offset + field->offset;
            if (strcmp(field->name, name) != 0)
                continue;
            if (field->type == FIELD_INTEGER)
                memcpy(place, &whole, sizeof whole);
            else
                memcpy(place, &number, sizeof number);
        }
}

/// The inversion of g(r), and of the pressure and the integrals of it if they are fitted.
static enum status create_inner(struct formulas_state *state) {
    struct formulas_inner *inner = &state->inner;
    inner->method = inner_method;
    inner->problem = *state->problem;
    for (int kind = 0; kind < TARGETS; kind++)
        if (kind != TARGET_RDF && kind != TARGET_PRESSURE && kind != mf_kirkwood_buff_kind())
            inner->problem.targets.target[kind].count = 0;
    TRY((inner->parameters = mf_memory_zeroed(1, inner->method->parameters_size))
            ? STATUS_OK
            : STATUS_NO_MEMORY);
    for (const struct inverse_table *table = inner->method->tables; table->fields; table++)
        mf_fields_set_defaults(table->fields, (char *)inner->parameters + table->offset);
    set_inner(inner, "particles", state->own.curve_particles, 0);
    set_inner(inner, "precision", 0, state->own.curve_precision);
    TRY((inner->state = mf_memory_zeroed(1, inner->method->state_size)) ? STATUS_OK
                                                                        : STATUS_NO_MEMORY);
    inner->created = true;
    return inner->method->create(inner->state, inner->method, &inner->problem, inner->parameters);
}

/// The points of the curve that a formula is to describe: the known bins of a potential; all of a
/// friction weight but the last, where it may end in a step.
static void find_points(struct formulas_state *state) {
    const struct potential_grid *grid = &state->unknowns.potential;
    const bool potential = state->kind == UNKNOWN_POTENTIAL;
    const size_t points = mf_unknowns_points(&state->unknowns, state->kind);
    const double *r = mf_unknowns_r(&state->unknowns, state->kind);
    state->first = potential ? grid->core[0] : 0;
    state->count = points - 1 - state->first;
    state->points = (struct programming_points){
        .count = state->count,
        .r = r + state->first,
        .rows = (potential ? 2 : 1) * state->count,
        .zero = potential ? r[points - 1] : NAN,
    };
}

static enum status allocate(struct formulas_state *state) {
    const size_t points = mf_unknowns_points(&state->unknowns, state->kind);
    state->features = mf_targets_features(&state->problem->targets);
    TRY_ARRAY(state->y, state->count);
    TRY_ARRAY(state->weight, state->count);
    TRY_ARRAY(state->response, 2 * state->count * state->count);
    TRY_ARRAY(state->offset, 2 * state->count);
    TRY_ARRAY(state->start, state->count);
    TRY_ARRAY(state->softness, state->count);
    TRY_ARRAY(state->curve, points);
    TRY_ARRAY(state->curve_error, points);
    TRY_ARRAY(state->target, state->features);
    TRY_ARRAY(state->found, (PROGRAMMING_MAX_NODES + 1) * state->features);
    state->points.y = state->y;
    state->points.offset = state->offset;
    state->points.softness = state->softness;
    if (state->kind == UNKNOWN_POTENTIAL)
        state->points.response = state->response;
    else
        state->points.weight = state->weight;
    return STATUS_OK;
}

/// Where a g below 1 says that pairs are few, they see differences the less the higher they are.
/// Elsewhere the response is linear: else a ramp, which g(r) does not see, would seem to matter.
static void soften(struct formulas_state *state) {
    for (size_t k = 0; k < state->count; k++) {
        const double g = state->target[state->first + k];
        state->softness[k] = g < 1 ? state->problem->scene.temperature / (1 - g) : 0;
    }
}

static enum status create(void *memory, const struct inverse_method *method,
                          const struct inverse_problem *problem, const void *parameters) {
    struct formulas_state *state = memory;
    state->own = *(const struct formulas_parameters *)parameters;
    state->problem = problem;
    state->kind = problem->unknown[UNKNOWN_POTENTIAL].wanted ? UNKNOWN_POTENTIAL : UNKNOWN_OMEGA;
    state->progress.error = state->progress.noise = NAN;
    TRY(refuse(method, problem));
    TRY(mf_unknowns_init(&state->unknowns, problem));
    find_points(state);
    TRY(allocate(state));
    mf_targets_take_features(&problem->targets, NULL, state->target, NULL);
    if (state->kind == UNKNOWN_POTENTIAL) {
        soften(state);
        TRY(create_inner(state));
    }
    return mf_programming_init(&state->programming, &state->points, &state->own.programming,
                               problem->seed, problem->threads, problem->scene.cancel);
}

// The curve ---------------------------------------------------------------------------------------

/// What a difference from the inversion's curve by 1 k_B T costs, where g(r) knows it, as if g(r)
/// were off by as much. g(r) hardly sees changes that are smooth; without this a formula for water
/// was 4 k_B T away, its pressure 20 times that of the curve.
static const double curve_penalty = 0.004;

/// The residuals of a potential become those of g(r): δg_a = −Σ_b C_ab δΦ_b/(k_B T S_ideal,a);
/// after them stand the differences from the curve. Both count half of the rows.
static void take_response(struct formulas_state *state, const struct inverse_response *from) {
    const double temperature = state->problem->scene.temperature;
    for (size_t a = 0; a < state->count; a++)
        for (size_t b = 0; b < state->count; b++)
            state->response[a * state->count + b] = -M_SQRT2 *
                                                    from->covariance[a * state->count + b] /
                                                    (temperature * from->ideal[state->first + a]);
    for (size_t a = 0; a < state->count; a++) {
        const double g = state->target[state->first + a];
        state->response[(state->count + a) * state->count + a] =
            M_SQRT2 * curve_penalty / temperature * fmin(1, fmax(0, g));
    }
}

static void take_curve(struct formulas_state *state, const struct inverse_step *step) {
    const size_t points = mf_unknowns_points(&state->unknowns, state->kind);
    memcpy(state->curve, step->curve[UNKNOWN_POTENTIAL], points * sizeof *state->curve);
    if (step->curve_error[UNKNOWN_POTENTIAL])
        memcpy(state->curve_error, step->curve_error[UNKNOWN_POTENTIAL],
               points * sizeof *state->curve_error);
    memcpy(state->y, state->curve + state->first, state->count * sizeof *state->y);
    memcpy(state->start, state->y, state->count * sizeof *state->start);
    take_response(state, &step->response);
    state->progress.evaluations = step->evaluations;
    state->progress.engine_steps = step->engine_steps;
    state->progress.error = step->error;
    state->progress.noise = step->noise;
}

/// One iteration of the inversion; a friction weight has its curve at once.
static enum status find_curve(struct formulas_state *state,
                              const struct inverse_listener *listener) {
    struct inverse_step step;
    if (state->kind == UNKNOWN_OMEGA) {
        mf_unknowns_start(&state->unknowns, UNKNOWN_OMEGA, state->curve);
        memcpy(state->y, state->curve + state->first, state->count * sizeof *state->y);
        for (size_t k = 0; k < state->count; k++)
            state->weight[k] = 1;
        state->progress.stage = FORMULAS_BREED;
        return STATUS_OK;
    }
    TRY(state->inner.method->iterate(state->inner.state, &step, listener));
    take_curve(state, &step);
    state->points.noise = step.noise;
    if (step.finished)
        state->progress.stage = FORMULAS_BREED;
    return STATUS_OK;
}

// Breeding ----------------------------------------------------------------------------------------

/// The best formula so far, whatever its length, until simulations say more.
static void show_best(struct formulas_state *state) {
    const struct programming_member *best = NULL;
    for (int length = 1; length <= PROGRAMMING_MAX_NODES; length++) {
        const struct programming_member *other = &state->programming.best[length];
        if (isfinite(other->error) && (best == NULL || other->error < best->error))
            best = other;
    }
    if (best == NULL || state->progress.nearest > 0)
        return;
    mf_formulas_make_curve(state, &best->expression, state->curve);
    state->progress.error = best->error;
}

static enum status breed(struct formulas_state *state) {
    TRY(mf_programming_round(&state->programming));
    show_best(state);
    if (state->programming.round % (uint64_t)state->own.programming.rounds == 0)
        state->progress.stage = FORMULAS_MEASURE;
    return STATUS_OK;
}

// A step ------------------------------------------------------------------------------------------

static void conclude(const struct formulas_state *state, struct inverse_step *step) {
    step->finished = true;
    step->exhausted = state->progress.chosen > 0;
    if (step->exhausted)
        snprintf(step->reason, sizeof step->reason,
                 "the shortest formula within %d standard errors of the best one of at most %lld "
                 "nodes; its error is %.2g (statistical error %.2g)",
                 FORMULAS_CHANCE, (long long)state->own.programming.nodes, step->error,
                 step->noise);
    else
        snprintf(step->reason, sizeof step->reason,
                 "no formula of at most %lld nodes was close enough to the curve to be simulated, "
                 "or every simulation failed, for example because \"equilibration\" is too short",
                 (long long)state->own.programming.nodes);
}

static void describe(const struct formulas_state *state, uint32_t stage, bool finished,
                     struct inverse_step *step) {
    const struct formulas_progress *progress = &state->progress;
    const struct formulas_member *chosen = &state->front[progress->chosen];
    const bool known = progress->chosen > 0;
    *step = (struct inverse_step){
        .iteration = progress->iteration,
        .evaluations = progress->evaluations,
        .engine_steps = progress->engine_steps,
        .error = progress->error,
        .noise = progress->noise,
        .variance = progress->variance,
        .extra = {stage, progress->cycle, known ? chosen->formula.expression.length : NAN,
                  known ? chosen->formula.error : NAN},
        .formula = known ? state->formula : NULL,
    };
    for (int n = 0; n < INVERSE_PARAMETERS; n++)
        step->parameter[n].value = step->parameter[n].error = NAN;
    step->curve[state->kind] = state->curve;
    if (stage == FORMULAS_CURVE && state->kind == UNKNOWN_POTENTIAL)
        step->curve_error[state->kind] = state->curve_error;
    if (finished)
        conclude(state, step);
}

static enum status iterate(void *memory, struct inverse_step *step,
                           const struct inverse_listener *listener) {
    struct formulas_state *state = memory;
    const uint32_t stage = state->progress.stage;
    bool finished = false;
    switch (stage) {
    case FORMULAS_CURVE:
        TRY(find_curve(state, listener));
        break;
    case FORMULAS_BREED:
        TRY(breed(state));
        break;
    default:
        TRY(mf_formulas_simulate(state, listener, &finished));
    }
    describe(state, stage, finished, step);
    state->progress.iteration++;
    return STATUS_OK;
}

static size_t spans(void *memory, struct memory_span *span) {
    struct formulas_state *state = memory;
    const size_t points = mf_unknowns_points(&state->unknowns, state->kind);
    const size_t of_curve = state->count * sizeof(double);
    size_t n = 0;
    span[n++] = (struct memory_span){&state->progress, sizeof state->progress};
    span[n++] = (struct memory_span){state->formula, sizeof state->formula};
    span[n++] = (struct memory_span){&state->points.noise, sizeof state->points.noise};
    span[n++] = (struct memory_span){state->front, sizeof state->front};
    span[n++] = (struct memory_span){state->y, of_curve};
    span[n++] = (struct memory_span){state->weight, of_curve};
    span[n++] = (struct memory_span){state->start, of_curve};
    span[n++] = (struct memory_span){state->offset, 2 * of_curve};
    span[n++] = (struct memory_span){state->response, 2 * state->count * of_curve};
    span[n++] = (struct memory_span){state->curve, points * sizeof(double)};
    span[n++] = (struct memory_span){state->curve_error, points * sizeof(double)};
    span[n++] = (struct memory_span){state->found, (PROGRAMMING_MAX_NODES + 1) * state->features *
                                                       sizeof(double)};
    n += mf_programming_spans(&state->programming, span + n);
    if (state->inner.created)
        n += state->inner.method->spans(state->inner.state, span + n);
    return n;
}

const struct inverse_method mf_formulas = {
    .name = "formulas",
    .summary = "a formula of r by genetic programming; J. R. Koza (1992)",
    POPULATION_RECORD,
    .tables =
        (const struct inverse_table[]){
            {mf_programming_fields, offsetof(struct formulas_parameters, programming), NULL},
            {own_fields, 0, NULL},
            {mf_population_fields, 0, "candidates"},
            {NULL, 0, NULL}},
    .parameters_size = sizeof(struct formulas_parameters),
    .state_size = sizeof(struct formulas_state),
    .write = mf_formulas_write,
};
