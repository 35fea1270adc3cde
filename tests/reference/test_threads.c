// SPDX-License-Identifier: GPL-3.0-or-later
//
// One simulation shared between threads has the bits of one thread alone.
#include "observe/rdf.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <string.h>

/// Few: on a busy machine threads wait long for each other, a dozen times in a step.
enum { STEPS = 15, MAX_PARTICLES = 2500, BINS = 50, MAX_PAIRS = 6 };

/// All that a run leaves, by id.
struct outcome {
    double position[MAX_PARTICLES][3], velocity[MAX_PARTICLES][3], histogram[MAX_PAIRS * BINS];
    struct pair_sums sums;
    uint64_t list_builds;
};

static void run(const struct simulation_setup *setup, int threads, struct outcome *outcome) {
    static struct simulation simulation;
    struct rdf rdf;
    struct simulation_setup shared = *setup;
    shared.threads = threads;
    assert_ok(mf_simulation_init(&simulation, &shared, NULL));
    assert_true(simulation.neighbours.parts >= 4);
    const double cutoff = mf_pair_cutoff(&simulation.law);
    const struct rdf_bins bins = {0, cutoff / BINS, BINS};
    const size_t count = simulation.particles.count;
    const struct composition alike = mf_composition_of_one((int64_t)count);
    assert_ok(mf_rdf_init_mixture(
        &rdf, &bins, &shared.box,
        composition_is_mixed(&shared.composition) ? &shared.composition : &alike, cutoff, 1));
    assert_true(rdf.pairs <= MAX_PAIRS);
    assert_ok(mf_simulation_run(&simulation, STEPS - 1));
    simulation.wants = PAIR_FORCES_AND_SUMS;
    simulation.law.histogram = mf_rdf_histogram(&rdf);
    assert_ok(mf_simulation_run(&simulation, 1));
    mf_rdf_sample_counted(&rdf);
    memset(outcome, 0, sizeof *outcome);
    for (int d = 0; d < shared.box.dimensions; d++)
        for (size_t k = 0; k < count; k++) {
            outcome->position[simulation.particles.id[k]][d] = simulation.particles.position[d][k];
            outcome->velocity[simulation.particles.id[k]][d] = simulation.particles.velocity[d][k];
        }
    memcpy(outcome->histogram, rdf.blocks.sums, rdf.pairs * BINS * sizeof *rdf.blocks.sums);
    outcome->sums = simulation.sums;
    outcome->list_builds = simulation.list_builds;
    mf_rdf_clear(&rdf);
    mf_simulation_clear(&simulation);
}

static void check_setup(const struct simulation_setup *setup) {
    static struct outcome alone, shared;
    run(setup, 1, &alone);
    assert_true(alone.list_builds > 0);
    for (int threads = 2; threads <= 4; threads++) {
        run(setup, threads, &shared);
        assert_memory_equal(&shared, &alone, sizeof alone);
    }
}

static void check(struct fluid *fluid) {
    for (int precision = PAIR_MIXED; precision <= PAIR_DOUBLE; precision++) {
        fluid->setup.precision = precision;
        check_setup(&fluid->setup);
    }
    fluid_clear(fluid);
}

static void test_threads_give_the_same_bits_when_there_is_friction_and_noise(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_groot_warren(&fluid, 1000, 0.04);
    check(&fluid);
}

static void test_threads_give_the_same_bits_when_energy_is_conserved(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_lennard_jones(&fluid, 2048, 0.005);
    fluid.setup.omega = NULL;
    fluid.setup.integrator = &mf_velocity_verlet;
    fluid.setup.temperature = 4;
    check(&fluid);
}

static void test_threads_give_the_same_bits_when_the_scene_is_flat(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_soft_discs(&fluid, 800, 0.04);
    check(&fluid);
}

static void test_threads_give_the_same_bits_when_friction_is_split_off(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_groot_warren(&fluid, 1000, 0.04);
    for (size_t k = 0; mf_integrator_list[k]; k++)
        if (mf_integrator_list[k]->friction) {
            fluid.setup.integrator = mf_integrator_list[k];
            check_setup(&fluid.setup);
        }
    fluid_clear(&fluid);
}

static void test_threads_give_the_same_bits_when_types_differ(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_mixture(&fluid, 1000, 0.04);
    check(&fluid);
    fluid_mixture(&fluid, 1000, 0.04);
    fluid.setup.integrator = &mf_aboba;
    check(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_threads_give_the_same_bits_when_there_is_friction_and_noise),
        cmocka_unit_test(test_threads_give_the_same_bits_when_energy_is_conserved),
        cmocka_unit_test(test_threads_give_the_same_bits_when_the_scene_is_flat),
        cmocka_unit_test(test_threads_give_the_same_bits_when_friction_is_split_off),
        cmocka_unit_test(test_threads_give_the_same_bits_when_types_differ),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
