// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/verify_agreement.h"

#include "base/memory.h"
#include "observe/rdf_observable.h"
#include "observe/stationary.h"
#include "observe/thermodynamics.h"

/// Chance with which any of the looks complains of samples in equilibrium.
static const double false_alarm = 1e-3;
enum { LOOKS = 2 * 3 };

/// Means of the parts of all replicas, shape [replicas, STATIONARY_PARTS, row].
struct parts {
    size_t replicas, row;
    double *values;
};

static enum status parts_init(struct parts *parts, size_t replicas, size_t row) {
    *parts = (struct parts){.replicas = replicas, .row = row};
    TRY_ARRAY(parts->values, replicas * STATIONARY_PARTS * row);
    return STATUS_OK;
}

static double *part_of(const struct parts *parts, size_t replica, size_t part) {
    return parts->values + (replica * STATIONARY_PARTS + part) * parts->row;
}

/// Look at numbers of all parts; the least likely so far is reported.
static enum status look(const struct parts *parts, const char *name, const double *weight,
                        double *min, char text[VERIFY_EQUILIBRIUM_SIZE]) {
    const double *chain[STATIONARY_MAX_CHAINS];
    struct stationary is;
    OWNED size_t *number = NULL;
    TRY_ARRAY(number, parts->row);
    for (size_t n = 0; n < parts->row; n++)
        number[n] = n;
    for (size_t k = 0; k < parts->replicas; k++)
        chain[k] = part_of(parts, k, 0);
    TRY(mf_stationary_test(&(struct stationary_numbers){.chains = parts->replicas,
                                                        .chain = chain,
                                                        .row = parts->row,
                                                        .count = parts->row,
                                                        .number = number,
                                                        .weight = weight},
                           &is));
    if (stationary_p_value(&is) < *min) {
        *min = stationary_p_value(&is);
        mf_stationary_describe(name, &is, text, VERIFY_EQUILIBRIUM_SIZE);
    }
    return STATUS_OK;
}

static enum status look_at_series(const struct measurement *replicas, size_t count, int quantity,
                                  const char *name, double *min,
                                  char text[VERIFY_EQUILIBRIUM_SIZE]) {
    static const double weight = 1;
    enum status status = STATUS_OK;
    struct parts parts;
    CHECK(parts_init(&parts, count, 1));
    for (size_t k = 0; k < count; k++) {
        const struct thermodynamics *own =
            mf_measurement_state(&replicas[k], &mf_thermodynamics_observable);
        const double *series = mf_thermodynamics_series(own, quantity);
        const size_t each = own->series.count / STATIONARY_PARTS;
        for (size_t n = 0; n < each * STATIONARY_PARTS; n++)
            *part_of(&parts, k, n / each) += series[n] / (double)each;
    }
    CHECK(look(&parts, name, &weight, min, text));
done:
    mf_memory_free(parts.values);
    return status;
}

/// Blocks that have samples.
static size_t sampled_blocks(const struct rdf *rdf) {
    size_t blocks = 0;
    while (blocks < rdf->blocks && rdf->block_samples[blocks] > 0)
        blocks++;
    return blocks;
}

/// Pairs of a bin in the blocks of a replica, by part; the last blocks that make no whole part are
/// left out.
static void add_blocks(const struct rdf *rdf, const struct parts *parts, size_t replica) {
    const size_t each = sampled_blocks(rdf) / STATIONARY_PARTS;
    double samples[STATIONARY_PARTS] = {0};
    for (size_t b = 0; b < each * STATIONARY_PARTS; b++)
        samples[b / each] += rdf->block_samples[b];
    for (size_t b = 0; b < each * STATIONARY_PARTS; b++)
        for (size_t n = 0; n < parts->row && samples[b / each] > 0; n++)
            part_of(parts, replica, b / each)[n] +=
                rdf->histogram[b * parts->row + n] / samples[b / each];
}

/// Bins are weighted by one over their pairs, which is one over their variance where these are few.
static enum status look_at_pairs(const struct measurement *replicas, size_t count, double *min,
                                 char text[VERIFY_EQUILIBRIUM_SIZE]) {
    enum status status = STATUS_OK;
    const struct rdf_observed *first = mf_measurement_state(replicas, &mf_rdf_observable);
    struct parts parts = {0};
    double *weight = NULL;
    if (first == NULL || sampled_blocks(&first->counted) < STATIONARY_PARTS)
        return STATUS_OK;
    CHECK(parts_init(&parts, count, first->counted.pairs * first->counted.bins.count));
    NEW_ARRAY(weight, parts.row);
    for (size_t k = 0; k < count; k++) {
        const struct rdf_observed *own = mf_measurement_state(&replicas[k], &mf_rdf_observable);
        add_blocks(&own->counted, &parts, k);
    }
    for (size_t n = 0; n < parts.row; n++) {
        double pairs = 0;
        for (size_t k = 0; k < count * STATIONARY_PARTS; k++)
            pairs += parts.values[k * parts.row + n];
        weight[n] = pairs > 0 ? 1 / pairs : 0;
    }
    CHECK(look(&parts, "g(r)", weight, min, text));
done:
    mf_memory_free(parts.values);
    mf_memory_free(weight);
    return status;
}

enum status mf_verify_equilibrium(const struct measurement *replicas, size_t count,
                                  char text[VERIFY_EQUILIBRIUM_SIZE]) {
    const struct thermodynamics *first =
        mf_measurement_state(replicas, &mf_thermodynamics_observable);
    double min = false_alarm / LOOKS;
    text[0] = '\0';
    if (count < 2 || first == NULL || first->series.count < 2 * STATIONARY_PARTS)
        return STATUS_OK;
    TRY(look_at_series(replicas, count, THERMODYNAMICS_POTENTIAL_ENERGY, "the energy", &min, text));
    TRY(look_at_series(replicas, count, THERMODYNAMICS_PRESSURE, "the pressure", &min, text));
    return look_at_pairs(replicas, count, &min, text);
}
