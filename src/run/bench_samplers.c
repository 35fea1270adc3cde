// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/bench_samplers.h"

#include "base/statistics.h"
#include "inverse/replicas.h"
#include "run/bench_case.h"

#include <stdio.h>
#include <time.h>

enum { REPLICAS = 4, REPEATS = 5, BINS = 100 };

/// As in the runs of water, and as in a simulation.
static const size_t sizes[] = {729, 2744};

static const struct replicas_plan warm_up = {.equilibration = 600, .block_samples = 25, .every = 2};
static const struct replicas_plan timed = {.equilibration = 0, .block_samples = 50, .every = 2};

static void ignore(void *context, const struct inverse_progress *progress) {
    (void)context, (void)progress;
}

/// Processor time of all threads [s].
static double processor_seconds(void) {
    return (double)clock() / CLOCKS_PER_SEC;
}

/// rms over the bins of the standard error of g, from the first bin with pairs on.
static double error_of_g(const struct replicas *replicas, const double *ideal,
                         double *inefficiency) {
    const struct comoments *counts = &replicas->counts;
    size_t first = 0;
    while (first + 1 < replicas->bins && !(counts->mean[first] > 0))
        first++;
    *inefficiency = replicas_inefficiency(replicas, ideal, first);
    double sum = 0;
    for (size_t a = first; a < replicas->bins; a++)
        sum += comoments_covariance(counts, a, a) / (ideal[a] * ideal[a]);
    return sqrt(sum / (double)(replicas->bins - first) * *inefficiency / counts->count);
}

/// Time one sampler, and print its row.
static enum status time_sampler(const struct sampler_system *system, enum sampler_kind kind,
                                int threads) {
    enum status status = STATUS_OK;
    const struct inverse_progress progress = {0};
    const struct inverse_listener listener = {ignore, NULL};
    const struct rdf_bins bins = {system->low, system->width, system->bins};
    struct running_mean merit = {0}, seconds = {0}, inefficiency = {0};
    struct replicas replicas = {0};
    double ideal[BINS];
    for (size_t a = 0; a < BINS; a++)
        ideal[a] = rdf_ideal_pairs(&bins, a, system->box, system->particles);
    CHECK(replicas_init(&replicas, REPLICAS, kind, system));
    CHECK(replicas_run(&replicas, &warm_up, threads, &progress, &listener));
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        double correlated;
        const double begin = processor_seconds();
        CHECK(replicas_run(&replicas, &timed, threads, &progress, &listener));
        const double used = processor_seconds() - begin;
        statistics_add(&merit, error_of_g(&replicas, ideal, &correlated) * sqrt(used));
        statistics_add(&seconds, used / replicas.counts.count);
        statistics_add(&inefficiency, correlated);
    }
    printf("%9zu  %-11s  %11.3f  %12.2f  %10.5f +- %.5f\n", system->particles, sampler_kinds[kind],
           1e3 * seconds.mean, inefficiency.mean, merit.mean, statistics_standard_error(&merit));
done:
    replicas_clear(&replicas);
    return status;
}

/// All samplers of a system with the scene's density.
static enum status time_size(const struct simulation_setup *setup, size_t particles, int threads) {
    struct box box = setup->box;
    for (int d = 0; d < box.dimensions; d++)
        box.length[d] *=
            pow((double)particles / (double)setup->placement.count, 1.0 / box.dimensions);
    const struct sampler_system system = {.box = &box,
                                          .particles = particles,
                                          .potential = setup->potential,
                                          .temperature = setup->temperature,
                                          .width = setup->potential->cutoff / BINS,
                                          .bins = BINS,
                                          .seed = setup->seed};
    for (int kind = 0; sampler_kinds[kind]; kind++)
        TRY(time_sampler(&system, (enum sampler_kind)kind, threads));
    return STATUS_OK;
}

static enum status time_all(const struct simulation_setup *setup, int threads) {
    if (setup->potential == NULL)
        return status_fail(STATUS_BAD_INPUT, "a scene without a potential has nothing to sample");
    printf("particles  sampler      ms a sample  inefficiency  error of g * sqrt(s)\n");
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++)
        TRY(time_size(setup, sizes[k], threads));
    return STATUS_OK;
}

enum status bench_samplers(const char *file, const struct run_options *common) {
    struct bench_scene scene = {0};
    enum status status = bench_scene_read(&scene, file, common);
    if (status == STATUS_OK)
        status = time_all(&scene.scene.setup, common->has_threads ? common->threads : 1);
    scene_clear(&scene.scene);
    return status;
}
