// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/bench_skips.h"

#include "base/memory.h"
#include "dynamics/respa.h"

/// A step as a fit takes it, and others.
enum part { PLAIN, WITHOUT_WEIGHT, WITH_SUMS, WITH_RDF, PARTS };

static const char *const names[PARTS] = {
    [PLAIN] = "as a fit runs it",
    [WITHOUT_WEIGHT] = "without friction and noise",
    [WITH_SUMS] = "with energy and virial at every step",
    [WITH_RDF] = "with g(r) at every step",
};

enum { BINS = 100 };

static enum status time_part(const struct bench_scene *scene, const struct bench_how *how,
                             enum part part, double *steps_per_second) {
    enum status status = STATUS_OK;
    struct bench_case bench = {0};
    struct bench_scene changed = *scene;
    struct pair_histogram histogram = {.bins = BINS};
    if (part == WITHOUT_WEIGHT) {
        changed.scene.setup.omega = NULL;
        // Inner steps of bonds are taken in both, other parameters are those of the other one.
        if (!mf_respa_acts(&scene->scene.setup))
            changed.scene.setup.integrator_parameters = NULL;
        changed.scene.setup.integrator = &mf_velocity_verlet;
    }
    NEW_ARRAY(histogram.counts, NEIGHBOURS_MAX_PARTS * (BINS + 1));
    CHECK(mf_bench_case_begin(&bench, &changed, how));
    histogram.width = mf_pair_cutoff(&bench.simulation.law) / BINS;
    if (part == WITH_SUMS)
        bench.simulation.wants = PAIR_FORCES_AND_SUMS;
    if (part == WITH_RDF)
        bench.simulation.law.histogram = &histogram;
    while (bench.repeats < BENCH_REPEATS)
        CHECK(mf_bench_case_repeat(&bench));
    *steps_per_second = mf_bench_median(bench.rate, bench.repeats);
done:
    mf_bench_case_clear(&bench);
    mf_memory_free(histogram.counts);
    return status;
}

enum status mf_bench_skips(FILE *out, const struct bench_scene *scene,
                           const struct bench_how *how) {
    double rate[PARTS];
    fprintf(out, "%s: %lld particles, %s, %s precision\n", scene->name,
            (long long)scene->scene.setup.placement.count, how->isa, how->precision);
    for (int part = PLAIN; part < PARTS; part++) {
        if (part == WITHOUT_WEIGHT &&
            (scene->scene.setup.omega == NULL || scene->scene.setup.potential == NULL))
            continue;
        TRY(time_part(scene, how, (enum part)part, &rate[part]));
        fprintf(out, "  %-38s %6.0f steps/s  %+4.0f %% of the time\n", names[part], rate[part],
                100 * (rate[PLAIN] / rate[part] - 1));
        fflush(out);
    }
    return STATUS_OK;
}
