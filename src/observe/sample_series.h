// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Numbers of each sample, several series side by side. Memory, and with it the size of a
/// checkpoint, grows with the samples that were taken, not with those that were asked for.
#pragma once

#include "base/memory.h"

struct sample_series {
    size_t columns;  ///< set by whom it belongs to; all else is 0 at the beginning
    size_t count;    ///< samples so far
    size_t capacity; ///< for samples
    double *values;  ///< shape [columns, room]
};

void mf_sample_series_clear(struct sample_series *series);

/// Add the numbers of a sample, shape [columns]. Fails: NO_MEMORY. Tested: test_sample_series.
enum status mf_sample_series_add(struct sample_series *series, const double *numbers) MUST_USE;

/// One series, shape [count]; the next sample may move it.
static inline double *sample_series_column(const struct sample_series *series, size_t column) {
    return series->capacity > 0 ? series->values + column * series->capacity : NULL;
}

/// The mean of one series, and its standard error, which sees that samples are correlated.
double mf_sample_series_mean(const struct sample_series *series, size_t column, double *error);

/// What goes with a checkpoint: 1 + columns spans. The lengths of all but the first depend on it:
/// after it was restored there is to be made room.
size_t mf_sample_series_spans(struct sample_series *series, struct memory_span *spans);
enum status mf_sample_series_reserve(struct sample_series *series) MUST_USE;
