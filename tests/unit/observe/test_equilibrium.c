// SPDX-License-Identifier: GPL-3.0-or-later
//
// Series of known correlation: x_t = r x_{t−1} + noise has n (1 − r)/(1 + r) independent values.
#include "base/rng.h"
#include "observe/equilibration.h"
#include "shared/testing.h"

#include <math.h>

enum { SAMPLES = 200, SERIES = 400 };

/// About a mean of −3, with a variance of 1.
static void make_series(double x[SAMPLES], double r, uint32_t number) {
    double last = 0;
    for (uint32_t t = 0; t < SAMPLES; t++) {
        double normal[4];
        mf_rng_normal4(mf_rng_philox(7, RNG_INITIAL, t, number, 0), normal);
        last = t == 0 ? normal[0] : r * last + sqrt(1 - r * r) * normal[0];
        x[t] = last - 3;
    }
}

/// Of SERIES, with a linear trend over `drift` standard deviations.
static int count_complaints(double independent, double drift) {
    const double r = (SAMPLES / independent - 1) / (SAMPLES / independent + 1);
    int complaints = 0;
    for (uint32_t n = 0; n < SERIES; n++) {
        double x[SAMPLES];
        make_series(x, r, n);
        for (int t = 0; t < SAMPLES; t++)
            x[t] += drift * t / SAMPLES;
        complaints += mf_equilibration_check("energy", "k_B T_0", x, SAMPLES) != STATUS_OK;
    }
    return complaints;
}

/// False alarms: 4 sigma of either half are 1 in 16000 of normal numbers, more with the errors of
/// 20 independent ones each. Among 4000 series of a program of its own 0, 3 and 26 were told.
static void test_equilibrium_check_is_content_with_series_in_equilibrium(void **state) {
    (void)state;
    assert_in_range(count_complaints(200, 0), 0, 1);
    assert_in_range(count_complaints(100, 0), 0, 2);
    assert_in_range(count_complaints(40, 0), 0, 8);
}

static void test_equilibrium_check_complains_of_what_remembers_its_begin_for_long(void **state) {
    (void)state;
    assert_in_range(count_complaints(2, 0), (88 * SERIES) / 100, SERIES);
}

/// Three times the scatter of the samples is a trend that anyone sees. Of twice, 378 were told.
static void test_equilibrium_check_complains_of_a_drift(void **state) {
    (void)state;
    assert_in_range(count_complaints(200, 3), (99 * SERIES) / 100, SERIES);
    assert_in_range(count_complaints(40, 4), (99 * SERIES) / 100, SERIES);
}

/// What decays in the first tenth is seen though the rest is long.
static void test_equilibrium_check_complains_of_a_begin_that_differs(void **state) {
    (void)state;
    int complaints = 0;
    for (uint32_t n = 0; n < SERIES; n++) {
        double x[SAMPLES];
        make_series(x, 0, n);
        for (int t = 0; t < SAMPLES; t++)
            x[t] += 15 * exp(-t / (0.1 * SAMPLES));
        complaints += mf_equilibration_check("energy", "k_B T_0", x, SAMPLES) != STATUS_OK;
    }
    assert_in_range(complaints, (95 * SERIES) / 100, SERIES);
}

static void test_equilibrium_check_names_what_it_complains_of(void **state) {
    (void)state;
    double x[SAMPLES];
    for (int t = 0; t < SAMPLES; t++)
        x[t] = (t < SAMPLES / 2 ? 1 : 2) + 0.01 * (t % 3);
    assert_fails(mf_equilibration_check("pressure", "k_B T_0/lambda^d", x, SAMPLES),
                 STATUS_UNCONVERGED, "the pressure is 1.0099 +- ");
    assert_contains(mf_status_message(), " and 2.01 +- ");
}

static void test_equilibrium_check_leaves_constants_alone(void **state) {
    (void)state;
    double x[SAMPLES];
    for (int t = 0; t < SAMPLES; t++)
        x[t] = 5e8 + 1e-3 * t; // as sums of doubles drift
    assert_ok(mf_equilibration_check("energy", "k_B T_0", x, SAMPLES));
    assert_ok(mf_equilibration_check("energy", "k_B T_0", x, 0));
}

static void test_equilibrium_check_says_that_few_samples_do_not_tell(void **state) {
    (void)state;
    double x[SAMPLES];
    for (int t = 0; t < SAMPLES; t++)
        x[t] = t % 2;
    assert_fails(mf_equilibration_check("energy", "k_B T_0", x, 19), STATUS_UNCONVERGED,
                 "too few samples of the energy (19)");
    assert_ok(mf_equilibration_check("energy", "k_B T_0", x, 20));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_equilibrium_check_is_content_with_series_in_equilibrium),
        cmocka_unit_test(test_equilibrium_check_complains_of_what_remembers_its_begin_for_long),
        cmocka_unit_test(test_equilibrium_check_complains_of_a_drift),
        cmocka_unit_test(test_equilibrium_check_complains_of_a_begin_that_differs),
        cmocka_unit_test(test_equilibrium_check_names_what_it_complains_of),
        cmocka_unit_test(test_equilibrium_check_leaves_constants_alone),
        cmocka_unit_test(test_equilibrium_check_says_that_few_samples_do_not_tell),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
