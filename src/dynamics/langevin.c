// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/langevin.h"

#include "base/parallel.h"
#include "base/simd.h"
#include "dynamics/particle_noise.h"
#include "dynamics/simulation.h"

struct state {
    struct normal_table normal;
};

static enum status begin(struct simulation *simulation) {
    struct state *state = simulation->integrator_state;
    mf_normal_table_init(&state->normal);
    return STATUS_OK;
}

/// Friction and noise of a whole step, exactly: v ← c v + sqrt((1 − c²) T/m) ζ, c = exp(−γ Δt/m).
SIMD_CLONES static void thermalise(void *context, size_t begin, size_t end) {
    const struct simulation *simulation = context;
    const struct simulation_setup *setup = &simulation->setup;
    const struct langevin_parameters *parameters = setup->integrator_parameters;
    const struct state *state = simulation->integrator_state;
    const struct particles *particles = &simulation->particles;
    const double *mass = particles_masses(particles);
    const double kept = exp(-parameters->rate * setup->time_step);
    const double given =
        sqrt(-expm1(-2 * parameters->rate * setup->time_step) * setup->temperature);
    double noise[PARTICLE_NOISE_NUMBERS][PARTICLE_NOISE_BLOCK];
    for (size_t first = begin; first < end; first += PARTICLE_NOISE_BLOCK) {
        const size_t left = end - first;
        const size_t count = left < PARTICLE_NOISE_BLOCK ? left : PARTICLE_NOISE_BLOCK;
        mf_particle_noise_draw(simulation, &state->normal, RNG_BROWNIAN, first, count, noise);
        for (int d = 0; d < particles->box.dimensions; d++) {
            double *restrict v = particles->velocity[d] + first;
            for (size_t k = 0; k < count; k++)
                v[k] = kept * v[k] + given / (mass ? sqrt(mass[first + k]) : 1) * noise[d][k];
        }
    }
}

static enum status step(struct simulation *simulation) {
    const struct particles *particles = &simulation->particles;
    mf_simulation_kick(simulation);
    mf_simulation_drift_half(simulation);
    mf_parallel_for(particles->count, particles->threads, thermalise, simulation);
    mf_simulation_drift_half(simulation);
    TRY(mf_simulation_compute_forces(simulation, 0));
    mf_simulation_kick(simulation);
    return STATUS_OK;
}

static bool holds_temperature(const struct simulation_setup *setup) {
    (void)setup;
    return true;
}

#define MEMBER(name) .offset = offsetof(struct langevin_parameters, name)
static const struct field fields[] = {
    {"rate", FIELD_NUMBER, MEMBER(rate), .initial = 1, .minimum = FIELD_ABOVE_ZERO,
     .maximum = DBL_MAX, .unit = "1/tau", .help = "gamma/m of each bead"},
    FIELD_END,
};

const struct integrator mf_langevin = {
    .name = "langevin",
    .summary = "a bath of each bead, BAOAB; B. Leimkuhler and C. Matthews, Appl. Math. Res. "
               "Express 2013, 34 (2013)",
    .fields = fields,
    .parameters_size = sizeof(struct langevin_parameters),
    .state_size = sizeof(struct state),
    .masses = true,
    .begin = begin,
    .holds_temperature = holds_temperature,
    .step = step,
};
