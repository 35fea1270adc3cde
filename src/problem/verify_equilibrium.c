// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"
#include "base/statistics.h"
#include "observe/kirkwood_buff.h"
#include "observe/rdf_observable.h"
#include "observe/stationary.h"
#include "observe/thermodynamics.h"
#include "problem/verify_agreement.h"

#include <math.h>

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
    while (blocks < rdf->blocks.count && rdf->blocks.samples[blocks] > 0)
        blocks++;
    return blocks;
}

/// Pairs of a bin in the blocks of a replica, by part; the last blocks that make no whole part are
/// left out.
static void add_blocks(const struct rdf *rdf, const struct parts *parts, size_t replica) {
    const size_t each = sampled_blocks(rdf) / STATIONARY_PARTS;
    double samples[STATIONARY_PARTS] = {0};
    for (size_t b = 0; b < each * STATIONARY_PARTS; b++)
        samples[b / each] += rdf->blocks.samples[b];
    for (size_t b = 0; b < each * STATIONARY_PARTS; b++)
        for (size_t n = 0; n < parts->row && samples[b / each] > 0; n++)
            part_of(parts, replica, b / each)[n] +=
                rdf->blocks.sums[b * parts->row + n] / samples[b / each];
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

// What is known -----------------------------------------------------------------------------------

/// Relative errors of the rms difference from a target, and of temperatures, that are enough: three
/// of the latter are the 1 % by which a time step is judged.
static const double enough_distance = 0.1, enough_temperature = 1.0 / 300;

// Distances ---------------------------------------------------------------------------------------

/// Exchange the last replica and that at `k`.
static void exchange_with_last(struct measurement *replicas, size_t count, size_t k) {
    const struct measurement last = replicas[count - 1];
    replicas[count - 1] = replicas[k];
    replicas[k] = last;
}

static enum status find_errors(struct measurement *replicas, size_t count,
                               const struct target_distance *of_all, double *error) {
    enum status status = STATUS_OK;
    const struct targets *targets = replicas->targets;
    struct observed without = {0};
    double squares[TARGETS] = {0};
    CHECK(mf_measurement_values_init(&without, targets));
    for (size_t k = 0; k < count && count > 1; k++) {
        struct target_distance distance[TARGETS];
        exchange_with_last(replicas, count, k);
        status = mf_measurement_result(replicas, count - 1, &without);
        exchange_with_last(replicas, count, k);
        CHECK(status);
        mf_measurement_distance(&without, targets, distance);
        for (int kind = 0; kind < TARGETS; kind++) {
            const double difference = distance[kind].rms - of_all[kind].rms;
            squares[kind] += difference * difference;
        }
    }
    for (int kind = 0; kind < TARGETS; kind++)
        error[kind] = count > 1 ? sqrt(squares[kind] * (double)(count - 1) / (double)count) : NAN;
done:
    mf_measurement_values_clear(&without);
    return status;
}

static enum status find_rdf_error(const struct measurement *replicas, size_t count, double *rms,
                                  double *error) {
    OWNED struct rdf *rdf = NULL;
    const struct targets *targets = replicas->targets;
    if (!targets_ask(targets, TARGET_RDF))
        return STATUS_OK;
    TRY_ARRAY(rdf, count);
    for (size_t k = 0; k < count; k++) {
        const struct rdf_observed *observed =
            mf_measurement_state(&replicas[k], &mf_rdf_observable);
        rdf[k] = observed->counted;
    }
    TRY(mf_rdf_distance(rdf, count, targets->target[TARGET_RDF].value, rms, error));
    mf_statistics_mark_unknown_errors(error, 1);
    return STATUS_OK;
}

enum status mf_verify_distances(struct measurement *replicas, size_t count,
                                struct observed *observed, struct target_distance *distance,
                                double *error) {
    TRY(mf_measurement_values_init(observed, replicas->targets));
    TRY(mf_measurement_result(replicas, count, observed));
    mf_measurement_distance(observed, replicas->targets, distance);
    TRY(find_errors(replicas, count, distance, error));
    return find_rdf_error(replicas, count, &distance[TARGET_RDF].rms, &error[TARGET_RDF]);
}

// What is known -----------------------------------------------------------------------------------

static bool is_known(double value, double error) {
    return !isfinite(value) || error <= enough_temperature * fabs(value);
}

static enum status knows_temperatures(const struct measurement *replicas, size_t count,
                                      bool *known) {
    OWNED struct thermodynamics *own = NULL;
    TRY_ARRAY(own, count);
    for (size_t k = 0; k < count; k++) {
        const struct thermodynamics *observed =
            mf_measurement_state(&replicas[k], &mf_thermodynamics_observable);
        own[k] = *observed;
    }
    const struct thermodynamics_summary found = mf_thermodynamics_result(own, count);
    *known = is_known(found.temperature, found.temperature_error) &&
             is_known(found.temperature_configurational, found.temperature_configurational_error);
    return STATUS_OK;
}

static double mean_square(const double *values, size_t count) {
    double sum = 0;
    for (size_t k = 0; k < count; k++)
        sum += isfinite(values[k]) ? values[k] * values[k] : 0;
    return sum / (double)count;
}

/// A curve: its distance within a tenth, of which no more than half of the square is the samples'
/// own noise, so that it tells of the target and of what was found. Four replicas know an error
/// badly: it is no less than that of the noise. A number: as well as that of the target. An error
/// of 0 is not known.
static bool knows_distance(const struct target *target, const double *own_error,
                           const struct target_distance *distance, double error, bool number) {
    const double own = mean_square(own_error, target->count);
    const double of_target = mean_square(target->error, target->count);
    if (number)
        return own > 0 && own <= of_target;
    return own > 0 && error <= enough_distance * distance->rms &&
           own <= 0.5 * distance->rms * distance->rms;
}

static enum status knows_distances(struct measurement *replicas, size_t count, bool *known) {
    enum status status = STATUS_OK;
    struct observed observed = {0};
    struct target_distance distance[TARGETS];
    double error[TARGETS];
    CHECK(mf_verify_distances(replicas, count, &observed, distance, error));
    *known = true;
    for (int kind = 0; kind < TARGETS; kind++) {
        const struct target *target = &replicas->targets->target[kind];
        const bool number = target->count == 1 || kind == mf_kirkwood_buff_kind();
        if (kind != TARGET_RDF)
            error[kind] = fmax(error[kind], sqrt(distance[kind].variance));
        if (target->count > 0)
            *known = *known && knows_distance(target, observed.error[kind], &distance[kind],
                                              error[kind], number);
    }
done:
    mf_measurement_values_clear(&observed);
    return status;
}

enum status mf_verify_knows(struct measurement *replicas, size_t count, bool *known) {
    char drifts[VERIFY_EQUILIBRIUM_SIZE];
    *known = false;
    if (count < 2)
        return STATUS_OK;
    TRY(knows_temperatures(replicas, count, known));
    if (*known)
        TRY(knows_distances(replicas, count, known));
    if (*known) {
        TRY(mf_verify_equilibrium(replicas, count, drifts));
        *known = drifts[0] == '\0';
    }
    return STATUS_OK;
}
