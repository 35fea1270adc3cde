// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/export_power.h"

#include "system/composition.h"

#include <math.h>

enum { POINTS = 4000 };

/// The law without its amplitude, of a share of the cutoff.
static double shape(const struct export_power *power, double share) {
    return power->family == EXPORT_RISING ? 1 - pow(share, power->exponent)
                                          : pow(1 - share, power->exponent);
}

/// The best amplitude for an exponent, and the misfit that it leaves.
static struct export_power fit_amplitude(const struct table *omega, const struct table *potential,
                                         int pair, double temperature, struct export_power power) {
    double own = 0, both = 0, theirs = 0;
    for (int k = 0; k < POINTS; k++) {
        const double share = (k + 0.5) / POINTS, r = share * power.cutoff;
        double value = 0, phi;
        if (r < table_cutoff(omega, pair))
            mf_table_evaluate_pair(omega, pair, r, &value, NULL, NULL);
        mf_table_evaluate_pair(potential, pair, r, &phi, NULL, NULL);
        const double weight = r * r * exp(-phi / temperature), term = shape(&power, share);
        own += weight * value * value;
        both += weight * value * term;
        theirs += weight * term * term;
    }
    power.amplitude = both / theirs;
    power.misfit = own > 0 ? sqrt(fmax(0, 1 - both * both / (own * theirs))) : 0;
    return power;
}

struct export_power mf_export_power_fit(const struct table *omega, const struct table *potential,
                                        int pair, double temperature,
                                        const struct export_power *form) {
    static const double golden = 0.6180339887498949;
    struct export_power power = *form;
    if (omega == NULL || !(table_cutoff(omega, pair) > 0))
        return (struct export_power){0};
    if (!(power.cutoff > 0))
        power.cutoff = table_cutoff(omega, pair);
    if (power.exponent > 0)
        return fit_amplitude(omega, potential, pair, temperature, power);
    power.exponent = 1;
    power = fit_amplitude(omega, potential, pair, temperature, power);
    if (power.family == EXPORT_LINEAR || power.misfit < 0.1 * EXPORT_POWER_BOUND)
        return power;
    double low = log(0.02), high = log(20);
    for (int k = 0; k < 60; k++) {
        struct export_power left = power, right = power;
        left.exponent = exp(high - golden * (high - low));
        right.exponent = exp(low + golden * (high - low));
        if (fit_amplitude(omega, potential, pair, temperature, left).misfit <
            fit_amplitude(omega, potential, pair, temperature, right).misfit)
            high = log(right.exponent);
        else
            low = log(left.exponent);
    }
    power.exponent = exp(0.5 * (low + high));
    return fit_amplitude(omega, potential, pair, temperature, power);
}

static double value_of(const void *parameters, double r) {
    const struct export_power *power = parameters;
    return r < power->cutoff ? power->amplitude * shape(power, r / power->cutoff) : 0;
}

static double cutoff_of(const void *parameters) {
    return ((const struct export_power *)parameters)->cutoff;
}

enum status mf_export_power_table(const struct export_power *power, int pairs,
                                  struct table *omega) {
    static const struct curve_family family = {
        .name = "nearest", .size = sizeof *power, .value = value_of, .cutoff = cutoff_of};
    enum status status = STATUS_OK;
    struct table part[COMPOSITION_MAX_PAIRS] = {{0}};
    for (int pair = 0; pair < pairs; pair++) {
        struct export_power law = power[pair];
        if (law.cutoff > 0)
            CHECK(mf_table_init_omega(&part[pair], &(struct curve){&family, &law}));
    }
    CHECK(mf_table_stack(omega, part, pairs));
done:
    for (int pair = 0; pair < pairs; pair++)
        mf_table_clear(&part[pair]);
    return status;
}
