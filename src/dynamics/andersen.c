// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/simulation.h"

#include "base/rng.h"

/// A new velocity from Maxwell's distribution for the particles whose turn it is, by their ids.
static void collide(struct simulation *simulation) {
    struct particles *particles = &simulation->particles;
    const uint64_t turns = (uint64_t)simulation->setup.integrator_parameters.turns;
    const uint64_t turn = simulation->step % turns;
    const double speed = sqrt(simulation->setup.temperature);
    for (size_t k = 0; k < particles->count; k++) {
        if (particles->id[k] % turns != turn)
            continue;
        double normal[4];
        rng_normal4(rng_philox(simulation->setup.seed, RNG_COLLISIONS, (uint32_t)simulation->step,
                               particles->id[k], (uint32_t)(simulation->step >> 32)),
                    normal);
        for (int d = 0; d < particles->box.dimensions; d++)
            particles->velocity[d][k] = speed * normal[d];
    }
}

/// Kick, drift, collide, drift, kick. With the bath in the middle of the drift the positions of a
/// harmonic oscillator have exactly their variance at any stable step; at the end of the step they
/// would have 1/(1 − ω²Δt²/4) of it.
static enum status step(struct simulation *simulation) {
    simulation_kick(simulation);
    simulation_drift_half(simulation);
    collide(simulation);
    simulation_drift_half(simulation);
    TRY(simulation_compute_forces(simulation, 0));
    simulation_kick(simulation);
    return STATUS_OK;
}

static const struct field fields[] = {FIELD_END};

const struct integrator andersen = {
    .name = "andersen",
    .summary = "particles collide with a heat bath in turn; H. C. Andersen, J. Chem. Phys. 72, "
               "2384 (1980)",
    .fields = fields,
    .step = step,
};
