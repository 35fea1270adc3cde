// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/simulation.h"

static double damping(double omega, double time_step) {
    (void)time_step;
    return omega * omega;
}

static double square(double time_step, double temperature) {
    return 2 * temperature / time_step;
}

/// Friction and noise as forces.
static const struct friction_method forces = {.damping = damping, .square = square};

/// Velocity Verlet whose friction is computed once more from the velocities at the end of the step.
static enum status step(struct simulation *simulation) {
    struct particles *particles = &simulation->particles;
    struct friction *friction = &simulation->friction;
    mf_simulation_kick_and_drift(simulation);
    TRY(mf_simulation_compute_forces(simulation, 0));
    if (simulation->setup.omega)
        TRY(mf_friction_add_to_forces(friction, particles, particles->velocity, 1, true));
    mf_simulation_kick(simulation);
    // Friction is linear in the velocities: what the kick has changed of them changes it.
    const double half_step = 0.5 * simulation->setup.time_step;
    if (simulation->setup.omega)
        TRY(mf_friction_add_to_forces(friction, particles, particles->force, half_step, false));
    return STATUS_OK;
}

static const struct field fields[] = {FIELD_END};

const struct integrator mf_dpd_vv = {
    .name = "dpd-vv",
    .summary = "DPD-VV, friction from the new velocities; G. Besold et al., Phys. Rev. E 62, R7611 "
               "(2000)",
    .fields = fields,
    .dissipative = true,
    .friction = &forces,
    .step = step,
};
