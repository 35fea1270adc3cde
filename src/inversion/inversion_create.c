// SPDX-License-Identifier: GPL-3.0-or-later
//
// What an inversion is made of: its parameters, its states, its memory.
#include "inversion/inversion.h"

#include <math.h>
#include <string.h>

static const char *const starts[] = {"auto", "mean-force", "forces", NULL};

#define MEMBER(name) .offset = offsetof(struct inversion_parameters, name)
const struct field mf_inversion_fields[] = {
    {"particles", FIELD_INTEGER, MEMBER(particles), .initial = 0, .minimum = 0, .maximum = 1e7,
     .unit = "", .help = "particles at the scene's density; 0: the scene's"},
    {"sampler", FIELD_CHOICE, MEMBER(sampler), .choices = mf_sampler_kinds, .initial = SAMPLER_AUTO,
     .unit = "",
     .help = "auto: Metropolis moves of single beads, hybrid Monte Carlo of molecules and "
             "\"many_body\""},
    {"replicas", FIELD_INTEGER, MEMBER(replicas), .initial = 8, .minimum = 2,
     .maximum = REPLICAS_MAX, .unit = "", .help = "independent samplers"},
    {"equilibration", FIELD_INTEGER, MEMBER(equilibration), .initial = 64, .minimum = 0,
     .maximum = 8e8, .unit = "sweeps", .help = "least equilibration; prolonged until stationary"},
    {"samples", FIELD_INTEGER, MEMBER(samples), .initial = 64, .minimum = 2 * REPLICAS_BLOCKS,
     .maximum = 1e9, .unit = "",
     .help = "least samples of each replica; doubled until exact enough"},
    {"every", FIELD_INTEGER, MEMBER(every), .initial = 2, .minimum = 1, .maximum = 1e6,
     .unit = "sweeps", .help = "least interval between samples"},
    {"iterations", FIELD_INTEGER, MEMBER(iterations), .initial = 30, .minimum = 1, .maximum = 10000,
     .unit = "", .help = "most iterations"},
    {"precision", FIELD_NUMBER, MEMBER(precision), .initial = 0.004, .minimum = FIELD_ABOVE_ZERO,
     .maximum = 1, .unit = "",
     .help = "statistical error of g, rms over bins, needed for convergence"},
    {"damping", FIELD_NUMBER, MEMBER(damping), .initial = 1, .minimum = FIELD_ABOVE_ZERO,
     .maximum = 1, .unit = "", .help = "part of each step that is taken"},
    {"start", FIELD_CHOICE, MEMBER(start), .choices = starts, .initial = INVERSION_FROM_HNC,
     .unit = "", .help = "without unknowns.potential.start; auto: as \"base\" there"},
    FIELD_END,
};

void mf_inversion_destroy(void *memory) {
    struct inversion *inversion = memory;
    for (size_t s = 0; s < inversion->states; s++)
        mf_inversion_state_clear(&inversion->state[s]);
    mf_memory_free(inversion->state);
    mf_inversion_equations_clear(&inversion->equations);
    mf_inversion_course_clear(&inversion->course);
    mf_inversion_history_clear(&inversion->history);
    mf_memory_free(inversion->smoothness);
}

/// Potentials are those of all states: each must have all pair types.
static enum status refuse_missing_pairs(const struct inversion_state *state,
                                        const struct inversion_state *first) {
    const struct potential_grid *own = &state->grid, *grid = &first->grid;
    for (size_t pair = 0; pair < grid->pairs; pair++) {
        char name[COMPOSITION_PAIR_NAME_SIZE];
        if (own->known_of[pair] == grid->known_of[pair])
            continue;
        mf_composition_pair_name(&state->problem->scene.composition, (int)pair, name);
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "target.rdf: one state has g(r) of %s and another has none: all must have it, or none "
            "(a single bead has no pairs)",
            name);
    }
    return STATUS_OK;
}

/// Make the states. The one that fails has memory, too.
static enum status make_states(struct inversion *inversion, const struct inverse_problem *problem,
                               const struct inversion_basis_size *coefficients) {
    const bool several =
        inversion->method && inversion->method->knows_states && problem->states > 1;
    const size_t states = several ? problem->states : 1;
    enum status status = STATUS_OK;
    NEW_ARRAY(inversion->state, states);
    for (size_t s = 0; s < states; s++) {
        const struct inverse_problem *own = several ? problem->state[s] : problem;
        inversion->states++;
        status = mf_inversion_state_init(&inversion->state[s], own, &inversion->parameters,
                                         coefficients);
        if (status == STATUS_OK)
            status = refuse_missing_pairs(&inversion->state[s], inversion->state);
        CHECK(status == STATUS_OK || !several ? status
                                              : mf_status_prefix(status, "states.%s", own->name));
    }
    inversion->problem = inversion->state->problem;
done:
    return status;
}

/// Of the samples of all states.
static size_t count_bins(const struct inversion *inversion) {
    size_t bins = 0;
    for (size_t s = 0; s < inversion->states; s++)
        bins += inversion->state[s].bins;
    return bins;
}

/// All but the samplers and the start.
static enum status prepare(struct inversion *inversion, const struct inverse_problem *problem,
                           const struct inversion_basis_size *coefficients) {
    TRY(make_states(inversion, problem, coefficients));
    const struct inversion_state *first = inversion->state;
    TRY(mf_inversion_course_init(&inversion->course, first->grid.known, first->grid.points,
                                 count_bins(inversion)));
    for (size_t s = 0; s < inversion->states; s++)
        inversion->state[s].phi = inversion->course.phi;
    TRY(mf_inversion_equations_init(&inversion->equations, first, inversion->states));
    TRY(mf_inversion_history_init(&inversion->history, (size_t)inversion->parameters.iterations,
                                  first->bins));
    return mf_inversion_smooth_init(inversion);
}

enum status mf_inversion_create(void *memory, const struct inverse_method *method,
                                const struct inverse_problem *problem, const void *parameters) {
    struct inversion *inversion = memory;
    const struct inversion_rule *rule = method->own;
    enum status status;
    inversion->parameters = *(const struct inversion_parameters *)parameters;
    inversion->method = method;
    TRY(prepare(inversion, problem, rule->coefficients ? rule->coefficients(parameters) : NULL));
    inversion->course.progress.chosen_damping = inversion->parameters.damping;
    // The samplers of each state are made with the start of its own target, which says how stiff
    // its bonds are.
    for (size_t s = inversion->states; s-- > 0;) {
        struct inversion_state *state = &inversion->state[s];
        TRY(mf_inversion_start(state, inversion->course.phi));
        status = mf_inversion_state_make_samplers(state);
        TRY(status == STATUS_OK || inversion->states == 1
                ? status
                : mf_status_prefix(status, "states.%s", state->problem->name));
    }
    struct inversion_state *widest =
        &inversion->state[mf_inversion_states_widest(inversion->state, inversion->states)];
    if (widest > inversion->state) // that of the first state was made last
        TRY(mf_inversion_start(widest, inversion->course.phi));
    TRY(mf_inversion_start_weigh(inversion, widest));
    inversion->course.progress.from_forces = inversion->parameters.start == INVERSION_FROM_FORCES;
    return mf_inversion_reference(widest, inversion->course.reference);
}

double *mf_inversion_damping(void *memory) {
    return &((struct inversion *)memory)->course.progress.chosen_damping;
}

size_t mf_inversion_spans(void *memory, struct memory_span *span) {
    struct inversion *inversion = memory;
    const struct inversion_state *first = inversion->state;
    size_t n = 0;
    span[n++] = (struct memory_span){&inversion->stagnation, sizeof inversion->stagnation};
    n += mf_inversion_course_spans(&inversion->course, first->grid.points, count_bins(inversion),
                                   span + n);
    n += mf_inversion_history_spans(&inversion->history, span + n);
    for (size_t s = 0; s < inversion->states; s++)
        n += mf_inversion_state_spans(&inversion->state[s], span + n);
    return n;
}

/// The virial pressure if the pairs were as the target has them: (d N k_B T − Σ S* r Φ')/(d V).
static enum status find_pressure(struct inversion *inversion, double *pressure) {
    struct inversion_state *state = inversion->state;
    struct table *table = &state->interaction.table;
    const struct potential_grid *grid = &state->grid;
    const double dimensions = state->box.dimensions;
    double virial = dimensions * (double)mf_composition_particles(&state->composition) *
                    state->problem->scene.temperature;
    double volume = 1, slope;
    TRY(mf_potential_grid_table(grid, inversion->course.phi, table));
    for (size_t n = 0; n < grid->pairs_known; n++) {
        const double r = grid->r[grid->known_point[n]];
        const int pair = (int)(grid->known_point[n] / (grid->bins + 1));
        mf_table_evaluate_pair(table, pair, r, NULL, &slope, NULL);
        virial -= state->target.counts[grid->known_bin[n]] * r * slope;
    }
    for (int d = 0; d < state->box.dimensions; d++)
        volume *= state->box.length[d];
    *pressure = virial / (dimensions * volume);
    return STATUS_OK;
}

enum status mf_inversion_start_curve(const struct inverse_problem *problem, double *curve,
                                     double *pressure) {
    struct inversion inversion = {0};
    mf_fields_set_defaults(mf_inversion_fields, &inversion.parameters);
    enum status status = prepare(&inversion, problem, NULL);
    if (status == STATUS_OK)
        status = mf_inversion_start(inversion.state, inversion.course.phi);
    if (status == STATUS_OK)
        status = find_pressure(&inversion, pressure);
    if (status == STATUS_OK)
        memcpy(curve, inversion.course.phi, inversion_grid(&inversion)->points * sizeof *curve);
    mf_inversion_destroy(&inversion);
    return status;
}
