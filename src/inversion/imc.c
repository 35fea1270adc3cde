// SPDX-License-Identifier: GPL-3.0-or-later
//
// Inverse Monte Carlo. A. P. Lyubartsev and A. Laaksonen, Phys. Rev. E 52, 3730 (1995).
#include "inversion/imc_solve.h"
#include "inversion/inversion.h"
#include "inversion/inversion_coarse.h"
#include "observe/kirkwood_buff_observable.h"

#include <math.h>

/// How the linear equations are solved, in the order of `regularisations`.
static enum status (*const solvers[])(const struct imc_system *, double, double *,
                                      struct imc_solution *) = {mf_imc_solve, mf_imc_truncated,
                                                                mf_imc_votca};
static const char *const regularisations[] = {"noise", "truncated", "votca", NULL};

#define MEMBER(name) .offset = offsetof(struct imc_parameters, name)
static const struct field own_fields[] = {
    {"regularisation", FIELD_CHOICE, MEMBER(regularisation), .choices = regularisations,
     .initial = 0, .unit = "",
     .help = "noise: smooth, as strong as the noise asks; truncated: singular values above the "
             "noise; votca: Tikhonov's lambda, as there"},
    {"strength", FIELD_NUMBER, MEMBER(strength), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "",
     .help = "of the regularisation; of \"truncated\" the least singular value over the largest; "
             "0: chosen from the noise, or none with \"votca\""},
    FIELD_END,
};

static const char *const columns[] = {INVERSION_COLUMNS, "regularisation[1]", "misfit[1]",
                                      "directions", NULL};

/// Near the noise a step that is as smooth as the noise allows is none at all, though g still asks
/// for one along the ramp. There the step is the most probable one, with the prior of the band.
static double choose_strength(struct inversion *inversion,
                              const struct imc_parameters *parameters) {
    if (parameters->regularisation != 0 || parameters->strength > 0 ||
        !mf_inversion_is_near(inversion))
        return parameters->strength;
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

/// The step far from the targets of groups.
static enum status step_coarsely(struct inversion *inversion, double *step) {
    TRY(mf_inversion_coarse_step(inversion, step));
    mf_inversion_pressure_add_ramp(inversion, step);
    return STATUS_OK;
}

enum status mf_imc_step(struct inversion *inversion, const struct imc_parameters *parameters,
                        double *step, double extra[3]) {
    const struct inverse_problem *problem = inversion->problem;
    const struct potential_grid *grid = &inversion->grid;
    enum status status = STATUS_OK;
    struct imc_solution solution;
    double *x = NULL;
    struct imc_system system = mf_inversion_system(inversion);
    if (mf_inversion_is_coarse(inversion) && parameters->regularisation == 0 &&
        !(parameters->strength > 0))
        return step_coarsely(inversion, step);
    mf_inversion_trail_take(&inversion->trail, &system);
    if (targets_ask(&problem->targets, TARGET_PRESSURE) && inversion->joint == NULL) {
        system.constraint = inversion->pressure.slope;
        system.wanted = *problem->targets.target[TARGET_PRESSURE].value - inversion->pressure.value;
    }
    NEW_ARRAY(x, grid->known);
    doubt_response(inversion, step, &system);
    CHECK(solvers[parameters->regularisation](&system, choose_strength(inversion, parameters), x,
                                              &solution));
    for (size_t a = 0; a < grid->known; a++)
        step[grid->known_point[a]] = x[a];
    extra[0] = solution.strength;
    extra[1] = solution.misfit;
    extra[2] = solution.directions;
done:
    mf_memory_free(x);
    return status;
}

/// VOTCA's lambda is of equations that are not over their errors, which integrals need.
static enum status create(void *memory, const struct inverse_method *method,
                          const struct inverse_problem *problem, const void *parameters) {
    const struct inversion_settings *settings = parameters;
    if (solvers[settings->imc.regularisation] == mf_imc_votca &&
        targets_ask(&problem->targets, mf_kirkwood_buff_kind()))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "method.regularisation: \"votca\" does not fit "
                              "target.kirkwood_buff; \"noise\" and \"truncated\" do");
    return mf_inversion_create(memory, method, problem, parameters);
}

static enum status update(struct inversion *inversion, double *extra) {
    return mf_imc_step(inversion, &inversion->settings.imc, inversion->step, extra);
}

const struct inverse_method mf_imc = {
    .name = "imc",
    .summary = "inverse Monte Carlo; A. P. Lyubartsev and A. Laaksonen, Phys. Rev. E 52, 3730 "
               "(1995)",
    .own = &(const struct inversion_rule){.update = update},
    .tables = (const struct inverse_table[]){INVERSION_TABLE,
                                             {own_fields, offsetof(struct inversion_settings, imc)},
                                             {NULL, 0}},
    .knows_molecules = true,
    .meets_integrals = true,
    .columns = columns,
    .create = create,
    INVERSION_RECORD,
};
