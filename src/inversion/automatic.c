// SPDX-License-Identifier: GPL-3.0-or-later
//
// Inverse Monte Carlo where its linear response holds, and before that the steps that need none, or
// little of it: by the hypernetted chain, or in two dimensions and of molecules Boltzmann
// inversion, of groups with the response of few coefficients (inversion/inversion_coarse.h). A
// Newton step converges at once near the solution and leads away from far off it (its basin; P.
// Deuflhard, Newton Methods for Nonlinear Problems (2004), section 2.1, which tests it as here, by
// what the last step did against what was predicted).
#include "inversion/inversion_coarse.h"
#include "inversion/joint.h"

#include <math.h>
#include <string.h>

/// The response holds if it tells what the last step did within this part.
static const double trust = 0.3;

static const char *const columns[] = {INVERSION_COLUMNS, "newton", "misfit[1]", "directions", NULL};

/// Whether −C ΔΦ/k_B T is the change of S from the best potential to this one, in the norm of their
/// noise, but for the noise of both.
static bool predicts(const struct inversion *inversion) {
    const struct potential_grid *grid = &inversion->grid;
    const double *response = mf_inversion_response_values(inversion);
    double miss = 0, change = 0;
    for (size_t a = 0; a < grid->known; a++) {
        const size_t bin = grid->known_bin[a];
        const double actual = inversion->replicas.counts.mean[bin] - inversion->best_counts[bin];
        double predicted = 0;
        for (size_t b = 0; b < grid->known; b++) {
            const size_t point = grid->known_point[b];
            predicted -= response[a * grid->known + b] *
                         (inversion->phi[point] - inversion->best[point]) /
                         inversion->problem->scene.temperature;
        }
        miss += (actual - predicted) * (actual - predicted) / inversion->variance[a];
        change += actual * actual / inversion->variance[a];
    }
    return miss <= trust * trust * change + 2 * (double)grid->known;
}

/// Whether the last step was Newton's, which keeps the other in reserve, and halved the error.
static bool newton_helped(const struct inversion *inversion) {
    return inversion->progress.best_other &&
           inversion->distance[TARGET_RDF].rms < 0.5 * inversion->progress.best[TARGET_RDF].rms;
}

/// Inside the basin of inverse Monte Carlo: near the noise, where its response holds, or where its
/// steps converge. Of groups C tells no more than the careful step until the targets are near.
static bool in_basin(const struct inversion *inversion) {
    const bool first = isinf(inversion->progress.best[TARGET_RDF].rms);
    return mf_inversion_is_near(inversion) || (!first && inversion->coarse.count == 0 &&
                                               (newton_helped(inversion) || predicts(inversion)));
}

static enum status careful_step(struct inversion *inversion, double *step) {
    const struct simulation_setup *scene = &inversion->problem->scene;
    if (inversion->box.dimensions == 3 &&
        mf_molecules_find(scene->interaction, scene->interactions) == NULL)
        return mf_hnc_step(inversion, step);
    if (inversion->coarse.count > 0)
        return mf_inversion_coarse_step(inversion, step);
    mf_ibi_step(inversion, step);
    return STATUS_OK;
}

static enum status newton_step(struct inversion *inversion, double *extra) {
    double newton[3] = {0};
    TRY(mf_imc_step(inversion, inversion->step, newton));
    extra[0] = !mf_inversion_is_coarse(inversion);
    extra[1] = newton[1];
    extra[2] = newton[2];
    return STATUS_OK;
}

/// The Newton step with the careful one in reserve, or that alone. A careful step is of one state:
/// what several say together are the equations of the other.
static enum status update(struct inversion *inversion, double *extra) {
    if (inversion->joint && inversion->joint->states > 1)
        return newton_step(inversion, extra);
    if (!in_basin(inversion))
        return careful_step(inversion, inversion->step);
    TRY(careful_step(inversion, inversion->other_step));
    inversion->has_other = true;
    return newton_step(inversion, extra);
}

const struct inverse_method mf_automatic = {
    .name = "auto",
    .summary = "hypernetted-chain steps (Delbary et al. 2020; in 2-D and of molecules Boltzmann "
               "inversion, Reith et al. 2003) until their linear response holds, or with groups "
               "until the targets are near, then inverse Monte Carlo (Lyubartsev and Laaksonen "
               "1995)",
    .own = &(const struct inversion_rule){.update = update},
    .tables = (const struct inverse_table[]){INVERSION_TABLE, {NULL, 0}},
    .knows_molecules = true,
    .meets_integrals = true,
    .columns = columns,
    JOINT_RECORD,
};
