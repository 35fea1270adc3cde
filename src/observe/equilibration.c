// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/equilibration.h"

#include "base/memory.h"
#include "base/statistics.h"

#include <gsl/gsl_cdf.h>
#include <math.h>

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
    if (samples < EQUILIBRATION_MIN_SAMPLES)
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
    if (samples < EQUILIBRATION_MIN_SAMPLES || 2 * end > samples)
        return 0;
    return pow((double)end / (double)samples, together) < chance ? end : 0;
}

// Drift -------------------------------------------------------------------------------------------

/// Means of a long series by which it is judged, at most; parts of it, between which it may have a
/// step; and the farthest that are compared for their noise.
enum { POINTS = 512, PARTS = 20, LAGS = 2 };

/// Independent samples make the freedom of an error a quarter of their number: how many they are is
/// known no better where samples remember each other.
static const double freedom_share = 0.25;

struct points {
    double value[POINTS];
    size_t count;
};

static void find_points(const double *series, size_t samples, struct points *points) {
    const size_t each = (samples - 1) / POINTS + 1;
    points->count = samples / each;
    for (size_t n = 0; n < points->count; n++) {
        struct running_mean mean = {0};
        for (size_t k = n * each; k < (n + 1) * each; k++)
            mf_statistics_add(&mean, series[k]);
        points->value[n] = mean.mean;
    }
}

/// What points are off a line or a step: the variance with which each counts, and its freedom.
struct noise {
    double variance, freedom;
};

static struct noise noise_about(const struct points *left) {
    double squares = 0;
    for (size_t n = 0; n < left->count; n++)
        squares += left->value[n] * left->value[n];
    const double count = (double)left->count;
    const double inefficiency = mf_statistics_inefficiency(left->value, left->count, 1, 1);
    return (struct noise){inefficiency * squares / (count - 2),
                          freedom_share * count / inefficiency - 1};
}

/// Evidence that a number is not 0, whose variance is so many times that of a point: −lg of the
/// chance in Student's distribution.
static double judge(double number, double times, const struct noise *noise) {
    if (!(noise->freedom > 1))
        return 0;
    return -log10(2 *
                  gsl_cdf_tdist_Q(fabs(number) / sqrt(times * noise->variance), noise->freedom));
}

/// Of a line through the points: their slope.
static double judge_line(const struct points *points) {
    const double middle = 0.5 * ((double)points->count - 1);
    struct points left = *points;
    double mean = 0, slope = 0, squares = 0;
    for (size_t n = 0; n < points->count; n++) {
        const double time = (double)n - middle;
        mean += points->value[n] / (double)points->count;
        slope += time * points->value[n];
        squares += time * time;
    }
    slope /= squares;
    for (size_t n = 0; n < points->count; n++)
        left.value[n] -= mean + slope * ((double)n - middle);
    if (!(fabs(slope) * (double)points->count > rounding * fabs(mean)))
        return 0;
    const struct noise noise = noise_about(&left);
    return judge(slope, 1 / squares, &noise);
}

static struct running_mean mean_of(const struct points *points, size_t begin, size_t end) {
    struct running_mean mean = {0};
    for (size_t n = begin; n < end; n++)
        mf_statistics_add(&mean, points->value[n]);
    return mean;
}

/// The step that leaves least.
static size_t find_step(const struct points *points) {
    double least = INFINITY;
    size_t best = 0;
    for (size_t part = 1; part < PARTS; part++) {
        const size_t at = part * points->count / PARTS;
        const double left =
            mean_of(points, 0, at).squares + mean_of(points, at, points->count).squares;
        if (!(left < least))
            continue;
        least = left;
        best = at;
    }
    return best;
}

/// Of that step, which may be anywhere: its height.
static double judge_step(const struct points *points, struct equilibration_drift *drift) {
    const size_t at = find_step(points);
    const double before = (double)at, after = (double)(points->count - at);
    const struct running_mean first = mean_of(points, 0, at);
    const struct running_mean second = mean_of(points, at, points->count);
    struct points left = *points;
    for (size_t n = 0; n < points->count; n++)
        left.value[n] -= n < at ? first.mean : second.mean;
    const double height = second.mean - first.mean;
    const struct noise noise = noise_about(&left);
    *drift = (struct equilibration_drift){.part = before / (before + after),
                                          .before = first.mean,
                                          .after = second.mean,
                                          .before_error = sqrt(noise.variance / before),
                                          .after_error = sqrt(noise.variance / after)};
    if (!(fabs(height) > rounding * fabs(second.mean)))
        return 0;
    return judge(height, 1 / before + 1 / after, &noise) - log10(PARTS - 1);
}

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

/// Of all parts, the first k of them against the others. A ratio of 7.5 to the noise is as rare as
/// a chance of 0.001.
static double judge_parts(const double *series, size_t samples) {
    static const double usual = 7.5, each = 2;
    double part[PARTS], noise = 0, all = 0, first = 0, most = 0;
    find_parts(series, samples, part);
    for (size_t lag = 1; lag <= LAGS; lag++)
        noise = fmax(noise, noise_of(part, lag));
    for (size_t b = 0; b < PARTS; b++)
        all += part[b];
    for (size_t k = 1; k < PARTS; k++) {
        first += part[k - 1];
        const double left = (double)(PARTS - k), after = (all - first) / left;
        const double off = fabs(first / (double)k - after);
        const double error = sqrt(noise * (1 / (double)k + 1 / left));
        most = fmax(most, off > rounding * fabs(after) ? off / error : 0);
    }
    return 3 + (most - usual) / each;
}

struct equilibration_drift mf_equilibration_drift(const double *series, size_t samples) {
    struct equilibration_drift drift = {0};
    struct points points;
    if (samples < EQUILIBRATION_MIN_SAMPLES)
        return drift;
    find_points(series, samples, &points);
    const double step = judge_step(&points, &drift);
    drift.evidence =
        fmax(fmax(step, judge_line(&points)) - log10(2), fmax(0, judge_parts(series, samples)));
    return drift;
}

// Equilibrium
// --------------------------------------------------------------------------------------

/// Longer series are averaged in blocks first, so that their autocovariances stay cheap.
enum { MAX_BLOCKS = 4096 };

/// Samples by which correlation can be told, and how many independent ones are enough.
static const size_t min_of_all = 50;
static const double enough = 10;

/// Relative scatter that sums of doubles have by themselves.
static const double sum_rounding = 1e-9;

static double mean_of_samples(const double *values, size_t count) {
    double sum = 0;
    for (size_t k = 0; k < count; k++)
        sum += values[k];
    return sum / (double)count;
}

/// Means of blocks of `each` samples.
static void average(const double *series, size_t each, double *block, size_t blocks) {
    for (size_t b = 0; b < blocks; b++)
        block[b] = mean_of_samples(series + b * each, each);
}

static enum status assess_drift(const char *name, const char *unit, const double *block,
                                size_t blocks) {
    const struct equilibration_drift drift = mf_equilibration_drift(block, blocks);
    if (!equilibration_drifts(&drift, 1))
        return STATUS_OK;
    return mf_status_fail(STATUS_UNCONVERGED,
                          "the %s is %.6g" STATUS_UNIT " +- %.1g" STATUS_UNIT
                          " in the first %.0f %% of the samples and %.6g" STATUS_UNIT
                          " +- %.1g" STATUS_UNIT " in the rest: "
                          "the run was not in equilibrium; equilibrate for longer",
                          name, drift.before, unit, drift.before_error, unit, 100 * drift.part,
                          drift.after, unit, drift.after_error, unit);
}

static enum status assess_correlation(const char *name, const char *unit, const double *block,
                                      size_t blocks, size_t samples) {
    const double independent = (double)blocks / mf_statistics_inefficiency(block, blocks, 1, 1);
    if (independent >= enough)
        return STATUS_OK;
    return mf_status_fail(
        STATUS_UNCONVERGED,
        "the %zu samples of the %s, %.6g" STATUS_UNIT
        ", are so correlated that only %.0f are independent: its "
        "error is not well known, and the run may not be in equilibrium; run for longer",
        samples, name, mean_of_samples(block, blocks), unit, fmax(1, independent));
}

enum status mf_equilibration_check(const char *name, const char *unit, const double *series,
                                   size_t samples) {
    struct running_mean all = {0};
    OWNED double *block = NULL;
    for (size_t k = 0; k < samples; k++)
        mf_statistics_add(&all, series[k]);
    if (!(sqrt(all.squares / all.count) > sum_rounding * fabs(all.mean)))
        return STATUS_OK;
    if (samples < EQUILIBRATION_MIN_SAMPLES)
        return mf_status_fail(STATUS_UNCONVERGED,
                              "too few samples of the %s (%zu) to tell whether the run was in "
                              "equilibrium: %d at least",
                              name, samples, EQUILIBRATION_MIN_SAMPLES);
    const size_t each = (samples + MAX_BLOCKS - 1) / MAX_BLOCKS, blocks = samples / each;
    TRY_ARRAY(block, blocks);
    average(series, each, block, blocks);
    TRY(assess_drift(name, unit, block, blocks));
    if (samples >= min_of_all)
        TRY(assess_correlation(name, unit, block, blocks, samples));
    return STATUS_OK;
}
