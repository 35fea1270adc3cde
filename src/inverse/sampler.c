// SPDX-License-Identifier: GPL-3.0-or-later
#include "inverse/sampler.h"

#include <math.h>
#include <string.h>

const char *const sampler_kinds[] = {"monte-carlo", "dynamics", NULL};

/// A particle collides with the bath so often [1/τ of the fastest pair's period]: in every so many
/// steps.
enum { TURNS = 100 };

/// Time step times ω of the fastest pair.
static const double step_share = 0.4;

/// How high pairs get that count [k_B T].
static const double highest = 10;

/// A step goes no further than this share of the cutoff at the thermal velocity, however soft.
static const double longest_flight = 0.05;

double sampler_time_step(const struct table *potential, double temperature) {
    double lowest = 0, fastest = 0;
    for (int k = 0; k < TABLE_INTERVALS; k++)
        lowest = fmin(lowest, potential->precise[k][0]);
    for (int k = 0; k < TABLE_INTERVALS; k++) {
        double value, curvature;
        table_evaluate(potential, (k + 0.5) / potential->inverse_spacing, &value, NULL, &curvature);
        if (value < lowest + highest * temperature)
            fastest = fmax(fastest, 2 * curvature);
    }
    return fmin(step_share / sqrt(fastest),
                longest_flight * potential->cutoff / sqrt(temperature));
}

static void set_time_step(struct simulation *simulation) {
    const double step =
        sampler_time_step(simulation->setup.potential, simulation->setup.temperature);
    simulation->setup.time_step = simulation->law.time_step = step;
}

static enum status init_simulation(struct sampler *sampler, const struct sampler_system *system) {
    enum status status = STATUS_OK;
    const struct simulation_setup setup = {
        .box = *system->box,
        .placement = {.count = (int64_t)system->particles,
                      .kind = PLACEMENT_LATTICE,
                      .jitter = 0.05},
        .temperature = system->temperature,
        .time_step = sampler_time_step(system->potential, system->temperature),
        .temperature_limit = 10,
        .integrator = &andersen,
        .integrator_parameters = {.turns = TURNS},
        .potential = system->potential,
        .seed = system->seed,
        .threads = 1,
    };
    TRY(simulation_init(&sampler->simulation, &setup, NULL));
    for (int d = 0; d < system->box->dimensions; d++)
        NEW_ARRAY(sampler->before[d], system->particles);
done:
    return status;
}

enum status sampler_init(struct sampler *sampler, enum sampler_kind kind,
                         const struct sampler_system *system) {
    enum status status = STATUS_OK;
    *sampler = (struct sampler){.kind = kind};
    NEW_ARRAY(sampler->counts, NEIGHBOURS_MOST_PARTS * (system->bins + 1));
    sampler->histogram =
        (struct pair_histogram){system->low, system->width, system->bins, sampler->counts};
    if (kind == SAMPLER_DYNAMICS)
        CHECK(init_simulation(sampler, system));
    else
        CHECK(metropolis_init(&sampler->chain, system->box, system->particles, system->potential,
                              system->temperature, system->seed));
done:
    if (status != STATUS_OK)
        sampler_clear(sampler);
    return status;
}

void sampler_clear(struct sampler *sampler) {
    metropolis_clear(&sampler->chain);
    simulation_clear(&sampler->simulation);
    for (int d = 0; d < 3; d++)
        memory_free(sampler->before[d]);
    memory_free(sampler->counts);
    *sampler = (struct sampler){0};
}

enum status sampler_begin(struct sampler *sampler) {
    if (sampler->kind == SAMPLER_MONTE_CARLO)
        return metropolis_refresh(&sampler->chain);
    struct simulation *simulation = &sampler->simulation;
    struct particles *particles = &simulation->particles;
    set_time_step(simulation);
    TRY(neighbours_sort_and_build(&simulation->neighbours, particles));
    for (int d = 0; d < particles->box.dimensions; d++)
        memcpy(sampler->before[d], particles->position[d],
               particles->count * sizeof *sampler->before[d]);
    return simulation_compute_forces(simulation, 0);
}

/// After a failure: back to where it began, with new velocities.
static void go_back(struct sampler *sampler) {
    struct particles *particles = &sampler->simulation.particles;
    for (int d = 0; d < particles->box.dimensions; d++)
        memcpy(particles->position[d], sampler->before[d],
               particles->count * sizeof *sampler->before[d]);
    particles_draw_velocities(particles, sampler->simulation.setup.temperature,
                              sampler->simulation.setup.seed);
}

static enum status step(struct sampler *sampler, uint64_t steps) {
    const enum status status = simulation_run(&sampler->simulation, steps);
    if (status == STATUS_UNSTABLE)
        go_back(sampler);
    return status;
}

enum status sampler_equilibrate(struct sampler *sampler, uint64_t sweeps) {
    if (sampler->kind == SAMPLER_MONTE_CARLO)
        return metropolis_equilibrate(&sampler->chain, (uint32_t)sweeps);
    return step(sampler, SAMPLER_STEPS * sweeps);
}

/// The steps of a sample; the last one counts the pairs in its force pass.
static enum status step_and_count(struct sampler *sampler, uint64_t steps, struct pair_sums *sums) {
    struct simulation *simulation = &sampler->simulation;
    TRY(step(sampler, steps - 1));
    simulation->law.histogram = &sampler->histogram;
    simulation->wants = PAIR_FORCES_AND_SUMS;
    const enum status status = step(sampler, 1);
    simulation->law.histogram = NULL;
    simulation->wants = PAIR_FORCES;
    *sums = simulation->sums;
    return status;
}

enum status sampler_sample(struct sampler *sampler, uint64_t sweeps, double *sample) {
    const size_t bins = sampler->histogram.bins;
    struct pair_sums sums;
    int parts = 1;
    memset(sampler->counts, 0, NEIGHBOURS_MOST_PARTS * (bins + 1) * sizeof *sampler->counts);
    if (sampler->kind == SAMPLER_MONTE_CARLO) {
        TRY(metropolis_run(&sampler->chain, (uint32_t)sweeps));
        metropolis_count(&sampler->chain, &sampler->histogram, &sums);
    } else {
        TRY(step_and_count(sampler, SAMPLER_STEPS * sweeps, &sums));
        parts = sampler->simulation.neighbours.parts;
    }
    for (size_t a = 0; a < bins; a++) {
        sample[a] = 0;
        for (int p = 0; p < parts; p++)
            sample[a] += sampler->counts[(size_t)p * (bins + 1) + a];
    }
    sample[bins] = sums.virial;
    return STATUS_OK;
}

/// Positions and ids of the particles, in their order.
static size_t place_spans(struct particles *particles, struct memory_span *span) {
    size_t n = 0;
    for (int d = 0; d < particles->box.dimensions; d++)
        span[n++] =
            (struct memory_span){particles->position[d], particles->count * sizeof(double)};
    span[n++] = (struct memory_span){particles->id, particles->count * sizeof(uint32_t)};
    return n;
}

size_t sampler_spans(struct sampler *sampler, struct memory_span *span) {
    if (sampler->kind == SAMPLER_MONTE_CARLO) {
        struct metropolis *chain = &sampler->chain;
        size_t n = place_spans(&chain->particles, span);
        span[n++] = (struct memory_span){&chain->step, sizeof chain->step};
        span[n++] = (struct memory_span){&chain->sweep, sizeof chain->sweep};
        return n;
    }
    struct simulation *simulation = &sampler->simulation;
    struct particles *particles = &simulation->particles;
    size_t n = place_spans(particles, span);
    for (int d = 0; d < particles->box.dimensions; d++)
        span[n++] =
            (struct memory_span){particles->velocity[d], particles->count * sizeof(double)};
    span[n++] = (struct memory_span){&simulation->step, sizeof simulation->step};
    return n;
}
