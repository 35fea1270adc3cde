// SPDX-License-Identifier: GPL-3.0-or-later
//
// What is made of the counts of bonds and angles: widths, bins that are joined, series of blocks.
#include "base/memory.h"
#include "observe/bonded_distribution.h"
#include "observe/bonded_counts.h"

#include <math.h>

const double mf_bonded_distribution_seen = 1e-3;

/// The last bin of the longest stretch whose p is below a twentieth of the lower of the peaks on
/// either side, with a twentieth of all below it and above it at least; `bins->count` if there is
/// none, or the peaks are of few counts, between which bins are empty by chance.
static size_t find_valley(const struct bonded_bins *bins, const double *p, double all) {
    static const double deep = 0.05, least = 0.05, few = 20;
    size_t valley = bins->count, run = 0, longest = 0;
    double left = 0, below = 0;
    for (size_t k = 0; k < bins->count; k++) {
        double right = 0;
        for (size_t n = k + 1; n < bins->count; n++)
            right = fmax(right, p[n]);
        const double lower = fmin(left, right);
        const bool low = below >= least * all && below <= (1 - least) * all && lower >= few &&
                         p[k] < deep * lower;
        run = low ? run + 1 : 0;
        if (run > longest) {
            longest = run;
            valley = k;
        }
        left = fmax(left, p[k]);
        below += p[k];
    }
    return valley;
}

/// What lies beyond twice the median, if it is a twentieth of all or more, and these are many:
/// `bins->count` if not.
static size_t find_tail(const struct bonded_bins *bins, const double *p, double all) {
    static const double least = 0.05, farther = 2, few = 400;
    double below = 0, beyond = 0, median = INFINITY;
    size_t tail = bins->count;
    for (size_t k = 0; k < bins->count; k++) {
        const double centre = bonded_bins_centre(bins, k);
        median = below + p[k] >= 0.5 * all && isinf(median) ? centre : median;
        below += p[k];
        if (centre > farther * median) {
            tail = tail == bins->count ? k - 1 : tail;
            beyond += p[k];
        }
    }
    return all >= few && beyond >= least * all ? tail : bins->count;
}

void mf_bonded_distribution_parts(const struct bonded_bins *bins, const double *p, double part[2]) {
    static const double apart = 1.25;
    double all = 0, sum[2] = {0}, moment[2] = {0};
    for (size_t k = 0; k < bins->count; k++)
        all += p[k];
    size_t valley = find_valley(bins, p, all);
    if (valley == bins->count)
        valley = find_tail(bins, p, all);
    for (size_t k = 0; k < bins->count; k++) {
        sum[k > valley] += p[k];
        moment[k > valley] += p[k] * bonded_bins_centre(bins, k);
    }
    for (int side = 0; side < 2; side++)
        part[side] = valley < bins->count ? moment[side] / sum[side] : NAN;
    if (!(part[1] > apart * part[0])) // the digits of a file, or one peak in two
        part[0] = part[1] = NAN;
}

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

// Bins that are joined when all has been counted --------------------------------------------------

static double count_all(const struct bonded_state *s, int group, size_t bin) {
    double count = 0;
    for (size_t block = 0; block < s->blocks.count; block++)
        count += s->blocks.sums[block * s->blocks.row + s->first[group] + bin];
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
    join_rows(s->blocks.sums, s->blocks.count, row, of);
    join_rows(s->of_part, s->parts, row, of);
    for (int g = 0; g < groups; g++) {
        s->bins[g].count /= of;
        s->bins[g].width *= (double)of;
        s->first[g + 1] = s->first[g] + s->bins[g].count;
    }
    s->blocks.row = row / of;
}

double *mf_bonded_distribution_counts(const void *state, int group, struct bonded_bins *bins) {
    const struct bonded_state *s = state;
    double *counts = mf_memory_zeroed(s->bins[group].count, sizeof *counts);
    *bins = s->bins[group];
    for (size_t bin = 0; counts && bin < bins->count; bin++)
        counts[bin] = count_all(s, group, bin);
    return counts;
}

// Blocks, and how the bins are correlated by them -------------------------------------------------

size_t mf_bonded_series_blocks(const struct bonded_state *const *states, size_t count) {
    size_t min = SIZE_MAX;
    for (size_t k = 0; k < count; k++) {
        const size_t blocks = mf_sample_blocks_whole(&states[k]->blocks);
        min = blocks < min ? blocks : min;
    }
    return min;
}

void mf_bonded_series_find(const struct bonded_state *const *states, size_t count, int group,
                           size_t blocks, double *series) {
    const struct bonded_state *s = states[0];
    const double terms =
        (double)mf_bonded_distribution_terms(&s->molecules->topology, s->order, group);
    const size_t bins = s->bins[group].count;
    for (size_t bin = 0; bin < bins; bin++)
        for (size_t n = 0; n < count * blocks; n++) {
            const struct bonded_state *of = states[n / blocks];
            const size_t block = n % blocks;
            series[bin * count * blocks + n] =
                of->blocks.sums[block * of->blocks.row + s->first[group] + bin] /
                (of->blocks.samples[block] * terms * s->bins[group].width);
        }
}

enum status mf_bonded_distribution_independence(const void *const *states, size_t count, int group,
                                                size_t first, size_t bins,
                                                struct statistics_independence *found) {
    const struct bonded_state *const *all = (const struct bonded_state *const *)states;
    const size_t blocks = mf_bonded_series_blocks(all, count), values = count * blocks;
    OWNED double *series = NULL;
    TRY_ARRAY(series, all[0]->bins[group].count * values + 1);
    mf_bonded_series_find(all, count, group, blocks, series);
    return mf_statistics_independence(series + first * values, blocks, count, bins, found);
}
