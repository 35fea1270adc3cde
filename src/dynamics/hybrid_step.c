// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/hybrid_step.h"

#include "curves/bonded_table.h"

#include <math.h>

/// The first time step, times ω of the fastest pair that ten k_B T can reach, ω² = 2 Φ''.
static const double first_share = 0.4, highest = 10;

/// A step goes no further than this share of the cutoff at the thermal velocity, however soft.
static const double longest_flight = 0.05;

static double longest_step(double cutoff, double temperature) {
    return longest_flight * cutoff / sqrt(temperature);
}

/// 2 Φ'' where the curve of a pair type bends most, as far up as ten k_B T reach.
static double fastest_of(const struct table *potential, int pair, double temperature) {
    const double spacing = 1 / mf_table_inverse_spacing(potential, pair);
    double lowest = 0, fastest = 0, value, curvature;
    for (int k = 0; k < TABLE_INTERVALS; k++) {
        mf_table_evaluate_pair(potential, pair, k * spacing, &value, NULL, NULL);
        lowest = fmin(lowest, value);
    }
    for (int k = 0; k < TABLE_INTERVALS; k++) {
        mf_table_evaluate_pair(potential, pair, (k + 0.5) * spacing, &value, NULL, &curvature);
        if (value < lowest + highest * temperature)
            fastest = fmax(fastest, 2 * curvature);
    }
    return fastest;
}

static double first_of_pairs(const struct table *potential, double temperature) {
    double fastest = 0;
    for (int curve = 0; curve < potential->curves; curve++)
        fastest = fmax(fastest, fastest_of(potential, curve, temperature));
    return fmin(first_share / sqrt(fastest), longest_step(potential->cutoff, temperature));
}

// Molecules ---------------------------------------------------------------------------------------

/// Half the width of the well about the least U, up to k_B T/2 above it: the thermal width of a
/// parabola.
static double width_of(const struct bonded_curve *curve, double low, double high,
                       double temperature) {
    enum { PLACES = 4000 };
    const double spacing = (high - low) / PLACES, rest = mf_bonded_rest(curve);
    double min, energy, from = rest, to = rest;
    mf_bonded_value(curve, rest, &min, NULL);
    for (energy = min; to < high && energy < min + 0.5 * temperature; to += spacing)
        mf_bonded_value(curve, to + spacing, &energy, NULL);
    for (energy = min; from > low && energy < min + 0.5 * temperature; from -= spacing)
        mf_bonded_value(curve, from - spacing, &energy, NULL);
    return fmax(0.5 * (to - from), spacing);
}

static double low_end(int order) {
    return mf_bonded_kinds[order]->scale * mf_bonded_kinds[order]->low;
}

static double high_end(const struct bonded_curve *curve, int order, double temperature) {
    const struct bonded_kind *kind = mf_bonded_kinds[order];
    return kind->is_length ? mf_bonded_reach(curve, temperature) : kind->scale * kind->high;
}

double mf_hybrid_step_variance(const struct bonded_curve *curve, int order, double temperature) {
    const double high = high_end(curve, order, temperature);
    return pow(width_of(curve, low_end(order), high, temperature), 2);
}

/// Root mean square of U'' where the terms are: k_B T over the variance of a parabola, and more of
/// a table whose values have noise, which longer steps do not follow.
static double find_curvature(const struct bonded_curve *curve, int order, double temperature) {
    enum { PLACES = 4000 };
    const double low = low_end(order);
    const double spacing = (high_end(curve, order, temperature) - low) / PLACES;
    double min, energy, slope, before, squares = 0, all = 0;
    mf_bonded_value(curve, mf_bonded_rest(curve), &min, NULL);
    mf_bonded_value(curve, low + 0.5 * spacing, &energy, &before);
    for (int k = 1; k < PLACES; k++) {
        mf_bonded_value(curve, low + (k + 0.5) * spacing, &energy, &slope);
        const double weight = exp(fmin(0, (min - energy) / temperature));
        if (weight > 0)
            squares += weight * pow((slope - before) / spacing, 2);
        all += weight;
        before = slope;
    }
    return sqrt(squares / all);
}

double mf_hybrid_step_squared_frequency(int order, double variance, double length,
                                        double temperature) {
    static const double bend = 6;
    const double joints = mf_bonded_kinds[order]->is_length ? 2 : bend / (length * length);
    return joints * temperature / variance;
}

double mf_hybrid_step_wrong(const struct integrator *integrator) {
    return integrator == &mf_aboba ? 0.1 : 0.25;
}

/// Whether the law of a group is there: one that a fit looks for is a table without points.
static bool is_known(const struct bonded_curve *curve) {
    return curve->law && !(bonded_is_table(curve->law) &&
                           ((const struct bonded_table *)curve->parameters)->point == NULL);
}

/// ω² of the fastest group that has a law, each with the variance that is found for it.
static double fastest_by(const struct molecules *molecules, double temperature,
                         double (*find_variance)(const struct bonded_curve *, int, double)) {
    double length = INFINITY, fastest = 0;
    for (int g = 0; g < molecules->groups[BONDED_BOND]; g++)
        if (is_known(&molecules->group[BONDED_BOND][g].curve))
            length =
                fmin(length, mf_bonded_reach(&molecules->group[BONDED_BOND][g].curve, temperature));
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int g = 0; g < molecules->groups[order]; g++) {
            const struct bonded_curve *curve = &molecules->group[order][g].curve;
            if (is_known(curve))
                fastest = fmax(fastest, mf_hybrid_step_squared_frequency(
                                            order, find_variance(curve, order, temperature), length,
                                            temperature));
        }
    return fastest;
}

double mf_hybrid_step_fastest(const struct molecules *molecules, double temperature) {
    return fastest_by(molecules, temperature, mf_hybrid_step_variance);
}

/// The variance that a parabola as bent as the curve is would have.
static double narrow_variance(const struct bonded_curve *curve, int order, double temperature) {
    return fmin(mf_hybrid_step_variance(curve, order, temperature),
                temperature / find_curvature(curve, order, temperature));
}

static double shortest_weight(const struct many_body *many_body) {
    double shortest = INFINITY;
    for (int t = 0; t < many_body->terms; t++)
        shortest = fmin(shortest, weight_cutoff(&many_body->term[t].weight));
    return shortest;
}

struct hybrid_step mf_hybrid_step_find(const struct table *potential,
                                       const struct molecules *molecules,
                                       const struct many_body *many_body, double temperature) {
    static const double share = 0.15; // of many oscillators, all of which must be taken at once
    enum { MAX = 10 };                // half a period is 20 of them
    struct hybrid_step step = {.first = INFINITY, .longest = INFINITY, .inner = 1};
    if (potential) {
        step.first = first_of_pairs(potential, temperature);
        step.longest = longest_step(potential->cutoff, temperature);
    } else if (many_body)
        step.first = step.longest = longest_step(shortest_weight(many_body), temperature);
    if (molecules == NULL)
        return step;
    const double fast = share / sqrt(mf_hybrid_step_fastest(molecules, temperature));
    const double narrow = share / sqrt(fastest_by(molecules, temperature, narrow_variance));
    step.first = fmin(step.first, MAX * fast);
    step.inner = (int64_t)fmax(1, fmin(MAX, ceil(step.first / narrow)));
    return step;
}
