// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/bench_skips.h"

#include "base/memory.h"
#include "dynamics/respa.h"

#include <string.h>

enum {
    BINS = 100,
    MOST_VARIANTS = 5 + INTERACTION_MAX, ///< the scene itself and each part that it has or lacks
};

/// A skin so narrow that every step finds the pairs anew, in units of the cutoff.
static const double no_skin = 1e-9;

/// A scene with one part more or less.
struct variant {
    char part[64];
    bool less; ///< the scene has the part, and this one does without
    struct bench_scene scene;
    enum pair_wants wants;
    bool histogram;
    struct bench_case bench;
};

struct skips {
    struct variant variant[MOST_VARIANTS]; ///< the scene as it is first
    int variants;
    struct pair_histogram histogram;
};

// What there is to leave out or to add -----------------------------------------------------------

static struct variant *add(struct skips *skips, const struct bench_scene *scene, const char *part,
                           bool less) {
    struct variant *variant = &skips->variant[skips->variants++];
    *variant = (struct variant){.less = less, .scene = *scene, .wants = PAIR_FORCES};
    snprintf(variant->part, sizeof variant->part, "%s", part);
    return variant;
}

/// Friction and noise are left out with the integrator that is made for them.
static void leave_out_friction(struct simulation_setup *setup) {
    const bool keeps_inner_steps = mf_respa_acts(setup);
    setup->omega = NULL;
    if (!keeps_inner_steps) // other parameters are those of the other integrator
        setup->integrator_parameters = NULL;
    setup->integrator = &mf_velocity_verlet;
}

static void leave_out_interaction(struct simulation_setup *setup, int which) {
    setup->interactions--;
    memmove(&setup->interaction[which], &setup->interaction[which + 1],
            (size_t)(setup->interactions - which) * sizeof *setup->interaction);
}

static void list_parts(struct skips *skips, const struct bench_scene *scene) {
    const struct simulation_setup *setup = &scene->scene.setup;
    // Of a pass over the pairs, which moves of Monte Carlo do not take.
    const bool pairs = (setup->potential || setup->omega) && !setup->integrator->samples;
    add(skips, scene, "", false);
    if (setup->omega && setup->potential)
        leave_out_friction(&add(skips, scene, "friction and noise", true)->scene.scene.setup);
    // Inner steps are those of what stands beside the pairs: they go together.
    for (int k = 0; k < setup->interactions && !mf_respa_acts(setup); k++)
        leave_out_interaction(
            &add(skips, scene, setup->interaction[k].kind->name, true)->scene.scene.setup, k);
    if (!pairs)
        return;
    add(skips, scene, "energy and virial at every step", false)->wants = PAIR_FORCES_AND_SUMS;
    add(skips, scene, "g(r) at every step", false)->histogram = true;
    add(skips, scene, "a new neighbour list at every step", false)->scene.scene.setup.skin =
        no_skin * mf_simulation_range(setup);
}

// Timing -----------------------------------------------------------------------------------------

static enum status begin(struct skips *skips, const struct bench_how *how) {
    for (int k = 0; k < skips->variants; k++) {
        struct variant *variant = &skips->variant[k];
        TRY(mf_bench_case_begin(&variant->bench, &variant->scene, how));
        variant->bench.simulation.wants = variant->wants;
        if (!variant->histogram)
            continue;
        skips->histogram.width = mf_pair_cutoff(&variant->bench.simulation.law) / BINS;
        variant->bench.simulation.law.histogram = &skips->histogram;
    }
    return STATUS_OK;
}

/// In turn, so that what else the machine does slows down all of them alike; what it takes of the
/// processor's time does not count.
static enum status repeat(struct skips *skips) {
    for (int round = 0; round < BENCH_REPEATS; round++)
        for (int k = 0; k < skips->variants; k++)
            TRY(mf_bench_case_repeat(&skips->variant[k].bench));
    return STATUS_OK;
}

// Telling ----------------------------------------------------------------------------------------

static double rate_of(const struct variant *variant) {
    return mf_bench_median(variant->bench.busy_rate, variant->bench.repeats);
}

static void report(const struct skips *skips, FILE *out, FILE *table,
                   const struct bench_scene *scene, const struct bench_how *how) {
    const double plain = rate_of(&skips->variant[0]);
    fprintf(out, "%s: %lld particles, %s, %s precision: %.0f steps/s\n", scene->name,
            (long long)scene->scene.setup.placement.count, how->isa, how->precision, plain);
    fprintf(out, "  %-36s %8s %8s  %s\n", "part [steps/s of processor time]", "with", "without",
            "adds to a step");
    for (int k = 1; k < skips->variants; k++) {
        const struct variant *variant = &skips->variant[k];
        const double other = rate_of(variant);
        const double with = variant->less ? plain : other, without = variant->less ? other : plain;
        fprintf(out, "  %-36s %8.0f %8.0f  %+.0f %%%s\n", variant->part, with, without,
                100 * (without / with - 1), variant->less ? "" : "  (skipped)");
        if (table)
            fprintf(table, "%s\t%s\t%s\t%s\t%s\t%.6g\t%.6g\t%.4g\n", scene->name, how->isa,
                    how->precision, variant->part, variant->less ? "no" : "yes", with, without,
                    without / with - 1);
    }
    fflush(out);
}

void mf_bench_skips_head(FILE *table) {
    fprintf(table, "# scene\tisa\tprecision\tpart\tskipped\twith[1/s]\twithout[1/s]\tadds[1]\n");
}

enum status mf_bench_skips(FILE *out, FILE *table, const struct bench_scene *scene,
                           const struct bench_how *how) {
    enum status status = STATUS_OK;
    struct skips *skips = NULL;
    NEW_ARRAY(skips, 1);
    skips->histogram.bins = BINS;
    NEW_ARRAY(skips->histogram.counts, NEIGHBOURS_MAX_PARTS * (BINS + 1));
    list_parts(skips, scene);
    CHECK(begin(skips, how));
    CHECK(repeat(skips));
    report(skips, out, table, scene, how);
done:
    for (int k = 0; skips && k < skips->variants; k++)
        mf_bench_case_clear(&skips->variant[k].bench);
    if (skips)
        mf_memory_free(skips->histogram.counts);
    mf_memory_free(skips);
    return status;
}
