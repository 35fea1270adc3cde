// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/rng.h"
#include "shared/hotelling.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <gsl/gsl_cdf.h>
#include <math.h>

enum { SIZE = 3, SAMPLES = 12, TRIALS = 4000 };

/// Standard errors of a fraction of TRIALS: a false alarm in 2 of 10^7 fixed seeds.
static const double deviations = 5;

/// Correlated normal samples whose last component has the mean `shift`.
static void draw(struct comoments *samples, uint32_t trial, uint32_t set, double shift) {
    mf_comoments_reset(samples);
    for (uint32_t k = 0; k < SAMPLES; k++) {
        double normal[4];
        mf_rng_normal4(mf_rng_philox(5, RNG_INITIAL, trial, set, k), normal);
        mf_comoments_add(samples, (double[SIZE]){normal[0], normal[0] + 0.3 * normal[1],
                                                 normal[2] - normal[1] + shift});
    }
}

/// Fractions of trials with p below `level`: of one sample, and of two.
static void find_alarms(double shift, double level, double *one, double *two) {
    struct comoments first, second;
    assert_ok(mf_comoments_init(&first, SIZE));
    assert_ok(mf_comoments_init(&second, SIZE));
    *one = *two = 0;
    for (uint32_t trial = 0; trial < TRIALS; trial++) {
        draw(&first, trial, 0, shift);
        draw(&second, trial, 1, 0);
        *one += (hotelling_one_sample(&first, (double[SIZE]){0}) < level) / (double)TRIALS;
        *two += (hotelling_two_samples(&first, &second) < level) / (double)TRIALS;
    }
    mf_comoments_clear(&first);
    mf_comoments_clear(&second);
}

static void test_hotelling_raises_the_stated_rate_of_alarms_when_means_are_equal(void **state) {
    (void)state;
    static const double levels[] = {0.5, 0.1, 0.01};
    for (int k = 0; k < 3; k++) {
        const double level = levels[k];
        const double error = sqrt(level * (1 - level) / TRIALS);
        double one, two;
        find_alarms(0, level, &one, &two);
        assert_close(one, level, deviations * error);
        assert_close(two, level, deviations * error);
    }
}

static void test_hotelling_raises_alarms_when_a_mean_is_off(void **state) {
    (void)state;
    double one, two;
    // The third component has standard deviation 1.4, its mean a standard error of 0.4.
    find_alarms(4, 0.001, &one, &two);
    assert_true(one > 0.9);
    assert_true(two > 0.9);
}

static void test_hotelling_is_student_when_there_is_one_number(void **state) {
    (void)state;
    struct comoments samples;
    assert_ok(mf_comoments_init(&samples, 1));
    for (int k = 0; k < 5; k++)
        mf_comoments_add(&samples, (double[]){k});
    // Mean 2, standard error sqrt(0.5): t = (2 − 0.5) / sqrt(0.5), both tails.
    const double t = 1.5 / sqrt(0.5);
    assert_close(hotelling_one_sample(&samples, (double[]){0.5}), 2 * gsl_cdf_tdist_Q(t, 4), 1e-12);
    struct comoments others;
    assert_ok(mf_comoments_init(&others, 1));
    for (int k = 0; k < 3; k++)
        mf_comoments_add(&others, (double[]){4 * k});
    // Mean 4; pooled variance (10 + 32)/6 = 7, of the difference 7 (1/5 + 1/3).
    const double t2 = 2 / sqrt(7 * (1.0 / 5 + 1.0 / 3));
    assert_close(hotelling_two_samples(&samples, &others), 2 * gsl_cdf_tdist_Q(t2, 6), 1e-12);
    mf_comoments_clear(&others);
    mf_comoments_clear(&samples);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_hotelling_raises_the_stated_rate_of_alarms_when_means_are_equal),
        cmocka_unit_test(test_hotelling_raises_alarms_when_a_mean_is_off),
        cmocka_unit_test(test_hotelling_is_student_when_there_is_one_number),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
