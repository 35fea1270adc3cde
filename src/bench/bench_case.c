// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/bench_case.h"

#include "base/clock.h"
#include "base/simd.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    EQUILIBRATION = 300, ///< steps: the lattice has melted, as far as speed is concerned
    SCALE_EVERY = 10,    ///< steps between scalings of the velocities
    FIRST_TRIAL = 16,    ///< steps of the first trial of the speed
};

/// A trial must take so long to tell the speed, a quarter of a repeat [repeats].
static const double trial_share = 0.25;

// Statistics --------------------------------------------------------------------------------------

/// The values in growing order: an insertion sort, since they are few.
static void sort(double *sorted, const double *values, uint64_t count) {
    for (uint64_t k = 0; k < count; k++) {
        uint64_t place = k;
        for (; place > 0 && sorted[place - 1] > values[k]; place--)
            sorted[place] = sorted[place - 1];
        sorted[place] = values[k];
    }
}

double mf_bench_median(const double *values, uint64_t count) {
    double sorted[BENCH_REPEATS];
    if (count == 0)
        return NAN;
    sort(sorted, values, count);
    return (sorted[(count - 1) / 2] + sorted[count / 2]) / 2;
}

double mf_bench_spread(const double *values, uint64_t count) {
    double sorted[BENCH_REPEATS];
    if (count == 0)
        return NAN;
    sort(sorted, values, count);
    return (sorted[count - 1] - sorted[0]) / mf_bench_median(values, count);
}

// Running -----------------------------------------------------------------------------------------

/// Scale all velocities to the set temperature.
static void scale_velocities(struct simulation *simulation) {
    struct particles *particles = &simulation->particles;
    const double temperature = mf_particles_temperature(particles);
    if (!(temperature > 0))
        return;
    const double factor = sqrt(simulation->setup.temperature / temperature);
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t k = 0; k < particles->count; k++)
            particles->velocity[d][k] *= factor;
}

static enum status equilibrate(struct simulation *simulation) {
    for (int step = 0; step < EQUILIBRATION; step += SCALE_EVERY) {
        TRY(mf_simulation_run(simulation, SCALE_EVERY));
        if (simulation->setup.omega == NULL)
            scale_velocities(simulation);
    }
    return STATUS_OK;
}

/// Steps of a repeat, from longer and longer trials.
static enum status calibrate(struct bench_case *bench) {
    const double wanted = bench->how.seconds;
    for (uint64_t steps = FIRST_TRIAL;; steps *= 2) {
        const double begin = clock_seconds();
        TRY(mf_simulation_run(&bench->simulation, steps));
        const double seconds = clock_seconds() - begin;
        if (seconds < trial_share * wanted)
            continue;
        bench->steps = (uint64_t)ceil((double)steps * wanted / seconds);
        return STATUS_OK;
    }
}

enum status mf_bench_case_begin(struct bench_case *bench, const struct bench_scene *scene,
                                const struct bench_how *how) {
    *bench = (struct bench_case){.how = *how};
    if (!mf_simd_select(how->isa))
        return mf_status_fail(STATUS_BAD_INPUT, "this processor lacks %s", how->isa);
    struct simulation_setup setup = scene->scene.setup;
    setup.precision = strcmp(how->precision, "double") == 0 ? PAIR_DOUBLE : PAIR_MIXED;
    setup.threads = how->threads;
    TRY(mf_simulation_init(&bench->simulation, &setup, &scene->scene.start));
    bench->simulation.wants = PAIR_FORCES;
    TRY(equilibrate(&bench->simulation));
    return calibrate(bench);
}

void mf_bench_case_clear(struct bench_case *bench) {
    mf_simulation_clear(&bench->simulation);
}

static void count_distances(void *context, const float *squared_distances, size_t count) {
    (void)squared_distances;
    *(double *)context += (double)count;
}

/// Add the pairs of the present moment to the sums.
static void sample(struct bench_case *bench) {
    const struct simulation *simulation = &bench->simulation;
    const struct neighbours *neighbours = &simulation->neighbours;
    mf_neighbours_visit_distances(neighbours, &simulation->particles,
                                  mf_pair_cutoff(&simulation->law), count_distances,
                                  &bench->in_range);
    bench->listed += (double)mf_neighbours_listed(neighbours);
    bench->places += (double)mf_neighbours_entries(neighbours);
    bench->temperature += mf_particles_temperature(&simulation->particles);
}

enum status mf_bench_case_repeat(struct bench_case *bench) {
    struct simulation *simulation = &bench->simulation;
    const struct bench_case before = *bench;
    if (!mf_simd_select(bench->how.isa)) // another case may have run in between
        return mf_status_fail(STATUS_BAD_INPUT, "this processor lacks %s", bench->how.isa);
    const uint64_t begin_ticks = clock_ticks();
    const double begin = clock_seconds(), begin_busy = clock_thread_seconds();
    TRY(mf_simulation_run(simulation, bench->steps));
    const double seconds = clock_seconds() - begin, busy = clock_thread_seconds() - begin_busy;
    bench->ticks_total += clock_ticks() - begin_ticks;
    bench->seconds += seconds;
    bench->busy_rate[bench->repeats] = (double)bench->steps / busy;
    bench->rate[bench->repeats++] = (double)bench->steps / seconds;
    bench->list_builds += simulation->list_builds - before.simulation.list_builds;
    for (int phase = 0; phase < SIMULATION_PHASES; phase++)
        bench->ticks[phase] += simulation->ticks[phase] - before.simulation.ticks[phase];
    sample(bench);
    return STATUS_OK;
}

void mf_bench_case_result(const struct bench_case *bench, const char *scene,
                          struct bench_result *result) {
    const double repeats = (double)bench->repeats;
    const double particles = (double)bench->simulation.particles.count;
    const double pairs = bench->in_range / repeats;
    const double steps = mf_bench_median(bench->rate, bench->repeats);
    double best = NAN, phases = 0;
    for (uint64_t k = 0; k < bench->repeats; k++)
        best = fmax(best, bench->rate[k]);
    for (int phase = 0; phase < SIMULATION_PHASES; phase++)
        phases += (double)bench->ticks[phase];
    *result = (struct bench_result){
        .isa = bench->how.isa,
        .precision = bench->how.precision,
        .particles = particles,
        .threads = bench->how.threads,
        .temperature = bench->temperature / repeats,
        .pairs = pairs,
        .steps_per_second = steps,
        .steps_per_second_best = best,
        .steps_per_second_spread = mf_bench_spread(bench->rate, bench->repeats),
        .particle_steps_per_second = particles * steps,
        .pairs_per_second = pairs * steps,
        .ns_per_pair = 1e9 / (pairs * steps),
        .ticks_per_pair = (double)bench->ticks_total / bench->seconds / (pairs * steps),
        .list_efficiency = bench->in_range / bench->listed,
        .row_filling = bench->listed / bench->places,
        // a list that was never built again has lasted for all steps at least
        .steps_per_build = (double)bench->steps * repeats / fmax((double)bench->list_builds, 1),
        .lammps_steps_per_second = NAN,
        .lammps_ratio = NAN,
    };
    for (int phase = 0; phase < SIMULATION_PHASES; phase++)
        result->phase_share[phase] = (double)bench->ticks[phase] / phases;
    snprintf(result->scene, sizeof result->scene, "%s", scene);
}
