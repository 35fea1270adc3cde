// SPDX-License-Identifier: GPL-3.0-or-later
//
// What counts alone allow the error of a potential to be at least.
#include "inversion/inversion.h"

#include <gsl/gsl_sf_psi.h>
#include <math.h>

double mf_inversion_poisson_error(double counts) {
    return isfinite(counts) ? sqrt(gsl_sf_psi_1(counts + 0.5)) : 0;
}

/// Counts whose mean has this variance; without any there is none to be had.
static double counts_of(double mean, double variance) {
    return mean > 0 ? mean * mean / fmax(variance, 0) : 0;
}

/// Counts of all states, and the sum of those over k_B T² of each.
struct counted {
    double counts, weighed;
};

/// A state's counts tell Φ/k_B T with its own T.
static void count_state(struct counted *all, const struct inversion_state *state, double counts) {
    all->counts += counts;
    all->weighed += counts / pow(state->problem->scene.temperature, 2);
}

/// Error of Φ where so many were counted; where nobody counted any, that of the first state.
static double error_of_counts(const struct inversion *inversion, const struct counted *all) {
    if (isinf(all->counts))
        return 0;
    const double temperature =
        all->counts > 0 ? sqrt(all->counts / all->weighed) : inversion->problem->scene.temperature;
    return temperature * mf_inversion_poisson_error(all->counts);
}

/// The variance of a group's target that is noise of each bin by itself grows with its counts as
/// those of unlike bins do: its part of them, by the fourth differences of the bins, which see
/// nothing of what neighbours have in common.
static double find_scatter(const struct inversion_state *state, size_t first, size_t end) {
    enum { TAPS = 5 };
    static const double taps[TAPS] = {1, -4, 6, -4, 1};
    double squares = 0, counts = 0;
    for (size_t a = first; a + TAPS <= end; a++) {
        double difference = 0, expected = 0;
        for (size_t k = 0; k < TAPS; k++) {
            const double count = state->target.counts[state->grid.known_bin[a + k]];
            difference += taps[k] * count;
            expected += taps[k] * taps[k] * count;
        }
        squares += expected > 0 ? difference * difference / expected : 0;
        counts += expected > 0;
    }
    return counts > 0 ? squares / counts : INFINITY;
}

/// What the bins of a group have in common of the error of −k_B T ln p, as the populations of two
/// wells that a molecule seldom leaves: a smooth U follows it, and is not known better.
static double min_of_group(const struct inversion *inversion, size_t a) {
    const struct potential_grid *grid = inversion_grid(inversion);
    const size_t bin = grid->known_bin[a];
    size_t first = grid->pairs_known, end, group = 0;
    struct counted known = {0};
    while (a >= (end = first + grid->group[group].own.known)) {
        first = end;
        group++;
    }
    for (size_t s = 0; s < inversion->states; s++) {
        const struct inversion_state *own = &inversion->state[s];
        const double counts = own->target.counts[bin];
        count_state(&known, own,
                    counts_of(counts, pow(own->target.error[bin], 2) -
                                          counts * find_scatter(own, first, end)));
    }
    return known.counts > 0 ? 1 / sqrt(known.weighed) : 0;
}

double mf_inversion_band_min_error(const struct inversion *inversion, size_t a) {
    const size_t bin = inversion_grid(inversion)->known_bin[a];
    struct counted asked = {0}, seen = {0};
    if (inversion->state->basis.count > 0)
        return 0;
    if (a >= inversion_grid(inversion)->pairs_known)
        return min_of_group(inversion, a);
    for (size_t s = 0; s < inversion->states; s++) {
        const struct inversion_state *own = &inversion->state[s];
        count_state(&asked, own,
                    counts_of(own->target.counts[bin], pow(own->target.error[bin], 2)));
        count_state(&seen, own,
                    counts_of(own->replicas.counts.mean[bin],
                              own->variance[a] - mf_inversion_target_variance(own, a)));
    }
    return hypot(error_of_counts(inversion, &asked), error_of_counts(inversion, &seen));
}
