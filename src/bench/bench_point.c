// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/bench_point.h"

#include "base/nearest.h"
#include "base/statistics.h"
#include "dynamics/dpd_verlet.h"
#include "dynamics/respa.h"
#include "observe/motion.h"
#include "observe/rdf_observable.h"
#include "observe/thermodynamics.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum {
    BLOCKS = 20,
    SHORTEST_STRETCH = 6, ///< steps between samples: most of them are timed
    SCALE_EVERY = 10,     ///< steps between scalings of the velocities
};

/// Groot and Warren's optimum is the second.
static const struct dpd_verlet_parameters predictions[] = {{0.5, 1}, {0.65, 1}};
static const double equilibration_share = 0.05;

/// Window of the diffusion coefficient, in times in which a particle flies the mean distance: in
/// the standard fluid 4 τ, where its D(t) has come to its plateau. It is measured in runs of
/// MIN_WINDOWS or more.
static const double window_length = 6;
enum { MIN_WINDOWS = 4, ORIGINS = 6 };

// What to run -------------------------------------------------------------------------------------

static void add_method(struct bench_method *methods, size_t *count,
                       const struct simulation_setup *setup, const struct integrator *integrator) {
    struct bench_method *method = &methods[(*count)++];
    method->integrator = integrator;
    method->parameters = setup->integrator == integrator ? setup->integrator_parameters : NULL;
    snprintf(method->name, sizeof method->name, "%s", integrator->name);
}

/// The scene's integrator without its inner steps is among all, and with them by itself.
static void add_inner_steps(struct bench_method *methods, size_t *count,
                            const struct simulation_setup *setup) {
    if (setup->omega == NULL || !mf_respa_acts(setup))
        return;
    for (size_t k = 0; k < *count; k++)
        if (methods[k].parameters == setup->integrator_parameters)
            methods[k].parameters = NULL;
    add_method(methods, count, setup, setup->integrator);
    snprintf(methods[*count - 1].name, BENCH_METHOD_SIZE, "%s, inner steps",
             setup->integrator->name);
}

enum status mf_bench_point_check(const struct simulation_setup *setup, const char *scene,
                                 const char *word) {
    const char *name = setup->integrator->name;
    if (setup->integrator->events)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: bench %s has nothing to vary: \"%s\" goes from collision to "
                              "collision, without an error of a time step",
                              scene, word, name);
    if (setup->integrator->model_time_step)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: bench %s has nothing to compare with: the time step of \"%s\" "
                              "is a property of its fluid",
                              scene, word, name);
    if (!simulation_has_velocities(setup))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: bench %s wants particles with velocities, which \"%s\" does not "
                              "have",
                              scene, word, name);
    if (setup->potential == NULL && setup->omega == NULL)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: bench %s wants \"conservative\" or \"dissipative\": it looks at "
                              "pairs as far as these reach",
                              scene, word);
    return STATUS_OK;
}

size_t mf_bench_methods(const struct simulation_setup *setup, struct bench_method *methods) {
    size_t count = 0;
    for (size_t k = 0; mf_integrator_list[k] && count + 3 <= BENCH_MAX_METHODS; k++) {
        const struct integrator *integrator = mf_integrator_list[k];
        if (integrator->dissipative != (setup->omega != NULL) || integrator->mobility ||
            integrator->events || integrator->solvent_particles || integrator->samples)
            continue;
        const bool predicts = integrator == &mf_dpd_verlet;
        for (size_t l = 0; l < (predicts ? sizeof predictions / sizeof *predictions : 1); l++) {
            add_method(methods, &count, setup, integrator);
            struct bench_method *method = &methods[count - 1];
            if (!predicts)
                continue;
            method->parameters = &predictions[l];
            snprintf(method->name, sizeof method->name, "%s(%g)", integrator->name,
                     predictions[l].lambda);
        }
    }
    add_inner_steps(methods, &count, setup);
    return count;
}

const struct bench_method *mf_bench_reference_method(const struct bench_method *methods,
                                                     size_t count) {
    for (size_t k = 0; k < count; k++)
        if (methods[k].integrator == &mf_aboba)
            return &methods[k];
    return methods;
}

/// Mean distance of particles, ρ^(−1/d) [λ].
static double mean_distance(const struct box *box, size_t particles) {
    return pow(mf_box_volume(box) / (double)particles, 1.0 / box->dimensions);
}

struct bench_bins mf_bench_bins_choose(const struct box *box, size_t particles, double cutoff) {
    const double distance = mean_distance(box, particles);
    struct bench_bins bins;
    bins.fine.low = 0;
    bins.fine.count = (size_t)fmin(fmax(2, rint(cutoff / distance * 10)), BENCH_MAX_BINS);
    bins.fine.width = cutoff / (double)bins.fine.count;
    bins.core = (size_t)fmax(1, rint(distance / 3 / bins.fine.width));
    if (bins.core > bins.fine.count / 2)
        bins.core = bins.fine.count / 2;
    bins.count = bins.fine.count - bins.core + 1;
    return bins;
}

// Running -----------------------------------------------------------------------------------------

/// Seconds that the calling thread has spent on a processor.
static double processor_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/// Time in which a particle flies the mean distance [τ].
static double flight(const struct simulation_setup *setup) {
    return mean_distance(&setup->box, (size_t)setup->placement.count) / sqrt(setup->temperature);
}

/// Samples a fifth of a flight apart: pairs have then left their bins.
static struct measure_plan plan_of(const struct bench_common *common,
                                   const struct bench_point *point) {
    const struct simulation_setup *setup = common->setup;
    struct measure_plan plan;
    plan.every = (int64_t)fmax(SHORTEST_STRETCH, rint(0.2 * flight(setup) / point->time_step));
    plan.samples =
        (int64_t)fmax(BLOCKS, rint(point->time / ((double)plan.every * point->time_step)));
    plan.equilibration = (int64_t)rint(equilibration_share * point->time / point->time_step);
    return plan;
}

/// The motion is sampled with everything else: the MSD is read far beyond the time between samples.
static struct motion_plan motion_plan_of(const struct bench_common *common,
                                         const struct bench_point *point,
                                         const struct measure_plan *plan) {
    const double between = (double)plan->every * point->time_step;
    const int64_t lags = (int64_t)fmax(4, rint(window_length * flight(common->setup) / between));
    return (struct motion_plan){.every = plan->every,
                                .lags = lags,
                                .origin_every = (int64_t)fmax(1, (double)(lags / ORIGINS))};
}

uint64_t mf_bench_point_steps(const struct bench_common *common, const struct bench_point *point) {
    const struct measure_plan plan = plan_of(common, point);
    return mf_measure_steps(&plan);
}

static int compare_numbers(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/// Median of the blocks: a machine that was busy for a while does not count. The median of normal
/// numbers has a standard error 1.25 times that of their mean.
static struct bench_number median(double *blocks) {
    struct running_mean running = {0};
    for (int b = 0; b < BLOCKS; b++)
        mf_statistics_add(&running, blocks[b]);
    qsort(blocks, BLOCKS, sizeof *blocks, compare_numbers);
    return (struct bench_number){(blocks[BLOCKS / 2 - 1] + blocks[BLOCKS / 2]) / 2,
                                 1.25 * mf_statistics_standard_error(&running)};
}

static void report(const struct bench_common *common, struct bench_point *point, int64_t steps) {
    point->reported += (uint64_t)steps;
    common->report(common->context, (uint64_t)steps);
}

struct bench_measured {
    struct rdf_observed rdf;
    struct thermodynamics thermodynamics;
    struct motion motion;
    bool moves; ///< whether the motion is measured
};

/// Run between samples by itself, timed; mf_measure_sample then does the one step that is left.
static enum status sample(const struct bench_common *common, struct bench_point *point,
                          struct simulation *simulation, const struct measure_plan *plan,
                          struct bench_measured *measured) {
    double seconds[BLOCKS] = {0}, times[BLOCKS] = {0};
    const struct observable_use uses[] = {
        {&mf_rdf_observable, &measured->rdf, NULL},
        {&mf_thermodynamics_observable, &measured->thermodynamics, NULL},
        {measured->moves ? &mf_motion_observable : NULL, &measured->motion, NULL},
        {NULL, NULL, NULL}};
    if (measured->moves)
        mf_motion_sample(&measured->motion, simulation);
    for (int64_t k = 0; k < plan->samples; k++) {
        const struct measure_plan next = {plan->equilibration, k + 1, plan->every};
        const int64_t block = k * BLOCKS / plan->samples;
        const double begin = processor_seconds();
        simulation->wants = PAIR_FORCES;
        TRY(mf_simulation_run(simulation, (uint64_t)plan->every - 1));
        seconds[block] += processor_seconds() - begin;
        times[block] += (double)(plan->every - 1) * point->time_step;
        TRY(mf_measure_sample(simulation, &next, uses, NULL));
        report(common, point, plan->every);
    }
    for (int b = 0; b < BLOCKS; b++)
        seconds[b] /= times[b];
    point->cpu = median(seconds);
    return STATUS_OK;
}

/// Total energy of a particle in each block, its mean and its slope in time.
static void find_total(const struct thermodynamics *thermodynamics, const struct box *box,
                       double particles, struct bench_point *point) {
    const double *potential =
        mf_thermodynamics_series(thermodynamics, THERMODYNAMICS_POTENTIAL_ENERGY);
    const double *temperature =
        mf_thermodynamics_series(thermodynamics, THERMODYNAMICS_TEMPERATURE);
    const double degrees = box->dimensions * (1 - 1 / particles);
    double energy[BLOCKS] = {0}, along = 0, spread = 0, rest = 0;
    struct running_mean blocks = {0};
    for (size_t b = 0; b < BLOCKS; b++) {
        const size_t samples = thermodynamics->series.count;
        const size_t begin = samples * b / BLOCKS, end = samples * (b + 1) / BLOCKS;
        for (size_t k = begin; k < end; k++)
            energy[b] += (potential[k] + 0.5 * degrees * temperature[k]) / (double)(end - begin);
        mf_statistics_add(&blocks, energy[b]);
    }
    for (int b = 0; b < BLOCKS; b++) {
        const double t = point->time * ((b + 0.5) / BLOCKS - 0.5);
        along += t * (energy[b] - blocks.mean);
        spread += t * t;
    }
    const double slope = along / spread;
    for (int b = 0; b < BLOCKS; b++) {
        const double t = point->time * ((b + 0.5) / BLOCKS - 0.5);
        rest += pow(energy[b] - blocks.mean - slope * t, 2);
    }
    point->quantity[BENCH_TOTAL] =
        (struct bench_number){blocks.mean, mf_statistics_correlated_error(energy, BLOCKS, 1)};
    point->quantity[BENCH_DRIFT] = (struct bench_number){slope, sqrt(rest / (BLOCKS - 2) / spread)};
}

/// Join the bins of the core: pairs add up, and so do the squares of their errors.
static void join_bins(const struct bench_bins *bins, const struct rdf *rdf, const double *g,
                      const double *error, struct bench_number *joined) {
    double pairs = 0, squares = 0, ideal = 0;
    for (size_t k = 0; k < bins->core; k++) {
        const double here = mf_rdf_ideal_pairs(&bins->fine, k, &rdf->box, rdf->particle_count);
        pairs += here * g[k];
        squares += here * error[k] * here * error[k];
        ideal += here;
    }
    joined[0] = (struct bench_number){pairs / ideal, sqrt(squares) / ideal};
    for (size_t k = bins->core; k < bins->fine.count; k++)
        joined[k - bins->core + 1] = (struct bench_number){g[k], error[k]};
}

static enum status find_results(const struct bench_common *common,
                                const struct bench_measured *measured, struct bench_point *point) {
    const struct bench_bins *bins = &common->bins;
    const struct rdf *rdf = &measured->rdf.counted;
    const struct thermodynamics_summary s = mf_thermodynamics_result(&measured->thermodynamics, 1);
    OWNED double *g = NULL, *error = NULL;
    TRY_ARRAY(g, bins->fine.count);
    TRY_ARRAY(error, bins->fine.count);
    TRY(mf_rdf_result(rdf, 1, g, error));
    join_bins(bins, rdf, g, error, point->g);
    struct bench_number *quantity = point->quantity;
    quantity[BENCH_TEMPERATURE] = (struct bench_number){s.temperature, s.temperature_error};
    quantity[BENCH_CONFIGURATIONAL] =
        (struct bench_number){s.temperature_configurational, s.temperature_configurational_error};
    quantity[BENCH_ENERGY] = (struct bench_number){s.potential_energy, s.potential_energy_error};
    quantity[BENCH_PRESSURE] = (struct bench_number){s.pressure, s.pressure_error};
    quantity[BENCH_DIFFUSION] = (struct bench_number){NAN, NAN};
    if (measured->moves) {
        const struct motion_summary motion = mf_motion_result(&measured->motion, NULL);
        quantity[BENCH_DIFFUSION] = (struct bench_number){motion.msd, motion.msd_error};
    }
    find_total(&measured->thermodynamics, &rdf->box, (double)rdf->particle_count, point);
    return STATUS_OK;
}

static struct simulation_setup setup_of(const struct simulation_setup *scene,
                                        const struct simulation_start *start,
                                        const struct bench_method *method, double time_step) {
    struct simulation_setup setup = *scene;
    setup.integrator = method->integrator;
    setup.integrator_parameters = method->parameters;
    setup.time_step = time_step;
    setup.threads = 1;
    if (start)
        setup.placement.kind = PLACEMENT_FILE;
    return setup;
}

enum status mf_bench_point_run(const struct bench_common *common, struct bench_point *point) {
    enum status status = STATUS_OK;
    struct simulation simulation = {0};
    struct bench_measured measured = {0};
    struct simulation_setup setup =
        setup_of(common->setup, common->start, point->method, point->time_step);
    const struct measure_plan plan = plan_of(common, point);
    const struct motion_plan motion_plan = motion_plan_of(common, point, &plan);
    measured.moves = plan.samples >= MIN_WINDOWS * motion_plan.lags;
    double temperature;
    setup.seed = point->seed;
    point->steps = (uint64_t)(plan.samples * plan.every);
    point->time = (double)point->steps * point->time_step;
    NEW_ARRAY(point->g, common->bins.count);
    CHECK(mf_simulation_init(&simulation, &setup, common->start));
    CHECK(mf_rdf_init(&measured.rdf.counted, &common->bins.fine, &setup.box,
                      simulation.particles.count, mf_pair_cutoff(&simulation.law),
                      (size_t)plan.samples));
    mf_thermodynamics_init(&measured.thermodynamics);
    CHECK(mf_measure_equilibrate(&simulation, &plan, &temperature, NULL));
    report(common, point, plan.equilibration);
    if (measured.moves)
        CHECK(mf_motion_init(&measured.motion, &motion_plan, &simulation, plan.equilibration,
                             plan.samples * plan.every));
    CHECK(sample(common, point, &simulation, &plan, &measured));
    CHECK(find_results(common, &measured, point));
done:
    point->status = status;
    mf_simulation_clear(&simulation);
    mf_rdf_clear(&measured.rdf.counted);
    mf_thermodynamics_clear(&measured.thermodynamics);
    mf_motion_clear(&measured.motion);
    return status == STATUS_UNSTABLE ? STATUS_OK : status;
}

// Equilibrating -----------------------------------------------------------------------------------

static void scale_velocities(struct simulation *simulation) {
    struct particles *particles = &simulation->particles;
    const double factor = sqrt(simulation->setup.temperature / mf_particles_temperature(particles));
    for (int d = 0; isfinite(factor) && d < particles->box.dimensions; d++)
        for (size_t k = 0; k < particles->count; k++)
            particles->velocity[d][k] *= factor;
}

enum status mf_bench_point_prepare(const struct simulation_setup *setup,
                                   const struct simulation_start *start,
                                   const struct bench_method *method, double time_step, double time,
                                   double *values) {
    CLEARED_BY(mf_simulation_clear) struct simulation simulation = {0};
    const struct simulation_setup changed = setup_of(setup, NULL, method, time_step);
    TRY(mf_simulation_init(&simulation, &changed, start));
    for (double done = 0; done < time; done += SCALE_EVERY * time_step) {
        TRY(mf_simulation_run(&simulation, SCALE_EVERY));
        if (setup->omega == NULL)
            scale_velocities(&simulation);
    }
    const struct particles *particles = &simulation.particles;
    for (int d = 0; d < particles->box.dimensions; d++) {
        memcpy(values + (size_t)d * particles->count, particles->position[d],
               particles->count * sizeof *values);
        memcpy(values + (size_t)(3 + d) * particles->count, particles->velocity[d],
               particles->count * sizeof *values);
    }
    return STATUS_OK;
}

// Lists of integrators ----------------------------------------------------------------------------

/// True if a list such as "aboba,shardlow" names a method, or its integrator.
static bool is_listed(const char *list, const struct bench_method *method) {
    const char *const names[] = {method->name, method->integrator->name};
    for (const char *at = list; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL)
        for (size_t k = 0; k < 2; k++)
            if (strcspn(at, ",") == strlen(names[k]) &&
                strncmp(at, names[k], strlen(names[k])) == 0)
                return true;
    return false;
}

/// Refuse a list with a name that is none of a suitable integrator.
static enum status check_names(const struct bench_method *methods, size_t count, const char *list) {
    const char *names[BENCH_MAX_METHODS];
    char hint[256], word[64];
    for (size_t k = 0; k < count; k++)
        names[k] = methods[k].name;
    for (const char *at = list; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL) {
        bool is_known = false;
        snprintf(word, sizeof word, "%.*s", (int)strcspn(at, ","), at);
        for (size_t k = 0; k < count; k++)
            is_known |= is_listed(word, &methods[k]);
        if (is_known)
            continue;
        mf_nearest_hint(word, names, count, hint, sizeof hint);
        return mf_status_fail(STATUS_BAD_INPUT, "--integrators: \"%s\" does not suit the scene; %s",
                              word, hint);
    }
    return STATUS_OK;
}

enum status mf_bench_methods_listed(const struct bench_method *methods, size_t count,
                                    const char *list, struct bench_method *listed,
                                    size_t *listed_count) {
    if (list)
        TRY(check_names(methods, count, list));
    for (size_t k = 0; k < count; k++)
        if (list == NULL || is_listed(list, &methods[k]))
            listed[(*listed_count)++] = methods[k];
    return STATUS_OK;
}
