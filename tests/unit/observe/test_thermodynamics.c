// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/rng.h"
#include "base/statistics.h"
#include "observe/thermodynamics.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

enum { SAMPLES = 200, TRIALS = 2000 };

/// Of sums of a few hundred numbers of order 1.
static const double rounding = 1e-12;

/// Pair energies are single-precision: 2^-24 of a pair, a few times.
static const double single_rounding = 1e-6;

/// Two particles at distance 0.5 in the box of the standard fluid, with given velocities along x.
static void make_pair(struct fluid *fluid, struct simulation *simulation, double v0, double v1) {
    static double position[3][2] = {{1, 1.5}, {1, 1}, {1, 1}}, velocity[3][2];
    const struct simulation_start start = {.position = {position[0], position[1], position[2]},
                                           .velocity = {velocity[0], velocity[1], velocity[2]}};
    velocity[0][0] = v0;
    velocity[0][1] = v1;
    fluid_groot_warren(fluid, 2, 1e-9);
    for (int d = 0; d < 3; d++)
        fluid->setup.box.length[d] = 3;
    fluid->setup.placement.kind = PLACEMENT_FILE;
    fluid->setup.omega = NULL;
    fluid->setup.integrator = &mf_velocity_verlet;
    fluid->setup.temperature_limit = 1e6;
    assert_ok(mf_simulation_init(simulation, &fluid->setup, &start));
    simulation->wants = PAIR_FORCES_AND_SUMS;
    assert_ok(mf_simulation_run(simulation, 1));
}

static void test_thermodynamics_sample_is_exact_when_there_are_two_particles(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    struct thermodynamics thermodynamics;
    make_pair(&fluid, &simulation, 2, -1);
    mf_thermodynamics_init(&thermodynamics);
    assert_ok(mf_thermodynamics_sample(&thermodynamics, &simulation));
    const struct thermodynamics_summary s = mf_thermodynamics_result(&thermodynamics, 1);
    // Velocities about their mean are ±1.5: Σ v² = 4.5 with 3 degrees of freedom.
    assert_close(s.temperature, 1.5, single_rounding);
    // Φ = 12.5 · 0.5² = 3.125, F = 12.5, virial 6.25.
    assert_close(s.potential_energy, 3.125 / 2, 10 * single_rounding);
    assert_close(s.pressure, 2 / 27.0 * 1.5 + 6.25 / (3 * 27), 10 * single_rounding);
    // Σ F² = 2 · 12.5²; Σ ∇²U = 2 (25 − 2 · 12.5 / 0.5) < 0.
    assert_close(s.temperature_configurational, 312.5 / -50, 100 * single_rounding);
    assert_true(isnan(s.temperature_error));
    mf_thermodynamics_clear(&thermodynamics);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

static void
test_thermodynamics_pressure_takes_the_set_temperature_when_there_is_friction(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    make_pair(&fluid, &simulation, 2, -1);
    simulation.law.omega = &fluid.omega;
    assert_close(mf_simulation_pressure(&simulation), 2 / 27.0 * 1 + 6.25 / (3 * 27),
                 10 * single_rounding);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

static void
test_thermodynamics_has_no_configurational_temperature_when_there_is_no_potential(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    struct thermodynamics thermodynamics;
    fluid_ideal_gas(&fluid, 2, 50, 0.01);
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    simulation.wants = PAIR_FORCES_AND_SUMS;
    assert_ok(mf_simulation_run(&simulation, 1));
    mf_thermodynamics_init(&thermodynamics);
    assert_ok(mf_thermodynamics_sample(&thermodynamics, &simulation));
    const struct thermodynamics_summary s = mf_thermodynamics_result(&thermodynamics, 1);
    assert_true(isnan(s.temperature_configurational));
    assert_close(s.pressure, 2, rounding);
    assert_close(s.potential_energy, 0, rounding);
    mf_thermodynamics_clear(&thermodynamics);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

/// A series of independent normal numbers in place of each quantity, about 1, 2, 3, 8 and 4; the
/// numerator of the configurational temperature moves with its denominator.
static void make_series(struct thermodynamics *thermodynamics, uint32_t trial, uint32_t replica) {
    mf_thermodynamics_init(thermodynamics);
    for (uint32_t k = 0; k < SAMPLES; k++) {
        double a[4], b[4];
        mf_rng_normal4(mf_rng_philox(3, RNG_INITIAL, trial, replica, 2 * k), a);
        mf_rng_normal4(mf_rng_philox(3, RNG_INITIAL, trial, replica, 2 * k + 1), b);
        const double here[THERMODYNAMICS_QUANTITIES] = {
            [THERMODYNAMICS_TEMPERATURE] = 1 + 0.1 * a[0],
            [THERMODYNAMICS_POTENTIAL_ENERGY] = 2 + 0.2 * a[1],
            [THERMODYNAMICS_PRESSURE] = 3 + 0.3 * a[2],
            [THERMODYNAMICS_FORCE_SQUARES] = 8 + 1.6 * b[0] + 0.1 * b[1],
            [THERMODYNAMICS_LAPLACIAN] = 4 + 0.8 * b[0]};
        assert_ok(mf_sample_series_add(&thermodynamics->series, here));
    }
}

static void test_thermodynamics_series_are_kept_when_there_is_room_for_more(void **state) {
    (void)state;
    struct thermodynamics thermodynamics;
    make_series(&thermodynamics, 0, 0);
    thermodynamics.series.count = 7;
    const double *energy =
        mf_thermodynamics_series(&thermodynamics, THERMODYNAMICS_POTENTIAL_ENERGY);
    double sum = 0;
    for (int k = 0; k < 7; k++)
        sum += energy[k];
    assert_close(mf_thermodynamics_result(&thermodynamics, 1).potential_energy, sum / 7, rounding);
    mf_thermodynamics_clear(&thermodynamics);
}

/// Errors of independent samples cover 95.4 %, and a little more for what the window leaves out;
/// the share of 2000 has a standard error of 0.5 %. Five of these: one false alarm in 10^6 seeds.
static const double covered_share = 0.960, covered_band = 0.025;

/// From 90 to 110, by a line, with a swing that no line sees: 20 of 100.
static void test_thermodynamics_energy_drift_is_that_of_a_line(void **state) {
    enum { ROWS = 41 };
    struct thermodynamics thermodynamics;
    (void)state;
    mf_thermodynamics_init(&thermodynamics);
    for (int k = 0; k < ROWS; k++) {
        const double swings = k % 4 == 2 ? 3 : k % 4 == 0 && k % (ROWS - 1) != 0 ? -3 : 0;
        const double here[THERMODYNAMICS_QUANTITIES] = {[THERMODYNAMICS_TOTAL_ENERGY] =
                                                            90 + 0.5 * k + swings};
        assert_ok(mf_sample_series_add(&thermodynamics.series, here));
    }
    const double swing = 3.0 * 10 - 3.0 * 9; // what the swing leaves in the mean
    assert_close(mf_thermodynamics_energy_drift(&thermodynamics), 20 / (100 + swing / ROWS), 1e-12);
    thermodynamics.series.count = 1;
    assert_true(isnan(mf_thermodynamics_energy_drift(&thermodynamics)));
    mf_thermodynamics_clear(&thermodynamics);
}

static void test_thermodynamics_errors_cover_the_truth_when_samples_are_independent(void **state) {
    (void)state;
    double temperature = 0, energy = 0, pressure = 0, configurational = 0;
    for (uint32_t trial = 0; trial < TRIALS; trial++) {
        struct thermodynamics replicas[2];
        make_series(&replicas[0], trial, 0);
        make_series(&replicas[1], trial, 1);
        const struct thermodynamics_summary s = mf_thermodynamics_result(replicas, 2);
        temperature += fabs(s.temperature - 1) < 2 * s.temperature_error;
        energy += fabs(s.potential_energy - 2) < 2 * s.potential_energy_error;
        pressure += fabs(s.pressure - 3) < 2 * s.pressure_error;
        configurational +=
            fabs(s.temperature_configurational - 2) < 2 * s.temperature_configurational_error;
        mf_thermodynamics_clear(&replicas[0]);
        mf_thermodynamics_clear(&replicas[1]);
    }
    assert_close(temperature / TRIALS, covered_share, covered_band);
    assert_close(energy / TRIALS, covered_share, covered_band);
    assert_close(pressure / TRIALS, covered_share, covered_band);
    assert_close(configurational / TRIALS, covered_share, covered_band);
}

static void test_thermodynamics_errors_grow_when_samples_are_correlated(void **state) {
    (void)state;
    // Each number ten times in a row: the naive error is sqrt(10) too small.
    struct running_mean squares = {0};
    for (uint32_t trial = 0; trial < TRIALS; trial++) {
        struct thermodynamics thermodynamics;
        make_series(&thermodynamics, trial, 2);
        double *series = sample_series_column(&thermodynamics.series, THERMODYNAMICS_TEMPERATURE);
        for (size_t k = 0; k < SAMPLES; k++)
            series[k] = series[k / 10 * 10];
        const double error = mf_thermodynamics_result(&thermodynamics, 1).temperature_error;
        mf_statistics_add(&squares, error * error);
        mf_thermodynamics_clear(&thermodynamics);
    }
    // Twenty independent numbers are few: the window has to be found, too, and the mean square of
    // the errors comes out 15 % (of the error) too large.
    assert_close_relative(sqrt(squares.mean), 1.15 * 0.1 / sqrt(SAMPLES / 10), 0.04);
}

static double count_solvent_particles(const struct simulation_setup *setup) {
    (void)setup;
    return 1000;
}

static void test_judge_tells_when_a_temperature_is_off(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_groot_warren(&fluid, 100, 0.01);
    struct thermodynamics_summary s = {.blocks = 20,
                                       .temperature = 1.027,
                                       .temperature_error = 0.002,
                                       .temperature_configurational = 0.75,
                                       .temperature_configurational_error = 0.01};
    assert_fails(mf_thermodynamics_assess(&s, &fluid.setup), STATUS_UNSTABLE,
                 "0.75 by the positions");
    s.temperature_configurational_error = 0.04; // it may be 0.9
    assert_ok(mf_thermodynamics_assess(&s, &fluid.setup));
    s.temperature_configurational = 1.05;
    s.temperature = 1.12;
    assert_fails(mf_thermodynamics_assess(&s, &fluid.setup), STATUS_UNSTABLE,
                 "1.12 by the velocities");
    // A bath that is slow leaves the two together.
    s.temperature = 0.8;
    s.temperature_configurational = 0.79;
    s.temperature_configurational_error = 0.01;
    assert_fails(mf_thermodynamics_assess(&s, &fluid.setup), STATUS_UNSTABLE, "more friction");
    s.temperature_configurational = NAN;
    s.temperature = 1.02;
    assert_ok(mf_thermodynamics_assess(&s, &fluid.setup));
    s.temperature = NAN;
    assert_fails(mf_thermodynamics_assess(&s, &fluid.setup), STATUS_UNSTABLE, "time_step");
    // Without friction the two are held to each other.
    fluid.setup.omega = NULL;
    s.temperature = 1.4;
    s.temperature_configurational = 1.45;
    s.temperature_configurational_error = 0.01;
    assert_ok(mf_thermodynamics_assess(&s, &fluid.setup));
    s.temperature_configurational = 1.1;
    assert_fails(mf_thermodynamics_assess(&s, &fluid.setup), STATUS_UNSTABLE,
                 "1.1 by the positions");
    s.blocks = 4;
    assert_ok(mf_thermodynamics_assess(&s, &fluid.setup));
    fluid_clear(&fluid);
}

static void test_judge_of_a_fit_sees_a_few_percent(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_groot_warren(&fluid, 100, 0.01);
    struct thermodynamics_summary s = {.blocks = 20,
                                       .temperature = 1.007,
                                       .temperature_error = 0.002,
                                       .temperature_configurational = 0.965,
                                       .temperature_configurational_error = 0.005};
    assert_ok(mf_thermodynamics_assess(&s, &fluid.setup));
    assert_fails(mf_thermodynamics_assess_fit(&s, &fluid.setup), STATUS_UNSTABLE,
                 "-3.50(50) % off");
    s.blocks = 49;
    assert_ok(mf_thermodynamics_assess_step(&s, &fluid.setup));
    s.blocks = 50;
    assert_fails(mf_thermodynamics_assess_step(&s, &fluid.setup), STATUS_UNSTABLE,
                 "configurational temperature is -4.17(53) % off");
    // A slow bath: both together.
    s.temperature = 0.98;
    assert_ok(mf_thermodynamics_assess_step(&s, &fluid.setup));
    s.temperature = 0.96;
    assert_fails(mf_thermodynamics_assess_step(&s, &fluid.setup), STATUS_UNSTABLE,
                 "0.96, not 1: friction hardly holds it");
    s.temperature = 1.007;
    s.laplacian_error = 0.3; // forces hardly act
    assert_ok(mf_thermodynamics_assess_step(&s, &fluid.setup));
    s.laplacian_error = 0;
    // Beads that a wall pushes, by no force that the positions would tell of.
    const struct integrator *without = fluid.setup.integrator;
    struct integrator with = *without;
    with.samples = true; // moves take no time
    fluid.setup.integrator = &with;
    assert_ok(mf_thermodynamics_assess_step(&s, &fluid.setup));
    with.samples = false;
    with.solvent_particles = count_solvent_particles;
    fluid.setup.integrator = &with;
    assert_ok(mf_thermodynamics_assess_fit(&s, &fluid.setup));
    fluid.setup.integrator = without;
    s.temperature_configurational_error = 0.013; // it may be chance
    assert_ok(mf_thermodynamics_assess_fit(&s, &fluid.setup));
    s.temperature_configurational = 1.02;
    s.temperature_configurational_error = 0.001; // sure, and little
    assert_ok(mf_thermodynamics_assess_fit(&s, &fluid.setup));
    s.temperature_configurational = NAN;
    assert_ok(mf_thermodynamics_assess_fit(&s, &fluid.setup));
    s.temperature = 1.059; // of a g(r) that was 1.05 times too large
    assert_ok(mf_thermodynamics_assess(&s, &fluid.setup));
    assert_fails(mf_thermodynamics_assess_fit(&s, &fluid.setup), STATUS_UNSTABLE,
                 "kinetic temperature is 5.90(20) % off");
    s.temperature_error = 0.02;
    assert_ok(mf_thermodynamics_assess_fit(&s, &fluid.setup));
    // A simulation may go where its energy leads it, but a target has its temperature.
    fluid.setup.omega = NULL;
    assert_ok(mf_thermodynamics_assess_fit(&s, &fluid.setup));
    s.temperature = 0.79;
    assert_ok(mf_thermodynamics_assess(&s, &fluid.setup));
    assert_fails(mf_thermodynamics_assess_fit(&s, &fluid.setup), STATUS_UNSTABLE,
                 "0.79, not 1: there is no thermostat");
    s.blocks = 4;
    assert_ok(mf_thermodynamics_assess_fit(&s, &fluid.setup));
    fluid_clear(&fluid);
}

static void test_thermodynamics_off_is_of_the_temperature_that_is_farther_off(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_groot_warren(&fluid, 100, 0.01);
    struct thermodynamics_summary s = {.blocks = 20,
                                       .temperature = 1.02,
                                       .temperature_error = 0.004,
                                       .temperature_configurational = 0.97,
                                       .temperature_configurational_error = 0.01};
    struct thermodynamics_off off = mf_thermodynamics_off(&s, &fluid.setup);
    assert_true(off.known && off.kinetic); // 2 % of 1.2, and 3 % of 3
    assert_close(off.share, 0.02, 1e-12);
    assert_close(off.within, 0.03, 1e-12); // by the error of the other
    s.temperature_configurational_error = 0.002;
    off = mf_thermodynamics_off(&s, &fluid.setup);
    assert_false(off.kinetic);
    assert_close(off.share, -0.03, 1e-12);
    assert_close(off.error, 0.002, 1e-12);
    s.temperature = NAN;
    s.temperature_configurational = 49;
    s.temperature_configurational_error = 86;
    off = mf_thermodynamics_off(&s, &fluid.setup);
    assert_true(off.known && off.share > 40 && off.error < 1e-12);
    s.temperature_configurational = NAN;
    assert_false(mf_thermodynamics_off(&s, &fluid.setup).known);
    // Without friction the kinetic one is taken as it is.
    fluid.setup.omega = NULL;
    s.temperature = 1.4;
    s.temperature_error = 0.01;
    s.temperature_configurational = 1.47;
    s.temperature_configurational_error = 0.001;
    assert_close(mf_thermodynamics_off(&s, &fluid.setup).share, 0.05, 1e-12);
    s.blocks = 4;
    assert_false(mf_thermodynamics_off(&s, &fluid.setup).known);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_thermodynamics_sample_is_exact_when_there_are_two_particles),
        cmocka_unit_test(test_thermodynamics_energy_drift_is_that_of_a_line),
        cmocka_unit_test(
            test_thermodynamics_pressure_takes_the_set_temperature_when_there_is_friction),
        cmocka_unit_test(
            test_thermodynamics_has_no_configurational_temperature_when_there_is_no_potential),
        cmocka_unit_test(test_thermodynamics_series_are_kept_when_there_is_room_for_more),
        cmocka_unit_test(test_thermodynamics_errors_cover_the_truth_when_samples_are_independent),
        cmocka_unit_test(test_thermodynamics_errors_grow_when_samples_are_correlated),
        cmocka_unit_test(test_judge_tells_when_a_temperature_is_off),
        cmocka_unit_test(test_judge_of_a_fit_sees_a_few_percent),
        cmocka_unit_test(test_thermodynamics_off_is_of_the_temperature_that_is_farther_off),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
