// SPDX-License-Identifier: GPL-3.0-or-later
//
// Iterative Boltzmann inversion. D. Reith, M. Pütz and F. Müller-Plathe, J. Comput. Chem. 24, 1624
// (2003).
#include "inversion/inversion.h"

#include <math.h>

static const char *const columns[] = {INVERSION_COLUMNS, NULL};

void mf_ibi_logarithms(const struct inversion *inversion, double *step) {
    const struct potential_grid *grid = &inversion->grid;
    for (size_t n = 0; n < grid->known; n++) {
        if (!grid->seen[n]) {
            step[grid->known_point[n]] = 0;
            continue;
        }
        // An empty bin is as full as one with the threshold's few pairs.
        const size_t bin = grid->known_bin[n];
        const double least = inversion->least[bin];
        const double g = fmax(mf_inversion_g(inversion, bin), least);
        const double target = fmax(mf_inversion_target_g(inversion, bin), least);
        step[grid->known_point[n]] = inversion->problem->scene.temperature * log(g / target);
    }
}

/// Standard error of S − S* of the present samples. A bin that has happened to be empty, or nearly
/// so, has that of the counts that its target expects there, since its own scatter tells nothing.
static double error_of(const struct inversion *inversion, size_t n) {
    const size_t bin = inversion->grid.known_bin[n];
    const struct comoments *counts = &inversion->replicas.counts;
    const double scatter =
        fmax(mf_comoments_covariance(counts, bin, bin), inversion->target_counts[bin]);
    return sqrt(scatter * inversion->inefficiency / counts->count +
                pow(inversion->target_error[bin], 2));
}

/// Where the target of a group has few counts, the logarithm of a few is mostly noise, which would
/// dig wells of a single bin into U: S counts as that within two standard errors which is nearest
/// to the target.
static void keep_within_noise(const struct inversion *inversion, double *step) {
    static const double errors = 2;
    const struct potential_grid *grid = &inversion->grid;
    for (size_t n = grid->pairs_known; n < grid->known; n++) {
        const size_t bin = grid->known_bin[n];
        const double least = inversion->least[bin] * inversion->ideal[bin];
        const double target = inversion->target_counts[bin];
        const double excess = inversion->replicas.counts.mean[bin] - target;
        const double beyond = fmax(0, fabs(excess) - errors * error_of(inversion, n));
        const double counts = target + copysign(beyond, excess);
        if (grid->seen[n] && !grid->well_known[n])
            step[grid->known_point[n]] = inversion->problem->scene.temperature *
                                         log(fmax(counts, least) / fmax(target, least));
    }
}

void mf_ibi_step(const struct inversion *inversion, double *step) {
    mf_ibi_logarithms(inversion, step);
    keep_within_noise(inversion, step);
    mf_inversion_pressure_add_ramp(inversion, step);
}

static enum status update(struct inversion *inversion, double *extra) {
    (void)extra;
    mf_ibi_step(inversion, inversion->step);
    return STATUS_OK;
}

const struct inverse_method mf_ibi = {
    .name = "ibi",
    .summary =
        "iterative Boltzmann inversion; D. Reith, M. Puetz and F. Mueller-Plathe, J. Comput. "
        "Chem. 24, 1624 (2003)",
    .own = &(const struct inversion_rule){.update = update, .forgets = true},
    .tables = (const struct inverse_table[]){INVERSION_TABLE, {NULL, 0}},
    .knows_molecules = true,
    .columns = columns,
    .create = mf_inversion_create,
    INVERSION_RECORD,
};
