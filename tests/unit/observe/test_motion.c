// SPDX-License-Identifier: GPL-3.0-or-later
//
// What is known exactly of motion: free flight, across the borders of the box and with a drift.
#include "observe/measure.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>

enum { PARTICLES = 60, LAGS = 40 };

/// Of positions of some hundred λ, relative to a step of a hundredth.
static const double rounding = 1e-9;

static const struct motion_plan plan = {
    .every = 5, .lags = LAGS, .origin_every = 7, .fit_from = 0.5};

struct curves {
    double msd[LAGS + 1], msd_error[LAGS + 1], vacf[LAGS + 1], vacf_error[LAGS + 1];
};

/// Free particles, in motion as a whole: by the end of the run most have left their box many times.
static void fly(struct fluid *fluid, struct simulation *simulation, int dimensions, double drift) {
    fluid_ideal_gas(fluid, dimensions, PARTICLES, 0.02);
    fluid->setup.weight = NULL;
    fluid->setup.integrator = &velocity_verlet;
    fluid->setup.temperature_limit = 1e4;
    assert_ok(simulation_init(simulation, &fluid->setup, NULL));
    for (int d = 0; d < dimensions; d++)
        for (size_t k = 0; k < PARTICLES; k++)
            simulation->particles.velocity[d][k] += drift * (1 - 3 * d);
}

static struct motion_summary measure(struct simulation *simulation, struct motion *motion,
                                     struct curves *c) {
    const struct measure_plan when = {.equilibration = 30, .samples = 100, .every = 13};
    const struct motion_curves curves = {c->msd, c->msd_error, c->vacf, c->vacf_error};
    double temperature;
    assert_ok(motion_init(motion, &plan, simulation, when.equilibration, 1300));
    assert_ok(measure_equilibrate(simulation, &when, &temperature, NULL));
    assert_ok(measure_sample(simulation, &when, (struct measure_targets){.motion = motion}, NULL));
    assert_int_equal(simulation->step, 1330);
    return motion_result(motion, &curves);
}

static void assert_free_flight(int dimensions, double drift) {
    struct fluid fluid;
    struct simulation simulation;
    struct motion motion;
    struct curves c;
    fly(&fluid, &simulation, dimensions, drift);
    const double square =
        dimensions * (1 - 1.0 / PARTICLES) * particles_temperature(&simulation.particles);
    const struct motion_summary s = measure(&simulation, &motion, &c);
    for (int lag = 0; lag <= LAGS; lag++) {
        const double t = lag * 5 * 0.02;
        assert_close(c.msd[lag], square * t * t, rounding);
        assert_close(c.vacf[lag], square, rounding);
        assert_close(c.msd_error[lag], 0, rounding);
        assert_close(c.vacf_error[lag], 0, rounding);
    }
    // The slope of t² over a window is twice the middle of the window.
    assert_close(s.fit_begin, 2, rounding);
    assert_close(s.fit_end, 4, rounding);
    assert_close(s.msd, square * 2 * 3 / (2 * dimensions), rounding);
    assert_close(s.green_kubo, square * 4 / dimensions, rounding);
    assert_true(isnan(s.maxwell.probability));
    int32_t most = 0;
    for (size_t k = 0; k < PARTICLES; k++)
        most = abs(simulation.particles.image[0][k]) > most ? abs(simulation.particles.image[0][k])
                                                            : most;
    assert_true(most >= 5);
    motion_clear(&motion);
    simulation_clear(&simulation);
    fluid_clear(&fluid);
}

static void test_motion_is_exact_when_particles_fly_freely(void **state) {
    (void)state;
    assert_free_flight(2, 0);
    assert_free_flight(3, 0);
}

static void test_motion_removes_the_drift_when_all_move_together(void **state) {
    (void)state;
    assert_free_flight(2, 3);
    assert_free_flight(3, -4);
}

static void test_motion_takes_only_samples_of_whole_windows(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    struct motion motion;
    fly(&fluid, &simulation, 3, 0);
    // 260 samples after the first: windows of 40 begin at 0, 7, … 217, the last ends at 257.
    assert_ok(motion_init(&motion, &plan, &simulation, 30, 1300));
    assert_int_equal(motion.blocks * motion.each, 32);
    assert_int_equal(motion_due(&motion), 30);
    for (int sample = 0; sample <= 257; sample++) {
        assert_int_equal(motion_due(&motion), 30 + 5 * sample);
        motion_sample(&motion, &simulation);
    }
    assert_true(motion_due(&motion) == INT64_MAX);
    assert_close(motion_result(&motion, NULL).msd, 0, rounding);
    motion_clear(&motion);
    simulation_clear(&simulation);
    fluid_clear(&fluid);
}

static void test_motion_has_no_result_before_a_window_is_complete(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    struct motion motion;
    fly(&fluid, &simulation, 3, 0);
    assert_ok(motion_init(&motion, &plan, &simulation, 0, 200));
    assert_true(isnan(motion_result(&motion, NULL).msd));
    for (int sample = 0; sample < LAGS; sample++)
        motion_sample(&motion, &simulation);
    assert_true(isnan(motion_result(&motion, NULL).green_kubo));
    motion_sample(&motion, &simulation);
    assert_true(motion_result(&motion, NULL).green_kubo > 0);
    assert_identical(motion_result(&motion, NULL).green_kubo_error, 0.0);
    motion_clear(&motion);
    simulation_clear(&simulation);
    fluid_clear(&fluid);
}

static void test_motion_init_refuses_when_there_is_no_time_for_a_window(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    struct motion motion;
    fly(&fluid, &simulation, 3, 0);
    assert_fails(motion_init(&motion, &plan, &simulation, 0, 199), STATUS_BAD_INPUT,
                 "40 lags of 5 steps are longer than the 199 steps");
    motion_clear(&motion);
    simulation_clear(&simulation);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_motion_is_exact_when_particles_fly_freely),
        cmocka_unit_test(test_motion_removes_the_drift_when_all_move_together),
        cmocka_unit_test(test_motion_takes_only_samples_of_whole_windows),
        cmocka_unit_test(test_motion_has_no_result_before_a_window_is_complete),
        cmocka_unit_test(test_motion_init_refuses_when_there_is_no_time_for_a_window),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
