// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/density_profile.h"

#include "base/memory.h"
#include "base/statistics.h"
#include "io/data_table.h"

#include <math.h>
#include <string.h>

/// 1 u/nm³ [g/cm³].
static const double gram_per_cubic_centimetre = UNITS_ATOMIC_MASS * 1e3 / 1e-21;

enum status mf_density_profile_init(struct density_profile *profile,
                                    const struct density_profile_plan *plan) {
    *profile = (struct density_profile){.plan = *plan};
    profile->row = (size_t)plan->composition.types * plan->bins * (plan->masses ? 2 : 1);
    TRY(mf_sample_blocks_init(&profile->blocks, plan->samples));
    TRY_ARRAY(profile->sums, profile->blocks.count * profile->row);
    return STATUS_OK;
}

void mf_density_profile_clear(struct density_profile *profile) {
    mf_sample_blocks_clear(&profile->blocks);
    mf_memory_free(profile->sums);
    *profile = (struct density_profile){0};
}

void mf_density_profile_next(struct density_profile *profile) {
    struct sample_blocks *const blocks = &profile->blocks;
    if (mf_sample_blocks_are_full(blocks)) {
        mf_sample_blocks_join(blocks, profile->sums, profile->row);
        mf_sample_blocks_double(blocks);
    }
    profile->block = profile->sums + mf_sample_blocks_take(blocks) * profile->row;
}

size_t mf_density_profile_spans(struct density_profile *profile, struct memory_span *spans) {
    const size_t n = mf_sample_blocks_spans(&profile->blocks, spans);
    const size_t size = profile->blocks.count * profile->row * sizeof *profile->sums;
    spans[n] = (struct memory_span){profile->sums, size};
    return n + 1;
}

/// A curve over the bins: of one type, or of the sum of several.
struct profile_curve {
    size_t first, types; ///< parts of a row
    double beads;        ///< of them, in all bins
    double unit;
    double *density, *error; ///< shape [bins]
};

static double sum_at(const struct density_profile *profile, const struct profile_curve *curve,
                     size_t block, size_t bin) {
    const size_t bins = profile->plan.bins;
    const double *const row = profile->sums + block * profile->row;
    double sum = 0;
    for (size_t type = curve->first; type < curve->first + curve->types; type++)
        sum += row[type * bins + bin];
    return sum * curve->unit;
}

/// Where nothing was: what one visit would have made.
static void mark_empty_bins(const struct density_profile *profile,
                            const struct profile_curve *curve) {
    double density = 0, squares = 0;
    for (size_t k = 0; k < profile->plan.bins; k++) {
        density += curve->density[k];
        squares += curve->error[k] * curve->error[k];
    }
    const double one = density / (curve->beads * (double)profile->blocks.taken);
    const double visit = one > 0 ? fmax(1, squares / (one * density)) * one : NAN;
    mf_statistics_mark_unknown_errors(curve->error, profile->plan.bins);
    for (size_t k = 0; k < profile->plan.bins; k++)
        if (curve->density[k] == 0 && !isnan(curve->error[k]))
            curve->error[k] = visit;
}

/// Mean over all samples, and the error by the blocks.
static enum status find_curve(const struct density_profile *profile,
                              const struct profile_curve *curve) {
    const size_t bins = profile->plan.bins, whole = mf_sample_blocks_whole(&profile->blocks);
    OWNED double *series = NULL;
    TRY_ARRAY(series, bins * whole + 1);
    for (size_t k = 0; k < bins; k++) {
        double sum = 0;
        for (size_t b = 0; b < profile->blocks.count; b++)
            sum += sum_at(profile, curve, b, k);
        for (size_t b = 0; b < whole; b++)
            series[k * whole + b] = sum_at(profile, curve, b, k) / profile->blocks.samples[b];
        curve->density[k] = sum / (double)profile->blocks.taken;
    }
    mf_statistics_correlated_errors(series, whole, 1, bins, curve->error);
    mark_empty_bins(profile, curve);
    return STATUS_OK;
}

/// Columns that are made, and their names.
struct columns {
    struct data_column column[1 + 2 * (2 * COMPOSITION_MAX_TYPES + 1)];
    char name[1 + 2 * (2 * COMPOSITION_MAX_TYPES + 1)][2 * COMPOSITION_NAME_SIZE + 32];
    size_t count;
};

/// "density_A[unit]" and "error_A[unit]".
static void name_columns(struct columns *columns, const char *const words[2], const char *type,
                         const char *unit, const struct profile_curve *curve) {
    for (int k = 0; k < 2; k++) {
        const size_t n = columns->count++;
        snprintf(columns->name[n], sizeof columns->name[n], "%s%s%s[%s]", words[k],
                 type[0] ? "_" : "", type, unit);
        columns->column[n] =
            (struct data_column){columns->name[n], k ? curve->error : curve->density, "%.6g"};
    }
}

static enum status add_curves(const struct density_profile *profile, int dimensions, double *values,
                              struct columns *columns) {
    static const char *const number[] = {"density", "error"}, *const mass[] = {"mass_density",
                                                                               "mass_error"};
    const struct composition *const composition = &profile->plan.composition;
    const size_t bins = profile->plan.bins, types = (size_t)composition->types;
    const bool mixed = composition_is_mixed(composition);
    const size_t parts = profile->plan.masses ? 2 * types : types;
    for (size_t part = 0; part < parts + (mixed && profile->plan.masses); part++) {
        const bool weighed = part >= types, all = part == parts;
        const char *const type = mixed && !all ? composition->name[part % types] : "";
        const struct profile_curve curve = {.first = all ? types : part,
                                            .types = all ? types : 1,
                                            .beads =
                                                all ? (double)mf_composition_particles(composition)
                                                    : (double)composition->count[part % types],
                                            .unit = weighed ? gram_per_cubic_centimetre : 1,
                                            .density = values + 2 * part * bins,
                                            .error = values + (2 * part + 1) * bins};
        TRY(find_curve(profile, &curve));
        name_columns(columns, weighed ? mass : number, type,
                     weighed           ? "g/cm^3"
                     : dimensions == 3 ? "1/lambda^3"
                                       : "1/lambda^2",
                     &curve);
    }
    return STATUS_OK;
}

enum status mf_density_profile_write(const struct density_profile *profile, double length,
                                     int dimensions, const struct observable_results *results) {
    const size_t bins = profile->plan.bins;
    struct columns columns = {.count = 1};
    OWNED double *values = NULL;
    TRY_ARRAY(values, bins + 2 * (profile->row + bins));
    for (size_t k = 0; k < bins; k++)
        values[k] = ((double)k + 0.5) * length / (double)bins;
    snprintf(columns.name[0], sizeof columns.name[0], "%s[lambda]",
             mf_density_profile_axes[profile->plan.axis]);
    columns.column[0] = (struct data_column){columns.name[0], values, "%.6g"};
    TRY(add_curves(profile, dimensions, values + bins, &columns));
    return mf_observable_table(results, "density_profile.tsv", columns.column, columns.count, bins);
}

const char *const mf_density_profile_axes[] = {"x", "y", "z", NULL};
