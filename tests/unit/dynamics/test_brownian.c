// SPDX-License-Identifier: GPL-3.0-or-later
//
// Dynamics without velocities: the same bits through threads and restarts, and no kinetic
// temperature where there is none.
#include "observe/measure.h"
#include "dynamics/brownian.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/restart.h"
#include "shared/testing.h"
#include "shared/watched.h"

#include <math.h>

static const struct brownian_parameters parameters = {.friction = 2};

static void make(struct fluid *fluid, int64_t count, double time_step) {
    fluid_groot_warren(fluid, count, time_step);
    fluid->setup.omega = NULL;
    fluid->setup.integrator = &mf_brownian;
    fluid->setup.integrator_parameters = &parameters;
}

static void test_brownian_goes_on_with_the_same_bits_when_restarted(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation whole, pieces;
    make(&fluid, 300, 0.004);
    assert_ok(mf_simulation_init(&whole, &fluid.setup, NULL));
    assert_ok(mf_simulation_init(&pieces, &fluid.setup, NULL));
    assert_ok(mf_simulation_run(&whole, 80));
    assert_ok(mf_simulation_run(&pieces, 33));
    restart_simulation(&pieces);
    assert_ok(mf_simulation_run(&pieces, 47));
    restart_assert_same(&whole, &pieces);
    mf_simulation_clear(&whole);
    mf_simulation_clear(&pieces);
    fluid_clear(&fluid);
}

static void test_brownian_has_the_same_bits_for_any_number_of_threads(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation alone, shared;
    make(&fluid, 2500, 0.004);
    assert_ok(mf_simulation_init(&alone, &fluid.setup, NULL));
    assert_ok(mf_simulation_run(&alone, 15));
    fluid.setup.threads = 2;
    assert_ok(mf_simulation_init(&shared, &fluid.setup, NULL));
    assert_ok(mf_simulation_run(&shared, 15));
    restart_assert_same(&alone, &shared);
    mf_simulation_clear(&alone);
    mf_simulation_clear(&shared);
    fluid_clear(&fluid);
}

static void test_brownian_takes_the_set_temperature_for_the_pressure(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    make(&fluid, 300, 0.004);
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    simulation.wants = PAIR_FORCES_AND_SUMS;
    assert_ok(mf_simulation_run(&simulation, 10));
    assert_true(isnan(mf_simulation_temperature(&simulation)));
    const double volume = mf_box_volume(&simulation.particles.box);
    assert_close(mf_simulation_pressure(&simulation),
                 300 / volume + simulation.sums.virial / (3 * volume), 1e-12);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

static void test_brownian_is_unstable_when_a_step_is_far_too_long(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    make(&fluid, 300, 0.004);
    fluid.setup.temperature = 1e-6;
    fluid.setup.time_step = 0.5;
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    assert_fails(mf_simulation_run(&simulation, 100), STATUS_UNSTABLE, "mean squared step");
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

/// Lennard-Jones at random: the forces of overlaps would fling beads far in their first step.
static void test_brownian_begins_well_when_particles_overlap_at_random(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_lennard_jones(&fluid, 500, 2e-4);
    fluid.setup.omega = NULL;
    fluid.setup.integrator = &mf_brownian;
    fluid.setup.placement.kind = PLACEMENT_RANDOM;
    for (uint64_t seed = 1; seed <= 5; seed++) {
        struct simulation simulation;
        fluid.setup.seed = seed;
        assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
        assert_ok(mf_simulation_run(&simulation, 200));
        mf_simulation_clear(&simulation);
    }
    fluid_clear(&fluid);
}

/// Without a kinetic temperature the positions are assessed, and a step that heats them is told.
static void test_brownian_is_judged_by_the_configurational_temperature(void **state) {
    (void)state;
    static const struct {
        double time_step;
        enum status deviation;
    } cases[] = {{0.004, STATUS_OK}, {0.024, STATUS_UNSTABLE}};
    const struct measure_plan plan = {.equilibration = 400, .samples = 100, .every = 4};
    for (int n = 0; n < 2; n++) {
        struct fluid fluid;
        struct simulation simulation;
        struct thermodynamics thermodynamics;
        double temperature;
        make(&fluid, 300, cases[n].time_step);
        assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
        mf_thermodynamics_init(&thermodynamics);
        assert_ok(mf_measure_equilibrate(&simulation, &plan, &temperature, NULL));
        const struct watched watched = {.thermodynamics = &thermodynamics};
        assert_ok(watched_sample(&simulation, &plan, watched, NULL));
        const struct thermodynamics_summary s = mf_thermodynamics_result(&thermodynamics, 1);
        print_message("time step %g: configurational %.3f(%.3f), after equilibration %.3f\n",
                      cases[n].time_step, s.temperature_configurational,
                      s.temperature_configurational_error, temperature);
        assert_true(isnan(s.temperature));
        assert_close(temperature, s.temperature_configurational, 0.1);
        assert_int_equal(mf_thermodynamics_assess(&s, &fluid.setup), cases[n].deviation);
        if (cases[n].deviation == STATUS_OK)
            assert_close(s.temperature_configurational, 1, 0.03);
        mf_thermodynamics_clear(&thermodynamics);
        mf_simulation_clear(&simulation);
        fluid_clear(&fluid);
    }
}

/// Steps that are far too long give numbers whose errors are as large.
static void test_brownian_is_unstable_when_its_temperature_is_absurd(void **state) {
    (void)state;
    static const struct {
        double temperature, error;
        enum status deviation;
    } cases[] = {
        {-613, 242, STATUS_UNSTABLE}, {3625, 9341, STATUS_UNSTABLE}, {0.7, 0.2, STATUS_OK}};
    const struct simulation_setup setup = {.temperature = 1, .integrator = &mf_brownian};
    for (int n = 0; n < 3; n++) {
        const struct thermodynamics_summary s = {
            .blocks = 20,
            .temperature = NAN,
            .temperature_configurational = cases[n].temperature,
            .temperature_configurational_error = cases[n].error};
        assert_int_equal(mf_thermodynamics_assess(&s, &setup), cases[n].deviation);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_brownian_goes_on_with_the_same_bits_when_restarted),
        cmocka_unit_test(test_brownian_has_the_same_bits_for_any_number_of_threads),
        cmocka_unit_test(test_brownian_takes_the_set_temperature_for_the_pressure),
        cmocka_unit_test(test_brownian_is_unstable_when_a_step_is_far_too_long),
        cmocka_unit_test(test_brownian_begins_well_when_particles_overlap_at_random),
        cmocka_unit_test(test_brownian_is_judged_by_the_configurational_temperature),
        cmocka_unit_test(test_brownian_is_unstable_when_its_temperature_is_absurd),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
