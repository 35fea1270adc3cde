// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/equilibration.h"

#include "base/statistics.h"

#include <gsl/gsl_cdf.h>
#include <math.h>

static const size_t min_samples = 20;

/// Variances of means that are as good as the least, whose own scatter makes some tail the best.
static const double as_good = 1.1;

/// False alarms of one test of a mean, of which a trajectory has a hundred, each of several
/// beginnings; and of events.
static const double false_alarms = 1e-7, chance = 1e-4;

/// Relative differences that digits of files make.
static const double rounding = 1e-6;

/// A series from a sample on.
struct tail {
    size_t start;
    struct running_mean mean;
    double inefficiency;
};

static struct tail tail_of(const double *series, size_t samples, size_t start) {
    const size_t left = samples - start;
    struct tail tail = {.start = start,
                        .inefficiency = mf_statistics_inefficiency(series + start, left, 1, 1)};
    for (size_t k = start; k < samples; k++)
        mf_statistics_add(&tail.mean, series[k]);
    return tail;
}

static double independent(const struct tail *tail) {
    return tail->mean.count / tail->inefficiency;
}

static double variance_of_mean(const struct tail *tail) {
    return tail->mean.squares / (tail->mean.count - 1) / independent(tail);
}

/// Whether the mean of the first `count` samples is off from that of the tail.
static bool differs(const double *series, size_t count, const struct tail *tail) {
    struct running_mean head = {0};
    for (size_t k = 0; k < count; k++)
        mf_statistics_add(&head, series[k]);
    const double freedom = independent(tail) - 1;
    const double alone = fmax(1, head.count / tail->inefficiency);
    const double error = sqrt(variance_of_mean(tail) * (1 + independent(tail) / alone));
    const double off = fabs(head.mean - tail->mean.mean);
    return freedom > 1 && off > rounding * fabs(tail->mean.mean) &&
           off > error * gsl_cdf_tdist_Qinv(0.5 * false_alarms, freedom);
}

/// What decays is seen best in its first part, whose length is not known.
static bool has_beginning(const double *series, const struct tail *tail) {
    for (size_t count = 1; count < tail->start; count *= 2)
        if (differs(series, count, tail))
            return true;
    return tail->start > 0 && differs(series, tail->start, tail);
}

/// Beginnings are a sixth apart, since none is known better.
static size_t next(size_t start) {
    return start + 1 + start / 6;
}

/// Of tails whose means are as well known as that of the best, the longest.
static struct tail longest_of(const double *series, size_t samples, const struct tail *best) {
    for (size_t s = 0; s < best->start; s = next(s)) {
        const struct tail tail = tail_of(series, samples, s);
        if (variance_of_mean(&tail) < as_good * variance_of_mean(best))
            return tail;
    }
    return *best;
}

size_t mf_equilibration_length(const double *series, size_t samples) {
    if (samples < min_samples)
        return 0;
    struct tail best = tail_of(series, samples, 0);
    for (size_t s = 1; s <= samples / 2; s = next(s)) {
        const struct tail tail = tail_of(series, samples, s);
        if (variance_of_mean(&tail) < variance_of_mean(&best))
            best = tail;
    }
    if (!has_beginning(series, &best))
        return 0;
    return longest_of(series, samples, &best).start;
}

size_t mf_equilibration_length_of_events(const double *events, size_t samples) {
    double together = 0;
    size_t end = 0;
    for (size_t k = 0; k < samples; k++) {
        together = fmax(together, events[k]);
        end = events[k] > 0 ? k + 1 : end;
    }
    if (samples < min_samples || 2 * end > samples)
        return 0;
    return pow((double)end / (double)samples, together) < chance ? end : 0;
}

/// Parts of a series that may drift, and the farthest that are compared for their noise.
enum { PARTS = 20, LAGS = 2 };

static void find_parts(const double *series, size_t samples, double part[PARTS]) {
    for (size_t b = 0; b < PARTS; b++) {
        struct running_mean mean = {0};
        for (size_t k = b * samples / PARTS; k < (b + 1) * samples / PARTS; k++)
            mf_statistics_add(&mean, series[k]);
        part[b] = mean.mean;
    }
}

/// Half of the mean square of what parts `lag` apart differ by, without the `lag` largest: one step
/// makes so many.
static double noise_of(const double part[PARTS], size_t lag) {
    double largest[LAGS] = {0}, sum = 0;
    for (size_t b = 0; b + lag < PARTS; b++) {
        double square = pow(part[b + lag] - part[b], 2);
        for (size_t k = 0; k < lag; k++) {
            const double smaller = fmin(square, largest[k]);
            largest[k] = fmax(square, largest[k]);
            square = smaller;
        }
        sum += square;
    }
    return 0.5 * sum / (double)(PARTS - 2 * lag);
}

struct equilibration_drift mf_equilibration_drift(const double *series, size_t samples) {
    struct equilibration_drift most = {0};
    double part[PARTS], noise = 0, all = 0, first = 0;
    if (samples < min_samples)
        return most;
    find_parts(series, samples, part);
    for (size_t lag = 1; lag <= LAGS; lag++)
        noise = fmax(noise, noise_of(part, lag));
    for (size_t b = 0; b < PARTS; b++)
        all += part[b];
    for (size_t k = 1; k < PARTS; k++) {
        first += part[k - 1];
        const double left = (double)(PARTS - k), before = first / (double)k;
        const double after = (all - first) / left, off = fabs(before - after);
        const double error = sqrt(noise * (1 / (double)k + 1 / left));
        const double ratio = off > rounding * fabs(after) ? off / error : 0;
        if (ratio > most.ratio)
            most = (struct equilibration_drift){.ratio = ratio,
                                                .part = (double)k / PARTS,
                                                .before = before,
                                                .after = after,
                                                .before_error = sqrt(noise / (double)k),
                                                .after_error = sqrt(noise / left)};
    }
    return most;
}
