// SPDX-License-Identifier: GPL-3.0-or-later
//
// What is asked of a measurement that is over.
#include "measure/measured.h"

#include "base/memory.h"

#include <math.h>

enum status mf_measured_moments(const struct measured *measured, int order, int group,
                                struct bonded_moments *moments) {
    const void *const state = mf_measured_state(measured, mf_bonded_distribution_of(order));
    struct bonded_bins bins;
    OWNED double *counts = mf_bonded_distribution_counts(state, group, &bins);
    if (counts == NULL)
        return STATUS_NO_MEMORY;
    *moments = mf_bonded_distribution_moments(&bins, counts);
    return STATUS_OK;
}

const void *mf_measured_state(const struct measured *measured,
                              const struct observable *observable) {
    const struct observable_use *use = measured->use;
    while (use->observable && use->observable != observable)
        use++;
    return use->state;
}

const struct rdf *mf_measured_rdf(const struct measured *measured) {
    const struct rdf_observed *const observed = mf_measured_state(measured, &mf_rdf_observable);
    return &observed->counted;
}

double mf_measured_mean(const struct sample_series *series, double *error) {
    struct running_mean mean = {0};
    for (size_t k = 0; k < series->count; k++)
        mf_statistics_add(&mean, series->values[k]);
    if (error)
        *error = series->count < 2
                     ? NAN
                     : mf_statistics_correlated_error(series->values, series->count, 1);
    return series->count > 0 ? mean.mean : NAN;
}

struct box mf_measured_box(const struct measured *measured) {
    return mf_box_cube(mf_measured_mean(&measured->volume, NULL));
}

struct units mf_measured_units(int system) {
    return (struct units){.length = 1,
                          .temperature = 1e3 / (UNITS_BOLTZMANN * UNITS_AVOGADRO),
                          .mass = UNITS_ATOMIC_MASS,
                          .system = system};
}
