// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/relax.h"

#include "base/interrupt.h"

#include <math.h>

enum { MAX_STEPS = 500 };

/// So many times the thermal force are an overlap; liquids of any potential here stay below 3.
static const double overlap = 10;

/// Largest shift in the first step, in mean spacings; it goes down to 0 over all steps.
static const double first_shift = 0.05;

/// Without noise this part of the range does for a free step: an overlap moves a particle by the
/// range.
static const double quiet_step = 0.1;

/// Along this part of the mean spacing a force that Monte Carlo meets may do the work of k_B T.
static const double sweep_step = 0.01;

static double spacing_of(const struct particles *particles) {
    return pow(mf_particles_density(particles), -1.0 / particles->box.dimensions);
}

/// The force that changes a velocity by a thermal one in a time step, or that moves a particle
/// without velocities by a free step.
static double thermal_force(const struct simulation *simulation) {
    const struct simulation_setup *setup = &simulation->setup;
    if (setup->integrator->samples)
        return setup->temperature / (sweep_step * spacing_of(&simulation->particles));
    if (simulation_has_velocities(setup))
        return sqrt(setup->temperature) / setup->time_step;
    const double step = setup->temperature > 0 ? simulation_free_step(setup)
                                               : quiet_step * mf_simulation_range(setup);
    return step / (setup->integrator->mobility(setup) * setup->time_step);
}

static void shift(struct particles *particles, double enough, double cap) {
    const int dimensions = particles->box.dimensions;
    for (size_t k = 0; k < particles->count; k++) {
        double square = 0;
        for (int d = 0; d < dimensions; d++)
            square += particles->force[d][k] * particles->force[d][k];
        const double scale = cap / fmax(sqrt(square), enough);
        for (int d = 0; d < dimensions; d++)
            particles->position[d][k] += scale * particles->force[d][k];
    }
}

enum status mf_relax_downhill(struct simulation *simulation, double enough) {
    struct particles *particles = &simulation->particles;
    const double spacing = spacing_of(particles);
    TRY(mf_simulation_compute_potential(simulation));
    for (int step = 0; step < MAX_STEPS; step++) {
        if (mf_interrupt_wanted(simulation->setup.cancel))
            return mf_status_fail(STATUS_INTERRUPTED, "interrupted");
        shift(particles, enough, first_shift * spacing * (1 - (double)step / MAX_STEPS));
        TRY(mf_simulation_compute_potential(simulation));
        if (!(mf_particles_largest_force(particles) > enough)) // NaN ends it, too
            break;
    }
    return STATUS_OK;
}

enum status mf_relax_overlaps(struct simulation *simulation) {
    const double enough = thermal_force(simulation);
    TRY(mf_simulation_compute_potential(simulation));
    if (!(mf_particles_largest_force(&simulation->particles) > overlap * enough))
        return STATUS_OK;
    return mf_relax_downhill(simulation, enough);
}
