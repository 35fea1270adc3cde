// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/export_power.h"

#include <math.h>

enum { POINTS = 4000 };

/// The best amplitude for an exponent, and the misfit that it leaves.
static struct export_power fit_amplitude(const struct table *omega, const struct table *potential,
                                         int pair, double temperature, double exponent) {
    struct export_power power = {.exponent = exponent, .cutoff = table_cutoff(omega, pair)};
    double own = 0, both = 0, theirs = 0;
    for (int k = 0; k < POINTS; k++) {
        const double share = (k + 0.5) / POINTS, r = share * power.cutoff;
        double value, phi;
        mf_table_evaluate_pair(omega, pair, r, &value, NULL, NULL);
        mf_table_evaluate_pair(potential, pair, r, &phi, NULL, NULL);
        const double weight = r * r * exp(-phi / temperature), term = pow(1 - share, exponent);
        own += weight * value * value;
        both += weight * value * term;
        theirs += weight * term * term;
    }
    power.amplitude = both / theirs;
    power.misfit = own > 0 ? sqrt(fmax(0, 1 - both * both / (own * theirs))) : 0;
    return power;
}

struct export_power mf_export_power_fit(const struct table *omega, const struct table *potential,
                                        int pair, double temperature, bool only_linear) {
    static const double golden = 0.6180339887498949;
    if (!(table_cutoff(omega, pair) > 0))
        return (struct export_power){0};
    const struct export_power linear = fit_amplitude(omega, potential, pair, temperature, 1);
    if (only_linear || linear.misfit < 0.1 * EXPORT_POWER_BOUND)
        return linear;
    double low = log(0.02), high = log(20);
    for (int k = 0; k < 60; k++) {
        const double left = high - golden * (high - low), right = low + golden * (high - low);
        if (fit_amplitude(omega, potential, pair, temperature, exp(left)).misfit <
            fit_amplitude(omega, potential, pair, temperature, exp(right)).misfit)
            high = right;
        else
            low = left;
    }
    return fit_amplitude(omega, potential, pair, temperature, exp(0.5 * (low + high)));
}
