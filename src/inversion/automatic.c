// SPDX-License-Identifier: GPL-3.0-or-later
//
// Inverse Monte Carlo near its solution, and before that the steps that need no response, or little
// of it: by the hypernetted chain, or in two dimensions and of molecules Boltzmann inversion, of
// groups with the response of few coefficients (inversion/inversion_coarse.h). A Newton step
// converges at once near the solution and leads away from far off it (its basin; P. Deuflhard,
// Newton Methods for Nonlinear Problems (2004), section 2.1): where the samples know C it is tried,
// with the other in reserve, each time that the error has halved since it led away.
#include "inversion/inversion_coarse.h"
#include "inversion/inversion.h"
#include "inversion/method_steps.h"

#include <math.h>

/// Newton's steps are tried again where the error is this part of that at which they failed.
static const double again = 0.5;

static const char *const columns[] = {INVERSION_COLUMNS, "newton", "misfit[1]", "directions", NULL};

/// What Newton's step leaves of what is off, by the noise of C: of N bins and n independent samples
/// it is the root of N/n.
static const double well_known = 1.0 / 3;

/// Whether Newton's step is tried: near the noise, or where C is well known and it has not failed
/// yet.
static bool in_basin(const struct inversion *inversion) {
    const struct inversion_progress *progress = &inversion->course.progress;
    const struct inversion_state *first = inversion->state;
    const bool start = isinf(progress->best.distance[TARGET_RDF].rms);
    return mf_inversion_is_near(inversion) ||
           (!start && first->coarse.count == 0 &&
            (double)first->grid.known < well_known * well_known * first->response.independent &&
            inversion->verdict.distance[TARGET_RDF].rms < again * progress->failed_error);
}

static enum status careful_step(struct inversion_state *state, double *step) {
    const struct simulation_setup *scene = &state->problem->scene;
    if (state->box.dimensions == 3 &&
        mf_molecules_find(scene->interaction, scene->interactions) == NULL)
        return mf_hnc_step(state, step);
    if (state->coarse.count > 0)
        return mf_inversion_coarse_step(state, step);
    mf_ibi_step(state, step);
    return STATUS_OK;
}

static enum status newton_step(struct inversion *inversion, double *extra) {
    double newton[3] = {0};
    TRY(mf_imc_step(inversion, inversion->course.step, newton));
    extra[0] = !mf_inversion_is_coarse(inversion);
    extra[1] = newton[1];
    extra[2] = newton[2];
    return STATUS_OK;
}

/// The Newton step with the careful one in reserve, or that alone. A careful step is of one state:
/// what several say together are the equations of the other.
static enum status update(struct inversion *inversion, double *extra) {
    struct inversion_course *course = &inversion->course;
    if (inversion->states > 1)
        return newton_step(inversion, extra);
    if (!in_basin(inversion))
        return careful_step(inversion->state, course->step);
    TRY(careful_step(inversion->state, course->other_step));
    course->has_other = true;
    return newton_step(inversion, extra);
}

const struct inverse_method mf_automatic = {
    .name = "auto",
    .summary = "hnc (ibi in two dimensions and for molecules) until linear response holds or the "
               "targets of groups are near, then imc",
    .own = &(const struct inversion_rule){.update = update},
    .knows_molecules = true,
    .meets_integrals = true,
    .knows_states = true,
    .columns = columns,
    .create = mf_inversion_create,
    INVERSION_PARAMETERS,
    INVERSION_RECORD,
};
