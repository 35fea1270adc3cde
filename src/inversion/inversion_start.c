// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion.h"

#include "inversion/force_matching.h"
#include "inversion/inversion_intramolecular.h"

#include <math.h>
#include <string.h>

/// Whether the run file gives a start, of a mixture for any of its pair types: the others then
/// begin with −k_B T ln g.
static bool has_own(const struct inversion_state *state) {
    for (size_t pair = 0; pair < state->grid.pairs; pair++)
        if (state->problem->unknown[UNKNOWN_POTENTIAL].start[pair])
            return true;
    return false;
}

static bool knows_hnc(const struct inversion_state *state) {
    return state->grid.pairs > 0 && mf_inversion_knows_intramolecular(state);
}

static bool is_from_hnc(const struct inversion_state *state) {
    return knows_hnc(state) && !has_own(state) && state->parameters->start == INVERSION_FROM_HNC;
}

/// Variance of −k_B T ln g*, or ln p*, in the known bins; false if the target does not say it of
/// all.
static bool find_variance(const struct inversion_state *state, double *variance) {
    const struct potential_grid *grid = &state->grid;
    for (size_t a = 0; a < grid->known; a++) {
        const size_t bin = grid->known_bin[a];
        const double g = fmax(mf_inversion_target_g(state, bin), state->target.min[bin]);
        const double error = state->target.error[bin] / state->target.ideal[bin];
        // What another state has seen is known within k_B T here.
        variance[a] = pow(state->problem->scene.temperature * (grid->seen[a] ? error / g : 1), 2);
        if (!(variance[a] > 0))
            return false;
    }
    return true;
}

/// The smoothest potential within the errors of the target: a response C/k_B T = 1, with the
/// potential itself as the excess.
static enum status smooth(struct inversion_state *state, double *start) {
    enum status status = STATUS_OK;
    const struct potential_grid *grid = &state->grid;
    double *unit = state->response.covariance;
    const size_t known = grid->known;
    struct imc_system system = mf_inversion_equations_of(state);
    struct imc_solution solution;
    double *variance = NULL, *phi = NULL, *x = NULL;
    NEW_ARRAY(variance, known);
    NEW_ARRAY(phi, known);
    NEW_ARRAY(x, known);
    if (state->problem->trial || !find_variance(state, variance))
        goto done; // in a trial nothing is sampled
    for (size_t a = 0; a < known; a++) {
        phi[a] = start[grid->known_point[a]];
        for (size_t b = 0; b < known; b++)
            unit[a * known + b] = a == b ? system.temperature : 0;
    }
    state->response.independent = 0; // C is that of no samples any more
    system.covariance = unit;
    system.excess = phi;
    system.variance = variance;
    system.noise = NULL;
    CHECK(mf_imc_solve(&system, 0, x, &solution));
    for (size_t a = 0; a < known; a++)
        start[grid->known_point[a]] = x[a];
    mf_potential_grid_complete(grid, start);
done:
    mf_memory_free(variance);
    mf_memory_free(phi);
    mf_memory_free(x);
    return status;
}

/// h − c of the target, which is found once.
static enum status find_indirect(struct inversion_state *state) {
    enum status status = STATUS_OK;
    const struct hnc_liquid liquid = mf_inversion_liquid(state);
    double *g = NULL;
    if (state->indirect)
        return STATUS_OK;
    NEW_ARRAY(g, state->bins);
    NEW_ARRAY(state->indirect, state->bins);
    for (size_t k = 0; k < state->bins; k++)
        g[k] = mf_inversion_target_g(state, k);
    CHECK(mf_hnc_closure(&liquid, g, state->indirect));
done:
    mf_memory_free(g);
    return status;
}

/// phi += k_B T (h − c).
static enum status add_indirect(struct inversion_state *state, double *phi) {
    const struct potential_grid *grid = &state->grid;
    TRY(find_indirect(state));
    for (size_t n = 0; n < grid->known; n++)
        phi[grid->known_point[n]] +=
            state->problem->scene.temperature * state->indirect[grid->known_bin[n]];
    return STATUS_OK;
}

/// Replace phi by the nearest that coefficients make, where potentials are made of them.
static enum status restrict_to_basis(const struct inversion_state *state, double *phi) {
    enum status status = STATUS_OK;
    double *weight = NULL;
    if (state->basis.count == 0)
        return STATUS_OK;
    NEW_ARRAY(weight, state->grid.known);
    mf_inversion_basis_weights(state, weight);
    CHECK(mf_inversion_basis_project(&state->basis, &state->grid, weight, phi));
    mf_potential_grid_complete(&state->grid, phi);
done:
    mf_memory_free(weight);
    return status;
}

enum status mf_inversion_reference(struct inversion_state *state, double *phi) {
    mf_potential_grid_mean_force(&state->grid, state->problem, phi);
    if (knows_hnc(state) && !state->problem->trial)
        TRY(add_indirect(state, phi));
    return smooth(state, phi);
}

/// What the forces of the target's trajectory say.
static enum status start_from_forces(const struct inversion_state *state, double *phi) {
    struct force_potentials found;
    if (state->problem->forces == NULL)
        return mf_status_fail(STATUS_BAD_INPUT, "method.start: \"forces\" needs a target that "
                                                "\"mesofit measure --forces R\" has made");
    TRY(mf_force_matching_find(state->problem, &state->grid, phi, NULL, &found));
    return restrict_to_basis(state, phi);
}

enum status mf_inversion_start(struct inversion_state *state, double *phi) {
    if (state->parameters->start == INVERSION_FROM_FORCES && !has_own(state))
        return start_from_forces(state, phi);
    if (!is_from_hnc(state))
        return mf_inversion_start_again(state, phi);
    TRY(mf_inversion_reference(state, phi));
    return restrict_to_basis(state, phi);
}

enum status mf_inversion_start_of_molecules(struct inversion *inversion,
                                            const struct inverse_listener *listener) {
    struct inversion_state *state = inversion->state;
    double *phi = inversion->course.phi;
    const struct simulation_setup *scene = &state->problem->scene;
    if (inversion->states > 1 || mf_molecules_find(scene->interaction, scene->interactions) == NULL)
        return STATUS_OK;
    TRY(mf_inversion_intramolecular_find(state, phi, listener));
    TRY(mf_inversion_reference(state, inversion->course.reference));
    return mf_inversion_start(state, phi);
}

enum status mf_inversion_start_weigh(struct inversion *inversion, struct inversion_state *state) {
    struct inversion_parameters *const parameters = &inversion->parameters;
    struct inversion_progress *const progress = &inversion->course.progress;
    const struct inversion_rule *const rule = inversion->method->own;
    if (!rule->weighs_starts || parameters->start != INVERSION_FROM_HNC || has_own(state) ||
        state->problem->forces == NULL)
        return STATUS_OK;
    const enum status status = start_from_forces(state, inversion->course.phi);
    if (status == STATUS_BAD_INPUT) // of other pairs or groups, or too few
        return mf_inversion_start(state, inversion->course.phi);
    parameters->start = INVERSION_FROM_FORCES;
    progress->weighs_starts = true;
    return status;
}

bool mf_inversion_start_has_trial(const struct inversion *inversion, bool kept) {
    const struct inversion_progress *const progress = &inversion->course.progress;
    return progress->weighs_starts && progress->iteration == 0 &&
           !(kept && mf_inversion_is_near(inversion));
}

void mf_inversion_start_try(struct inversion *inversion) {
    struct inversion_course *const course = &inversion->course;
    memcpy(course->phi, course->reference, inversion_grid(inversion)->points * sizeof *course->phi);
    course->progress.trial = course->progress.tried = course->progress.from_disorder = true;
}

enum inverse_start mf_inversion_start_taken(const struct inversion *inversion, bool kept) {
    const struct inversion_progress *const progress = &inversion->course.progress;
    if (!progress->weighs_starts || mf_inversion_start_has_trial(inversion, kept))
        return INVERSE_START_ONLY;
    if (!progress->from_forces)
        return INVERSE_START_TARGET_NEARER;
    return progress->tried ? INVERSE_START_FORCES_NEARER : INVERSE_START_FORCES;
}

bool mf_inversion_start_has_other(const struct inversion *inversion,
                                  const struct inversion_state *state) {
    const struct inversion_progress *progress = &inversion->course.progress;
    return is_from_hnc(state) && !progress->second_start && progress->iteration <= 1;
}

bool mf_inversion_start_is_poor(const struct inversion *inversion, bool kept) {
    const struct inversion_progress *progress = &inversion->course.progress;
    const bool useless = inversion->assessment.useless;
    const bool led_away = !kept && !useless && progress->damping < 1;
    return mf_inversion_start_has_other(inversion, inversion->state) &&
           (progress->iteration == 0 ? useless : led_away);
}

enum status mf_inversion_start_again(struct inversion_state *state, double *phi) {
    mf_potential_grid_start(&state->grid, state->problem, phi);
    if (!has_own(state))
        TRY(smooth(state, phi));
    return restrict_to_basis(state, phi);
}
