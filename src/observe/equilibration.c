// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/equilibration.h"

#include "base/statistics.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdbool.h>

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
