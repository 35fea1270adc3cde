// SPDX-License-Identifier: GPL-3.0-or-later
//
// The pairs that mf_rdf_sample counts from the simulation's list, and from a list of its own beyond
// it, are exactly those of a double loop over all particles in double precision.
#include "dynamics/metropolis.h"
#include "observe/rdf.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/watched.h"
#include "shared/testing.h"

enum { MAX_BINS = 40, PARTICLES = 200 };

/// Distances in the lists are single-precision: off by up to about 4e-7 at r = 2.5. A pair nearer
/// than this to an edge may be counted on either side of it: about one pair of a configuration.
static const double edge_rounding = 1e-6;

/// What a double loop says of each bin.
struct counts {
    double certain[MAX_BINS];  ///< pairs well inside
    double possible[MAX_BINS]; ///< these and the pairs on an edge
};

static void count_pair(const struct rdf_bins *bins, double r, struct counts *counts) {
    for (size_t k = 0; k < bins->count; k++) {
        const double low = mf_rdf_bins_edge(bins, k), high = mf_rdf_bins_edge(bins, k + 1);
        counts->certain[k] += r > low + edge_rounding && r < high - edge_rounding;
        counts->possible[k] += r > low - edge_rounding && r < high + edge_rounding;
    }
}

/// Pairs of one pair type.
static void count_kind(const struct rdf_bins *bins, const struct composition *composition, int pair,
                       const struct particles *particles, struct counts *counts) {
    *counts = (struct counts){0};
    for (size_t i = 0; i < particles->count; i++)
        for (size_t j = 0; j < i; j++) {
            double square = 0;
            for (int d = 0; d < particles->box.dimensions; d++) {
                const double dx = box_nearest(particles->position[d][i] - particles->position[d][j],
                                              particles->box.length[d]);
                square += dx * dx;
            }
            if (mf_composition_pair_of_ids(composition, particles->id[i], particles->id[j]) == pair)
                count_pair(bins, sqrt(square), counts);
        }
}

static void count_all(const struct rdf_bins *bins, const struct particles *particles,
                      struct counts *counts) {
    const struct composition alike = {0};
    count_kind(bins, &alike, 0, particles, counts);
}

/// A histogram with `times` the pairs of `counts`.
static void assert_histogram(const double *histogram, const struct counts *counts, size_t bins,
                             double times) {
    double pairs = 0, uncertain = 0;
    for (size_t k = 0; k < bins; k++) {
        assert_true(histogram[k] >= times * counts->certain[k]);
        assert_true(histogram[k] <= times * counts->possible[k]);
        pairs += counts->certain[k];
        uncertain += counts->possible[k] - counts->certain[k];
    }
    // A comparison of nothing proves nothing, nor one that lets much pass.
    assert_true(pairs > 100);
    assert_true(uncertain < 20);
}

/// One sample of an RDF on `bins` is the same as count_all, bin by bin.
static void assert_counts(const struct rdf_bins *bins, const struct particles *particles,
                          const struct neighbours *neighbours, double list_cutoff,
                          bool needs_own_list) {
    struct counts counts;
    struct rdf rdf;
    count_all(bins, particles, &counts);
    assert_ok(mf_rdf_init(&rdf, bins, &particles->box, particles->count, list_cutoff, 1));
    assert_int_equal(rdf.needs_own_list, needs_own_list);
    assert_ok(mf_rdf_sample(&rdf, particles, neighbours));
    assert_histogram(rdf.blocks.sums, &counts, bins->count, 1);
    mf_rdf_clear(&rdf);
}

/// What a force pass counts is the same, too.
static void assert_passing_counts(const struct rdf_bins *bins, struct simulation *simulation) {
    struct counts counts;
    struct rdf rdf;
    count_all(bins, &simulation->particles, &counts);
    assert_ok(
        mf_rdf_init(&rdf, bins, &simulation->particles.box, simulation->particles.count, 1, 1));
    struct pair_law law = simulation->law;
    law.histogram = mf_rdf_histogram(&rdf);
    assert_non_null(law.histogram);
    mf_pair_forces(&law, &simulation->particles, &simulation->neighbours, 1, PAIR_FORCES, NULL);
    mf_rdf_sample_counted(&rdf);
    assert_histogram(rdf.blocks.sums, &counts, bins->count, 1);
    mf_rdf_clear(&rdf);
}

/// The partial histograms of a sample, from a list or from the force pass.
static void assert_kinds(const struct rdf_bins *bins, struct simulation *simulation,
                         bool in_passing) {
    const struct particles *particles = &simulation->particles;
    const struct composition *composition = &simulation->setup.composition;
    struct rdf rdf;
    assert_ok(mf_rdf_init_mixture(&rdf, bins, &particles->box, composition, 1, 1));
    struct pair_law law = simulation->law;
    law.histogram = mf_rdf_histogram(&rdf);
    assert_int_equal(law.histogram == NULL, rdf.needs_own_list);
    if (in_passing) {
        mf_pair_forces(&law, &simulation->particles, &simulation->neighbours, 1, PAIR_FORCES, NULL);
        mf_rdf_sample_counted(&rdf);
    } else {
        assert_ok(mf_rdf_sample(&rdf, particles, &simulation->neighbours));
    }
    for (int pair = 0; pair < mf_composition_pairs(composition); pair++) {
        struct counts counts;
        count_kind(bins, composition, pair, particles, &counts);
        assert_histogram(rdf.blocks.sums + (size_t)pair * bins->count, &counts, bins->count, 1);
    }
    mf_rdf_clear(&rdf);
}

static void assert_mixture_counts(struct fluid *fluid, const struct composition *composition) {
    const struct rdf_bins within = {0, 0.025, 40}, above_zero = {0.31, 0.023, 30},
                          beyond = {0, 0.05, 40};
    static struct simulation simulation;
    fluid->setup.composition = *composition;
    for (int precision = PAIR_MIXED; precision <= PAIR_DOUBLE; precision++) {
        fluid->setup.precision = precision;
        assert_ok(mf_simulation_init(&simulation, &fluid->setup, NULL));
        assert_ok(mf_simulation_run(&simulation, 53));
        assert_kinds(&within, &simulation, false);
        assert_kinds(&within, &simulation, true);
        assert_kinds(&above_zero, &simulation, true);
        assert_kinds(&beyond, &simulation, false);
        mf_simulation_clear(&simulation);
    }
    fluid_clear(fluid);
}

static void test_rdf_counts_every_pair_once_when_types_differ(void **state) {
    (void)state;
    const struct composition three = {.types = 3, .count = {300, 500, 400}},
                             two = {.types = 2, .count = {250, 350}};
    struct fluid fluid;
    fluid_groot_warren(&fluid, 1200, 0.04);
    assert_mixture_counts(&fluid, &three);
    fluid_soft_discs(&fluid, 600, 0.04);
    assert_mixture_counts(&fluid, &two);
}

/// A fluid after some steps, so that particles have moved since the last build of the list and some
/// have left the box.
static void run_fluid(struct fluid *fluid, struct simulation *simulation) {
    assert_ok(mf_simulation_init(simulation, &fluid->setup, NULL));
    assert_ok(mf_simulation_run(simulation, 203));
}

static void assert_fluid_counts(struct fluid *fluid) {
    struct simulation simulation;
    run_fluid(fluid, &simulation);
    // Within the list's cutoff of 1, to its end, and beyond it to half the box.
    const double half = mf_box_shortest(&fluid->setup.box) / 2;
    const struct rdf_bins within = {0, 0.025, 40}, above_zero = {0.31, 0.023, 30},
                          beyond = {0, half / 40, 40}, far = {1.1, 0.03, 20};
    assert_counts(&within, &simulation.particles, &simulation.neighbours, 1, false);
    assert_counts(&above_zero, &simulation.particles, &simulation.neighbours, 1, false);
    assert_passing_counts(&within, &simulation);
    assert_passing_counts(&above_zero, &simulation);
    assert_counts(&beyond, &simulation.particles, &simulation.neighbours, 1, true);
    assert_counts(&far, &simulation.particles, &simulation.neighbours, 1, true);
    mf_simulation_clear(&simulation);
    fluid_clear(fluid);
}

static void test_rdf_counts_every_pair_once_when_the_box_is_a_cube(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_groot_warren(&fluid, PARTICLES, 0.04);
    assert_fluid_counts(&fluid);
}

static void test_rdf_counts_every_pair_once_when_the_box_is_long(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_groot_warren(&fluid, PARTICLES, 0.04);
    fluid.setup.box.length[0] = 3.6;
    fluid.setup.box.length[1] = 7;
    fluid.setup.box.length[2] = 3.5;
    assert_fluid_counts(&fluid);
}

static void test_rdf_counts_every_pair_once_when_the_scene_is_flat(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_soft_discs(&fluid, PARTICLES, 0.04);
    assert_fluid_counts(&fluid);
}

static void test_rdf_counts_every_pair_twice_when_the_list_is_full(void **state) {
    (void)state;
    enum { BINS = 20 };
    const struct rdf_bins bins = {0, 0.05, BINS};
    double counted[BINS] = {0};
    struct counts counts;
    struct fluid fluid;
    struct metropolis metropolis;
    fluid_groot_warren(&fluid, PARTICLES, 0.01);
    assert_ok(mf_metropolis_init(&metropolis, &fluid.setup.box,
                                 &(struct composition){.types = 1, .count = {PARTICLES}},
                                 &fluid.potential, 1, 6));
    assert_ok(mf_metropolis_equilibrate(&metropolis, 51));
    count_all(&bins, &metropolis.particles, &counts);
    mf_rdf_count_pairs(&bins, &metropolis.law.composition, &metropolis.particles,
                       &metropolis.neighbours, counted);
    assert_histogram(counted, &counts, BINS, 2);
    mf_metropolis_clear(&metropolis);
    fluid_clear(&fluid);
}

/// Forces of ABOBA belong to the middle of the step.
static void test_rdf_counts_the_end_of_the_step_when_forces_are_midway(void **state) {
    (void)state;
    enum { BINS = 40 };
    const struct measure_plan plan = {.equilibration = 50, .samples = 1, .every = 5};
    const struct rdf_bins bins = {0, 1.0 / BINS, BINS};
    struct fluid fluid;
    struct simulation simulation;
    struct rdf measured, end;
    double temperature, differences = 0;
    fluid_groot_warren(&fluid, 1000, 0.05);
    fluid.setup.integrator = &mf_aboba;
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    assert_ok(mf_rdf_init(&measured, &bins, &fluid.setup.box, 1000, 1, 1));
    assert_ok(mf_rdf_init(&end, &bins, &fluid.setup.box, 1000, 1, 1));
    assert_ok(mf_measure_equilibrate(&simulation, &plan, &temperature, NULL));
    assert_ok(watched_sample(&simulation, &plan, (struct watched){.rdf = &measured}, NULL));
    assert_ok(mf_rdf_sample(&end, &simulation.particles, &simulation.neighbours));
    for (int k = 0; k < BINS; k++)
        differences += fabs(measured.blocks.sums[k] - end.blocks.sums[k]);
    assert_true(differences <= 4); // two pairs on an edge
    mf_rdf_clear(&measured);
    mf_rdf_clear(&end);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rdf_counts_every_pair_once_when_the_box_is_a_cube),
        cmocka_unit_test(test_rdf_counts_every_pair_once_when_the_box_is_long),
        cmocka_unit_test(test_rdf_counts_every_pair_once_when_the_scene_is_flat),
        cmocka_unit_test(test_rdf_counts_every_pair_once_when_types_differ),
        cmocka_unit_test(test_rdf_counts_every_pair_twice_when_the_list_is_full),
        cmocka_unit_test(test_rdf_counts_the_end_of_the_step_when_forces_are_midway),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
