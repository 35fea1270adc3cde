// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/equilibrium.h"

#include "base/memory.h"
#include "base/statistics.h"
#include "observe/equilibration.h"

#include <math.h>

/// Longer series are averaged in blocks first, so that their autocovariances stay cheap.
enum { MAX_BLOCKS = 4096 };

/// Samples by which correlation can be told, and how many independent ones are enough.
static const size_t min_of_all = 50;
static const double enough = 10;

/// Relative scatter that sums of doubles have by themselves.
static const double rounding = 1e-9;

static double mean_of(const double *values, size_t count) {
    double sum = 0;
    for (size_t k = 0; k < count; k++)
        sum += values[k];
    return sum / (double)count;
}

/// Means of blocks of `each` samples.
static void average(const double *series, size_t each, double *block, size_t blocks) {
    for (size_t b = 0; b < blocks; b++)
        block[b] = mean_of(series + b * each, each);
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
        samples, name, mean_of(block, blocks), unit, fmax(1, independent));
}

enum status mf_equilibrium_check(const char *name, const char *unit, const double *series,
                                 size_t samples) {
    struct running_mean all = {0};
    OWNED double *block = NULL;
    for (size_t k = 0; k < samples; k++)
        mf_statistics_add(&all, series[k]);
    if (!(sqrt(all.squares / all.count) > rounding * fabs(all.mean)))
        return STATUS_OK;
    const size_t each = (samples + MAX_BLOCKS - 1) / MAX_BLOCKS, blocks = samples / each;
    TRY_ARRAY(block, blocks);
    average(series, each, block, blocks);
    TRY(assess_drift(name, unit, block, blocks));
    if (samples >= min_of_all)
        TRY(assess_correlation(name, unit, block, blocks, samples));
    return STATUS_OK;
}
