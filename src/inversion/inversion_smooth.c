// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_smooth.h"

#include "base/memory.h"
#include "inversion/inversion.h"
#include "problem/group_kind.h"

#include <gsl/gsl_linalg.h>
#include <math.h>

/// The laws that U is compared with: 1, q, q², or of a dihedral 1, cos φ, sin φ, … sin 3φ.
enum { PARABOLA = 3, TORSION = 7, MAX_TERMS = TORSION };

/// One group as it is smoothed.
struct group {
    const struct bonded_grid *own;
    size_t first;           ///< of its known bins, among all
    struct imc_shape shape; ///< of the prior
};

static struct group group_of(const struct inversion_state *state, size_t g) {
    const struct potential_grid *grid = &state->grid;
    size_t first = grid->pairs_known;
    for (size_t before = 0; before < g; before++)
        first += grid->group[before].own.known;
    return (struct group){&grid->group[g].own, first, state->target.shape[grid->pairs + g]};
}

/// Value of a term of the law at a known bin, with lengths and angles from −1 to 1.
static double term_of(const struct group *group, size_t term, size_t bin) {
    const double count = (double)group->own->known;
    if (!group->shape.periodic)
        return pow(2 * (double)bin / (count - 1) - 1, (double)term);
    const double angle = 2 * M_PI * (double)bin / count * (double)((term + 1) / 2);
    return term % 2 ? sin(angle) : cos(angle);
}

/// The law nearest to a curve, weighted by p of the target. Σ w t tᵀ is positive definite, as the
/// bins at both ends are seen, and some between.
static void find_law(const struct group *group, const double *curve, double *law) {
    const size_t terms = group->shape.periodic ? TORSION : PARABOLA;
    double normal[MAX_TERMS * MAX_TERMS] = {0}, right[MAX_TERMS] = {0};
    double t[MAX_TERMS];
    for (size_t a = 0; a < group->own->known; a++) {
        const double weight = group->own->target[group->own->first + a];
        for (size_t k = 0; k < terms; k++)
            t[k] = term_of(group, k, a);
        for (size_t k = 0; k < terms; k++) {
            right[k] += weight * t[k] * curve[a];
            for (size_t n = 0; n < terms; n++)
                normal[k * terms + n] += weight * t[k] * t[n];
        }
    }
    gsl_matrix_view matrix = gsl_matrix_view_array(normal, terms, terms);
    gsl_vector_view vector = gsl_vector_view_array(right, terms);
    const bool found = gsl_linalg_cholesky_decomp1(&matrix.matrix) == GSL_SUCCESS;
    if (found)
        gsl_linalg_cholesky_svx(&matrix.matrix, &vector.vector);
    for (size_t a = 0; a < group->own->known; a++) {
        law[a] = 0;
        for (size_t k = 0; k < terms && found; k++)
            law[a] += right[k] * term_of(group, k, a);
    }
}

/// Replace a curve by the one that is most probable if it is known with the information F in each
/// bin: minimise Σ F (y − curve)² + strength (|D(y − law)|² + ρ|y − law|²).
static enum status smooth(const struct group *group, double temperature, double strength,
                          const double *information, double *curve, struct imc_solution *solution) {
    enum status status = STATUS_OK;
    const size_t known = group->own->known;
    double *law = NULL, *root = NULL, *asked = NULL, *variance = NULL;
    NEW_ARRAY(law, known);
    NEW_ARRAY(root, known * known);
    NEW_ARRAY(asked, known);
    NEW_ARRAY(variance, known);
    find_law(group, curve, law);
    for (size_t a = 0; a < known; a++) {
        root[a * (known + 1)] = temperature * sqrt(information[a]);
        asked[a] = sqrt(information[a]) * (curve[a] - law[a]);
        variance[a] = 1;
    }
    const struct imc_system system = {.size = known,
                                      .block = &known,
                                      .blocks = 1,
                                      .shape = &group->shape,
                                      .covariance = root,
                                      .excess = asked,
                                      .variance = variance,
                                      .temperature = temperature,
                                      .spacing = 1};
    CHECK(mf_imc_solve(&system, strength, curve, solution));
    for (size_t a = 0; a < known; a++)
        curve[a] += law[a];
done:
    mf_memory_free(law);
    mf_memory_free(root);
    mf_memory_free(asked);
    mf_memory_free(variance);
    return status;
}

// How smooth -------------------------------------------------------------------------------------

/// −k_B T ln(p/J) of the target, and what its errors know of that.
static void take_target(const struct inversion_state *state, const struct group *group,
                        double *curve, double *information) {
    static const double exact = 1e-4;
    const struct bonded_grid *own = group->own;
    const double temperature = state->problem->scene.temperature;
    for (size_t a = 0; a < own->known; a++) {
        const size_t bin = state->grid.known_bin[group->first + a];
        const double counts = state->target.counts[bin];
        const double min = state->target.min[bin] * state->target.ideal[bin];
        const double error = fmax(state->target.error[bin], exact * state->target.ideal[bin]);
        const double jacobian = mf_group_kind_jacobian(own->unknown->order, own->dimensions,
                                                       &own->unknown->bins, own->first + a);
        curve[a] = -temperature * log(fmax(counts, min) / jacobian);
        information[a] = pow(counts / (error * temperature), 2);
    }
}

/// The strength of the prior over its own, at most 1, with the least risk, χ² + 2 directions: C. L.
/// Mallows, Technometrics 15, 661 (1973).
static enum status find_smoothness(const struct inversion_state *state, size_t g,
                                   double *smoothness) {
    enum { STRENGTHS = 13 };
    static const double ratio = 0.31622776601683794;
    enum status status = STATUS_OK;
    const struct group group = group_of(state, g);
    const size_t known = group.own->known;
    const double temperature = state->problem->scene.temperature;
    double *target = NULL, *curve = NULL, *information = NULL;
    double min = INFINITY;
    NEW_ARRAY(target, known);
    NEW_ARRAY(curve, known);
    NEW_ARRAY(information, known);
    take_target(state, &group, target, information);
    for (int k = 0; k < STRENGTHS; k++) {
        struct imc_solution solution;
        memcpy(curve, target, known * sizeof *curve);
        CHECK(smooth(&group, temperature, pow(ratio, k) / (temperature * temperature), information,
                     curve, &solution));
        const double risk = (double)known * solution.misfit + 2 * solution.directions;
        if (risk >= min)
            continue;
        min = risk;
        *smoothness = pow(ratio, k);
    }
done:
    mf_memory_free(target);
    mf_memory_free(curve);
    mf_memory_free(information);
    return status;
}

enum status mf_inversion_smooth_init(struct inversion *inversion) {
    enum status status = STATUS_OK;
    const size_t groups = inversion_grid(inversion)->groups;
    NEW_ARRAY(inversion->smoothness, groups);
    for (size_t g = 0; g < groups; g++)
        CHECK(find_smoothness(inversion->state, g, &inversion->smoothness[g]));
done:
    return status;
}

void mf_inversion_smooth_shapes(const struct inversion *inversion, struct imc_shape *shape) {
    const struct potential_grid *grid = inversion_grid(inversion);
    memcpy(shape, inversion->state->target.shape, grid->blocks * sizeof *shape);
    for (size_t g = 0; g < grid->groups; g++)
        shape[grid->pairs + g].bend *= pow(inversion->smoothness[g], 0.25);
}

// The result -------------------------------------------------------------------------------------

/// What the samples of one state know of U where they are of the present one, F = S²/(σ k_B T)²,
/// and F u.
static void add_state(const struct inversion *inversion, const struct inversion_state *state,
                      const struct group *group, double *information, double *moved) {
    static const double max = 1; // an empty bin tells no more than that of (S − S*)/S
    const double temperature = state->problem->scene.temperature;
    const bool moves = ((const struct inversion_rule *)inversion->method->own)->memoryless;
    const bool mean = moves && mf_inversion_ends_with_mean(inversion);
    // The first state counts with what is left of all, as the equations do, the others with their
    // own.
    const double birge = mf_inversion_band_birge(state == inversion->state ? &inversion->assessment
                                                                           : &state->assessment);
    for (size_t a = 0; a < group->own->known; a++) {
        const size_t known = group->first + a, bin = state->grid.known_bin[known];
        const double counts = state->replicas.counts.mean[bin], target = state->target.counts[bin];
        const double excess = mean ? state->pool.excess[known] : counts - target;
        const double min = state->target.min[bin] * state->target.ideal[bin];
        const double own = pow(counts / temperature, 2) / (birge * state->variance[known]);
        if (!state->grid.seen[known] || !(counts > 0))
            continue;
        const double step = log(fmax(target + excess, min) / fmax(target, min));
        information[a] += own;
        moved[a] += moves ? own * temperature * fmin(step, max) : 0;
    }
}

static enum status smooth_group(struct inversion *inversion, size_t g) {
    enum status status = STATUS_OK;
    const struct group group = group_of(inversion->state, g);
    const size_t *point = inversion_grid(inversion)->known_point + group.first;
    double *phi = inversion->course.phi;
    const size_t known = group.own->known;
    const double temperature = inversion->problem->scene.temperature;
    double *curve = NULL, *information = NULL, *moved = NULL;
    struct imc_solution solution;
    NEW_ARRAY(curve, known);
    NEW_ARRAY(information, known);
    NEW_ARRAY(moved, known);
    for (size_t s = 0; s < inversion->states; s++)
        add_state(inversion, &inversion->state[s], &group, information, moved);
    for (size_t a = 0; a < known; a++)
        curve[a] = phi[point[a]] + (information[a] > 0 ? moved[a] / information[a] : 0);
    CHECK(smooth(&group, temperature, inversion->smoothness[g] / (temperature * temperature),
                 information, curve, &solution));
    for (size_t a = 0; a < known; a++)
        phi[point[a]] = curve[a];
done:
    mf_memory_free(curve);
    mf_memory_free(information);
    mf_memory_free(moved);
    return status;
}

enum status mf_inversion_smooth(struct inversion *inversion) {
    if (inversion->state->basis.count > 0)
        return STATUS_OK;
    for (size_t g = 0; g < inversion_grid(inversion)->groups; g++)
        TRY(smooth_group(inversion, g));
    mf_potential_grid_complete(inversion_grid(inversion), inversion->course.phi);
    return STATUS_OK;
}
