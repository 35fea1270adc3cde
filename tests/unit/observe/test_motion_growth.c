// SPDX-License-Identifier: GPL-3.0-or-later
//
// Whether beads diffuse, by paths of a known law: fractional Brownian motion, whose MSD is t^2H at
// every t. Its steps are Gaussian and correlated by (|k+1|^2H − 2|k|^2H + |k−1|^2H)/2; they are
// drawn by circulant embedding: R. B. Davies and D. S. Harte, Biometrika 74, 95 (1987).
#include "observe/motion.h"
#include "base/statistics.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <gsl/gsl_fft_complex.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS = 1024, CIRCLE = 2 * STEPS };

/// Square roots of the eigenvalues of the circulant matrix of correlations.
static void find_amplitudes(double hurst, double amplitude[CIRCLE]) {
    double values[2 * CIRCLE];
    for (int k = 0; k < CIRCLE; k++) {
        const double lag = k <= STEPS ? k : CIRCLE - k, power = 2 * hurst;
        values[2 * k] =
            0.5 * (pow(lag + 1, power) - 2 * pow(lag, power) + pow(fabs(lag - 1), power));
        values[2 * k + 1] = 0;
    }
    gsl_fft_complex_radix2_forward(values, 1, CIRCLE);
    for (int k = 0; k < CIRCLE; k++)
        amplitude[k] = sqrt(fmax(values[2 * k], 0) / CIRCLE);
}

/// Two independent paths: real and imaginary part. shape [STEPS] of each
static void draw_paths(gsl_rng *rng, const double amplitude[CIRCLE], double *one, double *two) {
    double values[2 * CIRCLE], x = 0, y = 0;
    for (int k = 0; k < 2 * CIRCLE; k++)
        values[k] = amplitude[k / 2] * gsl_ran_gaussian_ziggurat(rng, 1);
    gsl_fft_complex_radix2_forward(values, 1, CIRCLE);
    for (int k = 0; k < STEPS; k++) {
        one[k] = x += values[2 * k];
        two[k] = y += values[2 * k + 1];
    }
}

struct series {
    double hurst;
    size_t beads; ///< even
    int windows;  ///< in each
    int many;
};

struct found {
    double early;                          ///< share of the series
    struct running_mean growth, deviation; ///< of the exponent, and over its error
};

static struct found look_at(const struct series *made) {
    const int64_t lags = STEPS / made->windows;
    const struct motion_plan plan = {.every = 1, .lags = lags, .origin_every = lags / 5};
    const size_t numbers = 3 * made->beads;
    struct found found = {0};
    double amplitude[CIRCLE];
    double *const paths = calloc(numbers * STEPS, sizeof *paths);
    double *const state = calloc(2 * numbers, sizeof *state);
    gsl_rng *const rng = gsl_rng_alloc(gsl_rng_mt19937);
    find_amplitudes(made->hurst, amplitude);
    for (int n = 0; n < made->many; n++) {
        struct motion motion;
        assert_ok(mf_motion_init_endless(&motion, &plan, made->beads, 1, false));
        for (size_t k = 0; k < numbers; k += 2)
            draw_paths(rng, amplitude, paths + k * STEPS, paths + (k + 1) * STEPS);
        for (size_t step = 0; step < STEPS; step++) {
            for (size_t k = 0; k < numbers; k++)
                state[k] = paths[k * STEPS + step];
            mf_motion_add(&motion, state, 1);
        }
        const struct motion_summary s = mf_motion_result(&motion, NULL);
        found.early += mf_motion_is_early(&s) ? 1.0 / made->many : 0;
        mf_statistics_add(&found.growth, s.growth);
        mf_statistics_add(&found.deviation, (s.growth - 2 * made->hurst) / s.growth_error);
        mf_motion_clear(&motion);
    }
    gsl_rng_free(rng);
    free(paths);
    free(state);
    return found;
}

/// Beads of which several hundred series can be drawn, and the least windows that `measure` takes.
static void test_brownian_motion_is_told_to_diffuse(void **state) {
    (void)state;
    static const struct series made[] = {
        {0.5, 2, 20, 1000}, {0.5, 16, 20, 200}, {0.5, 16, 60, 200}};
    for (size_t k = 0; k < sizeof made / sizeof *made; k++) {
        const struct found found = look_at(&made[k]);
        assert_true(found.early < 0.01);
        assert_close(found.growth.mean, 1, 0.01);
    }
}

/// Errors that overlapping windows are allowed to make a little large, but not more.
static void test_the_error_of_the_exponent_is_its_scatter(void **state) {
    (void)state;
    static const struct series made[] = {{0.4, 2, 20, 600}, {0.4, 16, 60, 150}, {0.5, 16, 60, 150}};
    for (size_t k = 0; k < sizeof made / sizeof *made; k++) {
        const struct found found = look_at(&made[k]);
        const double ratio = sqrt(found.deviation.squares / found.deviation.count);
        assert_true(ratio > 0.7 && ratio < 1.1);
    }
}

static void test_slower_motion_is_told_where_its_exponent_is_known(void **state) {
    (void)state;
    static const struct series made[] = {{0.4, 16, 60, 100}, {0.4, 100, 20, 40}};
    for (size_t k = 0; k < sizeof made / sizeof *made; k++)
        assert_true(look_at(&made[k]).early > 0.95);
}

/// Of one window nothing tells the error, and the exponent decides alone.
static void test_exponents_are_of_powers_and_not_of_lines(void **state) {
    (void)state;
    struct motion_summary s = {.growth = 0.8, .growth_error = NAN};
    assert_true(mf_motion_is_early(&s));
    s.growth = 0.9;
    assert_false(mf_motion_is_early(&s));
    s.growth = 1.4;
    assert_true(mf_motion_is_early(&s));
    // A line above 0, as of caged beads that have left: t^0.8 would bend by -6.5 %.
    s = (struct motion_summary){.growth = 0.8, .growth_error = 0.01, .bend_error = 0.012};
    assert_false(mf_motion_is_early(&s));
    s.bend_error = 0.02;
    assert_true(mf_motion_is_early(&s));
}

/// By Rouse's chain, whose D is 7 % too large where the MSD begins at 4 R_g².
static void test_beads_within_their_molecules_are_told_by_their_sizes(void **state) {
    (void)state;
    struct motion_summary s = {.growth = 1, .growth_error = 0.01, .sizes = 3.9};
    char text[MOTION_EARLY_SIZE];
    assert_true(mf_motion_is_within(&s) && mf_motion_is_early(&s));
    assert_string_equal(mf_motion_early_text(&s, text),
                        "no D yet: beads still move within their molecules");
    s.sizes = 4.1;
    assert_false(mf_motion_is_early(&s));
    s.bend = -0.2, s.bend_error = 0.06;
    assert_true(mf_motion_is_early(&s));
    assert_string_equal(mf_motion_early_text(&s, text),
                        "no D yet: the slope of the MSD still changes by -20 % along the window");
    s.bend_error = 0.07;
    assert_false(mf_motion_is_early(&s));
    s.bend = 0.04, s.bend_error = 0.001;
    assert_false(mf_motion_is_early(&s));
    s.sizes = 0; // no molecules
    assert_false(mf_motion_is_early(&s));
}

static void test_the_line_has_the_exponent_with_its_error(void **state) {
    (void)state;
    char text[MOTION_EARLY_SIZE];
    assert_string_equal(mf_motion_early_text(
                            &(struct motion_summary){.growth = 0.803, .growth_error = 0.021}, text),
                        "no D yet: the MSD still grows as t^0.803(21)");
    assert_string_equal(
        mf_motion_early_text(&(struct motion_summary){.growth = 1.998, .growth_error = 1e-9}, text),
        "no D yet: the MSD still grows as t^2.00");
    assert_string_equal(
        mf_motion_early_text(&(struct motion_summary){.growth = 0.803, .growth_error = 0.08}, text),
        "");
    assert_string_equal(
        mf_motion_early_text(&(struct motion_summary){.growth = 0.9, .growth_error = 0.01}, text),
        "");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_brownian_motion_is_told_to_diffuse),
        cmocka_unit_test(test_the_error_of_the_exponent_is_its_scatter),
        cmocka_unit_test(test_slower_motion_is_told_where_its_exponent_is_known),
        cmocka_unit_test(test_exponents_are_of_powers_and_not_of_lines),
        cmocka_unit_test(test_beads_within_their_molecules_are_told_by_their_sizes),
        cmocka_unit_test(test_the_line_has_the_exponent_with_its_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
