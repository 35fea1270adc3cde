// SPDX-License-Identifier: GPL-3.0-or-later
//
// What is known exactly of motion: free flight, across the borders of the box and with a drift.
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/watched.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>

enum { PARTICLES = 60, LAGS = 40 };

/// Of positions of some hundred λ, relative to a step of a hundredth.
static const double rounding = 1e-9;

static const struct motion_plan plan = {.every = 5, .lags = LAGS, .origin_every = 7};

struct curves {
    double msd[LAGS + 1], msd_error[LAGS + 1], vacf[LAGS + 1], vacf_error[LAGS + 1];
};

/// Free particles, in motion as a whole: by the end of the run most have left their box many times.
static void fly(struct fluid *fluid, struct simulation *simulation, int dimensions, double drift) {
    fluid_ideal_gas(fluid, dimensions, PARTICLES, 0.02);
    fluid->setup.omega = NULL;
    fluid->setup.integrator = &mf_velocity_verlet;
    fluid->setup.temperature_limit = 1e4;
    assert_ok(mf_simulation_init(simulation, &fluid->setup, NULL));
    for (int d = 0; d < dimensions; d++)
        for (size_t k = 0; k < PARTICLES; k++)
            simulation->particles.velocity[d][k] += drift * (1 - 3 * d);
}

static struct motion_summary measure(struct simulation *simulation, struct motion *motion,
                                     struct curves *c) {
    const struct measure_plan when = {.equilibration = 30, .samples = 100, .every = 13};
    const struct motion_curves curves = {c->msd, c->msd_error, c->vacf, c->vacf_error};
    double temperature;
    assert_ok(mf_motion_init(motion, &plan, simulation, when.equilibration, 1300));
    assert_ok(mf_measure_equilibrate(simulation, &when, &temperature, NULL));
    assert_ok(watched_sample(simulation, &when, (struct watched){.motion = motion}, NULL));
    assert_int_equal(simulation->step, 1330);
    return mf_motion_result(motion, &curves);
}

static void assert_free_flight(int dimensions, double drift) {
    struct fluid fluid;
    struct simulation simulation;
    struct motion motion;
    struct curves c;
    fly(&fluid, &simulation, dimensions, drift);
    const double square =
        dimensions * (1 - 1.0 / PARTICLES) * mf_particles_temperature(&simulation.particles);
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
    assert_close(s.growth, 2, rounding);
    assert_true(mf_motion_is_early(&s));
    assert_true(isnan(s.maxwell.probability));
    int32_t max = 0;
    for (size_t k = 0; k < PARTICLES; k++)
        max = abs(simulation.particles.image[0][k]) > max ? abs(simulation.particles.image[0][k])
                                                          : max;
    assert_true(max >= 5);
    mf_motion_clear(&motion);
    mf_simulation_clear(&simulation);
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
    assert_ok(mf_motion_init(&motion, &plan, &simulation, 30, 1300));
    assert_int_equal(motion.blocks * motion.each, 32);
    assert_int_equal(mf_motion_due(&motion), 30);
    for (int sample = 0; sample <= 257; sample++) {
        assert_int_equal(mf_motion_due(&motion), 30 + 5 * sample);
        mf_motion_sample(&motion, &simulation);
    }
    assert_true(mf_motion_due(&motion) == INT64_MAX);
    assert_close(mf_motion_result(&motion, NULL).msd, 0, rounding);
    mf_motion_clear(&motion);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

static void test_motion_has_no_result_before_a_window_is_complete(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    struct motion motion;
    fly(&fluid, &simulation, 3, 0);
    assert_ok(mf_motion_init(&motion, &plan, &simulation, 0, 200));
    assert_true(isnan(mf_motion_result(&motion, NULL).msd));
    for (int sample = 0; sample < LAGS; sample++)
        mf_motion_sample(&motion, &simulation);
    assert_true(isnan(mf_motion_result(&motion, NULL).green_kubo));
    mf_motion_sample(&motion, &simulation);
    assert_true(mf_motion_result(&motion, NULL).green_kubo > 0);
    assert_true(isnan(mf_motion_result(&motion, NULL).green_kubo_error));
    mf_motion_clear(&motion);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

static void test_motion_init_refuses_when_there_is_no_time_for_a_window(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    struct motion motion;
    fly(&fluid, &simulation, 3, 0);
    assert_fails(mf_motion_init(&motion, &plan, &simulation, 0, 199), STATUS_BAD_INPUT,
                 "40 lags of 5 steps are longer than the 199 steps");
    mf_motion_clear(&motion);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

enum { MADE_LAGS = 60 };

/// A VACF exp(−t/τ_c) of one window, sampled every τ_c h, and an MSD whose slope is that of D =
/// τ_c.
static struct motion_summary of_decay(double h, double msd_slope) {
    double squares[MADE_LAGS + 1], products[MADE_LAGS + 1];
    struct motion motion = {.plan = {.every = 1, .lags = MADE_LAGS, .origin_every = 1},
                            .dimensions = 1,
                            .time_step = h,
                            .blocks = 1,
                            .each = 1,
                            .samples = MADE_LAGS + 1,
                            .squares = squares,
                            .products = products};
    for (int k = 0; k <= MADE_LAGS; k++) {
        products[k] = exp(-h * k);
        squares[k] = 2 * msd_slope * h * k;
    }
    assert_ok(mf_maxwell_init(&motion.maxwell, 0));
    const struct motion_summary s = mf_motion_result(&motion, NULL);
    mf_maxwell_clear(&motion.maxwell);
    return s;
}

/// D = ∫ exp(−t) dt = 1: what trapezoids are off is known, h²/12 for small h.
static void test_green_kubo_knows_what_its_sampling_costs(void **state) {
    (void)state;
    struct motion_summary fine = of_decay(0.2, 1), coarse = of_decay(2, 1);
    assert_close_relative(fine.green_kubo_sampling, fabs(fine.green_kubo - 1), 0.05);
    assert_ok(mf_motion_assess(&fine));
    assert_true(coarse.green_kubo > 1.3);
    assert_close_relative(coarse.green_kubo_sampling, fabs(coarse.green_kubo - 1), 0.3);
    assert_true(mf_motion_green_kubo_uncertainty(&coarse) > 0.25);
    assert_fails(mf_motion_assess(&coarse), STATUS_UNCONVERGED, "the VACF falls by 86 %");
}

/// A window that ends at 1.2 relaxation times leaves out exp(−1.2) of D.
static void test_green_kubo_knows_what_its_window_leaves_out(void **state) {
    (void)state;
    const struct motion_summary s = of_decay(0.02, 1);
    assert_close(1 - s.green_kubo, exp(-1.2), 1e-3);
    assert_true(s.green_kubo_truncation > 0.5 * exp(-1.2));
    assert_true(mf_motion_green_kubo_uncertainty(&s) < 2 * exp(-1.2));
}

static void test_judge_tells_when_both_diffusion_coefficients_disagree(void **state) {
    (void)state;
    struct motion_summary s = of_decay(0.2, 1.5);
    assert_ok(mf_motion_assess(&s)); // one window: the errors are not known
    s.msd_error = s.green_kubo_error = 0.01;
    assert_close(s.msd, 1.5, 1e-9);
    assert_fails(mf_motion_assess(&s), STATUS_UNCONVERGED,
                 "1.5 by the MSD and 1 by Green and Kubo");
    s.msd_error = 0.2;
    assert_ok(mf_motion_assess(&s));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_motion_is_exact_when_particles_fly_freely),
        cmocka_unit_test(test_motion_removes_the_drift_when_all_move_together),
        cmocka_unit_test(test_motion_takes_only_samples_of_whole_windows),
        cmocka_unit_test(test_motion_has_no_result_before_a_window_is_complete),
        cmocka_unit_test(test_green_kubo_knows_what_its_sampling_costs),
        cmocka_unit_test(test_green_kubo_knows_what_its_window_leaves_out),
        cmocka_unit_test(test_judge_tells_when_both_diffusion_coefficients_disagree),
        cmocka_unit_test(test_motion_init_refuses_when_there_is_no_time_for_a_window),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
