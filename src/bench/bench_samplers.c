// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/bench.h"

#include "base/statistics.h"
#include "inversion/replicas.h"
#include "bench/bench_case.h"

#include <stdio.h>
#include <time.h>

enum { REPLICAS = 4, REPEATS = 5, BINS = 100, MAX_BINS = BINS * COMPOSITION_MAX_PAIRS };

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

/// rms of the standard error of g over the bins that have pairs.
static double error_of_g(const struct replicas *replicas, const double *ideal,
                         double *inefficiency) {
    const struct comoments *counts = &replicas->counts;
    size_t seen[MAX_BINS], count = 0;
    double sum = 0;
    for (size_t a = 0; a < replicas->bins; a++)
        if (counts->mean[a] > 0)
            seen[count++] = a;
    *inefficiency = mf_replicas_inefficiency(replicas, REPLICAS_BLOCKS, seen, count);
    for (size_t n = 0; n < count; n++)
        sum +=
            mf_comoments_covariance(counts, seen[n], seen[n]) / (ideal[seen[n]] * ideal[seen[n]]);
    return sqrt(sum / (double)count * *inefficiency / counts->count);
}

/// How often each kind of moves of molecules was accepted.
static void print_moves(const struct sampler *sampler) {
    const struct molecule_tally *tally = mf_sampler_tally(sampler);
    if (tally == NULL)
        return;
    printf("           accepted: %.2f of all", mf_sampler_acceptance(sampler));
    for (int move = 0; move < MOLECULE_MOVES; move++)
        if (tally[move].tried > 0)
            printf(", %s %.2f", mf_molecule_move_names[move],
                   (double)tally[move].accepted / (double)tally[move].tried);
    printf("\n");
}

/// Time one sampler, and print its row.
static enum status time_sampler(const struct sampler_system *system, enum sampler_kind kind,
                                int threads) {
    const struct inverse_progress progress = {0};
    const struct inverse_listener listener = {ignore, NULL};
    const struct rdf_bins bins = {system->low, system->width, system->bins};
    struct running_mean merit = {0}, seconds = {0}, inefficiency = {0};
    CLEARED_BY(mf_replicas_clear) struct replicas replicas = {0};
    double ideal[MAX_BINS];
    for (int pair = 0; pair < mf_composition_pairs(system->composition); pair++)
        for (size_t a = 0; a < BINS; a++)
            ideal[(size_t)pair * BINS + a] =
                mf_rdf_ideal_pairs_of(&bins, a, system->box, system->composition, pair);
    TRY(mf_replicas_init(&replicas, REPLICAS, kind, system));
    TRY(mf_replicas_run(&replicas, &warm_up, threads, &progress, &listener));
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        double correlated;
        const double begin = processor_seconds();
        TRY(mf_replicas_run(&replicas, &timed, threads, &progress, &listener));
        const double used = processor_seconds() - begin;
        mf_statistics_add(&merit, error_of_g(&replicas, ideal, &correlated) * sqrt(used));
        mf_statistics_add(&seconds, used / replicas.counts.count);
        mf_statistics_add(&inefficiency, correlated);
    }
    printf("%9lld  %-11s  %11.3f  %12.2f  %10.5f +- %.5f\n",
           (long long)mf_composition_particles(system->composition), mf_sampler_kinds[kind],
           1e3 * seconds.mean, inefficiency.mean, merit.mean, mf_statistics_standard_error(&merit));
    print_moves(&replicas.member[0].sampler);
    return STATUS_OK;
}

/// All samplers of a system with the scene's densities, or of the scene with its molecules.
static enum status time_size(const struct simulation_setup *setup, size_t particles, int threads) {
    const struct molecules *molecules = mf_molecules_find(setup->interaction, setup->interactions);
    const struct composition composition =
        molecules ? setup->composition
                  : mf_composition_scaled(&setup->composition, (int64_t)particles);
    const struct box box =
        mf_box_scaled(&setup->box, (double)mf_composition_particles(&composition) /
                                       (double)mf_composition_particles(&setup->composition));
    const struct sampler_system system = {.box = &box,
                                          .composition = &composition,
                                          .potential = setup->potential,
                                          .temperature = setup->temperature,
                                          .width = setup->potential->cutoff / BINS,
                                          .bins = BINS,
                                          .molecules = molecules,
                                          .seed = setup->seed};
    for (int kind = 0; kind < SAMPLER_AUTO; kind++)
        TRY(time_sampler(&system, (enum sampler_kind)kind, threads));
    return STATUS_OK;
}

static enum status time_all(const struct simulation_setup *setup, int threads) {
    if (setup->potential == NULL)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "a scene without a potential has nothing to sample");
    printf("particles  sampler      ms a sample  inefficiency  error of g * sqrt(s)\n");
    const bool joined = mf_molecules_find(setup->interaction, setup->interactions) != NULL;
    for (size_t k = 0; k < (joined ? 1 : sizeof sizes / sizeof *sizes); k++)
        TRY(time_size(setup, sizes[k], threads));
    return STATUS_OK;
}

enum status mf_bench_samplers(const char *file, const struct run_options *common) {
    struct bench_scene scene = {0};
    enum status status = mf_bench_scene_read(&scene, file, NULL, common);
    for (int k = 0; k < scene.scene.setup.interactions && status == STATUS_OK; k++)
        if (scene.scene.setup.interaction[k].kind != &mf_molecules)
            status = mf_status_fail(
                STATUS_BAD_INPUT,
                "%s: samplers support only pair potentials and molecules, not \"%s\"", file,
                scene.scene.setup.interaction[k].kind->name);
    if (status == STATUS_OK)
        status = time_all(&scene.scene.setup, common->has_threads ? common->threads : 1);
    mf_scene_clear(&scene.scene);
    return status;
}
