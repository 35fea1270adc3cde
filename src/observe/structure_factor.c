// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/structure_factor.h"

#include "base/memory.h"
#include "base/statistics.h"
#include "io/data_table.h"

#include <math.h>
#include <string.h>

enum { MAX_BLOCKS = 64 };

enum status mf_structure_factor_init(struct structure_factor *factor,
                                     const struct density_waves_plan *plan, size_t planned) {
    const struct composition *const composition = &plan->composition;
    *factor = (struct structure_factor){
        .composition = *composition,
        .curves =
            composition_is_mixed(composition) ? 1 + (size_t)mf_composition_pairs(composition) : 1,
        .bins = plan->bins,
        .endless = planned == 0};
    factor->each = planned > 0 ? (planned + MAX_BLOCKS - 1) / MAX_BLOCKS : 1;
    factor->blocks = planned > 0 ? planned / factor->each : MAX_BLOCKS;
    TRY_ARRAY(factor->sums, factor->blocks * mf_structure_factor_numbers(factor));
    return STATUS_OK;
}

void mf_structure_factor_clear(struct structure_factor *factor) {
    mf_memory_free(factor->sums);
    *factor = (struct structure_factor){0};
}

size_t mf_structure_factor_numbers(const struct structure_factor *factor) {
    return (factor->curves + 2) * factor->bins;
}

// Samples -----------------------------------------------------------------------------------------

/// What a sample has.
static void take(const struct density_waves *waves, double *numbers) {
    const size_t bins = waves->plan.bins;
    memset(numbers, 0, waves->curves * bins * sizeof *numbers);
    mf_density_waves_add(waves, numbers);
    memcpy(numbers + waves->curves * bins, waves->q, bins * sizeof *numbers);
    memcpy(numbers + (waves->curves + 1) * bins, waves->members, bins * sizeof *numbers);
}

/// Make of every two blocks one, of twice the samples.
static void join_blocks(struct structure_factor *factor) {
    const size_t numbers = mf_structure_factor_numbers(factor), half = factor->blocks / 2;
    for (size_t b = 0; b < half; b++)
        for (size_t k = 0; k < numbers; k++)
            factor->sums[b * numbers + k] =
                factor->sums[2 * b * numbers + k] + factor->sums[(2 * b + 1) * numbers + k];
    memset(factor->sums + half * numbers, 0, half * numbers * sizeof *factor->sums);
    factor->each *= 2;
}

void mf_structure_factor_add(struct structure_factor *factor, const struct density_waves *waves,
                             double *numbers) {
    const size_t count = mf_structure_factor_numbers(factor);
    take(waves, numbers);
    if (factor->endless && factor->samples == factor->blocks * factor->each)
        join_blocks(factor);
    const size_t block = factor->samples++ / factor->each;
    if (block >= factor->blocks)
        return;
    for (size_t k = 0; k < count; k++)
        factor->sums[block * count + k] += numbers[k];
}

// Results -----------------------------------------------------------------------------------------

size_t mf_structure_factor_blocks(const struct structure_factor *factor) {
    const size_t blocks = factor->samples / factor->each;
    return blocks < factor->blocks ? blocks : factor->blocks;
}

/// One of the numbers of a bin, in one block.
static double sum_at(const struct structure_factor *factor, size_t block, size_t row, size_t bin) {
    return factor->sums[block * mf_structure_factor_numbers(factor) + row * factor->bins + bin];
}

/// The mean over all waves and samples, and the error by the means of those blocks that have any
/// wave: where the box changes, a bin may have none at times.
static void find_point(const struct structure_factor *factor, size_t curve, size_t bin,
                       double *value, double *error) {
    const size_t blocks = mf_structure_factor_blocks(factor);
    double means[MAX_BLOCKS], sum = 0, all = 0;
    size_t count = 0;
    for (size_t b = 0; b < blocks; b++) {
        const double members = sum_at(factor, b, factor->curves + 1, bin);
        if (!(members > 0))
            continue;
        sum += sum_at(factor, b, curve, bin);
        all += members;
        means[count++] = sum_at(factor, b, curve, bin) / members;
    }
    *value = all > 0 ? sum / all : NAN;
    *error = mf_statistics_correlated_error(means, count, 1);
}

enum status mf_structure_factor_find(const struct structure_factor *factor,
                                     struct structure_factor_curves *curves) {
    enum status status = STATUS_OK;
    const size_t blocks = mf_structure_factor_blocks(factor);
    size_t kept = 0;
    *curves = (struct structure_factor_curves){0};
    NEW_ARRAY(curves->q, factor->bins);
    NEW_ARRAY(curves->members, factor->bins);
    NEW_ARRAY(curves->value, factor->curves * factor->bins);
    NEW_ARRAY(curves->error, factor->curves * factor->bins);
    for (size_t bin = 0; bin < factor->bins; bin++) {
        double q = 0, members = 0;
        // A block that is not complete says where the waves are if there is no other.
        for (size_t b = 0; b < (blocks > 0 ? blocks : 1); b++) {
            q += sum_at(factor, b, factor->curves, bin);
            members += sum_at(factor, b, factor->curves + 1, bin);
        }
        if (!(members > 0))
            continue;
        const size_t samples =
            factor->samples < factor->each ? factor->samples : blocks * factor->each;
        curves->q[kept] = q / members;
        curves->members[kept] = members / (double)samples;
        for (size_t curve = 0; curve < factor->curves; curve++) {
            const size_t at = curve * factor->bins + kept;
            find_point(factor, curve, bin, &curves->value[at], &curves->error[at]);
        }
        kept++;
    }
    curves->bins = kept;
done:
    if (status != STATUS_OK)
        mf_structure_factor_curves_clear(curves);
    return status;
}

void mf_structure_factor_curves_clear(struct structure_factor_curves *curves) {
    mf_memory_free(curves->q);
    mf_memory_free(curves->members);
    mf_memory_free(curves->value);
    mf_memory_free(curves->error);
    *curves = (struct structure_factor_curves){0};
}

enum status mf_structure_factor_write(const struct structure_factor *factor,
                                      const struct observable_results *results) {
    CLEARED_BY(mf_structure_factor_curves_clear) struct structure_factor_curves curves = {0};
    struct data_column columns[2 + 2 * (1 + COMPOSITION_MAX_PAIRS)];
    static const char *const beside[sizeof columns / sizeof *columns] = {"%.10g"};
    char names[2 * (1 + COMPOSITION_MAX_PAIRS)][COMPOSITION_PAIR_NAME_SIZE + 16];
    char path[OUTPUT_PATH_SIZE];
    size_t n = 0;
    TRY(mf_structure_factor_find(factor, &curves));
    columns[n++] = (struct data_column){"q[1/lambda]", curves.q, NULL};
    for (size_t curve = 0; curve < factor->curves; curve++) {
        char pair[COMPOSITION_PAIR_NAME_SIZE] = "", brackets[COMPOSITION_PAIR_NAME_SIZE + 2] = "";
        double *const value = curves.value + curve * factor->bins, *const error =
                                                                       curves.error +
                                                                       curve * factor->bins;
        mf_statistics_mark_unknown_errors(error, curves.bins);
        if (curve > 0) {
            mf_composition_pair_name(&factor->composition, (int)curve - 1, pair);
            snprintf(brackets, sizeof brackets, "(%s)", pair);
        }
        snprintf(names[2 * curve], sizeof *names, "S%s[1]", brackets);
        snprintf(names[2 * curve + 1], sizeof *names, "S_error%s[1]", brackets);
        columns[n++] = (struct data_column){names[2 * curve], value, "%.8g"};
        columns[n++] = (struct data_column){names[2 * curve + 1], error, "%.3g"};
    }
    columns[n++] = (struct data_column){"vectors[1]", curves.members, "%.7g"};
    mf_observable_file(results, "structure_factor.tsv", path);
    return mf_data_table_write_beside(path, results->units, columns, beside, n, curves.bins);
}
