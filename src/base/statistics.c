// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/statistics.h"

#include "base/memory.h"

#include <math.h>
#include <stdbool.h>

void mf_statistics_add(struct running_mean *running, double value) {
    running->count += 1;
    const double deviation = value - running->mean;
    running->mean += deviation / running->count;
    running->squares += deviation * (value - running->mean);
}

double mf_statistics_standard_error(const struct running_mean *running) {
    if (running->count < 2)
        return 0;
    return sqrt(running->squares / (running->count - 1) / running->count);
}

/// Chains of one number, with the mean and the variance of all their values.
struct chains {
    const double *values;
    size_t length, count;
    double mean, variance;
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

static struct chains describe(const double *values, size_t length, size_t count) {
    struct chains chains = {values, length, count, 0, 0};
    struct running_mean mean = {0};
    for (size_t k = 0; k < length * count; k++)
        mf_statistics_add(&mean, values[k]);
    chains.mean = mean.mean;
    chains.variance = autocovariance(&chains, 0);
    return chains;
}

/// Mean autocorrelation of the numbers that scatter at all; 0 if none does.
/// @param[in] apart  shape [numbers]: above 0 of those that are left out; NULL: of none
static double autocorrelation(const double *values, size_t length, size_t chains, size_t numbers,
                              const double *apart, size_t lag) {
    double sum = 0, count = 0;
    if (lag >= length)
        return 0;
    for (size_t n = 0; n < numbers; n++) {
        const struct chains one = describe(values + n * length * chains, length, chains);
        if (!(one.variance > 0) || (apart && apart[n] > 0))
            continue;
        sum += autocovariance(&one, lag) / one.variance;
        count += 1;
    }
    return count > 0 ? sum / count : 0;
}

static double inefficiency_of(const double *values, size_t length, size_t chains, size_t numbers,
                              const double *apart) {
    const double n = (double)(length * chains);
    double sum = -1, last = INFINITY;
    size_t window = 0;
    if (length * chains < 2)
        return 1;
    for (size_t t = 0; t == 0 || t + 1 < length / 2; t += 2) {
        const double pair = autocorrelation(values, length, chains, numbers, apart, t) +
                            autocorrelation(values, length, chains, numbers, apart, t + 1);
        if (!(pair > 0))
            break;
        last = fmin(last, pair);
        sum += 2 * last;
        window = t + 1 < length ? t + 1 : 0;
    }
    // With a window that is most of the series there is no honest error, only a large one.
    const double left = fmax(n - 2 * (double)window - 1, 0.1 * n);
    return fmax(sum / left, 1 / (n - 1)) * n;
}

double mf_statistics_inefficiency(const double *values, size_t length, size_t chains,
                                  size_t numbers) {
    return inefficiency_of(values, length, chains, numbers, NULL);
}

/// Of more values the means of so many blocks are looked at, too.
enum { MAX_VALUES = 64 };

static double error_of_values(const double *values, size_t length, size_t chains) {
    const size_t n = length * chains;
    if (n < 2)
        return NAN;
    const double variance = describe(values, length, chains).variance;
    if (!(variance > 0))
        return variance;
    return sqrt(variance * mf_statistics_inefficiency(values, length, chains, 1) / (double)n);
}

/// Blocks of a chain that differ by one value at most.
double mf_statistics_correlated_error(const double *values, size_t length, size_t chains) {
    double block[MAX_VALUES];
    const size_t blocks = chains > 0 ? MAX_VALUES / chains : 0;
    if (length <= blocks || blocks < 2)
        return error_of_values(values, length, chains);
    for (size_t b = 0; b < blocks * chains; b++) {
        const double *chain = values + b / blocks * length;
        struct running_mean mean = {0};
        for (size_t k = b % blocks * length / blocks; k < (b % blocks + 1) * length / blocks; k++)
            mf_statistics_add(&mean, chain[k]);
        block[b] = mean.mean;
    }
    return fmin(error_of_values(values, length, chains), error_of_values(block, blocks, chains));
}

/// Inefficiencies of the numbers that are slower than all are, or 0: numbers whose neighbourhood of
/// five is so beyond chance, of which it tells a relative sqrt(2/n) or so.
static void find_slow(const double *values, size_t length, size_t chains, size_t numbers,
                      double *slow) {
    static const double errors = 4;
    enum { REACH = 2 };
    const size_t n = length * chains;
    const double all = mf_statistics_inefficiency(values, length, chains, numbers);
    const double limit = all * (1 + errors * sqrt(2 / (double)n));
    for (size_t k = 0; k < numbers; k++) {
        const size_t from = k > REACH ? k - REACH : 0,
                     to = k + REACH < numbers ? k + REACH + 1 : numbers;
        const bool is_slow =
            mf_statistics_inefficiency(values + from * n, length, chains, to - from) > limit;
        const double own = mf_statistics_inefficiency(values + k * n, length, chains, 1);
        slow[k] = is_slow ? fmax(all, own) : 0;
    }
}

void mf_statistics_correlated_errors(const double *values, size_t length, size_t chains,
                                     size_t numbers, double *error) {
    const size_t n = length * chains;
    find_slow(values, length, chains, numbers, error);
    const double others = inefficiency_of(values, length, chains, numbers, error);
    for (size_t k = 0; k < numbers; k++) {
        const double inefficiency = error[k] > 0 ? error[k] : others;
        struct running_mean mean = {0};
        for (size_t m = 0; m < n; m++)
            mf_statistics_add(&mean, values[k * n + m]);
        error[k] = n < 2 ? 0 : sqrt(mean.squares * inefficiency) / (double)n;
    }
}

void mf_statistics_take_larger(double *error, const double *others, size_t count) {
    double ratio = 0, seen = 0;
    for (size_t k = 0; k < count; k++)
        if (error[k] > 0) {
            ratio += pow(others[k] / error[k], 2);
            seen += 1;
        }
    for (size_t k = 0; k < count && ratio > seen; k++)
        error[k] = others[k];
}

void mf_statistics_mark_unknown_errors(double *error, size_t count) {
    bool known = false;
    for (size_t k = 0; k < count; k++)
        known = known || error[k] > 0;
    for (size_t k = 0; k < count && !known; k++)
        error[k] = NAN;
}

/// Of every number, about its mean and over its deviation; those that do not scatter are left out.
/// Returns how many there are.
static size_t standardise(const double *values, size_t n, size_t numbers, double *scaled) {
    size_t found = 0;
    for (size_t k = 0; k < numbers; k++) {
        struct running_mean mean = {0};
        for (size_t m = 0; m < n; m++)
            mf_statistics_add(&mean, values[k * n + m]);
        if (!(mean.squares > 0))
            continue;
        for (size_t m = 0; m < n; m++)
            scaled[found * n + m] = (values[k * n + m] - mean.mean) / sqrt(mean.squares);
        found++;
    }
    return found;
}

double mf_statistics_square_of_correlation(double square, double independent) {
    return 1 - (1 - square) * (independent - 1) / (independent - 2);
}

enum status mf_statistics_independence(const double *values, size_t length, size_t chains,
                                       size_t numbers, struct statistics_independence *found) {
    enum status status = STATUS_OK;
    const size_t n = length * chains;
    double *scaled = NULL;
    *found = (struct statistics_independence){1, 0};
    NEW_ARRAY(scaled, numbers * n + 1);
    const size_t seen = standardise(values, n, numbers, scaled);
    const double independent =
        (double)n / mf_statistics_inefficiency(values, length, chains, numbers);
    if (seen == 0 || n < 3)
        goto done;
    found->freedom = fmax(independent - 1, 0);
    if (!(independent > 2))
        goto done;
    double squares = 0;
    for (size_t a = 0; a < seen; a++)
        for (size_t b = 0; b < a; b++) {
            double r = 0;
            for (size_t m = 0; m < n; m++)
                r += scaled[a * n + m] * scaled[b * n + m];
            squares += 2 * mf_statistics_square_of_correlation(r * r, independent);
        }
    const double all = (double)seen;
    found->numbers = all * all / (all + fmax(squares, 0));
done:
    mf_memory_free(scaled);
    return status;
}
