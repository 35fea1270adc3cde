// SPDX-License-Identifier: GPL-3.0-or-later
//
// Inverse Monte Carlo. A. P. Lyubartsev and A. Laaksonen, Phys. Rev. E 52, 3730 (1995).
#include "inversion/imc_solve.h"
#include "inversion/inversion_coarse.h"
#include "inversion/joint.h"

#include <math.h>
#include <string.h>

static const char *const columns[] = {INVERSION_COLUMNS, "regularisation[1]", "misfit[1]",
                                      "directions", NULL};

/// Near the noise a step that is as smooth as the noise allows is none at all, though g still asks
/// for one along the ramp. There the step is the most probable one, with the prior of the band.
static double choose_strength(struct inversion *inversion) {
    if (!mf_inversion_is_near(inversion))
        return 0; // by the noise
    inversion->settling = true;
    return mf_inversion_band_prior(inversion);
}

void mf_imc_doubt(struct inversion *inversion, double *logarithms) {
    const size_t known = inversion->grid.known;
    const double *covariance = inversion->covariance;
    const double temperature = inversion->problem->scene.temperature;
    const double independent = inversion->behind / inversion->inefficiency;
    double squares = 0;
    mf_ibi_logarithms(inversion, logarithms);
    for (size_t a = 0; a < known; a++)
        squares += covariance[a * known + a] *
                   pow(logarithms[inversion->grid.known_point[a]] / temperature, 2);
    for (size_t a = 0; a < known; a++)
        inversion->doubt[a] =
            inversion->variance[a] +
            (covariance[a * known + a] * squares + inversion->excess[a] * inversion->excess[a]) /
                independent;
}

/// The same equations with the variances of what C predicts, in fits with groups.
static void doubt_response(struct inversion *inversion, double *scratch,
                           struct imc_system *system) {
    if (inversion->doubt == NULL)
        return;
    if (inversion->joint) {
        *system = inversion->joint->doubted;
        return;
    }
    mf_imc_doubt(inversion, scratch);
    system->variance = inversion->doubt;
}

/// The step far from the targets of groups, which several states have taken together.
static enum status step_coarsely(struct inversion *inversion, double *step) {
    if (inversion->joint && inversion->joint->coarse) {
        memcpy(step, inversion->joint->coarse, inversion->grid.points * sizeof *step);
        return STATUS_OK;
    }
    TRY(mf_inversion_coarse_step(inversion, step));
    mf_inversion_pressure_add_ramp(inversion, step);
    return STATUS_OK;
}

enum status mf_imc_step(struct inversion *inversion, double *step, double extra[3]) {
    const struct inverse_problem *problem = inversion->problem;
    const struct potential_grid *grid = &inversion->grid;
    enum status status = STATUS_OK;
    struct imc_solution solution;
    double *x = NULL;
    struct imc_system system = mf_inversion_system(inversion);
    if (mf_inversion_is_coarse(inversion))
        return step_coarsely(inversion, step);
    if (targets_ask(&problem->targets, TARGET_PRESSURE) && inversion->joint == NULL) {
        system.constraint = inversion->pressure.slope;
        system.wanted = *problem->targets.target[TARGET_PRESSURE].value - inversion->pressure.value;
    }
    NEW_ARRAY(x, grid->known);
    doubt_response(inversion, step, &system);
    CHECK(mf_imc_solve(&system, choose_strength(inversion), x, &solution));
    for (size_t a = 0; a < grid->known; a++)
        step[grid->known_point[a]] = x[a];
    extra[0] = solution.strength;
    extra[1] = solution.misfit;
    extra[2] = solution.directions;
done:
    mf_memory_free(x);
    return status;
}

static enum status update(struct inversion *inversion, double *extra) {
    return mf_imc_step(inversion, inversion->step, extra);
}

const struct inverse_method mf_imc = {
    .name = "imc",
    .summary = "inverse Monte Carlo; A. P. Lyubartsev and A. Laaksonen, Phys. Rev. E 52, 3730 "
               "(1995)",
    .own = &(const struct inversion_rule){.update = update},
    .tables = (const struct inverse_table[]){INVERSION_TABLE, {NULL, 0}},
    .knows_molecules = true,
    .meets_integrals = true,
    .columns = columns,
    JOINT_RECORD,
};
