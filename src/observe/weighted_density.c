// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/weighted_density.h"

#include "base/memory.h"
#include "base/statistics.h"

#include <math.h>

enum { MAX_BLOCKS = 40 };
enum { MEAN, SQUARE, BEYOND, SERIES };

/// ∫ w^power dV, by the rule of the middle.
static double integrate(const struct weighted_density_settings *settings, const struct box *box,
                        int power) {
    enum { STEPS = 1000 };
    const double width = settings->cutoff / STEPS;
    double sum = 0;
    for (int k = 0; k < STEPS; k++) {
        const double r = width * (k + 0.5);
        sum += pow(weighted_density_weight(settings, r * r), power) *
               mf_box_shell_volume(box, width * k, width * (k + 1));
    }
    return sum;
}

enum status mf_weighted_density_init(struct weighted_density *density,
                                     const struct weighted_density_settings *settings,
                                     const struct box *box, size_t count, size_t planned) {
    static const double room = 4;
    const double number = (double)count / mf_box_volume(box);
    *density = (struct weighted_density){.settings = *settings, .series.columns = SERIES};
    if (!(settings->inner_cutoff < settings->cutoff))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "weighted_density.inner_cutoff: %g" STATUS_LENGTH
                              " is not below the cutoff %g" STATUS_LENGTH,
                              settings->inner_cutoff, settings->cutoff);
    if (settings->maximum == 0)
        density->settings.maximum = room * (number * integrate(settings, box, 1) +
                                            sqrt(number * integrate(settings, box, 2)));
    TRY(mf_sample_blocks_init(&density->blocks, planned));
    TRY_ARRAY(density->sums, density->blocks.count * (size_t)settings->bins);
    return STATUS_OK;
}

void mf_weighted_density_clear(struct weighted_density *density) {
    mf_sample_series_clear(&density->series);
    mf_sample_blocks_clear(&density->blocks);
    mf_memory_free(density->sums);
    *density = (struct weighted_density){0};
}

enum status mf_weighted_density_add(struct weighted_density *density, const double *values,
                                    size_t count) {
    const size_t bins = (size_t)density->settings.bins;
    const double per_density = (double)bins / density->settings.maximum, one = 1 / (double)count;
    double numbers[SERIES] = {0};
    if (mf_sample_blocks_are_full(&density->blocks)) {
        mf_sample_blocks_join(&density->blocks, density->sums, bins);
        mf_sample_blocks_double(&density->blocks);
    }
    double *const sums = density->sums + mf_sample_blocks_take(&density->blocks) * bins;
    for (size_t k = 0; k < count; k++) {
        const double place = values[k] * per_density;
        numbers[MEAN] += one * values[k];
        numbers[SQUARE] += one * values[k] * values[k];
        if (place < (double)bins)
            sums[(size_t)place] += one;
        else
            numbers[BEYOND] += one;
    }
    return mf_sample_series_add(&density->series, numbers);
}

/// ⟨ρ²⟩ − ⟨ρ⟩²; to first order its error is that of the mean of ρ² − 2⟨ρ⟩ρ.
static double find_variance(const struct weighted_density *density, double mean, double *error) {
    const size_t count = density->series.count;
    const double *const means = sample_series_column(&density->series, MEAN);
    const double *const squares = sample_series_column(&density->series, SQUARE);
    struct sample_series linear = {.columns = 1};
    double ignored;
    *error = NAN;
    for (size_t k = 0; k < count; k++) {
        const double number = squares[k] - 2 * mean * means[k];
        if (mf_sample_series_add(&linear, &number) != STATUS_OK)
            break;
    }
    if (linear.count == count && count > 0)
        (void)mf_sample_series_mean(&linear, 0, error);
    mf_sample_series_clear(&linear);
    return mf_sample_series_mean(&density->series, SQUARE, &ignored) - mean * mean;
}

struct weighted_density_summary mf_weighted_density_result(const struct weighted_density *density) {
    struct weighted_density_summary s;
    double ignored;
    s.mean = mf_sample_series_mean(&density->series, MEAN, &s.mean_error);
    s.variance = find_variance(density, s.mean, &s.variance_error);
    s.beyond = mf_sample_series_mean(&density->series, BEYOND, &ignored);
    if (density->series.count < 2)
        s.mean_error = s.variance_error = NAN;
    return s;
}

/// p in a bin, the mean over the whole blocks, and its error.
static double find_bin(const struct weighted_density *density, size_t bin, double *error) {
    const size_t bins = (size_t)density->settings.bins;
    const double width = density->settings.maximum / (double)bins;
    const size_t whole = mf_sample_blocks_whole(&density->blocks);
    double means[MAX_BLOCKS], sum = 0, samples = 0;
    for (size_t b = 0; b < whole; b++) {
        const double own = density->sums[b * bins + bin] / width;
        means[b] = own / density->blocks.samples[b];
        sum += own;
        samples += density->blocks.samples[b];
    }
    *error = mf_statistics_correlated_error(means, whole, 1);
    return samples > 0 ? sum / samples : NAN;
}

double mf_weighted_density_at(const struct weighted_density *density, double value, double *error) {
    static const double rounding = 1e-6;
    const double bins = (double)density->settings.bins;
    const double place = value / density->settings.maximum * bins - 0.5;
    double errors[2];
    *error = NAN;
    if (!(place >= -0.5 && place <= bins - 0.5 + rounding))
        return NAN;
    const double low = fmin(fmax(floor(place), 0), bins - 1), high = fmin(low + 1, bins - 1);
    const double part = fmin(fmax(place - low, 0), 1);
    const double below = find_bin(density, (size_t)low, &errors[0]);
    const double above = find_bin(density, (size_t)high, &errors[1]);
    *error = hypot((1 - part) * errors[0], part * errors[1]);
    return (1 - part) * below + part * above;
}

enum status mf_weighted_density_write(const struct weighted_density *density,
                                      const struct observable_results *results) {
    const size_t bins = (size_t)density->settings.bins;
    OWNED double *values = NULL;
    TRY_ARRAY(values, 3 * bins);
    double *const place = values, *const share = place + bins, *const error = share + bins;
    for (size_t k = 0; k < bins; k++) {
        place[k] = density->settings.maximum * ((double)k + 0.5) / (double)bins;
        share[k] = find_bin(density, k, &error[k]);
    }
    mf_statistics_mark_unknown_errors(error, bins);
    const struct data_column columns[] = {
        {"rho[1]", place, "%.6g"}, {"p[1]", share, "%.6g"}, {"error[1]", error, "%.3g"}};
    return mf_observable_table(results, "weighted_density.tsv", columns, 3, bins);
}

void mf_weighted_density_write_summary(const struct weighted_density *density,
                                       struct json_writer *writer) {
    const struct weighted_density_summary s = mf_weighted_density_result(density);
    mf_json_put_measured(writer, "weighted_density", "1", s.mean, s.mean_error);
    mf_json_put_measured(writer, "weighted_density_variance", "1", s.variance, s.variance_error);
    if (s.beyond > 0)
        mf_json_write_number(writer, "weighted_density_beyond", s.beyond);
}
