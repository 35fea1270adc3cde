// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/series.h"

#include "base/growing.h"
#include "base/statistics.h"

#include <math.h>

enum status mf_series_add(struct series *series, double value) {
    TRY(mf_growing_reserve(&series->value, &series->capacity, series->count, series->count + 1,
                           sizeof value, 1024));
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
