// SPDX-License-Identifier: GPL-3.0-or-later
//
// Mean-square displacement, velocity autocorrelation and diffusion of a fluid are those of a twin
// that stores its whole trajectory and loops over all pairs of times. The twin unwraps positions
// by following each particle from sample to sample, and never looks at the counters of boxes.
#include "base/memory.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/watched.h"
#include "shared/testing.h"

enum { LAGS = 25, EVERY = 3, ORIGIN_EVERY = 4, SAMPLES = 331, EQUILIBRATION = 40 };

/// Sums of a few thousand numbers, in another order.
static const double rounding = 1e-11;

/// Positions and velocities by id, shape [SAMPLES, 2, dimensions, count].
struct trajectory {
    int dimensions;
    size_t count;
    double *values;
};

static double *find(const struct trajectory *trajectory, int sample, int what, int d) {
    const size_t axis = (size_t)((sample * 2 + what) * trajectory->dimensions + d);
    return trajectory->values + axis * trajectory->count;
}

static void store(struct trajectory *trajectory, int sample, const struct particles *particles) {
    for (int d = 0; d < trajectory->dimensions; d++)
        for (size_t k = 0; k < trajectory->count; k++) {
            const size_t id = particles->id[k];
            const double x = particles->position[d][k];
            const double before = sample ? find(trajectory, sample - 1, 0, d)[id] : x;
            find(trajectory, sample, 0, d)[id] =
                before + box_nearest(x - before, particles->box.length[d]);
            find(trajectory, sample, 1, d)[id] = particles->velocity[d][k];
        }
}

static void make_trajectory(struct trajectory *trajectory, const struct simulation_setup *setup) {
    struct simulation simulation;
    trajectory->dimensions = setup->box.dimensions;
    trajectory->count = (size_t)setup->placement.count;
    trajectory->values =
        mf_memory_zeroed((size_t)(SAMPLES * 2 * trajectory->dimensions) * trajectory->count,
                         sizeof *trajectory->values);
    assert_non_null(trajectory->values);
    assert_ok(mf_simulation_init(&simulation, setup, NULL));
    assert_ok(mf_simulation_run(&simulation, EQUILIBRATION));
    for (int sample = 0; sample < SAMPLES; sample++) {
        store(trajectory, sample, &simulation.particles);
        assert_ok(mf_simulation_run(&simulation, EVERY));
    }
    mf_simulation_clear(&simulation);
}

/// Put every sample into the frame of its centre of mass.
static void centre(struct trajectory *trajectory) {
    for (int sample = 0; sample < SAMPLES; sample++)
        for (int what = 0; what < 2; what++)
            for (int d = 0; d < trajectory->dimensions; d++) {
                double *x = find(trajectory, sample, what, d), mean = 0;
                for (size_t k = 0; k < trajectory->count; k++)
                    mean += x[k] / (double)trajectory->count;
                for (size_t k = 0; k < trajectory->count; k++)
                    x[k] -= mean;
            }
}

/// Mean over particles of the squared changes (what 0) or of the products of velocities (what 1)
/// from one sample to another.
static double correlate(const struct trajectory *trajectory, int what, int then, int now) {
    double sum = 0;
    for (int d = 0; d < trajectory->dimensions; d++) {
        const double *a = find(trajectory, then, what, d), *b = find(trajectory, now, what, d);
        for (size_t k = 0; k < trajectory->count; k++)
            sum += what ? a[k] * b[k] : (b[k] - a[k]) * (b[k] - a[k]);
    }
    return sum / (double)trajectory->count;
}

static void correlate_all(const struct trajectory *trajectory, int what, int origins,
                          double curve[LAGS + 1]) {
    for (int lag = 0; lag <= LAGS; lag++) {
        curve[lag] = 0;
        for (int o = 0; o < origins; o++)
            curve[lag] += correlate(trajectory, what, o * ORIGIN_EVERY, o * ORIGIN_EVERY + lag);
        curve[lag] /= origins;
    }
}

/// Slope by the normal equations, over lags 13 … LAGS, half of the window.
static double fit_slope(const double curve[LAGS + 1], double spacing) {
    double n = 0, t = 0, y = 0, tt = 0, ty = 0;
    for (int lag = 13; lag <= LAGS; lag++) {
        n += 1;
        t += lag * spacing;
        y += curve[lag];
        tt += lag * spacing * lag * spacing;
        ty += lag * spacing * curve[lag];
    }
    return (n * ty - t * y) / (n * tt - t * t);
}

static void assert_motion(const struct simulation_setup *setup) {
    const struct motion_plan plan = {EVERY, LAGS, ORIGIN_EVERY};
    // Samples of other things fall on the same steps now and then.
    const struct measure_plan when = {.equilibration = EQUILIBRATION, .samples = 99, .every = 10};
    struct trajectory trajectory;
    struct simulation simulation;
    struct motion motion;
    struct thermodynamics thermodynamics;
    double c[4][LAGS + 1], msd[LAGS + 1], vacf[LAGS + 1], temperature, integral = 0;
    const struct motion_curves curves = {c[0], c[1], c[2], c[3]};
    make_trajectory(&trajectory, setup);
    centre(&trajectory);
    assert_ok(mf_simulation_init(&simulation, setup, NULL));
    assert_ok(mf_motion_init(&motion, &plan, &simulation, EQUILIBRATION, 990));
    mf_thermodynamics_init(&thermodynamics);
    assert_ok(mf_measure_equilibrate(&simulation, &when, &temperature, NULL));
    const struct watched observables = {.thermodynamics = &thermodynamics, .motion = &motion};
    assert_ok(watched_sample(&simulation, &when, observables, NULL));
    const struct motion_summary s = mf_motion_result(&motion, &curves);
    // Whole windows begin at 0, 4, … 304: 77 of them, of which 64 blocks of equal size take 76.
    assert_int_equal(motion.blocks * motion.each, 76);
    correlate_all(&trajectory, 0, 76, msd);
    correlate_all(&trajectory, 1, 76, vacf);
    for (int lag = 0; lag <= LAGS; lag++) {
        assert_close(c[0][lag], msd[lag], rounding);
        assert_close(c[2][lag], vacf[lag], rounding);
        assert_true(c[3][lag] > 0);
        integral += (lag == 0 || lag == LAGS ? 0.5 : 1) * vacf[lag];
    }
    const double spacing = EVERY * setup->time_step;
    const int dimensions = setup->box.dimensions;
    assert_close(s.msd, fit_slope(msd, spacing) / (2 * dimensions), 100 * rounding);
    assert_close(s.green_kubo, integral * spacing / dimensions, rounding);
    // The list was built, and particles sorted, many times; some have changed boxes.
    assert_true(simulation.list_builds > 50);
    mf_thermodynamics_clear(&thermodynamics);
    mf_motion_clear(&motion);
    mf_simulation_clear(&simulation);
    mf_memory_free(trajectory.values);
}

static void test_motion_equals_that_of_a_stored_trajectory(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_groot_warren(&fluid, 300, 0.04);
    assert_motion(&fluid.setup);
    fluid.setup.threads = 2;
    assert_motion(&fluid.setup);
    fluid_clear(&fluid);
}

static void test_motion_equals_that_of_a_stored_trajectory_in_the_plane(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_soft_discs(&fluid, 157, 0.04);
    assert_motion(&fluid.setup);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_motion_equals_that_of_a_stored_trajectory),
        cmocka_unit_test(test_motion_equals_that_of_a_stored_trajectory_in_the_plane),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
