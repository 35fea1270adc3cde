// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/statistics.h"

#include <math.h>

void statistics_add(struct running_mean *running, double value) {
    running->count += 1;
    const double deviation = value - running->mean;
    running->mean += deviation / running->count;
    running->squares += deviation * (value - running->mean);
}

double statistics_standard_error(const struct running_mean *running) {
    if (running->count < 2)
        return 0;
    return sqrt(running->squares / (running->count - 1) / running->count);
}

/// The chains with the mean of all their values.
struct chains {
    const double *values;
    size_t length, count;
    double mean;
};

static double autocovariance(const struct chains *chains, size_t lag) {
    double sum = 0;
    for (size_t c = 0; c < chains->count; c++) {
        const double *x = chains->values + c * chains->length;
        for (size_t k = 0; k + lag < chains->length; k++)
            sum += (x[k] - chains->mean) * (x[k + lag] - chains->mean);
    }
    return sum / (double)((chains->length - lag) * chains->count);
}

static double find_mean(const double *values, size_t count) {
    struct running_mean mean = {0};
    for (size_t k = 0; k < count; k++)
        statistics_add(&mean, values[k]);
    return mean.mean;
}

double statistics_correlated_error(const double *values, size_t length, size_t chains) {
    const size_t n = length * chains;
    if (n < 2)
        return 0;
    const struct chains all = {values, length, chains, find_mean(values, n)};
    const double variance = autocovariance(&all, 0);
    if (!(variance > 0))
        return variance;
    double sum = -variance, last = INFINITY;
    size_t window = 0;
    for (size_t t = 0; t == 0 || t + 1 < length / 2; t += 2) {
        const double pair =
            autocovariance(&all, t) + (t + 1 < length ? autocovariance(&all, t + 1) : 0);
        if (!(pair > 0))
            break;
        last = fmin(last, pair);
        sum += 2 * last;
        window = t + 1 < length ? t + 1 : 0;
    }
    // With a window that is most of the series there is no honest error, only a large one.
    const double left = fmax((double)n - 2 * (double)window - 1, 0.1 * (double)n);
    return sqrt(fmax(sum, variance) / left);
}
