// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/rng.h"
#include "optimise/nsga2.h"

/// Spread factor β of a uniform number u, when the nearest bound allows β = `max` at last.
static double spread_factor(double u, double max, double exponent) {
    const double inside = 2 - pow(max, -(exponent + 1));
    if (u <= 1 / inside)
        return pow(u * inside, 1 / (exponent + 1));
    return pow(1 / (2 - u * inside), 1 / (exponent + 1));
}

static double within(double x) {
    return fmin(1, fmax(0, x));
}

void mf_nsga2_cross(double *a, double *b, size_t genes, double exponent,
                    struct rng_sequence *random) {
    static const double same = 1e-14;
    for (size_t k = 0; k < genes; k++) {
        const double low = fmin(a[k], b[k]), high = fmax(a[k], b[k]), apart = high - low;
        const double chance = mf_rng_sequence_uniform(random), u = mf_rng_sequence_uniform(random);
        const bool swapped = mf_rng_sequence_uniform(random) < 0.5;
        if (chance >= 0.5 || apart < same)
            continue;
        const double below = spread_factor(u, 1 + 2 * low / apart, exponent);
        const double above = spread_factor(u, 1 + 2 * (1 - high) / apart, exponent);
        const double first = within(0.5 * (low + high - below * apart));
        const double second = within(0.5 * (low + high + above * apart));
        a[k] = swapped ? second : first;
        b[k] = swapped ? first : second;
    }
}

double mf_nsga2_mutate(double gene, double exponent, struct rng_sequence *random) {
    const double u = mf_rng_sequence_uniform(random), power = exponent + 1;
    const bool down = u < 0.5;
    const double capacity = pow(down ? 1 - gene : gene, power);
    if (down)
        return within(gene + pow(2 * u + (1 - 2 * u) * capacity, 1 / power) - 1);
    return within(gene + 1 - pow(2 * (1 - u) + (2 * u - 1) * capacity, 1 / power));
}
