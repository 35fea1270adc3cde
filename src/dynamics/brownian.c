// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/brownian.h"

#include "base/normal.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "dynamics/simulation.h"

/// The noise of the last step is an attribute of the particles.
struct state {
    int noise;
    struct normal_table normal;
};

static double friction_of(const struct simulation_setup *setup) {
    const struct brownian_parameters *parameters = setup->integrator_parameters;
    return parameters->friction;
}

static double free_step(const struct simulation_setup *setup) {
    return sqrt(2 * setup->temperature * setup->time_step / friction_of(setup));
}

/// Standard normal numbers of a particle in this step, for each axis.
static void draw(const struct simulation *simulation, uint32_t id, double noise[3]) {
    const struct state *state = simulation->integrator_state;
    const uint64_t step = simulation->step;
    const struct rng_block block = mf_rng_philox(simulation->setup.seed, RNG_BROWNIAN,
                                                 (uint32_t)step, id, (uint32_t)(step >> 32));
    for (int d = 0; d < 3; d++)
        noise[d] = mf_normal_of_word(&state->normal, block.word[d]);
}

/// Nothing has moved yet: the velocities that were drawn are nobody's.
static enum status begin(struct simulation *simulation) {
    struct state *state = simulation->integrator_state;
    struct particles *particles = &simulation->particles;
    const int dimensions = particles->box.dimensions;
    const struct particles_attribute attribute = {
        .name = "noise", .type = PARTICLES_DOUBLE, .components = dimensions};
    mf_normal_table_init(&state->normal);
    TRY(mf_particles_add_attribute(particles, &attribute, &state->noise));
    for (size_t k = 0; k < particles->count; k++) {
        double noise[3];
        draw(simulation, particles->id[k], noise);
        for (int d = 0; d < dimensions; d++) {
            ((double *)particles->attribute[state->noise].value[d])[k] = noise[d];
            particles->velocity[d][k] = 0;
        }
    }
    return STATUS_OK;
}

/// x += Δt F/γ + sqrt(k_B T Δt/(2γ)) (R + R'), with R of the last step and R' of this one.
static void move(void *context, size_t begin, size_t end) {
    struct simulation *simulation = context;
    struct particles *particles = &simulation->particles;
    const struct state *state = simulation->integrator_state;
    const double time_step = simulation->setup.time_step;
    const double mobility = 1 / friction_of(&simulation->setup);
    const double kick = 0.5 * free_step(&simulation->setup) / time_step;
    for (size_t k = begin; k < end; k++) {
        double noise[3];
        draw(simulation, particles->id[k], noise);
        for (int d = 0; d < particles->box.dimensions; d++) {
            double *last = particles->attribute[state->noise].value[d];
            const double rate = mobility * particles->force[d][k] + kick * (last[k] + noise[d]);
            last[k] = noise[d];
            particles->velocity[d][k] = rate;
            particles->position[d][k] += time_step * rate;
        }
    }
}

/// y = x − ½ sqrt(2 D Δt) R with R of the last step, whose increments Δt F/γ + sqrt(2 D Δt) R are
/// independent: the MSD of free particles is 2 d D t at every lag, that of x lacks half a step.
static void forget(const struct simulation *simulation, double *positions) {
    const struct particles *particles = &simulation->particles;
    const struct state *state = simulation->integrator_state;
    const double half = 0.5 * free_step(&simulation->setup);
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double *noise = particles->attribute[state->noise].value[d];
        for (size_t k = 0; k < particles->count; k++)
            positions[(size_t)d * particles->count + particles->id[k]] -= half * noise[k];
    }
}

static enum status step(struct simulation *simulation) {
    const struct particles *particles = &simulation->particles;
    mf_parallel_for(particles->count, particles->threads, move, simulation);
    return mf_simulation_compute_forces(simulation, 0);
}

static const struct field fields[] = {
    {"friction", FIELD_NUMBER, offsetof(struct brownian_parameters, friction), .initial = 1,
     .minimum = FIELD_ABOVE_ZERO, .maximum = DBL_MAX, .unit = "mass/tau",
     .help = "gamma of each particle; alone it diffuses with D = T/gamma"},
    FIELD_END,
};

const struct integrator mf_brownian = {
    .name = "brownian",
    .summary = "no velocities, friction with what is at rest, the high-friction limit of BAOAB; "
               "B. Leimkuhler and C. Matthews, Appl. Math. Res. Express 2013, 34 (2013)",
    .fields = fields,
    .parameters_size = sizeof(struct brownian_parameters),
    .state_size = sizeof(struct state),
    .begin = begin,
    .free_step = free_step,
    .forget = forget,
    .step = step,
};
