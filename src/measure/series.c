// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/series.h"

#include "base/memory.h"
#include "base/statistics.h"

#include <math.h>
#include <string.h>

enum status mf_series_add(struct series *series, double value) {
    if (series->count == series->capacity) {
        const size_t capacity = series->capacity ? 2 * series->capacity : 1024;
        double *values = mf_memory_uncleared(capacity, sizeof *values);
        if (values == NULL)
            return STATUS_NO_MEMORY;
        if (series->count > 0)
            memcpy(values, series->value, series->count * sizeof *values);
        mf_memory_free(series->value);
        series->value = values;
        series->capacity = capacity;
    }
    series->value[series->count++] = value;
    return STATUS_OK;
}

void mf_series_clear(struct series *series) {
    mf_memory_free(series->value);
    *series = (struct series){0};
}

double mf_series_mean(const struct series *series) {
    struct running_mean mean = {0};
    for (size_t k = 0; k < series->count; k++)
        mf_statistics_add(&mean, series->value[k]);
    return series->count > 0 ? mean.mean : NAN;
}

double mf_series_error(const struct series *series) {
    return series->count < 2 ? NAN
                             : mf_statistics_correlated_error(series->value, series->count, 1);
}
