// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bins that are joined when all has been counted.
#include "base/memory.h"
#include "observe/bonded_state.h"

#include <math.h>

static double count_all(const struct bonded_state *s, int group, size_t bin) {
    const size_t all = s->first[s->molecules->groups[s->order]];
    double count = 0;
    for (size_t block = 0; block < s->blocks.count; block++)
        count += s->counts[block * all + s->first[group] + bin];
    return count;
}

/// How wide the bins of a group may be. Of several peaks the deviation is the sum of theirs: that
/// of the normal distribution with the same ∫ p² dq, which is known, however narrow it is, by how
/// many pairs of counts fall into the same bin, if they do.
static double wanted_width(const struct bonded_state *s, int group) {
    static const double fewest = 2, max = 5, scott = 3.49, enough = 40;
    const struct bonded_bins *bins = &s->bins[group];
    double all = 0, pairs = 0, mean = 0, square = 0;
    for (size_t bin = 0; bin < bins->count; bin++) {
        const double count = count_all(s, group, bin), q = bonded_bins_centre(bins, bin);
        all += count;
        pairs += count * (count - 1);
        mean += count * q;
        square += count * q * q;
    }
    if (all == 0)
        return INFINITY;
    mean /= all;
    double deviation = sqrt(fmax(0, square / all - mean * mean));
    if (pairs > enough)
        deviation = fmin(deviation, all * (all - 1) * bins->width / (2 * sqrt(M_PI) * pairs));
    return fmax(deviation, mf_bonded_distribution_narrow(s->order, mean)) /
           fmin(max, fmax(fewest, cbrt(all) / scott));
}

/// The largest number of fine bins that make a whole number of bins and are not wider than wanted.
static size_t bins_to_join(const struct bonded_state *s) {
    enum { MIN = 100 };
    double width = INFINITY;
    for (int g = 0; g < s->molecules->groups[s->order]; g++)
        width = fmin(width, wanted_width(s, g));
    size_t of = s->bins[0].count / MIN;
    while (of > 1 && (s->bins[0].count % of != 0 || (double)of * s->bins[0].width > width))
        of--;
    return of;
}

/// Join the bins of `rows` rows. All groups have a whole number of bins, so that a row is one run.
static void join_rows(double *counts, size_t rows, size_t row, size_t of) {
    for (size_t k = 0; k < rows * row / of; k++) {
        double sum = 0;
        for (size_t n = 0; n < of; n++)
            sum += counts[k * of + n];
        counts[k] = sum;
    }
}

void mf_bonded_distribution_join(void *state) {
    struct bonded_state *s = state;
    const int groups = s->molecules->groups[s->order];
    const size_t of = bins_to_join(s), row = s->first[groups];
    join_rows(s->counts, s->blocks.count, row, of);
    join_rows(s->of_part, s->parts, row, of);
    for (int g = 0; g < groups; g++) {
        s->bins[g].count /= of;
        s->bins[g].width *= (double)of;
        s->first[g + 1] = s->first[g] + s->bins[g].count;
    }
}

double *mf_bonded_distribution_counts(const void *state, int group, struct bonded_bins *bins) {
    const struct bonded_state *s = state;
    double *counts = mf_memory_zeroed(s->bins[group].count, sizeof *counts);
    *bins = s->bins[group];
    for (size_t bin = 0; counts && bin < bins->count; bin++)
        counts[bin] = count_all(s, group, bin);
    return counts;
}
