// SPDX-License-Identifier: GPL-3.0-or-later
//
// Inverse Monte Carlo where its linear response holds, and before that the steps that need none, or
// little of it: by the hypernetted chain, or in two dimensions and of molecules Boltzmann
// inversion, of groups with the response of few coefficients (inversion/inversion_coarse.h). A
// Newton step converges at once near the solution and leads away from far off it (its basin; P.
// Deuflhard, Newton Methods for Nonlinear Problems (2004), section 2.1, which tests it as here, by
// what the last step did against what was predicted).
#include "inversion/inversion_coarse.h"
#include "inversion/inversion.h"
#include "inversion/method_steps.h"

#include <math.h>

/// The response holds if it tells what the last step did within this part.
static const double trust = 0.3;

static const char *const columns[] = {INVERSION_COLUMNS, "newton", "misfit[1]", "directions", NULL};

/// Whether −C ΔΦ/k_B T is the change of S from the best potential to this one, in the norm of their
/// noise, but for the noise of both.
static bool predicts(const struct inversion *inversion) {
    const struct inversion_state *first = inversion->state;
    const struct inversion_course *course = &inversion->course;
    const struct potential_grid *grid = &first->grid;
    const double *response = mf_inversion_response_values(first);
    double miss = 0, change = 0;
    for (size_t a = 0; a < grid->known; a++) {
        const size_t bin = grid->known_bin[a];
        const double actual = first->replicas.counts.mean[bin] - course->best.counts[bin];
        double predicted = 0;
        for (size_t b = 0; b < grid->known; b++) {
            const size_t point = grid->known_point[b];
            predicted -= response[a * grid->known + b] *
                         (course->phi[point] - course->best.phi[point]) /
                         first->problem->scene.temperature;
        }
        miss += (actual - predicted) * (actual - predicted) / first->variance[a];
        change += actual * actual / first->variance[a];
    }
    return miss <= trust * trust * change + 2 * (double)grid->known;
}

/// Whether the last step was Newton's, which keeps the other in reserve, and halved the error.
static bool newton_helped(const struct inversion *inversion) {
    const struct inversion_progress *progress = &inversion->course.progress;
    return progress->has_other && inversion->verdict.distance[TARGET_RDF].rms <
                                      0.5 * progress->best.distance[TARGET_RDF].rms;
}

/// Inside the basin of inverse Monte Carlo: near the noise, where its response holds, or where its
/// steps converge. Of groups C tells no more than the careful step until the targets are near.
static bool in_basin(const struct inversion *inversion) {
    const bool first = isinf(inversion->course.progress.best.distance[TARGET_RDF].rms);
    return mf_inversion_is_near(inversion) || (!first && inversion->state->coarse.count == 0 &&
                                               (newton_helped(inversion) || predicts(inversion)));
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
    .summary = "hypernetted-chain steps (Delbary et al. 2020; in 2-D and of molecules Boltzmann "
               "inversion, Reith et al. 2003) until their linear response holds, or with groups "
               "until the targets are near, then inverse Monte Carlo (Lyubartsev and Laaksonen "
               "1995)",
    .own = &(const struct inversion_rule){.update = update},
    .knows_molecules = true,
    .meets_integrals = true,
    .knows_states = true,
    .columns = columns,
    .create = mf_inversion_create,
    INVERSION_PARAMETERS,
    INVERSION_RECORD,
};
