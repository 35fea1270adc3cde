// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/brownian.h"

#include "base/parallel.h"
#include "base/simd.h"
#include "dynamics/particle_noise.h"
#include "dynamics/simulation.h"
#include "system/orientation.h"

/// The noise of the last step is an attribute of the particles, if it outlasts the step.
struct state {
    int noise;
    bool outlasts;
    struct normal_table normal;
};

/// Particles that are moved together, and numbers that one of them draws: for its axes and, in the
/// place of the third, for its orientation.
enum { BLOCK = PARTICLE_NOISE_BLOCK, NUMBERS = PARTICLE_NOISE_NUMBERS };

static const struct brownian_parameters *parameters_of(const struct simulation_setup *setup) {
    return setup->integrator_parameters;
}

static double mobility(const struct simulation_setup *setup) {
    return 1 / parameters_of(setup)->friction;
}

static double orientation_mobility(const struct simulation_setup *setup) {
    return 1 / parameters_of(setup)->orientation_friction;
}

/// sqrt(2 D_r Δt).
static double free_turn(const struct simulation_setup *setup) {
    return sqrt(2 * parameters_of(setup)->orientation_temperature * orientation_mobility(setup) *
                setup->time_step);
}

/// Standard normal numbers of the particles begin … begin + count − 1 in this step.
static void draw(const struct simulation *simulation, size_t begin, size_t count,
                 double noise[NUMBERS][BLOCK]) {
    const struct state *state = simulation->integrator_state;
    mf_particle_noise_draw(simulation, &state->normal, RNG_BROWNIAN, begin, count, noise);
}

/// Attributes of the particles that are moved.
struct moved {
    struct simulation *simulation;
    struct orientation orientation;
    double *last[NUMBERS]; ///< noise of the last step
};

static struct moved find_moved(struct simulation *simulation) {
    const struct particles *particles = &simulation->particles;
    const struct state *state = simulation->integrator_state;
    struct moved moved = {.simulation = simulation, .orientation = mf_orientation_of(particles)};
    for (int n = 0; n < NUMBERS && state->outlasts; n++)
        moved.last[n] = particles->attribute[state->noise].value[n];
    return moved;
}

/// Nothing has moved yet: the velocities that were drawn are nobody's.
static void rest(struct particles *particles) {
    for (int d = 0; d < particles->box.dimensions; d++)
        memset(particles->velocity[d], 0, particles->count * sizeof *particles->velocity[d]);
}

static enum status begin(struct simulation *simulation) {
    struct state *state = simulation->integrator_state;
    mf_normal_table_init(&state->normal);
    rest(&simulation->particles);
    return STATUS_OK;
}

static enum status begin_outlasting(struct simulation *simulation) {
    struct state *state = simulation->integrator_state;
    struct particles *particles = &simulation->particles;
    const bool turns = mf_orientation_of(particles).angle != NULL;
    const struct particles_attribute attribute = {.name = "noise",
                                                  .type = PARTICLES_DOUBLE,
                                                  .components =
                                                      particles->box.dimensions + (turns ? 1 : 0)};
    double noise[NUMBERS][BLOCK];
    TRY(begin(simulation));
    TRY(mf_particles_add_attribute(particles, &attribute, &state->noise));
    state->outlasts = true;
    for (size_t first = 0; first < particles->count; first += BLOCK) {
        const size_t count = particles->count - first < BLOCK ? particles->count - first : BLOCK;
        draw(simulation, first, count, noise);
        for (int n = 0; n < attribute.components; n++)
            memcpy((double *)particles->attribute[state->noise].value[n] + first, noise[n],
                   count * sizeof **noise);
    }
    return STATUS_OK;
}

/// One coordinate of a block: x += Δt rate, rate = mobility · force + kick · R. With the noise of
/// the last step, R is the mean of that and this one's.
static inline __attribute__((always_inline)) void
advance(size_t count, double time_step, double mobility, double kick, const double *restrict force,
        const double *restrict noise, double *restrict last, double *restrict rate,
        double *restrict x) {
    for (size_t k = 0; k < count; k++) {
        const double drawn = last ? 0.5 * (last[k] + noise[k]) : noise[k];
        rate[k] = mobility * force[k] + kick * drawn;
        x[k] += time_step * rate[k];
    }
    if (last)
        memcpy(last, noise, count * sizeof *last);
}

SIMD_CLONES static void move_block(const struct moved *moved, size_t first, size_t count,
                                   double noise[NUMBERS][BLOCK]) {
    const struct simulation_setup *setup = &moved->simulation->setup;
    const struct particles *particles = &moved->simulation->particles;
    const struct orientation *orientation = &moved->orientation;
    const double time_step = setup->time_step;
    const double kick = simulation_free_step(setup) / time_step;
    for (int d = 0; d < particles->box.dimensions; d++)
        advance(count, time_step, mobility(setup), kick, particles->force[d] + first, noise[d],
                moved->last[d] ? moved->last[d] + first : NULL, particles->velocity[d] + first,
                particles->position[d] + first);
    if (orientation->angle == NULL)
        return;
    const double turn = free_turn(setup), shared = moved->last[2] ? 0.5 * turn : 0;
    double rate[BLOCK];
    double *restrict angle = orientation->angle + first;
    advance(count, time_step, orientation_mobility(setup), turn / time_step,
            orientation->torque + first, noise[2], moved->last[2] ? moved->last[2] + first : NULL,
            rate, angle);
    for (size_t k = 0; k < count; k++)
        orientation_polarity(angle[k], &orientation->polarity[0][first + k],
                             &orientation->polarity[1][first + k]);
    for (size_t k = 0; k < count; k++)
        orientation_polarity(angle[k] - shared * noise[2][k], &orientation->heading[0][first + k],
                             &orientation->heading[1][first + k]);
}

static void move(void *context, size_t begin, size_t end) {
    const struct moved *moved = context;
    double noise[NUMBERS][BLOCK];
    for (size_t first = begin; first < end; first += BLOCK) {
        const size_t count = end - first < BLOCK ? end - first : BLOCK;
        draw(moved->simulation, first, count, noise);
        move_block(moved, first, count, noise);
    }
}

/// y = x − ½ sqrt(2 D Δt) R with R of the last step, whose increments Δt F/γ + sqrt(2 D Δt) R are
/// independent: the MSD of free particles is 2 d D t at every lag, that of x lacks half a step. So
/// it is with orientations, and particles drive themselves along the angle without that half: what
/// they then diffuse is too much by a part (D_r Δt)²/12 alone, and by D_r Δt/2 with it.
static void remove_correlated(const struct simulation *simulation, double *positions,
                              double *angles) {
    const struct particles *particles = &simulation->particles;
    const struct state *state = simulation->integrator_state;
    const double half = 0.5 * simulation_free_step(&simulation->setup);
    const double half_turn = 0.5 * free_turn(&simulation->setup);
    for (int d = 0; d < particles->box.dimensions; d++) {
        const double *noise = particles->attribute[state->noise].value[d];
        for (size_t k = 0; k < particles->count; k++)
            positions[(size_t)d * particles->count + particles->id[k]] -= half * noise[k];
    }
    const double *noise = particles->attribute[state->noise].value[2];
    for (size_t k = 0; angles && k < particles->count; k++)
        angles[particles->id[k]] -= half_turn * noise[k];
}

static enum status step(struct simulation *simulation) {
    const struct particles *particles = &simulation->particles;
    struct moved moved = find_moved(simulation);
    mf_parallel_for(particles->count, particles->threads, move, &moved);
    return mf_simulation_compute_forces(simulation, 0);
}

// Free particles ----------------------------------------------------------------------------------

struct brownian_free mf_brownian_free(const struct simulation_setup *setup) {
    return (struct brownian_free){.diffusion = setup->temperature * mobility(setup),
                                  .speed = mf_simulation_push(setup) * mobility(setup),
                                  .orientation_diffusion =
                                      parameters_of(setup)->orientation_temperature *
                                      orientation_mobility(setup)};
}

/// t/D − (1 − exp(−D t))/D², and ½ t² for D → 0.
static double persistence(double diffusion, double time) {
    const double turns = diffusion * time;
    return turns < 1e-4 ? time * time * (0.5 - turns / 6)
                        : (turns + expm1(-turns)) / (diffusion * diffusion);
}

double mf_brownian_free_msd(const struct brownian_free *free, double time) {
    return 4 * free->diffusion * time +
           2 * free->speed * free->speed * persistence(free->orientation_diffusion, time);
}

double mf_brownian_free_long_time(const struct brownian_free *free) {
    return free->speed > 0
               ? free->diffusion + free->speed * free->speed / (2 * free->orientation_diffusion)
               : free->diffusion;
}

// Records -----------------------------------------------------------------------------------------

#define MEMBER(name) .offset = offsetof(struct brownian_parameters, name)
static const struct field fields[] = {
    {"friction", FIELD_NUMBER, MEMBER(friction), .initial = 1, .minimum = FIELD_ABOVE_ZERO,
     .maximum = DBL_MAX, .unit = "mu/tau", .help = "gamma, with D = T/gamma of a single particle"},
    {"orientation_friction", FIELD_NUMBER, MEMBER(orientation_friction), .initial = 1,
     .minimum = FIELD_ABOVE_ZERO, .maximum = DBL_MAX, .unit = "mu lambda^2/tau",
     .help = "gamma_r of the orientation"},
    {"orientation_temperature", FIELD_NUMBER, MEMBER(orientation_temperature), .initial = 1,
     .minimum = 0, .maximum = DBL_MAX, .unit = "T_0",
     .help = "T_r of the orientation's noise: D_r = T_r/gamma_r"},
    FIELD_END,
};

const struct integrator mf_brownian = {
    .name = "brownian",
    .summary = "overdamped dynamics, the high-friction limit of BAOAB; B. Leimkuhler and C. "
               "Matthews, Appl. Math. Res. Express 2013, 34 (2013)",
    .fields = fields,
    .parameters_size = sizeof(struct brownian_parameters),
    .state_size = sizeof(struct state),
    .begin = begin_outlasting,
    .mobility = mobility,
    .orientation_mobility = orientation_mobility,
    .remove_correlated = remove_correlated,
    .step = step,
};

const struct integrator mf_brownian_euler = {
    .name = "euler-maruyama",
    .summary = "brownian to first order in the time step, for comparison; G. Maruyama, Rend. Circ. "
               "Mat. Palermo 4, 48 (1955)",
    .fields = fields,
    .parameters_size = sizeof(struct brownian_parameters),
    .state_size = sizeof(struct state),
    .begin = begin,
    .mobility = mobility,
    .orientation_mobility = orientation_mobility,
    .step = step,
};
