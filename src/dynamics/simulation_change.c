// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/simulation_change.h"

#include "base/visible.h"

#include <math.h>
#include <string.h>

static bool is_positive(double value) {
    return isfinite(value) && value > 0;
}

enum status mf_simulation_check_change(const struct simulation *simulation,
                                       const struct simulation_change *change) {
    const struct simulation_setup *setup = &simulation->setup;
    const struct integrator *integrator = setup->integrator;
    const bool heats = change->temperature != setup->temperature;
    if (!is_positive(change->temperature))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "temperature: %g" STATUS_TEMPERATURE " is not above 0",
                              mf_visible_number(change->temperature));
    if (!is_positive(change->time_step))
        return mf_status_fail(STATUS_BAD_INPUT, "time_step: %g" STATUS_TIME " is not above 0",
                              mf_visible_number(change->time_step));
    if (integrator->events || integrator->solvent_particles || integrator->samples)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "\"%s\" begins with its temperature and its time step: stop the "
                              "simulation to change them",
                              integrator->name);
    if (heats && !simulation_holds_temperature(setup))
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "temperature: there is no thermostat: the scene has no friction and noise");
    return STATUS_OK;
}

static enum status renew_friction(struct simulation *simulation) {
    const struct simulation_setup *setup = &simulation->setup;
    if (simulation->friction.single == NULL)
        return STATUS_OK;
    mf_friction_clear(&simulation->friction);
    return mf_friction_init(&simulation->friction, setup->omega, setup->time_step,
                            setup->temperature, setup->integrator->friction);
}

/// Velocities of the new temperature; without velocities there are none.
static void scale_velocities(struct simulation *simulation, double scale) {
    struct particles *particles = &simulation->particles;
    if (!simulation_has_velocities(&simulation->setup))
        return;
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t k = 0; k < particles->count; k++)
            particles->velocity[d][k] *= scale;
}

enum status mf_simulation_change(struct simulation *simulation,
                                 const struct simulation_change *change) {
    struct simulation_setup *setup = &simulation->setup;
    TRY(mf_simulation_check_change(simulation, change));
    if (setup->temperature > 0)
        scale_velocities(simulation, sqrt(change->temperature / setup->temperature));
    setup->temperature = simulation->law.temperature = change->temperature;
    setup->time_step = simulation->law.time_step = change->time_step;
    TRY(renew_friction(simulation));
    if (pair_memory_acts(&setup->memory))
        TRY(mf_pair_memory_change(&simulation->memory, change->temperature, change->time_step));
    // Forces have friction and noise in them, or the pairs that the next step begins with.
    return mf_simulation_compute_forces(simulation, 0);
}

enum status mf_simulation_set_box(struct simulation *simulation, const struct box *box) {
    struct particles *particles = &simulation->particles;
    const double skin = simulation->neighbours.skin;
    if (memcmp(particles->box.length, box->length, sizeof box->length) == 0)
        return STATUS_OK;
    particles->box = *box;
    mf_neighbours_clear(&simulation->neighbours);
    TRY(mf_neighbours_init(&simulation->neighbours, NEIGHBOURS_HALF, box, particles->count,
                           mf_simulation_range(&simulation->setup), skin));
    return mf_neighbours_sort_and_build(&simulation->neighbours, particles);
}
