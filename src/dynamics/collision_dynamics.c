// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/collision_dynamics.h"

#include "dynamics/simulation.h"
#include "dynamics/solvent.h"

#include <math.h>

static const struct collision_dynamics_parameters *
parameters_of(const struct simulation_setup *setup) {
    return setup->integrator_parameters;
}

static double solvent_particles(const struct simulation_setup *setup) {
    return mf_solvent_count(parameters_of(setup), &setup->box);
}

static bool holds_temperature(const struct simulation_setup *setup) {
    return parameters_of(setup)->thermostat;
}

static bool has_drift(const struct collision_dynamics_parameters *parameters) {
    return parameters->drift[0] != 0 || parameters->drift[1] != 0 || parameters->drift[2] != 0;
}

static const char *warning(const struct simulation_setup *setup) {
    const struct collision_dynamics_parameters *parameters = parameters_of(setup);
    const bool pushed = parameters->acceleration[0] != 0 || parameters->acceleration[1] != 0 ||
                        parameters->acceleration[2] != 0;
    const bool held = parameters->walls == COLLISION_PLATES || parameters->obstacle_radius > 0;
    const bool flows = parameters->wave_acceleration != 0 || (pushed && held);
    if (parameters->particles_per_cell < 3)
        return "dynamics.particles_per_cell: below 3 many cells have no collisions, and the theory "
               "is not valid";
    if (!parameters->hydrodynamics && (flows || has_drift(parameters)))
        return "dynamics.hydrodynamics: without it the flow of the solvent does not act on beads";
    if (parameters->walls == COLLISION_PLATES && setup->potential)
        return "dynamics.walls: pair forces are not cut by plates: beads within a cutoff interact "
               "through them";
    if (flows && setup->placement.count > 1)
        return "dynamics: the flow contributes to the temperature, MSD, VACF and D of the beads; "
               "accelerations of 0 avoid that";
    return NULL;
}

static enum status begin(struct simulation *simulation) {
    const struct simulation_setup *setup = &simulation->setup;
    struct solvent *solvent = simulation->integrator_state;
    solvent->parameters = *parameters_of(setup);
    solvent->box = setup->box;
    solvent->temperature = setup->temperature;
    solvent->time = (double)solvent->parameters.interval * setup->time_step;
    solvent->seed = setup->seed;
    TRY(mf_solvent_init(solvent, &simulation->particles, simulation->threads.max));
    TRY(mf_solvent_part_beads(solvent, &simulation->particles, &setup->placement));
    return mf_simulation_compute_forces(simulation, 0);
}

static void clear(void *state) {
    mf_solvent_clear(state);
}

static size_t spans(void *state, struct memory_span *spans) {
    struct solvent *solvent = state;
    const size_t bytes = solvent->count * sizeof(double);
    size_t n = 0;
    for (int d = 0; d < solvent->box.dimensions; d++) {
        spans[n++] = (struct memory_span){solvent->position[d], bytes};
        spans[n++] = (struct memory_span){solvent->velocity[d], bytes};
    }
    spans[n++] = (struct memory_span){solvent->given, sizeof solvent->given};
    return n;
}

/// v += ½ Δt (F/m + g), with the wave's acceleration.
static void kick(struct simulation *simulation) {
    const struct solvent *solvent = simulation->integrator_state;
    const struct collision_dynamics_parameters *parameters = &solvent->parameters;
    struct particles *beads = &simulation->particles;
    const double half = 0.5 * simulation->setup.time_step;
    const double wave = half * parameters->wave_acceleration;
    const double turn = 2 * M_PI / solvent->box.length[1];
    mf_simulation_kick(simulation);
    for (int d = 0; d < beads->box.dimensions; d++) {
        const double more = half * parameters->acceleration[d];
        for (size_t k = 0; k < beads->count && more != 0; k++)
            beads->velocity[d][k] += more;
    }
    for (size_t k = 0; k < beads->count && wave != 0; k++)
        beads->velocity[0][k] += wave * sin(turn * beads->position[1][k]);
}

/// x += Δt v, turned back by walls.
static void drift(struct simulation *simulation) {
    static const double none[3] = {0};
    struct solvent *solvent = simulation->integrator_state;
    struct particles *beads = &simulation->particles;
    const double *masses = particles_masses(beads);
    for (size_t k = 0; k < beads->count; k++) {
        double position[3] = {0}, velocity[3] = {0}, impulse[3] = {0};
        for (int d = 0; d < beads->box.dimensions; d++) {
            position[d] = beads->position[d][k];
            velocity[d] = beads->velocity[d][k];
        }
        mf_solvent_propagate(solvent, position, velocity, none, simulation->setup.time_step,
                             impulse);
        for (int d = 0; d < beads->box.dimensions; d++) {
            beads->position[d][k] = position[d];
            beads->velocity[d][k] = velocity[d];
            solvent->given[d] += llrint((masses ? masses[k] : 1) * impulse[d] / SOLVENT_IMPULSE);
        }
    }
}

/// Velocity Verlet of the beads, and after every interval streaming and collisions.
static enum status step(struct simulation *simulation) {
    struct solvent *solvent = simulation->integrator_state;
    struct particles *beads = &simulation->particles;
    if (beads->count > 0) {
        kick(simulation);
        drift(simulation);
        TRY(mf_simulation_compute_forces(simulation, 0));
        kick(simulation);
    }
    if (simulation->step % (uint64_t)solvent->parameters.interval != 0)
        return STATUS_OK;
    TRY(mf_solvent_stream(solvent, simulation->step, beads->threads));
    mf_solvent_sort(solvent, beads->threads);
    mf_solvent_collide(solvent, beads, simulation->step, beads->threads);
    return STATUS_OK;
}

const struct solvent *mf_collision_dynamics_solvent(const struct simulation *simulation) {
    return simulation->setup.integrator == &mf_collision_dynamics ? simulation->integrator_state
                                                                  : NULL;
}

// Theory ------------------------------------------------------------------------------------------

/// What N bodies keep of relative velocities (`power` 1) and of their products (2).
static double kept(const struct simulation_setup *setup, int power, double bodies) {
    const struct collision_dynamics_parameters *parameters = parameters_of(setup);
    const bool fixed = parameters->angles == COLLISION_FIXED_ANGLES;
    const double one = fixed ? cos(parameters->angle * (M_PI / 180)) : 0;
    const double two = fixed ? cos(2 * parameters->angle * (M_PI / 180)) : 0;
    const int dimensions = setup->box.dimensions;
    const double k = 0.5 * dimensions * (bodies - 1);
    double share = power == 1 ? one : two;
    if (dimensions == 3)
        share = power == 1 ? (1 + 2 * one) / 3 : (1 + 2 * one + 2 * two) / 5;
    if (!parameters->thermostat)
        return share;
    return share *
           (power == 1 ? exp(2 * lgamma(k + 0.5) - lgamma(k) - lgamma(k + 1)) : k / (k + 1));
}

/// Σ_N P(N) (m N/(mass + m N)) (1 − ρ_n): what a particle among N others forgets in a collision.
static double decorrelation(const struct simulation_setup *setup, int power, double mass) {
    const struct collision_dynamics_parameters *parameters = parameters_of(setup);
    const double mean = parameters->particles_per_cell;
    const int max = (int)(mean + 10 * sqrt(mean) + 20);
    double sum = 0;
    for (int n = 1; n <= max; n++) {
        const double chance = exp(n * log(mean) - mean - lgamma(n + 1));
        const double others = parameters->mass * n;
        sum += chance * others / (mass + others) * (1 - kept(setup, power, n + 1));
    }
    return sum;
}

static double collision_time(const struct simulation_setup *setup) {
    return (double)parameters_of(setup)->interval * setup->time_step;
}

double mf_collision_dynamics_viscosity(const struct simulation_setup *setup) {
    const struct collision_dynamics_parameters *parameters = parameters_of(setup);
    const double time = collision_time(setup), mass = parameters->mass;
    return parameters->cell * parameters->cell * decorrelation(setup, 1, mass) / (12 * time) +
           setup->temperature * time / mass * (1 / decorrelation(setup, 2, mass) - 0.5);
}

double mf_collision_dynamics_diffusion(const struct simulation_setup *setup, double mass) {
    return setup->temperature * collision_time(setup) / mass *
           (1 / decorrelation(setup, 1, mass) - 0.5);
}

// Record ------------------------------------------------------------------------------------------

static const char *const yes_or_no[] = {"no", "yes", NULL};
static const char *const angles[] = {"fixed", "random", NULL}; // enum collision_angles
static const char *const walls[] = {"none", "plates", NULL};   // enum collision_walls

#define MEMBER(name) .offset = offsetof(struct collision_dynamics_parameters, name)
static const struct field fields[] = {
    {"cell", FIELD_NUMBER, MEMBER(cell), .initial = 1, .minimum = FIELD_ABOVE_ZERO,
     .maximum = DBL_MAX, .unit = "lambda", .help = "edge a of a cell, which divides the box"},
    {"particles_per_cell", FIELD_NUMBER, MEMBER(particles_per_cell), .initial = 10,
     .minimum = FIELD_ABOVE_ZERO, .maximum = 1e6, .unit = "",
     .help = "M, mean number of solvent particles in a cell"},
    {"mass", FIELD_NUMBER, MEMBER(mass), .initial = 1, .minimum = FIELD_ABOVE_ZERO,
     .maximum = DBL_MAX, .unit = "mu", .help = "m of a solvent particle"},
    {"angle", FIELD_NUMBER, MEMBER(angle), .initial = 130, .minimum = FIELD_ABOVE_ZERO,
     .maximum = 180, .unit = "degrees", .help = "alpha, rotation of relative velocities"},
    {"angles", FIELD_CHOICE, MEMBER(angles), .choices = angles, .initial = COLLISION_FIXED_ANGLES,
     .unit = "", .help = "random: one a cell, instead of alpha"},
    {"interval", FIELD_INTEGER, MEMBER(interval), .initial = 1, .minimum = 1, .maximum = 1e9,
     .unit = "steps", .help = "interval between collisions"},
    {"thermostat", FIELD_CHOICE, MEMBER(thermostat), .choices = yes_or_no, .initial = 0, .unit = "",
     .help = "canonical thermostat of every cell"},
    {"grid_shift", FIELD_CHOICE, MEMBER(grid_shift), .choices = yes_or_no, .initial = 1, .unit = "",
     .help = "random shift of the grid before each collision"},
    {"hydrodynamics", FIELD_CHOICE, MEMBER(hydrodynamics), .choices = yes_or_no, .initial = 1,
     .unit = "", .help = "no: friction and noise without flow, as in Rouse's model"},
    {"walls", FIELD_CHOICE, MEMBER(walls), .choices = walls, .initial = COLLISION_NO_WALLS,
     .unit = "", .help = "no-slip plates at y = 0 and the box edge"},
    {"wall_filling", FIELD_NUMBER, MEMBER(wall_filling), .initial = 1.4, .minimum = 0,
     .maximum = 10, .unit = "particles_per_cell",
     .help = "virtual particles in cells at walls; 1.4 for no slip"},
    {"acceleration", FIELD_LENGTHS, MEMBER(acceleration), .minimum = -DBL_MAX, .maximum = DBL_MAX,
     .unit = "lambda/tau^2", .help = "acceleration of solvent and beads, along each axis"},
    {"wave_acceleration", FIELD_NUMBER, MEMBER(wave_acceleration), .initial = 0,
     .minimum = -DBL_MAX, .maximum = DBL_MAX, .unit = "lambda/tau^2",
     .help = "A of a force A sin(2 pi y/L_y) per mass along x, to measure the viscosity"},
    {"drift", FIELD_LENGTHS, MEMBER(drift), .minimum = -DBL_MAX, .maximum = DBL_MAX,
     .unit = "lambda/tau", .help = "initial mean velocity of the solvent"},
    {"obstacle_centre", FIELD_LENGTHS, MEMBER(obstacle_centre), .minimum = -DBL_MAX,
     .maximum = DBL_MAX, .unit = "lambda",
     .help = "centre of a disc or sphere at rest, without slip"},
    {"obstacle_radius", FIELD_NUMBER, MEMBER(obstacle_radius), .initial = 0, .minimum = 0,
     .maximum = DBL_MAX, .unit = "lambda", .help = "its radius; 0: none"},
    FIELD_END,
};

const struct integrator mf_collision_dynamics = {
    .name = "collision-dynamics",
    .summary = "multi-particle collision dynamics of a solvent and beads in it; A. Malevanets and "
               "R. Kapral, J. Chem. Phys. 110, 8605 (1999)",
    .fields = fields,
    .parameters_size = sizeof(struct collision_dynamics_parameters),
    .state_size = sizeof(struct solvent),
    .begin = begin,
    .clear = clear,
    .spans = spans,
    .solvent_particles = solvent_particles,
    .solvent_cost = 12,
    .model_time_step = true,
    .masses = true,
    .holds_temperature = holds_temperature,
    .warning = warning,
    .step = step,
};
