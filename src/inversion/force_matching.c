// SPDX-License-Identifier: GPL-3.0-or-later
//
// Force matching, or multiscale coarse-graining: S. Izvekov and G. A. Voth, J. Phys. Chem. B 109,
// 2469 (2005); W. G. Noid et al., J. Chem. Phys. 128, 244114 (2008). Of a liquid whose forces are
// those of pairs and bonds it returns them; of other liquids their mean forces in the presence of
// all others, whose g(r) is not that of the target.
#include "inversion/force_matching.h"

#include "base/memory.h"
#include "inversion/force_solve.h"
#include "inversion/inversions.h"
#include "problem/group_kind.h"

#include <math.h>
#include <string.h>

/// What of Φ is asked for: ∫ of a force between two places is its value, up to a sign.
struct reading {
    const struct force_equations *equations;
    const struct force_solution *solution;
    double *weight; ///< shape [unknowns]
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

static enum status find_group(const struct inverse_problem *problem,
                              const struct bonded_unknown *unknown,
                              const struct force_curve **curve) {
    const char *const name = mf_group_kind_group(&problem->scene, unknown);
    *curve = unknown->order == INVERSE_LOCAL_DENSITY
                 ? NULL
                 : find_curve(problem->forces, unknown->order, name);
    if (*curve)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT, "target.forces: it has no %s \"%s\"",
                          mf_group_kind_name(unknown->order), name);
}

/// ∫ of the force of a curve, and its standard error: of the forces, and of straight lines between
/// their nodes, of which the difference is about three.
static double integrate(const struct reading *from, const struct force_curve *curve, double begin,
                        double end, double *error) {
    const struct force_solution *const s = from->solution;
    const size_t first = curve->first, last = first + curve->nodes;
    double value = 0, variance = 0, coarse = 0;
    memset(from->weight, 0, s->size * sizeof *from->weight);
    mf_force_solution_integral(s, curve, begin, end, from->weight);
    for (size_t k = first; k < last; k++) {
        double sum = 0;
        for (size_t l = first; l < last; l++)
            sum += s->covariance[k * s->size + l] * from->weight[l];
        value += from->weight[k] * s->value[k];
        coarse += from->weight[k] * s->coarse[k];
        variance += from->weight[k] * sum;
    }
    *error = hypot(sqrt(fmax(0, variance)), (coarse - value) / 2);
    return value;
}

/// Φ = ∫ of the force from r to where it ends, less what is known of it.
static enum status read_pairs(const struct inverse_problem *problem,
                              const struct potential_grid *grid, const struct reading *from,
                              double *phi, double *error) {
    for (size_t n = 0; n < grid->pairs_known; n++) {
        const size_t point = grid->known_point[n], pair = point / (grid->bins + 1);
        const struct curve *const known = inverse_law_curve(&grid->beside, (int)pair);
        const struct force_curve *curve;
        TRY(find_pair(problem, pair, &curve));
        const double last = curve->low + curve->width * (double)(curve->nodes - 1);
        const double end = fmin(last, grid->r[grid->pair_points - 1]);
        const double r = fmin(grid->r[point], end);
        phi[point] = integrate(from, curve, r, end, &error[point]);
        phi[point] -= known ? mf_curve_value(known, grid->r[point]) : 0;
    }
    return STATUS_OK;
}

/// The known point of a group where its target is largest.
static size_t most_likely(const struct bonded_grid *own) {
    size_t most = 0;
    for (size_t k = 0; k < own->known; k++)
        if (own->target[own->first + k] > own->target[own->first + most])
            most = k;
    return own->below + most;
}

/// U = −∫ of the force from where U is least.
static enum status read_groups(const struct inverse_problem *problem,
                               const struct potential_grid *grid, const struct reading *from,
                               double *phi, double *error) {
    for (size_t g = 0; g < grid->groups; g++) {
        const struct potential_group *const group = &grid->group[g];
        const struct bonded_grid *const own = &group->own;
        const double unit =
            own->unknown->order < BONDED_KINDS ? mf_bonded_kinds[own->unknown->order]->scale : 1;
        const double least = unit * grid->r[group->point + most_likely(own)];
        const struct force_curve *curve;
        TRY(find_group(problem, own->unknown, &curve));
        for (size_t k = 0; k < own->known; k++) {
            const size_t point = group->point + own->below + k;
            phi[point] = integrate(from, curve, unit * grid->r[point], least, &error[point]);
        }
    }
    return STATUS_OK;
}

/// A pressure that is a target is met.
static enum status meet_pressure(const struct inverse_problem *problem,
                                 struct force_solution *solution) {
    const struct target *const target = &problem->targets.target[TARGET_PRESSURE];
    const struct simulation_setup *const scene = &problem->scene;
    const double ideal = (double)mf_composition_particles(&scene->composition) *
                         scene->temperature / mf_box_volume(&scene->box);
    if (target->count == 0)
        return STATUS_OK;
    return mf_force_solution_meet(solution, problem->forces, target->value[0] - ideal,
                                  target->error ? target->error[0] : 0);
}

enum status mf_force_matching_find(const struct inverse_problem *problem,
                                   const struct potential_grid *grid, double *phi, double *error,
                                   struct force_potentials *found) {
    CLEARED_BY(mf_force_solution_clear) struct force_solution solution = {0};
    OWNED double *weight = NULL, *unused = NULL;
    if (error == NULL)
        TRY_ARRAY(unused, grid->points);
    TRY_ARRAY(weight, problem->forces->size);
    TRY(mf_force_solve(problem->forces, problem->scene.temperature, &solution));
    TRY(meet_pressure(problem, &solution));
    const struct reading from = {problem->forces, &solution, weight};
    TRY(read_pairs(problem, grid, &from, phi, error ? error : unused));
    TRY(read_groups(problem, grid, &from, phi, error ? error : unused));
    mf_potential_grid_complete(grid, phi);
    for (size_t g = 0; error && g < grid->groups; g++)
        mf_potential_grid_close(grid, g, error);
    *found = (struct force_potentials){.explained = solution.explained,
                                       .directions = solution.directions};
    for (size_t k = 0; k < solution.size; k++)
        found->unknowns += solution.known[k];
    return STATUS_OK;
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

static enum status create(void *memory, const struct inverse_method *method,
                          const struct inverse_problem *problem, const void *parameters) {
    struct force_matching *const state = memory;
    (void)parameters;
    if (problem->forces == NULL)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "method.name: \"%s\" needs the forces of a trajectory: \"mesofit "
                              "measure --forces R\" keeps them in the folder that \"target\" names",
                              method->name);
    state->problem = problem;
    TRY(mf_potential_grid_init(&state->grid, problem));
    TRY(refuse_beyond(problem, &state->grid));
    TRY_ARRAY(state->phi, state->grid.points);
    TRY_ARRAY(state->error, state->grid.points);
    return STATUS_OK;
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
             "%.*f %% of the mean square of the forces is that of these potentials; g(r) was not "
             "fitted",
             found.explained > 0.999 ? 4 : 1, 100 * found.explained);
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
