// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/event_driven.h"

#include "base/clock.h"
#include "dynamics/hard_start.h"
#include "forces/molecules.h"

static const struct event_driven_parameters *parameters_of(const struct simulation *simulation) {
    return simulation->setup.integrator_parameters;
}

const struct event_driven *mf_event_driven_state(const struct simulation *simulation) {
    return simulation->setup.integrator == &mf_event_driven ? simulation->integrator_state : NULL;
}

static enum status refuse(const char *key) {
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: \"event-driven\" moves hard particles, on which no forces act; "
                          "leave it out, or take another integrator",
                          key);
}

static enum status check(const struct simulation_setup *setup, int walls) {
    if (setup->potential)
        return refuse("conservative");
    if (setup->omega)
        return refuse("dissipative");
    if (mf_molecules_find(setup->interaction, setup->interactions))
        return refuse("molecules");
    if (setup->interactions > 0)
        return refuse("interactions");
    if (walls >> setup->box.dimensions)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "dynamics.walls: the scene has two dimensions, and no axis z");
    return STATUS_OK;
}

/// What all particles have that the scene says nothing of.
static const double usual_radius = 0.5, usual_mass = 1;

static void fill(double *to, const double *from, double otherwise, size_t count) {
    for (size_t k = 0; k < count; k++)
        to[k] = from ? from[k] : otherwise;
}

/// They keep the energy that they begin with, which is therefore exactly that of the scene's
/// temperature. Momentum, 0 at first, is kept along axes without walls alone.
static enum status scale_velocities(struct particles *particles, int walls, double temperature) {
    double degrees = (double)particles->box.dimensions * (double)particles->count;
    for (int d = 0; d < particles->box.dimensions; d++)
        degrees -= walls >> d & 1 ? 0 : 1;
    const double energy = mf_particles_kinetic_energy(particles);
    if (!(energy > 0))
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "particles.velocities: all velocities are equal; choose another \"seed\"");
    const double scale = sqrt(0.5 * degrees * temperature / energy);
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t k = 0; k < particles->count; k++)
            particles->velocity[d][k] *= scale;
    return STATUS_OK;
}

/// What a file puts beyond a wall has been wrapped into the box.
static enum status check_inside(const struct particles *particles, int walls) {
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t k = 0; k < particles->count && (walls >> d & 1); k++)
            if (particles->image[d][k] != 0)
                return mf_status_fail(STATUS_BAD_INPUT,
                                      "particles.file: particle %u is beyond a wall along %c",
                                      particles->id[k], "xyz"[d]);
    return STATUS_OK;
}

static enum status begin(struct simulation *simulation) {
    struct event_driven *state = simulation->integrator_state;
    struct particles *particles = &simulation->particles;
    const int walls = parameters_of(simulation)->walls;
    OWNED double *radius = NULL, *mass = NULL;
    TRY(check(&simulation->setup, walls));
    TRY_ARRAY(radius, particles->count);
    TRY_ARRAY(mass, particles->count);
    fill(radius, mf_particles_numbers(particles, "radius"), usual_radius, particles->count);
    fill(mass, particles_masses(particles), usual_mass, particles->count);
    if (simulation->velocities_drawn)
        TRY(scale_velocities(particles, walls, simulation->setup.temperature));
    if (simulation->setup.placement.kind != PLACEMENT_FILE)
        TRY(mf_hard_start_part(particles, radius, walls));
    else
        TRY(check_inside(particles, walls));
    TRY(mf_hard_start_check(particles, radius, walls));
    TRY(mf_hard_gas_init(&state->gas, particles, radius, mass, walls));
    return mf_simulation_compute_forces(simulation, 0);
}

static void clear(void *state) {
    mf_hard_gas_clear(&((struct event_driven *)state)->gas);
}

static size_t spans(void *state, struct memory_span *spans) {
    struct event_driven *own = state;
    const size_t n = mf_hard_gas_spans(&own->gas, spans);
    spans[n] = (struct memory_span){&own->virial, sizeof own->virial};
    return n + 1;
}

/// The virial of the step, as if forces had acted in it: that of its collisions over its time. No
/// forces are computed, and no list is built: there are none for which it would be needed.
static enum status step(struct simulation *simulation) {
    struct event_driven *state = simulation->integrator_state;
    const uint64_t collisions = state->gas.now.tally.collisions;
    const double dt = simulation->setup.time_step, time = (double)simulation->step * dt;
    const double begin = clock_seconds();
    const enum status status = mf_hard_gas_run(&state->gas, time, simulation->setup.cancel);
    const struct hard_gas_tally *after = &state->gas.now.tally;
    state->seconds += clock_seconds() - begin;
    state->collisions += after->collisions - collisions;
    if (status != STATUS_OK) {
        simulation->step--; // the rest of it is done by the next call
        return status;
    }
    mf_hard_gas_write(&state->gas, time, &simulation->particles);
    mf_particles_wrap(&simulation->particles);
    mf_particles_update_fractions(&simulation->particles);
    simulation->sums = (struct pair_sums){.virial = (after->virial - state->virial) / dt};
    state->virial = after->virial;
    return STATUS_OK;
}

/// In the order of the bits of the axes.
static const char *const walls[] = {"none", "x", "y", "xy", "z", "xz", "yz", "xyz", NULL};

static const struct field fields[] = {
    {"walls", FIELD_CHOICE, offsetof(struct event_driven_parameters, walls), .choices = walls,
     .unit = "", .help = "axes with reflecting walls at both ends; others are periodic"},
    FIELD_END,
};

const struct integrator mf_event_driven = {
    .name = "event-driven",
    .summary = "hard discs and spheres, from collision to collision; B. J. Alder and T. E. "
               "Wainwright, J. Chem. Phys. 31, 459 (1959)",
    .fields = fields,
    .parameters_size = sizeof(struct event_driven_parameters),
    .state_size = sizeof(struct event_driven),
    .begin = begin,
    .clear = clear,
    .spans = spans,
    .masses = true,
    .events = true,
    .step = step,
};
