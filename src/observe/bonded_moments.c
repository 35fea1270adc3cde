// SPDX-License-Identifier: GPL-3.0-or-later
//
// How wide distributions of bonds and angles are, and which of them are constraints.
#include "observe/bonded_distribution.h"

#include <math.h>

const double mf_bonded_distribution_seen = 1e-3;

struct bonded_moments mf_bonded_distribution_moments(const struct bonded_bins *bins,
                                                     const double *p) {
    struct bonded_moments moments = {0};
    double sum = 0, mean = 0, square = 0, peak = 0;
    size_t first = bins->count, last = 0;
    for (size_t k = 0; k < bins->count; k++) {
        const double q = bonded_bins_centre(bins, k);
        sum += p[k];
        mean += p[k] * q;
        peak = fmax(peak, p[k]);
    }
    mean /= sum;
    for (size_t k = 0; k < bins->count; k++) {
        square += p[k] * pow(bonded_bins_centre(bins, k) - mean, 2) / sum;
        if (p[k] <= mf_bonded_distribution_seen * peak)
            continue;
        first = first == bins->count ? k : first;
        last = k;
    }
    moments.mean = mean;
    moments.deviation = sqrt(fmax(0, square - bins->width * bins->width / 12));
    moments.seen = first < bins->count ? last + 1 - first : 0;
    return moments;
}

double mf_bonded_distribution_narrow(int order, double mean) {
    const struct bonded_kind *kind = mf_bonded_kinds[order];
    return kind->is_length ? kind->narrow * mean : kind->narrow;
}

bool mf_bonded_distribution_is_constrained(int order, const struct bonded_moments *moments) {
    return moments->deviation < mf_bonded_distribution_narrow(order, moments->mean);
}
