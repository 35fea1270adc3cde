// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/bench_errors.h"

#include <math.h>
#include <string.h>

// The reference -----------------------------------------------------------------------------------

static struct bench_number extrapolated(struct bench_number fine, struct bench_number coarse,
                                        double weight) {
    return (struct bench_number){fine.value - weight * (coarse.value - fine.value),
                                 hypot((1 + weight) * fine.error, weight * coarse.error)};
}

static const struct bench_point *find_partner(const struct bench_point *reference,
                                              const struct bench_point *points, size_t count) {
    const struct bench_point *best = NULL;
    for (size_t k = 0; k < count; k++) {
        const struct bench_point *point = &points[k];
        const double ratio = point->time_step / reference->time_step;
        if (strcmp(point->method->name, reference->method->name) != 0 ||
            point->status != STATUS_OK || ratio < 2.5 || ratio > 6)
            continue;
        if (best == NULL ||
            fabs(log(ratio / 4)) < fabs(log(best->time_step / reference->time_step / 4)))
            best = point;
    }
    return best;
}

struct bench_extrapolation mf_bench_extrapolate(struct bench_point *reference,
                                                const struct bench_point *points, size_t count,
                                                size_t bins) {
    const struct bench_point *partner = find_partner(reference, points, count);
    if (partner == NULL)
        return (struct bench_extrapolation){0, 0};
    const double ratio = partner->time_step / reference->time_step;
    const double weight = 1 / (ratio * ratio - 1);
    double moved = 0;
    for (size_t k = 0; k < bins; k++) {
        const struct bench_number before = reference->g[k];
        reference->g[k] = extrapolated(before, partner->g[k], weight);
        moved = fmax(moved, fabs(reference->g[k].value - before.value));
    }
    for (int q = 0; q < BENCH_DRIFT; q++)
        reference->quantity[q] = extrapolated(reference->quantity[q], partner->quantity[q], weight);
    return (struct bench_extrapolation){partner->time_step, moved};
}

// Errors ------------------------------------------------------------------------------------------

double mf_bench_expected_largest(const double *error, size_t count) {
    double max = 0, sum = 0;
    for (size_t k = 0; k < count; k++)
        max = fmax(max, error[k]);
    const double step = max / 50;
    for (int i = 0; i < 400 && max > 0; i++) {
        double below = 1;
        for (size_t k = 0; k < count; k++)
            if (error[k] > 0)
                below *= erf((i + 0.5) * step / (sqrt(2) * error[k]));
        sum += (1 - below) * step;
    }
    return sum;
}

static void find_rdf_errors(const struct bench_point *point, const struct bench_point *reference,
                            size_t bins, struct bench_row *row) {
    double error[BENCH_MAX_BINS], squares = 0, variance = 0;
    double *value = row->value;
    value[BENCH_G_LARGEST] = -1;
    for (size_t k = 0; k < bins; k++) {
        const double change = fabs(point->g[k].value - reference->g[k].value);
        error[k] = hypot(point->g[k].error, reference->g[k].error);
        const double noise = error[k] * error[k];
        squares += change * change - noise;
        variance += 4 * fmax(change * change - noise, 0) * noise + 2 * noise * noise;
        if (change <= value[BENCH_G_LARGEST])
            continue;
        value[BENCH_G_LARGEST] = change;
        value[BENCH_G_LARGEST_ERROR] = error[k];
    }
    const double n = (double)bins;
    value[BENCH_G_NOISE] = mf_bench_expected_largest(error, bins);
    value[BENCH_G_RMS] = sqrt(fmax(squares / n, 0));
    value[BENCH_G_RMS_ERROR] = sqrt(fmax(squares / n, 0) + sqrt(variance) / n) - value[BENCH_G_RMS];
}

struct bench_row mf_bench_row_of(const struct bench_point *point,
                                 const struct bench_point *reference, size_t bins, double wanted) {
    struct bench_row row = {.method = point->method->name};
    double *value = row.value, worst = 0;
    for (size_t k = 0; k < bins; k++)
        worst = fmax(worst, point->g[k].error);
    value[BENCH_TIME_STEP] = point->time_step;
    value[BENCH_CPU] = point->cpu.value;
    value[BENCH_CPU_ERROR] = point->cpu.error;
    value[BENCH_CPU_TO_ERROR] = point->cpu.value * point->time * pow(worst / wanted, 2);
    find_rdf_errors(point, reference, bins, &row);
    for (int q = 0; q < BENCH_QUANTITIES; q++) {
        const struct bench_number here = point->quantity[q], there = reference->quantity[q];
        value[BENCH_CHANGES + 2 * q] = here.value - there.value;
        value[BENCH_CHANGES + 2 * q + 1] = hypot(here.error, there.error);
        value[BENCH_VALUES + 2 * q] = here.value;
        value[BENCH_VALUES + 2 * q + 1] = here.error;
    }
    return row;
}

// What to recommend -------------------------------------------------------------------------------

struct bench_limit mf_bench_limit_of(const struct bench_row *rows, size_t count, double wanted) {
    size_t good = 0;
    while (good < count && rows[good].value[BENCH_G_LARGEST] <= wanted)
        good++;
    if (good == 0)
        return (struct bench_limit){.method = NULL};
    const double *low = rows[good - 1].value;
    struct bench_limit limit = {.method = rows[good - 1].method,
                                .time_step = low[BENCH_TIME_STEP],
                                .cpu = low[BENCH_CPU],
                                .cpu_error = low[BENCH_CPU_ERROR],
                                .is_bounded = good < count};
    if (good == count)
        return limit;
    const double *high = rows[good].value;
    const double rise = log(high[BENCH_G_LARGEST] / low[BENCH_G_LARGEST]);
    const double steps = log(high[BENCH_TIME_STEP] / low[BENCH_TIME_STEP]);
    const double costs = log(high[BENCH_CPU] / low[BENCH_CPU]);
    const double part = log(wanted / low[BENCH_G_LARGEST]) / rise;
    // What the interpolated error is uncertain by moves the crossing along.
    const double noise = hypot((1 - part) * low[BENCH_G_LARGEST_ERROR] / low[BENCH_G_LARGEST],
                               part * high[BENCH_G_LARGEST_ERROR] / high[BENCH_G_LARGEST]);
    limit.time_step *= exp(part * steps);
    limit.time_step_error = limit.time_step * noise * steps / rise;
    limit.cpu *= exp(part * costs);
    const double timing = hypot((1 - part) * low[BENCH_CPU_ERROR] / low[BENCH_CPU],
                                part * high[BENCH_CPU_ERROR] / high[BENCH_CPU]);
    limit.cpu_error = limit.cpu * hypot(noise * costs / rise, timing);
    return limit;
}
