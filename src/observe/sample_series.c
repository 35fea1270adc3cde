// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/sample_series.h"

#include "base/statistics.h"

#include <string.h>

enum { FIRST_ROOM = 256 };

void mf_sample_series_clear(struct sample_series *series) {
    mf_memory_free(series->values);
    *series = (struct sample_series){0};
}

/// Twice the room, or more, so that it is made seldom.
static enum status grow(struct sample_series *series, size_t wanted) {
    size_t capacity = series->capacity > 0 ? series->capacity : FIRST_ROOM;
    double *values = NULL;
    while (capacity < wanted)
        capacity *= 2;
    TRY_ARRAY(values, series->columns * capacity);
    for (size_t c = 0; c < series->columns && series->capacity > 0; c++)
        memcpy(values + c * capacity, sample_series_column(series, c),
               series->capacity * sizeof *values);
    mf_memory_free(series->values);
    series->values = values;
    series->capacity = capacity;
    return STATUS_OK;
}

enum status mf_sample_series_reserve(struct sample_series *series) {
    return series->count > series->capacity ? grow(series, series->count) : STATUS_OK;
}

enum status mf_sample_series_add(struct sample_series *series, const double *numbers) {
    if (series->count == series->capacity)
        TRY(grow(series, series->count + 1));
    for (size_t c = 0; c < series->columns; c++)
        series->values[c * series->capacity + series->count] = numbers[c];
    series->count++;
    return STATUS_OK;
}

double mf_sample_series_mean(const struct sample_series *series, size_t column, double *error) {
    const double *values = sample_series_column(series, column);
    double sum = 0;
    for (size_t k = 0; k < series->count; k++)
        sum += values[k];
    *error = mf_statistics_correlated_error(values, series->count, 1);
    return sum / (double)series->count;
}

size_t mf_sample_series_spans(struct sample_series *series, struct memory_span *spans) {
    spans[0] = (struct memory_span){&series->count, sizeof series->count};
    for (size_t c = 0; c < series->columns; c++)
        spans[1 + c] = (struct memory_span){sample_series_column(series, c),
                                            series->count * sizeof *series->values};
    return 1 + series->columns;
}
