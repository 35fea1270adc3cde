// SPDX-License-Identifier: GPL-3.0-or-later
//
// Iterative Boltzmann inversion. D. Reith, M. Pütz and F. Müller-Plathe, J. Comput. Chem. 24, 1624
// (2003).
#include "inversion/inversion.h"
#include "inversion/inversions.h"
#include "inversion/method_steps.h"

#include <math.h>

static const char *const columns[] = {INVERSION_COLUMNS, NULL};

void mf_ibi_logarithms(const struct inversion_state *state, double *step) {
    const struct potential_grid *grid = &state->grid;
    for (size_t n = 0; n < grid->known; n++) {
        if (!grid->seen[n]) {
            step[grid->known_point[n]] = 0;
            continue;
        }
        // An empty bin is as full as one with the threshold's few pairs.
        const size_t bin = grid->known_bin[n];
        const double min = state->target.min[bin];
        const double g = fmax(mf_inversion_g(state, bin), min);
        const double target = fmax(mf_inversion_target_g(state, bin), min);
        step[grid->known_point[n]] = state->problem->scene.temperature * log(g / target);
    }
}

/// Standard error of S − S* of the present samples. A bin that has happened to be empty, or nearly
/// so, has that of the counts that its target expects there, since its own scatter tells nothing.
static double error_of(const struct inversion_state *state, size_t n) {
    const size_t bin = state->grid.known_bin[n];
    const struct comoments *counts = &state->replicas.counts;
    const double scatter =
        fmax(mf_comoments_covariance(counts, bin, bin), state->target.counts[bin]);
    return sqrt(scatter * state->bin_inefficiency[n] / counts->count +
                pow(state->target.error[bin], 2));
}

/// Where the target of a group has few counts, the logarithm of a few is mostly noise, which would
/// dig wells of a single bin into U: S counts as that within two standard errors which is nearest
/// to the target.
static void keep_within_noise(const struct inversion_state *state, double *step) {
    static const double errors = 2;
    const struct potential_grid *grid = &state->grid;
    for (size_t n = grid->pairs_known; n < grid->known; n++) {
        const size_t bin = grid->known_bin[n];
        const double min = state->target.min[bin] * state->target.ideal[bin];
        const double target = state->target.counts[bin];
        const double excess = state->replicas.counts.mean[bin] - target;
        const double beyond = fmax(0, fabs(excess) - errors * error_of(state, n));
        const double counts = target + copysign(beyond, excess);
        if (grid->seen[n] && !grid->well_known[n])
            step[grid->known_point[n]] =
                state->problem->scene.temperature * log(fmax(counts, min) / fmax(target, min));
    }
}

void mf_ibi_step(const struct inversion_state *state, double *step) {
    mf_ibi_logarithms(state, step);
    keep_within_noise(state, step);
    mf_inversion_bulk_add_ramp(state, step);
}

static enum status update(struct inversion *inversion, double *extra) {
    (void)extra;
    mf_ibi_step(inversion->state, inversion->course.step);
    return STATUS_OK;
}

const struct inverse_method mf_ibi = {
    .name = "ibi",
    .summary =
        "iterative Boltzmann inversion; D. Reith, M. Puetz and F. Mueller-Plathe, J. Comput. "
        "Chem. 24, 1624 (2003)",
    .own = &(const struct inversion_rule){.update = update, .memoryless = true},
    .knows_molecules = true,
    .columns = columns,
    .create = mf_inversion_create,
    INVERSION_PARAMETERS,
    INVERSION_RECORD,
};
