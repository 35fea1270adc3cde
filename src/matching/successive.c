// SPDX-License-Identifier: GPL-3.0-or-later
//
// Potential and friction weight one after the other. In equilibrium g(r) follows from the potential
// alone, whatever the friction: pair friction and noise that balance each other keep the canonical
// ensemble (P. Español and P. Warren, Europhys. Lett. 30, 191 (1995)). So the potential is found
// first, by the inversion `auto` and from g(r), the pressure and the
// integrals of g alone; then it is held, and
// `gauss-newton` finds ω from what moves.
#include "matching/population.h"
#include "inversion/inversions.h"
#include "matching/matchings.h"
#include "observe/kirkwood_buff.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

struct parameters {
    struct population_parameters population; ///< of gauss-newton
    int64_t potential_particles;
    double potential_precision;
};

/// One of the two fits, with the problem that it has.
struct part {
    const struct inverse_method *method;
    struct inverse_problem problem;
    void *parameters, *state;
    bool created;
};

enum { PARTS = 2 }; // UNKNOWN_POTENTIAL and UNKNOWN_OMEGA

/// What is known of a part.
struct outcome {
    double error, noise, variance; ///< as in struct inverse_step
    bool converged, exhausted;
    uint64_t evaluations, engine_steps;
    char reason[INVERSE_REASON_SIZE];
};

struct state {
    const struct inverse_problem *problem;
    struct unknowns unknowns;
    struct part part[PARTS];
    struct table table;   ///< of the potential that is held
    bool has_table;       ///< it is made when it is needed
    double *curve[PARTS]; ///< shape [points]: the best so far
    double *error[PARTS]; ///< of them
    double *flat[PARTS];  ///< shape [INVERSE_FLAT, points]
    double *without_ramp; ///< shape [points of the potential]
    struct progress {
        uint32_t iteration;
        uint32_t begun; ///< iteration with which the second part began
        int stage;      ///< enum unknown_kind
        struct outcome outcome[PARTS];
        struct inverse_ramp ramp;
        enum inverse_start start;
        struct inverse_parameter parameter[INVERSE_PARAMETERS];
    } progress;
};

#define OWN(name) .offset = offsetof(struct parameters, name)
static const struct field own_fields[] = {
    {"potential_particles", FIELD_INTEGER, OWN(potential_particles), .initial = 0, .minimum = 0,
     .maximum = 1e7, .unit = "", .help = "\"particles\" of the method auto, which comes first"},
    {"potential_precision", FIELD_NUMBER, OWN(potential_precision), .initial = 0.004,
     .minimum = FIELD_ABOVE_ZERO, .maximum = 1, .unit = "",
     .help = "\"precision\" of the method auto"},
    FIELD_END,
};

static_assert(offsetof(struct parameters, population) == 0, "the first, says population.h");

static const char *const columns[] = {"finds_omega", "potential_error[1]", "omega_error[1]", NULL};

static const struct inverse_method *const methods[PARTS] = {&mf_automatic, &mf_gauss_newton};

static void destroy(void *memory) {
    struct state *state = memory;
    for (int kind = 0; kind < PARTS; kind++) {
        struct part *part = &state->part[kind];
        if (part->created)
            part->method->destroy(part->state);
        mf_memory_free(part->state);
        mf_memory_free(part->parameters);
        mf_memory_free(state->curve[kind]);
        mf_memory_free(state->error[kind]);
        mf_memory_free(state->flat[kind]);
    }
    mf_memory_free(state->without_ramp);
    mf_table_clear(&state->table);
    mf_unknowns_clear(&state->unknowns);
}

static bool is_of_potential(int target) {
    return target == TARGET_RDF || target == TARGET_PRESSURE || target == mf_kirkwood_buff_kind();
}

static enum status refuse(const struct inverse_method *method,
                          const struct inverse_problem *problem) {
    const char *why = NULL;
    size_t of_omega = 0;
    const bool has_densities =
        mf_many_body_find(problem->scene.interaction, problem->scene.interactions) != NULL;
    for (int target = 0; target < TARGETS; target++)
        of_omega += targets_ask(&problem->targets, target) && !is_of_potential(target);
    if (!problem->unknown[UNKNOWN_POTENTIAL].wanted || !problem->unknown[UNKNOWN_OMEGA].wanted ||
        mf_inverse_unknown_count(problem) > PARTS)
        why = "finds a potential and omega, and nothing else";
    else if (of_omega == 0)
        why = "finds omega from a target of motion, as \"etd\", that is fitted";
    else if (problem->scene.interactions > (int)has_densities)
        why = "fits only single beads with potentials of pairs and \"many_body\": leave out "
              "\"interactions\"";
    return why == NULL
               ? STATUS_OK
               : mf_status_fail(STATUS_BAD_INPUT, "method.name: \"%s\" %s", method->name, why);
}

/// Set the parameter of that name.
static void set(const struct part *part, const char *name, const void *value, size_t size) {
    for (const struct inverse_table *table = part->method->tables; table->fields; table++)
        for (const struct field *field = table->fields; field->name; field++)
            if (strcmp(field->name, name) == 0)
                memcpy((char *)part->parameters + table->offset + field->offset, value, size);
}

/// A part with the defaults of its method, for the unknown and the targets that are its own.
static enum status create_part(struct state *state, enum unknown_kind kind,
                               const struct parameters *own) {
    struct part *part = &state->part[kind];
    part->method = methods[kind];
    part->problem = *state->problem;
    part->problem.unknown[kind == UNKNOWN_OMEGA ? UNKNOWN_POTENTIAL : UNKNOWN_OMEGA].wanted = false;
    for (int target = 0; target < TARGETS; target++)
        if (is_of_potential(target) != (kind == UNKNOWN_POTENTIAL))
            part->problem.targets.target[target].count = 0;
    TRY((part->parameters = mf_memory_zeroed(1, part->method->parameters_size)) ? STATUS_OK
                                                                                : STATUS_NO_MEMORY);
    for (const struct inverse_table *table = part->method->tables; table->fields; table++)
        mf_fields_set_defaults(table->fields, (char *)part->parameters + table->offset);
    if (kind == UNKNOWN_POTENTIAL) {
        set(part, "particles", &own->potential_particles, sizeof own->potential_particles);
        set(part, "precision", &own->potential_precision, sizeof own->potential_precision);
    } else {
        memcpy(part->parameters, &own->population, sizeof own->population);
        part->problem.scene.potential = &state->table;
    }
    TRY((part->state = mf_memory_zeroed(1, part->method->state_size)) ? STATUS_OK
                                                                      : STATUS_NO_MEMORY);
    part->created = true;
    return part->method->create(part->state, part->method, &part->problem, part->parameters);
}

static enum status create(void *memory, const struct inverse_method *method,
                          const struct inverse_problem *problem, const void *parameters) {
    struct state *state = memory;
    state->problem = problem;
    TRY(refuse(method, problem));
    TRY(mf_unknowns_init(&state->unknowns, problem));
    for (int kind = 0; kind < PARTS; kind++) {
        const size_t points = mf_unknowns_points(&state->unknowns, kind);
        struct outcome *outcome = &state->progress.outcome[kind];
        outcome->error = outcome->noise = outcome->variance = NAN;
        TRY_ARRAY(state->curve[kind], points);
        TRY_ARRAY(state->error[kind], points);
        TRY_ARRAY(state->flat[kind], INVERSE_FLAT * points);
        for (size_t k = 0; k < points; k++)
            state->error[kind][k] = NAN;
        for (size_t k = 0; k < INVERSE_FLAT * points; k++)
            state->flat[kind][k] = NAN;
        TRY(create_part(state, kind, parameters));
        mf_unknowns_start(&state->unknowns, kind, state->curve[kind]);
    }
    TRY_ARRAY(state->without_ramp, mf_unknowns_points(&state->unknowns, UNKNOWN_POTENTIAL));
    for (int n = 0; n < INVERSE_PARAMETERS; n++)
        state->progress.parameter[n].value = state->progress.parameter[n].error = NAN;
    return STATUS_OK;
}

// A step ------------------------------------------------------------------------------------------

static void copy(double *to, const double *from, size_t count) {
    if (from)
        memcpy(to, from, count * sizeof *to);
}

/// Keep what a part has found so far.
static void take(struct state *state, enum unknown_kind kind, const struct inverse_step *step) {
    const size_t points = mf_unknowns_points(&state->unknowns, kind);
    struct outcome *outcome = &state->progress.outcome[kind];
    copy(state->curve[kind], step->curve[kind], points);
    copy(state->error[kind], step->curve_error[kind], points);
    copy(state->flat[kind], step->curve_flat[kind], INVERSE_FLAT * points);
    *outcome = (struct outcome){.error = step->error,
                                .noise = step->noise,
                                .variance = step->variance,
                                .converged = step->converged,
                                .exhausted = step->exhausted,
                                .evaluations = step->evaluations,
                                .engine_steps = step->engine_steps};
    memcpy(outcome->reason, step->reason, sizeof outcome->reason);
    if (kind == UNKNOWN_POTENTIAL) {
        copy(state->without_ramp, step->without_ramp, points);
        state->progress.ramp = step->ramp;
        state->progress.start = step->start;
    } else {
        memcpy(state->progress.parameter, step->parameter, sizeof step->parameter);
    }
}

/// Σ (w rms)² of a part's targets and their number, from its error (mf_targets_error).
static double squares_of(const struct inverse_problem *problem, double error, size_t *count) {
    const struct targets *targets = &problem->targets;
    *count = mf_targets_count(targets);
    for (int target = 0; target < TARGETS && *count == 1; target++)
        if (targets_ask(targets, target))
            return pow(mf_targets_weight(&targets->target[target]) * error, 2);
    return (double)*count * error * error;
}

/// Errors of the parts so far as that of all their targets together.
static void join(const struct state *state, struct inverse_step *step) {
    double errors = 0, noises = 0, variance = 0;
    size_t all = 0, count;
    for (int kind = 0; kind <= state->progress.stage; kind++) {
        const struct outcome *outcome = &state->progress.outcome[kind];
        const double unit = squares_of(&state->part[kind].problem, 1, &count);
        errors += unit * outcome->error * outcome->error;
        noises += unit * outcome->noise * outcome->noise;
        variance += pow(unit * outcome->error, 2) * outcome->variance;
        all += count;
    }
    step->error = sqrt(errors / (double)all);
    step->noise = sqrt(noises / (double)all);
    step->variance = errors > 0 ? variance / (errors * (double)all) : 0;
}

/// Both must have settled.
static void conclude(const struct state *state, struct inverse_step *step) {
    const struct outcome *first = &state->progress.outcome[UNKNOWN_POTENTIAL],
                         *second = &state->progress.outcome[UNKNOWN_OMEGA];
    step->finished = true;
    step->converged = first->converged && second->converged;
    step->exhausted = !step->converged && (first->converged || first->exhausted) &&
                      (second->converged || second->exhausted);
    const bool both = first->reason[0] && second->reason[0];
    snprintf(step->reason, sizeof step->reason, "%s%.100s%s%s%.100s",
             first->reason[0] ? "the potential: " : "", first->reason, both ? "; " : "",
             second->reason[0] ? "omega: " : "", second->reason);
}

static void describe(struct state *state, int stage, bool finished, struct inverse_step *step) {
    const struct progress *progress = &state->progress;
    const struct outcome *outcome = progress->outcome;
    *step = (struct inverse_step){
        .iteration = progress->iteration,
        .evaluations = outcome[0].evaluations + outcome[1].evaluations,
        .engine_steps = outcome[0].engine_steps + outcome[1].engine_steps,
        .extra = {stage, outcome[0].error, outcome[1].error},
        .without_ramp = state->without_ramp,
        .ramp = progress->ramp,
        .start = progress->start,
    };
    memcpy(step->parameter, progress->parameter, sizeof step->parameter);
    for (int kind = 0; kind < PARTS; kind++) {
        step->curve[kind] = state->curve[kind];
        step->curve_error[kind] = state->error[kind];
        step->curve_flat[kind] = state->flat[kind];
    }
    join(state, step);
    if (finished)
        conclude(state, step);
}

/// An error of the part at work as that of all targets so far, as the iterations tell it; what is
/// not known stays so.
static double among_all(const struct state *state, double error) {
    double errors = 0;
    size_t all = 0, count;
    for (int kind = 0; kind <= state->progress.stage; kind++) {
        const double of_part =
            kind < state->progress.stage ? state->progress.outcome[kind].error : error;
        errors += squares_of(&state->part[kind].problem, of_part, &count);
        all += count;
    }
    return sqrt(errors / (double)all);
}

/// The second part counts its iterations from 0, and each knows its own targets alone.
struct listening {
    const struct inverse_listener *listener;
    const struct state *state;
};

static void report(void *context, const struct inverse_progress *progress) {
    const struct listening *listening = context;
    struct inverse_progress own = *progress;
    own.iteration += listening->state->progress.begun;
    own.iterations += listening->state->progress.begun;
    own.best = among_all(listening->state, own.best);
    own.min = among_all(listening->state, own.min);
    own.mean = among_all(listening->state, own.mean);
    listening->listener->report(listening->listener->context, &own);
}

static enum status iterate(void *memory, struct inverse_step *step,
                           const struct inverse_listener *listener) {
    struct state *state = memory;
    struct progress *progress = &state->progress;
    const int stage = progress->stage;
    const struct part *part = &state->part[stage];
    struct listening listening = {listener, state};
    const struct inverse_listener own = {report, &listening};
    struct inverse_step inner;
    if (stage == UNKNOWN_OMEGA && !state->has_table) {
        TRY(mf_potential_grid_table(&state->unknowns.potential, state->curve[UNKNOWN_POTENTIAL],
                                    &state->table));
        state->has_table = true;
    }
    TRY(part->method->iterate(part->state, &inner, &own));
    take(state, stage, &inner);
    describe(state, stage, inner.finished && stage == UNKNOWN_OMEGA, step);
    progress->iteration++;
    if (inner.finished && stage == UNKNOWN_POTENTIAL) {
        progress->stage = UNKNOWN_OMEGA;
        progress->begun = progress->iteration;
        step->begins =
            "the potential is found; omega is next: from here on \"error\" includes its targets";
    }
    return STATUS_OK;
}

static size_t spans(void *memory, struct memory_span *span) {
    struct state *state = memory;
    size_t n = 0;
    span[n++] = (struct memory_span){&state->progress, sizeof state->progress};
    for (int kind = 0; kind < PARTS; kind++) {
        const size_t bytes = mf_unknowns_points(&state->unknowns, kind) * sizeof(double);
        span[n++] = (struct memory_span){state->curve[kind], bytes};
        span[n++] = (struct memory_span){state->error[kind], bytes};
        span[n++] = (struct memory_span){state->flat[kind], INVERSE_FLAT * bytes};
        n += state->part[kind].method->spans(state->part[kind].state, span + n);
    }
    span[n++] = (struct memory_span){state->without_ramp,
                                     mf_unknowns_points(&state->unknowns, UNKNOWN_POTENTIAL) *
                                         sizeof(double)};
    return n;
}

const struct inverse_method mf_successive = {
    .name = "successive",
    .summary = "the potential from g(r) by auto, then with it omega from the dynamics by "
               "gauss-newton; g(r) does not depend on omega (Espanol and Warren 1995)",
    POPULATION_RECORD,
    .tables = (const struct inverse_table[]){{own_fields, 0, NULL},
                                             {mf_population_fields, 0, "candidates"},
                                             {mf_population_round_fields, 0, NULL},
                                             {NULL, 0, NULL}},
    .parameters_size = sizeof(struct parameters),
    .state_size = sizeof(struct state),
};
