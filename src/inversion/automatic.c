// SPDX-License-Identifier: GPL-3.0-or-later
//
// Inverse Monte Carlo near its solution, and before that the steps that need no response, or little
// of it: of one type of beads by the hypernetted chain, or, in two dimensions and of molecules
// whose own structure is not known, Boltzmann inversion; of several pair types and of groups with
// the response of few coefficients (inversion/inversion_low_rank.h). A Newton step converges at
// once near the solution and leads away from far off it (its basin; P. Deuflhard, Newton Methods
// for Nonlinear Problems (2004), section 2.1): where the samples know C it is tried, with the other
// in reserve, each time that the error has halved since it led away; of groups only near their
// targets. Where the target has forces, and no start is given, the fit begins with them, or with
// what g(r) says, whichever is nearer: both are sampled. Of a liquid of pairs forces are near; the
// mean forces of molecules need not be.
#include "inversion/inversion_low_rank.h"
#include "inversion/inversion.h"
#include "inversion/inversion_intramolecular.h"
#include "inversion/inversions.h"
#include "inversion/method_steps.h"

#include <math.h>
#include <string.h>

/// Newton's steps are tried again where the error is this part of that at which they failed.
static const double again = 0.5;

static const char *const columns[] = {INVERSION_COLUMNS, "newton", "misfit[1]",
                                      "directions",      "forces", NULL};

/// Whether Newton's step is tried: near the noise, or where it has not failed yet.
static bool may_be_in_basin(const struct inversion *inversion) {
    const struct inversion_progress *progress = &inversion->course.progress;
    const bool start = isinf(progress->best.distance[TARGET_RDF].rms) || progress->trial;
    return mf_inversion_is_near(inversion) ||
           (!start && !mf_potential_grid_has_terms(inversion_grid(inversion)) &&
            inversion->assessment.distance[TARGET_RDF].rms < again * progress->newton_failed_error);
}

static enum status careful_step(struct inversion_state *state, double *step) {
    if (state->low_rank.count > 0) {
        TRY(mf_inversion_low_rank_step(state, step));
        mf_inversion_bulk_add_ramp(state, step);
        return STATUS_OK;
    }
    if (state->grid.groups == 0 && mf_inversion_knows_intramolecular(state))
        return mf_hnc_step(state, step);
    mf_ibi_step(state, step);
    return STATUS_OK;
}

static enum status newton_step(struct inversion *inversion, double *extra) {
    double newton[3] = {0};
    TRY(mf_imc_step(inversion, inversion->course.step, newton));
    extra[0] = newton[2] > 0;
    extra[1] = newton[1];
    extra[2] = newton[2];
    return STATUS_OK;
}

/// The Newton step with the careful one in reserve, or that alone. A careful step is of one state:
/// what several say together are the equations of the other.
static enum status update(struct inversion *inversion, double *extra) {
    struct inversion_course *course = &inversion->course;
    extra[3] = course->progress.from_forces && !course->progress.trial;
    if (inversion->states > 1)
        return newton_step(inversion, extra);
    if (!may_be_in_basin(inversion))
        return careful_step(inversion->state, course->step);
    TRY(careful_step(inversion->state, course->other_step));
    TRY(newton_step(inversion, extra));
    course->has_other = mf_imc_is_known(inversion, extra[2]);
    if (!course->has_other) {
        extra[0] = 0;
        memcpy(course->step, course->other_step,
               inversion_grid(inversion)->points * sizeof *course->step);
    }
    return STATUS_OK;
}

const struct inverse_method mf_automatic = {
    .name = "auto",
    .summary =
        "hnc (ibi in two dimensions; with a low-rank response for mixtures and molecules) until "
        "the response is known, or the targets of groups are near, then imc",
    .own = &(const struct inversion_rule){.update = update, .weighs_starts = true},
    .knows_molecules = true,
    .meets_integrals = true,
    .knows_states = true,
    .columns = columns,
    .create = mf_inversion_create,
    INVERSION_PARAMETERS,
    INVERSION_RECORD,
};
