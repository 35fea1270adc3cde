// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/statistics.h"
#include "observe/thermodynamics.h"

#include <math.h>

enum { MIN_SAMPLES = 5, MAX_BLOCKS = 4096 };

/// The energy of sample k whose fluctuations tell [k_B T_0 a particle].
static double energy_of(const struct thermodynamics *t, const struct simulation_setup *setup,
                        size_t k) {
    const double total = mf_thermodynamics_series(t, THERMODYNAMICS_TOTAL_ENERGY)[k];
    const double potential = mf_thermodynamics_series(t, THERMODYNAMICS_POTENTIAL_ENERGY)[k];
    if (!simulation_has_velocities(setup))
        return potential;
    return simulation_holds_temperature(setup) ? total : total - potential;
}

/// Variance of that energy with its error: that of the mean of the squares.
static struct thermodynamics_capacity variance_of(const struct thermodynamics *t,
                                                  const struct simulation_setup *setup) {
    const size_t count = t->series.count, each = (count + MAX_BLOCKS - 1) / MAX_BLOCKS;
    struct running_mean mean = {0}, square = {0};
    double squares[MAX_BLOCKS] = {0};
    for (size_t k = 0; k < count; k++)
        mf_statistics_add(&mean, energy_of(t, setup, k));
    for (size_t k = 0; k < count; k++) {
        const double s = pow(energy_of(t, setup, k) - mean.mean, 2);
        mf_statistics_add(&square, s);
        squares[k / each] += s / (double)each;
    }
    return (struct thermodynamics_capacity){
        square.mean * (double)count / (double)(count - 1),
        mf_statistics_correlated_error(squares, count / each, 1)};
}

struct thermodynamics_capacity
mf_thermodynamics_heat_capacity(const struct thermodynamics *thermodynamics,
                                const struct simulation_setup *setup) {
    const double particles = (double)setup->placement.count, d = setup->box.dimensions;
    struct thermodynamics_capacity none = {NAN, NAN};
    if (thermodynamics->series.count < MIN_SAMPLES || !mf_simulation_is_thermal(setup) ||
        setup->integrator->events || setup->integrator->solvent_particles)
        return none;
    const struct thermodynamics_capacity variance = variance_of(thermodynamics, setup);
    if (simulation_holds_temperature(setup)) {
        const double factor = particles / pow(setup->temperature, 2);
        const double kinetic = simulation_has_velocities(setup) ? 0 : d / 2;
        return (struct thermodynamics_capacity){kinetic + factor * variance.value,
                                                factor * variance.error};
    }
    const struct thermodynamics_summary s = mf_thermodynamics_result(thermodynamics, 1);
    const double factor = 2 * particles / (d * pow(s.temperature, 2));
    const double left = 1 - factor * variance.value; // d/2 of the capacity
    return left > 0 ? (struct thermodynamics_capacity){d / 2 / left, d / 2 / (left * left) *
                                                                         factor * variance.error}
                    : none;
}
