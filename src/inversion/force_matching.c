// SPDX-License-Identifier: GPL-3.0-or-later
//
// Force matching, or multiscale coarse-graining: S. Izvekov and G. A. Voth, J. Phys. Chem. B 109,
// 2469 (2005); W. G. Noid et al., J. Chem. Phys. 128, 244114 (2008). Of a liquid whose forces are
// those of pairs and bonds it returns them; of other liquids their mean forces in the presence of
// all others, whose g(r) is not that of the target.
#include "inversion/force_matching.h"

#include "base/memory.h"
#include "forces/many_body.h"
#include "inversion/force_solve.h"
#include "inversion/inversions.h"
#include "problem/group_kind.h"

#include <math.h>
#include <string.h>

/// What of Φ is asked for: ∫ of a force between two places is its value, up to a sign.
struct reading {
    const struct inverse_problem *problem;
    const struct potential_grid *grid;
    const struct force_equations *equations;
    struct force_solution solution;
    double *weight; ///< of c in each known value, shape [known, unknowns]
    double *mean;   ///< of c in what is a convention, shape [unknowns]
};

static const struct force_curve *find_curve(const struct force_equations *equations, int order,
                                            const char *name) {
    for (size_t n = 0; n < equations->curves; n++)
        if (equations->curve[n].order == order && strcmp(equations->curve[n].name, name) == 0)
            return &equations->curve[n];
    return NULL;
}

/// "A-B" is also the pair "B-A".
static enum status find_pair(const struct inverse_problem *problem, size_t pair,
                             const struct force_curve **curve) {
    const struct composition *const composition = &problem->scene.composition;
    char name[COMPOSITION_PAIR_NAME_SIZE] = "-", other[2 * COMPOSITION_PAIR_NAME_SIZE] = "-";
    if (composition_is_mixed(composition)) {
        mf_composition_pair_name(composition, (int)pair, name);
        const char *const dash = strchr(name, '-');
        snprintf(other, sizeof other, "%s-%.*s", dash + 1, (int)(dash - name), name);
    }
    *curve = find_curve(problem->forces, FORCES_OF_PAIRS, name);
    if (*curve == NULL)
        *curve = find_curve(problem->forces, FORCES_OF_PAIRS, other);
    if (*curve)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT, "target.forces: it has no pairs %s", name);
}

/// The density whose weight is that of the target.
static const struct force_curve *find_density(const struct inverse_problem *problem) {
    static const double same = 1e-4; // as scenes are compared with their targets
    const struct force_equations *const equations = problem->forces;
    const struct weighted_density_settings *const weight = mf_group_kind_density(&problem->targets);
    for (size_t n = 0; n < equations->curves; n++) {
        const struct force_curve *const curve = &equations->curve[n];
        if (curve->order == FORCES_OF_DENSITY &&
            fabs(curve->inner_cutoff - weight->inner_cutoff) < same * weight->cutoff &&
            fabs(curve->cutoff - weight->cutoff) < same * weight->cutoff)
            return curve;
    }
    return NULL;
}

static enum status find_group(const struct inverse_problem *problem,
                              const struct bonded_unknown *unknown,
                              const struct force_curve **curve) {
    const bool of_density = unknown->order == INVERSE_LOCAL_DENSITY;
    const char *const name = mf_group_kind_group(&problem->scene, unknown);
    *curve = of_density ? find_density(problem) : find_curve(problem->forces, unknown->order, name);
    if (*curve)
        return STATUS_OK;
    if (of_density)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "target.forces: it has no local density with the weight of "
                              "\"%s\": measure --forces and --weighted-density together",
                              name);
    return mf_status_fail(STATUS_BAD_INPUT, "target.forces: it has no %s \"%s\"",
                          mf_group_kind_name(unknown->order), name);
}

/// Φ = ∫ of the force from r to where it ends.
static enum status weigh_pairs(const struct reading *from) {
    const struct potential_grid *const grid = from->grid;
    for (size_t a = 0; a < grid->pairs_known; a++) {
        const size_t point = grid->known_point[a], pair = point / (grid->bins + 1);
        const struct force_curve *curve;
        TRY(find_pair(from->problem, pair, &curve));
        const double last = curve->low + curve->width * (double)(curve->nodes - 1);
        const double end = fmin(last, grid->r[grid->pair_points - 1]);
        mf_force_solution_integral(&from->solution, curve, fmin(grid->r[point], end), end,
                                   from->weight + a * from->solution.size);
    }
    return STATUS_OK;
}

/// The constant of U is a convention and has no error: its mean over the target is 0.
static void take_mean_off(const struct bonded_grid *own, size_t size, double *weight,
                          double *mean) {
    const double sum = mf_bonded_grid_mean(own) * (double)own->known;
    memset(mean, 0, size * sizeof *mean);
    for (size_t a = 0; a < own->known; a++)
        for (size_t k = 0; k < size; k++)
            mean[k] += own->target[own->first + a] / sum * weight[a * size + k];
    for (size_t a = 0; a < own->known; a++)
        for (size_t k = 0; k < size; k++)
            weight[a * size + k] -= mean[k];
}

/// U = −∫ of the force.
static enum status weigh_groups(const struct reading *from) {
    const struct potential_grid *const grid = from->grid;
    const size_t size = from->solution.size;
    double *weight = from->weight + grid->pairs_known * size;
    for (size_t g = 0; g < grid->groups; g++) {
        const struct potential_group *const group = &grid->group[g];
        const struct bonded_grid *const own = &group->own;
        const double unit =
            own->unknown->order < BONDED_KINDS ? mf_bonded_kinds[own->unknown->order]->scale : 1;
        const double *const q = grid->r + group->point + own->below;
        const struct force_curve *curve;
        TRY(find_group(from->problem, own->unknown, &curve));
        for (size_t k = 0; k < own->known; k++)
            mf_force_solution_integral(&from->solution, curve, unit * q[k], unit * q[0],
                                       weight + k * size);
        take_mean_off(own, size, weight, from->mean);
        weight += own->known * size;
    }
    return STATUS_OK;
}

/// f has no slope, and Φ has it all: forces tell of the two together.
static void take_slope_off(const struct reading *from) {
    const struct potential_grid *const grid = from->grid;
    const size_t size = from->solution.size;
    double *const slope = from->mean;
    memset(slope, 0, size * sizeof *slope);
    for (size_t a = 0; a < grid->known; a++)
        for (size_t k = 0; k < size; k++)
            slope[k] += grid->shared.weight[a] * from->weight[a * size + k];
    for (size_t a = 0; a < grid->known; a++)
        for (size_t k = 0; k < size; k++)
            from->weight[a * size + k] -= grid->shared.change[a] * slope[k];
}

/// A known value, its standard error by the noise of the forces, and that of straight lines between
/// nodes, of which the difference is about three.
static double integrate(const struct reading *from, size_t a, double *error, double *line) {
    const struct force_solution *const s = &from->solution;
    const double *const weight = from->weight + a * s->size;
    double value = 0, variance = 0, coarse = 0;
    for (size_t k = 0; k < s->size; k++) {
        double sum = 0;
        for (size_t l = 0; weight[k] != 0 && l < s->size; l++)
            sum += s->covariance[k * s->size + l] * weight[l];
        value += weight[k] * s->value[k];
        coarse += weight[k] * s->coarse[k];
        variance += weight[k] * sum;
    }
    *error = sqrt(fmax(0, variance));
    *line = (coarse - value) / 2;
    return value;
}

/// Root mean square of what straight lines are off around a value of a block: it is 0 at some.
static double find_line_error(const double *line, size_t begin, size_t end, size_t a) {
    enum { BESIDE = 2 };
    const size_t first = a > begin + BESIDE ? a - BESIDE : begin;
    const size_t last = a + BESIDE < end ? a + BESIDE : end - 1;
    double squares = 0;
    for (size_t b = first; b <= last; b++)
        squares += line[b] * line[b];
    return sqrt(squares / (double)(last - first + 1));
}

/// The known values, less what is known of those of pairs.
static enum status read_values(const struct reading *from, double *phi, double *error) {
    const struct potential_grid *const grid = from->grid;
    OWNED double *line = NULL;
    TRY_ARRAY(line, grid->known);
    for (size_t a = 0; a < grid->known; a++) {
        const size_t point = grid->known_point[a];
        const struct curve *const known =
            a < grid->pairs_known
                ? inverse_law_curve(&grid->beside, (int)(point / (grid->bins + 1)))
                : NULL;
        phi[point] = integrate(from, a, &error[point], &line[a]);
        phi[point] -= known ? mf_curve_value(known, grid->r[point]) : 0;
    }
    for (size_t block = 0, first = 0; block < grid->blocks; first += grid->known_of[block++])
        for (size_t a = first; a < first + grid->known_of[block]; a++)
            error[grid->known_point[a]] =
                hypot(error[grid->known_point[a]],
                      find_line_error(line, first, first + grid->known_of[block], a));
    return STATUS_OK;
}

/// A pressure that is a target is met.
static enum status meet_pressure(struct reading *from) {
    const struct target *const target = &from->problem->targets.target[TARGET_PRESSURE];
    const struct simulation_setup *const scene = &from->problem->scene;
    const double ideal = (double)mf_composition_particles(&scene->composition) *
                         scene->temperature / mf_box_volume(&scene->box);
    if (target->count == 0)
        return STATUS_OK;
    return mf_force_solution_meet(&from->solution, from->equations, target->value[0] - ideal,
                                  target->error ? target->error[0] : 0);
}

static int count_densities(const struct inverse_problem *problem) {
    int found = 0;
    for (size_t g = 0; g < problem->bonded; g++)
        found += problem->group[g].order == INVERSE_LOCAL_DENSITY;
    return found;
}

static const struct many_body *find_many_body(const struct inverse_problem *problem) {
    return mf_many_body_find(problem->scene.interaction, problem->scene.interactions);
}

/// Without the forces of a density in a scene that has none; pairs that are not looked for held.
static enum status choose_curves(const struct inverse_problem *problem,
                                 const struct potential_grid *grid, struct force_curve *curve,
                                 struct force_equations *equations) {
    *equations = *problem->forces;
    equations->curve = curve;
    for (size_t n = 0; n < equations->curves; n++) {
        curve[n] = problem->forces->curve[n];
        curve[n].left_out = curve[n].order == FORCES_OF_DENSITY && find_many_body(problem) == NULL;
        curve[n].held = curve[n].order == FORCES_OF_PAIRS;
    }
    for (size_t a = 0; a < grid->pairs_known; a++) {
        const struct force_curve *sought;
        TRY(find_pair(problem, grid->known_point[a] / (grid->bins + 1), &sought));
        curve[sought - problem->forces->curve].held = false;
    }
    return STATUS_OK;
}

static enum status weigh(struct reading *from) {
    const size_t size = from->solution.size;
    TRY_ARRAY(from->weight, from->grid->known * size);
    TRY_ARRAY(from->mean, size);
    TRY(weigh_pairs(from));
    TRY(weigh_groups(from));
    if (from->grid->shared.change)
        take_slope_off(from);
    return STATUS_OK;
}

static enum status find(struct reading *from, double *phi, double *error,
                        struct force_potentials *found) {
    const struct potential_grid *const grid = from->grid;
    struct force_solution *const solution = &from->solution;
    OWNED double *unused = NULL;
    if (error == NULL)
        TRY_ARRAY(unused, grid->points);
    TRY(mf_force_solve(from->equations, from->problem->scene.temperature, solution));
    TRY(meet_pressure(from));
    TRY(weigh(from));
    TRY(read_values(from, phi, error ? error : unused));
    mf_potential_grid_complete(grid, phi);
    for (size_t g = 0; error && g < grid->groups; g++)
        mf_potential_grid_close(grid, g, error);
    *found = (struct force_potentials){.explained = solution->explained,
                                       .directions = solution->directions};
    for (size_t k = 0; k < solution->size; k++)
        found->unknowns += solution->known[k];
    return STATUS_OK;
}

enum status mf_force_matching_find(const struct inverse_problem *problem,
                                   const struct potential_grid *grid, double *phi, double *error,
                                   struct force_potentials *found) {
    OWNED struct force_curve *curve = NULL;
    struct force_equations equations;
    struct reading from = {.problem = problem, .grid = grid, .equations = &equations};
    TRY_ARRAY(curve, problem->forces->curves);
    TRY(choose_curves(problem, grid, curve, &equations));
    const enum status status = find(&from, phi, error, found);
    mf_force_solution_clear(&from.solution);
    mf_memory_free(from.weight);
    mf_memory_free(from.mean);
    return status;
}

// The method --------------------------------------------------------------------------------------

struct force_matching {
    const struct inverse_problem *problem;
    struct potential_grid grid;
    double *phi, *error; ///< shape [points]
};

static const char *const columns[] = {"explained[1]", "directions", "unknowns", NULL};

static void destroy(void *memory) {
    struct force_matching *const state = memory;
    mf_potential_grid_clear(&state->grid);
    mf_memory_free(state->phi);
    mf_memory_free(state->error);
}

/// Forces tell nothing of bonds, angles, dihedrals and densities that were not measured with them.
static enum status refuse_unmeasured(const struct inverse_problem *problem,
                                     const struct potential_grid *grid) {
    const struct force_curve *curve;
    for (size_t g = 0; g < grid->groups; g++)
        TRY(find_group(problem, grid->group[g].own.unknown, &curve));
    return STATUS_OK;
}

/// Beyond their range the forces tell nothing: no potential would be as good as one of 0.
static enum status refuse_beyond(const struct inverse_problem *problem,
                                 const struct potential_grid *grid) {
    for (size_t pair = 0; pair < grid->pairs; pair++) {
        const double range = grid->r[grid->pair_points - 1];
        const struct force_curve *curve;
        TRY(find_pair(problem, pair, &curve));
        const double last = curve->low + curve->width * (double)(curve->nodes - 1);
        if (last < range - 1.01 * curve->width)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "target.forces: they end at r = %.4g" STATUS_LENGTH
                                  ", the potential at %.4g" STATUS_LENGTH
                                  ": measure them as far (--forces), or end the g(r) there by "
                                  "\"cutoff\"",
                                  last, range);
    }
    return STATUS_OK;
}

/// Forces of what is known would count as those of what is looked for.
static enum status refuse_known(const struct inverse_problem *problem) {
    const struct composition *const composition = &problem->scene.composition;
    const struct many_body *const many_body = find_many_body(problem);
    if (!problem->unknown[UNKNOWN_POTENTIAL].wanted)
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "scene.conservative: the forces of pairs whose law is known are not "
            "taken off those of the trajectory: look for it, too, by \"unknowns\": "
            "{\"potential\": {}} and a \"target.rdf\"");
    if (many_body && many_body->terms != count_densities(problem))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "scene.many_body: the forces of a local density whose energy is "
                              "known are not taken off those of the trajectory: leave its "
                              "\"energy\" out");
    for (int pair = 0; many_body && pair < mf_composition_pairs(composition); pair++)
        if (mf_composition_has_pairs(composition, pair) &&
            !mf_targets_have_pair(&problem->targets, (size_t)pair))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "target.rdf: forces tell the energy of a local density from "
                                  "pairs only with the potentials of all pair types: give g(r) of "
                                  "each");
    return STATUS_OK;
}

static enum status create(void *memory, const struct inverse_method *method,
                          const struct inverse_problem *problem, const void *parameters) {
    struct force_matching *const state = memory;
    (void)parameters;
    if (problem->forces == NULL)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "method.name: \"%s\" needs the forces of a trajectory: \"mesofit "
                              "measure --forces R\" keeps them in the folder that \"target\" names",
                              method->name);
    TRY(refuse_known(problem));
    state->problem = problem;
    TRY(mf_potential_grid_init(&state->grid, problem));
    TRY(refuse_unmeasured(problem, &state->grid));
    TRY(refuse_beyond(problem, &state->grid));
    TRY_ARRAY(state->phi, state->grid.points);
    TRY_ARRAY(state->error, state->grid.points);
    return STATUS_OK;
}

/// Whether all that forces tell of is looked for, and nothing is as the scene has it.
static bool finds_all(const struct force_matching *state) {
    const struct composition *const composition = &state->problem->scene.composition;
    const struct force_equations *const equations = state->problem->forces;
    size_t curves = (size_t)count_densities(state->problem), sought = 0;
    for (size_t n = 0; n < equations->curves; n++)
        curves += equations->curve[n].order != FORCES_OF_DENSITY;
    for (size_t block = 0; block < state->grid.blocks; block++)
        sought += state->grid.known_of[block] > 0;
    for (int pair = 0; pair < mf_composition_pairs(composition); pair++)
        curves -= !mf_composition_has_pairs(composition, pair);
    return sought == curves;
}

static enum status iterate(void *memory, struct inverse_step *step,
                           const struct inverse_listener *listener) {
    struct force_matching *const state = memory;
    struct force_potentials found;
    (void)listener;
    TRY(mf_force_matching_find(state->problem, &state->grid, state->phi, state->error, &found));
    *step = (struct inverse_step){
        .error = NAN,
        .noise = NAN,
        .extra = {found.explained, found.directions, found.unknowns},
        .curve = {state->grid.pairs > 0 ? state->phi : NULL},
        .curve_error = {state->error},
        .finished = true,
        .exhausted = true,
    };
    if (state->grid.groups > 0) {
        step->curve[UNKNOWN_BONDED] = state->phi + state->grid.pair_points;
        step->curve_error[UNKNOWN_BONDED] = state->error + state->grid.pair_points;
    }
    snprintf(step->reason, sizeof step->reason,
             "%.*f %% of the mean square of the forces is that of %s; g(r) was not fitted",
             found.explained > 0.999 ? 4 : 1, 100 * found.explained,
             finds_all(state) ? "these potentials"
                              : "such potentials, with what the scene gives as the forces have it");
    return STATUS_OK;
}

static size_t spans(void *memory, struct memory_span *span) {
    struct force_matching *const state = memory;
    const size_t bytes = state->grid.points * sizeof(double);
    span[0] = (struct memory_span){state->phi, bytes};
    span[1] = (struct memory_span){state->error, bytes};
    return 2;
}

const struct inverse_method mf_force_matching = {
    .name = "force-matching",
    .summary = "least squares of forces; S. Izvekov and G. A. Voth, J. Phys. "
               "Chem. B 109, 2469 (2005)",
    .kind = INVERSE_DIRECT,
    .tables = (const struct inverse_table[]){{NULL, 0, NULL}},
    .parameters_size = 1,
    .state_size = sizeof(struct force_matching),
    .columns = columns,
    .finds_potential = true,
    .knows_molecules = true,
    .create = create,
    .destroy = destroy,
    .iterate = iterate,
    .spans = spans,
};
