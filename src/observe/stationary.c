// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/stationary.h"

#include "base/memory.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdio.h>

/// The mean over the parts, the slope along them, and what is left: orthogonal polynomials.
enum { MEAN, SLOPE, CONTRASTS = STATIONARY_PARTS };
static const double contrast[CONTRASTS][STATIONARY_PARTS] = {
    {0.5, 0.5, 0.5, 0.5},
    {-0.67082039324993691, -0.22360679774997897, 0.22360679774997897, 0.67082039324993691},
    {0.5, -0.5, -0.5, 0.5},
    {-0.22360679774997897, 0.67082039324993691, -0.67082039324993691, 0.22360679774997897},
};

/// Scatter that means of doubles have by themselves.
static const double relative_rounding = 1e-12;

/// Contrasts of all chains, shape [CONTRASTS, chains, count], weighted, and their means over the
/// chains, shape [CONTRASTS, count], which are taken off them.
struct contrasts {
    size_t chains, count;
    double *own, *common;
};

static void fill(const struct stationary_numbers *numbers, struct contrasts *to) {
    for (size_t k = 0; k < CONTRASTS; k++)
        for (size_t n = 0; n < to->count; n++) {
            double *own = to->own + k * to->chains * to->count + n, mean = 0;
            for (size_t c = 0; c < to->chains; c++) {
                double sum = 0;
                for (size_t p = 0; p < STATIONARY_PARTS; p++)
                    sum +=
                        contrast[k][p] * numbers->chain[c][p * numbers->row + numbers->number[n]];
                own[c * to->count] = sum * sqrt(numbers->weight[n]);
                mean += own[c * to->count] / (double)to->chains;
            }
            to->common[k * to->count + n] = mean;
            for (size_t c = 0; c < to->chains; c++)
                own[c * to->count] -= mean;
        }
}

static double product(const double *a, const double *b, size_t count) {
    double sum = 0;
    for (size_t n = 0; n < count; n++)
        sum += a[n] * b[n];
    return sum;
}

/// Sum of squares of one contrast.
static double squares(const struct contrasts *all, size_t k) {
    const size_t size = all->chains * all->count;
    const double *own = all->own + k * size;
    return product(own, own, size);
}

/// ν of the deviations within the chains, whose sum of squares is known. By chance as large as
/// their number at most: of few chains there is no better estimate that is not too large now and
/// then.
static double find_independent(const struct contrasts *all, double within) {
    const size_t rows = (CONTRASTS - 1) * all->chains, n = all->count;
    const double *first = all->own + SLOPE * all->chains * n;
    double sum = 0;
    for (size_t i = 0; i < rows; i++)
        for (size_t j = 0; j <= i; j++)
            sum += (i == j ? 1 : 2) * pow(product(first + i * n, first + j * n, n), 2);
    return fmax(1, within * within / sum);
}

/// Chance of a ratio of variances.
static double find_p_value(double ratio, double above, double below) {
    return isfinite(ratio) ? gsl_cdf_fdist_Q(ratio, above, below) : 0;
}

/// Ratio of variances, where what is within rounding is none.
static double divide(double above, double below, double rounding) {
    return below > rounding ? above / below : above > rounding ? INFINITY : 1;
}

/// The variances of one number.
struct variances {
    double drift, between, within;
};

static struct variances find_variances(const struct contrasts *all, size_t n) {
    const double chains = (double)all->chains;
    struct variances found = {.drift = chains * pow(all->common[SLOPE * all->count + n], 2)};
    for (size_t k = 0; k < CONTRASTS; k++)
        for (size_t c = 0; c < all->chains; c++) {
            const double square = pow(all->own[(k * all->chains + c) * all->count + n], 2);
            if (k == MEAN)
                found.between += square / (chains - 1);
            else
                found.within += square / ((CONTRASTS - 1) * (chains - 1));
        }
    return found;
}

/// The least of two chances, and its ratio, of which the other has been taken before.
static void take_least(double chance, double ratio, double *least, double *its_ratio) {
    if (chance < *least)
        *its_ratio = ratio;
    *least = fmin(1, 2 * fmin(chance, *least));
}

/// Look at each number that may be by itself.
static void assess_alone(const struct contrasts *all, const bool *alone,
                         struct stationary *result) {
    const double chains = (double)all->chains, freedom = (CONTRASTS - 1) * (chains - 1);
    struct stationary least = {1, 1, 1, 1};
    double count = 0;
    for (size_t n = 0; n < all->count; n++) {
        const struct variances of = find_variances(all, n);
        if (!alone[n] || !(of.within > 0))
            continue;
        const double drift = find_p_value(of.drift / of.within, 1, freedom);
        const double memory = find_p_value(of.between / of.within, chains - 1, freedom);
        count++;
        if (drift < least.drift)
            least.drift = drift, least.drift_ratio = of.drift / of.within;
        if (memory < least.memory)
            least.memory = memory, least.memory_ratio = of.between / of.within;
    }
    if (count == 0)
        return;
    take_least(-expm1(count * log1p(-least.drift)), least.drift_ratio, &result->drift,
               &result->drift_ratio);
    take_least(-expm1(count * log1p(-least.memory)), least.memory_ratio, &result->memory,
               &result->memory_ratio);
}

static void assess(const struct contrasts *all, struct stationary *result) {
    const double chains = (double)all->chains;
    const double freedom = (CONTRASTS - 1) * (chains - 1);
    const double *slope = all->common + SLOPE * all->count;
    double within = 0;
    for (size_t k = SLOPE; k < CONTRASTS; k++)
        within += squares(all, k);
    const double drift = chains * product(slope, slope, all->count);
    const double between = squares(all, MEAN) / (chains - 1);
    const double rounding =
        pow(relative_rounding, 2) * product(all->common, all->common, all->count);
    const double independent = within > 0 ? find_independent(all, within) : 1;
    result->drift_ratio = divide(drift, within / freedom, rounding);
    result->memory_ratio = divide(between, within / freedom, rounding);
    result->drift = find_p_value(result->drift_ratio, independent, independent * freedom);
    result->memory =
        find_p_value(result->memory_ratio, independent * (chains - 1), independent * freedom);
    if (!(drift + between + within > rounding))
        *result = (struct stationary){1, 1, 1, 1};
}

enum status mf_stationary_test(const struct stationary_numbers *numbers,
                               struct stationary *result) {
    enum status status = STATUS_OK;
    struct contrasts all = {numbers->chains, numbers->count, NULL, NULL};
    *result = (struct stationary){1, 1, 1, 1};
    if (numbers->count == 0 || numbers->chains < 2)
        return STATUS_OK;
    NEW_ARRAY(all.own, CONTRASTS * all.chains * all.count);
    NEW_ARRAY(all.common, CONTRASTS * all.count);
    fill(numbers, &all);
    assess(&all, result);
    if (numbers->alone && numbers->count > 1)
        assess_alone(&all, numbers->alone, result);
done:
    mf_memory_free(all.own);
    mf_memory_free(all.common);
    return status;
}

void mf_stationary_describe(const char *name, const struct stationary *is, char *text,
                            size_t size) {
    const bool drifts = is->drift < is->memory;
    snprintf(text, size, "%s %s, %.2g times as much as its noise explains", name,
             drifts ? "still changes" : "differs between replicas",
             sqrt(drifts ? is->drift_ratio : is->memory_ratio));
}
