// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/bound_pairs.h"

#include <math.h>

/// Of the way to the cutoff.
enum { STEPS = 2000 };

/// Mean speed at which pairs pass a distance outwards [λ/τ].
static double passing_speed(const struct simulation_setup *setup) {
    const struct attributes_range masses = mf_attributes_span(&setup->attribute[ATTRIBUTES_MASS]);
    const double mass = masses.maximum > 0 ? masses.minimum : 1;
    return sqrt(setup->temperature / (2 * M_PI * 0.5 * mass));
}

struct bound_pairs mf_bound_pairs_find(const struct simulation_setup *setup, int pair) {
    struct bound_pairs found = {0};
    if (setup->potential == NULL || !simulation_has_velocities(setup) ||
        setup->integrator->samples || setup->integrator->events)
        return found;
    const double width = table_cutoff(setup->potential, pair) / STEPS;
    const double speed = passing_speed(setup), power = setup->box.dimensions - 1;
    // ∫_0^b w(r) dr / w(b), from one distance to the next.
    double stay = 0, before = 0, lowest = INFINITY;
    for (int k = 1; k <= STEPS && width > 0; k++) {
        double energy;
        mf_table_evaluate_pair(setup->potential, pair, k * width, &energy, NULL, NULL);
        energy /= setup->temperature;
        const double ratio =
            k > 1 ? pow((k - 1.0) / k, power) * exp(fmin(energy - before, 100)) : 0;
        stay = stay * ratio + 0.5 * width * (ratio + 1);
        lowest = fmin(lowest, energy);
        before = energy;
        if (stay / speed > found.lifetime)
            found = (struct bound_pairs){stay / speed, energy - lowest, k * width};
    }
    return found;
}
