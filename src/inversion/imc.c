// SPDX-License-Identifier: GPL-3.0-or-later
//
// Inverse Monte Carlo. A. P. Lyubartsev and A. Laaksonen, Phys. Rev. E 52, 3730 (1995).
#include "inversion/imc_solve.h"
#include "inversion/inversion_low_rank.h"
#include "inversion/inversion.h"
#include "inversion/inversions.h"
#include "inversion/method_steps.h"

#include <math.h>

static const char *const columns[] = {INVERSION_COLUMNS, "regularisation[1]", "misfit[1]",
                                      "directions", NULL};

/// C is known well enough if a Newton step leaves at most this share of the excess by the noise of
/// C: sqrt(directions/n) of a step in so many directions, by n independent samples.
static const double well_known = 1.0 / 3;

bool mf_imc_is_known(const struct inversion *inversion, double directions) {
    double independent = INFINITY;
    for (size_t s = 0; s < inversion->states; s++)
        independent = fmin(independent, inversion->state[s].response.independent);
    return mf_inversion_is_near(inversion) || directions < well_known * well_known * independent;
}

/// The strength of the regularisation: 0, by the noise (mf_imc_solve), or that of the band's prior,
/// which makes the step the most probable one. Near the targets the smoothest step within the noise
/// is none at all, though g still asks for one along the ramp: the most probable one is taken. Far
/// from them, with one type of beads, it would take what is not linear for the ramp, and g hardly
/// calls that back: soft beads ended four errors off. In a mixture the most probable one is taken
/// always: the smoothest leaves the concentrations, few directions among many bins, far outside
/// their own noise, and makes up for that by a ramp, which is smooth: of urea in water 3900 bar.
static double choose_strength(struct inversion *inversion) {
    if (inversion_grid(inversion)->pairs <= 1 && !mf_inversion_is_near(inversion))
        return 0; // by the noise
    inversion->course.most_probable = true;
    return mf_inversion_band_prior(inversion);
}

enum status mf_imc_response_variance(const struct inversion_state *state, double *variance) {
    enum status status = STATUS_OK;
    const size_t known = state->grid.known;
    const double *covariance = state->response.covariance;
    const double temperature = state->problem->scene.temperature;
    const double *shared = state->response.shared, independent = state->response.independent;
    double squares = 0, *logarithms = NULL;
    NEW_ARRAY(logarithms, state->grid.points);
    mf_ibi_logarithms(state, logarithms);
    for (size_t a = 0; a < known; a++)
        squares += covariance[a * known + a] *
                   pow(logarithms[state->grid.known_point[a]] / temperature, 2);
    for (size_t a = 0; a < known; a++)
        variance[a] = (shared[a] * squares + state->excess[a] * state->excess[a]) *
                      state->bin_inefficiency[a] / (state->inefficiency * independent);
done:
    mf_memory_free(logarithms);
    return status;
}

/// The step of a fit with groups as long as C is not known well enough for Newton's.
static enum status step_low_rank(struct inversion *inversion, double *step) {
    struct inversion_state *first = inversion->state;
    if (inversion->states > 1)
        return mf_inversion_states_low_rank_step(first, inversion->states, step);
    TRY(mf_inversion_low_rank_step(first, step));
    mf_inversion_bulk_add_ramp(first, step);
    return STATUS_OK;
}

enum status mf_imc_step(struct inversion *inversion, double *step, double extra[3]) {
    enum status status = STATUS_OK;
    const struct inversion_state *first = inversion->state;
    const struct inversion_equations *equations = &inversion->equations;
    const size_t *point = first->grid.known_point;
    struct imc_system system = first->grid.groups > 0 ? equations->of_response : equations->system;
    struct imc_solution solution;
    double *x = NULL, *phi = NULL, *reference = NULL;
    if (mf_inversion_is_low_rank(inversion))
        return step_low_rank(inversion, step);
    if (mf_inversion_bulk_is_asked(first) && !equations->reduced) {
        system.constraint = first->bulk.slope;
        system.wanted = mf_inversion_bulk_missing(first);
    }
    NEW_ARRAY(x, system.size);
    NEW_ARRAY(phi, system.size);
    NEW_ARRAY(reference, system.size);
    for (size_t a = 0; a < system.size; a++) {
        phi[a] = inversion->course.phi[point[a]];
        reference[a] = inversion->course.reference[point[a]];
    }
    system.phi = phi;
    system.reference = reference;
    CHECK(mf_imc_solve(&system, choose_strength(inversion), x, &solution));
    for (size_t a = 0; a < system.size; a++)
        step[point[a]] = x[a];
    extra[0] = solution.strength;
    extra[1] = solution.misfit;
    extra[2] = solution.directions;
done:
    mf_memory_free(x);
    mf_memory_free(phi);
    mf_memory_free(reference);
    return status;
}

static enum status update(struct inversion *inversion, double *extra) {
    return mf_imc_step(inversion, inversion->course.step, extra);
}

const struct inverse_method mf_imc = {
    .name = "imc",
    .summary = "inverse Monte Carlo; A. P. Lyubartsev and A. Laaksonen, Phys. Rev. E 52, 3730 "
               "(1995)",
    .own = &(const struct inversion_rule){.update = update},
    .knows_molecules = true,
    .meets_integrals = true,
    .knows_states = true,
    .columns = columns,
    .create = mf_inversion_create,
    INVERSION_PARAMETERS,
    INVERSION_RECORD,
};
