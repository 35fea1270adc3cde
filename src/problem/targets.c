// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/targets.h"

#include <math.h>

const char *const mf_targets_errors[] = {"unknown", "samples", "bins", NULL};

const char *mf_targets_name(int kind) {
    const struct observable_kind found = mf_observable_kind(kind);
    return found.observable ? found.target->name : NULL;
}

/// Values of an observable that count as independent, for the variance of its rms: bins of g(r) and
/// cells of E(t, r_0) next to each other see the same pairs.
static const double max_independent = 10;

/// Weight of a target without errors: as if they were this [unit of the target].
static const double assumed_error = 0.01;

bool mf_targets_have_pair(const struct targets *targets, size_t pair) {
    const struct target *rdf = &targets->target[TARGET_RDF];
    return rdf->count > 0 && !isnan(rdf->value[pair * targets->bins.count]);
}

size_t mf_targets_count(const struct targets *targets) {
    size_t count = 0;
    for (int kind = 0; kind < TARGETS; kind++)
        count += targets_ask(targets, kind);
    return count;
}

double mf_targets_rms_variance(double rms, double square, double count) {
    const double independent = fmin(count, max_independent);
    return (square + 0.5 * square * square / fmax(rms * rms, 1e-300)) / independent;
}

struct target_distance mf_targets_distance(const struct target *target, const double *value,
                                           const double *error) {
    struct target_distance distance = {0};
    double squares = 0, noise = 0, own = 0;
    for (size_t k = 0; k < target->count; k++) {
        if (!isfinite(target->value[k]) || !isfinite(value[k]))
            continue;
        const double difference = value[k] - target->value[k];
        const double target_error = isfinite(target->error[k]) ? target->error[k] : 0;
        const double own_error = isfinite(error[k]) ? error[k] : 0;
        squares += difference * difference;
        noise += own_error * own_error + target_error * target_error;
        own += own_error * own_error;
        distance.count++;
    }
    const double count = (double)distance.count;
    // Nothing in common with the target is as bad as a failure.
    distance.rms = count > 0 ? sqrt(squares / count) : INFINITY;
    if (count > 0) {
        distance.noise = sqrt(noise / count);
        distance.variance = mf_targets_rms_variance(distance.rms, own / count, count);
    }
    return distance;
}

struct target_distance mf_targets_worst(const struct target *target, const double *value,
                                        const double *error) {
    struct target_distance worst = {0};
    for (size_t k = 0; k < target->count; k++) {
        const struct target one = {
            .count = 1, .value = target->value + k, .error = target->error + k};
        if (!isfinite(target->value[k]))
            continue;
        const struct target_distance distance = mf_targets_distance(&one, value + k, error + k);
        if (worst.count == 0 || distance.rms * worst.noise > worst.rms * distance.noise)
            worst = distance;
    }
    return worst;
}

/// The rms of the standard errors of a target.
static double error_of(const struct target *target) {
    double sum = 0, count = 0;
    for (size_t k = 0; k < target->count; k++)
        if (isfinite(target->error[k]) && target->error[k] > 0) {
            sum += target->error[k] * target->error[k];
            count += 1;
        }
    return count > 0 ? sqrt(sum / count) : assumed_error;
}

double mf_targets_weight(const struct target *target) {
    return target->weight > 0 ? target->weight : 1 / error_of(target);
}

static double combine(const struct targets *targets, const struct target_distance *distance,
                      double (*part)(const struct target_distance *)) {
    const size_t count = mf_targets_count(targets);
    double sum = 0;
    for (int kind = 0; kind < TARGETS; kind++) {
        if (!targets_ask(targets, kind))
            continue;
        const double weight = count > 1 ? mf_targets_weight(&targets->target[kind]) : 1;
        const double term = weight * part(&distance[kind]);
        sum += term * term / (double)count;
    }
    return sqrt(sum);
}

double mf_targets_variance(const struct targets *targets, const struct target_distance *distance) {
    const size_t count = mf_targets_count(targets);
    const double error = mf_targets_error(targets, distance);
    double sum = 0;
    for (int kind = 0; kind < TARGETS; kind++) {
        if (!targets_ask(targets, kind))
            continue;
        const double weight = count > 1 ? mf_targets_weight(&targets->target[kind]) : 1;
        const double slope =
            error > 0 ? weight * weight * distance[kind].rms / ((double)count * error) : weight;
        sum += slope * slope * distance[kind].variance;
    }
    return sum;
}

static double rms_of(const struct target_distance *distance) {
    return distance->rms;
}

static double noise_of(const struct target_distance *distance) {
    return distance->noise;
}

double mf_targets_error(const struct targets *targets, const struct target_distance *distance) {
    return combine(targets, distance, rms_of);
}

double mf_targets_noise(const struct targets *targets, const struct target_distance *distance) {
    return combine(targets, distance, noise_of);
}

double mf_targets_own_noise(const struct targets *targets) {
    struct target_distance distance[TARGETS] = {0};
    for (int kind = 0; kind < TARGETS; kind++)
        if (targets_ask(targets, kind))
            distance[kind].noise = error_of(&targets->target[kind]);
    return mf_targets_noise(targets, distance);
}

/// Blocks of a matrix along each axis.
enum { BLOCKS = 10 };

static size_t features_of(const struct target *target) {
    if (target->count == 0)
        return 0;
    return target->columns > 0 ? BLOCKS * BLOCKS : target->block ? target->blocks : target->count;
}

size_t mf_targets_blocks(const double *value, size_t count, size_t first,
                         size_t block[TARGETS_MAX_BLOCKS]) {
    double whole = 0, own = 0;
    size_t blocks = 0;
    bool full = true;
    for (size_t k = 0; k < count; k++)
        whole += value[k];
    for (size_t k = 0; k < count; k++) {
        if (full)
            block[blocks++] = first + k;
        own = full ? value[k] : own + value[k];
        full = own * TARGETS_MAX_BLOCKS >= whole * (1 - 1e-9);
    }
    // What is left at the end belongs to the block before.
    return blocks > 1 && !full ? blocks - 1 : blocks;
}

size_t mf_targets_features(const struct targets *targets) {
    size_t count = 0;
    for (int kind = 0; kind < TARGETS; kind++)
        count += features_of(&targets->target[kind]);
    return count;
}

/// Sums over what is known of the target in one feature.
struct feature {
    double count, value, square;
};

/// What was not measured of a cell that the target knows is taken to be the target: a mean over the
/// other cells alone would differ from the target's without any difference between the two.
static void add_cell(struct feature *feature, const struct target *target, const double *observed,
                     size_t cell) {
    const double wanted = target->value[cell];
    const double error = isfinite(target->error[cell]) ? target->error[cell] : 0;
    if (!isfinite(wanted))
        return;
    feature->count += 1;
    feature->value += observed && isfinite(observed[cell]) ? observed[cell] : wanted;
    feature->square += error * error;
}

/// One block of the cells of a matrix; those of its first row, E at time 0, are no measurement.
static struct feature block_of(const struct target *target, const double *observed, size_t block) {
    const size_t columns = target->columns, rows = target->count / columns - 1;
    const size_t i = block / BLOCKS, j = block % BLOCKS;
    struct feature feature = {0};
    for (size_t row = rows * i / BLOCKS; row < rows * (i + 1) / BLOCKS; row++)
        for (size_t c = columns * j / BLOCKS; c < columns * (j + 1) / BLOCKS; c++)
            add_cell(&feature, target, observed, (row + 1) * columns + c);
    return feature;
}

/// The mean of a distribution over one of its blocks, over that of the target. Its bins are seen by
/// different counts, so that their errors are independent.
static struct feature share_of(const struct target *target, const double *observed, size_t block) {
    struct feature all = {0};
    double wanted = 0;
    for (size_t k = target->block[block]; k < target->block[block + 1]; k++) {
        add_cell(&all, target, observed, k);
        wanted += target->value[k];
    }
    return (struct feature){1, all.value / wanted, all.square / (wanted * wanted)};
}

/// Mean of the target over one of its blocks; 1 of what has none.
static double block_mean(const struct target *target, size_t block) {
    double sum = 0;
    if (target->block == NULL)
        return 1;
    for (size_t k = target->block[block]; k < target->block[block + 1]; k++)
        sum += target->value[k];
    return sum / (double)(target->block[block + 1] - target->block[block]);
}

void mf_targets_take_features(const struct targets *targets, double *const *observed, double *value,
                              double *error) {
    size_t n = 0;
    for (int kind = 0; kind < TARGETS; kind++) {
        const struct target *target = &targets->target[kind];
        const double *of = observed ? observed[kind] : NULL;
        for (size_t k = 0; k < features_of(target); k++, n++) {
            struct feature feature = {0};
            if (target->columns > 0)
                feature = block_of(target, of, k);
            else if (target->block)
                feature = share_of(target, of, k);
            else
                add_cell(&feature, target, of, k);
            value[n] = feature.count > 0 ? feature.value / feature.count : 0;
            if (error)
                error[n] = feature.count > 0 ? sqrt(feature.square / feature.count) : 0;
        }
    }
}

void mf_targets_spread_error(const struct targets *targets, double error, double *variance) {
    const size_t count = mf_targets_count(targets);
    const double features = (double)mf_targets_features(targets);
    size_t n = 0;
    for (int kind = 0; kind < TARGETS; kind++) {
        const struct target *target = &targets->target[kind];
        const size_t own = features_of(target);
        const double weight = own > 0 && count > 1 ? mf_targets_weight(target) : 1;
        for (size_t k = 0; k < own; k++)
            variance[n++] =
                pow(error / (weight * block_mean(target, k)), 2) * (double)own / features;
    }
}
