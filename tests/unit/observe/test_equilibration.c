// SPDX-License-Identifier: GPL-3.0-or-later
//
// Series of known correlation, x_t = r x_{t−1} + noise, with and without a beginning of known
// length.
#include "base/rng.h"
#include "observe/equilibration.h"
#include "shared/testing.h"

#include <math.h>

enum { SAMPLES = 500, SERIES = 500 };

/// A variance of 1 and a memory of `memory` samples; the first value is the stationary one.
static void make_series(double x[SAMPLES], double memory, uint32_t number) {
    const double r = memory > 0 ? exp(-1 / memory) : 0;
    double last = 0;
    for (uint32_t t = 0; t < SAMPLES; t++) {
        double normal[4];
        mf_rng_normal4(mf_rng_philox(11, RNG_INITIAL, t, number, 0), normal);
        last = t == 0 ? normal[0] : r * last + sqrt(1 - r * r) * normal[0];
        x[t] = last;
    }
}

/// At most 1 of 100 series in equilibrium loses a sample, 5 of 500.
static void test_equilibration_keeps_series_in_equilibrium(void **state) {
    (void)state;
    static const double memory[] = {0, 2, 8, 25};
    for (size_t m = 0; m < 4; m++) {
        int lost = 0;
        for (uint32_t n = 0; n < SERIES; n++) {
            double x[SAMPLES];
            make_series(x, memory[m], n);
            lost += mf_equilibration_length(x, SAMPLES) > 0;
        }
        assert_in_range(lost, 0, SERIES / 100);
    }
}

/// An offset of 8 standard deviations that decays with a time of 10 samples is one after 10 ln 8 =
/// 21. Of 500 series 470 lose between 8 and 61 samples, and none keeps all.
static void test_equilibration_leaves_out_what_decays(void **state) {
    (void)state;
    int right = 0;
    for (uint32_t n = 0; n < SERIES; n++) {
        double x[SAMPLES];
        make_series(x, 2, n);
        for (int t = 0; t < SAMPLES; t++)
            x[t] += 8 * exp(-t / 10.0);
        const size_t start = mf_equilibration_length(x, SAMPLES);
        assert_true(start > 0);
        right += start >= 8 && start <= 61;
    }
    assert_in_range(right, 90 * SERIES / 100, SERIES);
}

/// One sample alone, and constants.
static void test_equilibration_of_short_and_constant_beginnings(void **state) {
    (void)state;
    double x[SAMPLES] = {0};
    assert_int_equal(mf_equilibration_length(x, SAMPLES), 0);
    // A box that is written with other digits in the first frame.
    for (int t = 0; t < SAMPLES; t++)
        x[t] = t == 0 ? 27.000003 : 27;
    assert_int_equal(mf_equilibration_length(x, SAMPLES), 0);
    x[0] = 27.3;
    assert_int_equal(mf_equilibration_length(x, SAMPLES), 1);
    make_series(x, 0, 1);
    x[0] = 50;
    assert_in_range(mf_equilibration_length(x, SAMPLES), 1, 3);
    assert_int_equal(mf_equilibration_length(x, 19), 0);
}

/// Five overlaps in one of the first 10 of 500 frames; a single one may be chance, and so may one
/// pair that stays for 200 frames.
static void test_equilibration_length_of_events_needs_more_than_chance(void **state) {
    (void)state;
    double events[SAMPLES] = {0};
    events[9] = 5;
    assert_int_equal(mf_equilibration_length_of_events(events, SAMPLES), 10);
    events[9] = 1;
    assert_int_equal(mf_equilibration_length_of_events(events, SAMPLES), 0);
    for (int t = 0; t < 200; t++)
        events[t] = 1;
    assert_int_equal(mf_equilibration_length_of_events(events, SAMPLES), 0);
    events[0] = 9;
    assert_int_equal(mf_equilibration_length_of_events(events, SAMPLES), 0);
    events[400] = 1;
    assert_int_equal(mf_equilibration_length_of_events(events, SAMPLES), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_equilibration_keeps_series_in_equilibrium),
        cmocka_unit_test(test_equilibration_leaves_out_what_decays),
        cmocka_unit_test(test_equilibration_of_short_and_constant_beginnings),
        cmocka_unit_test(test_equilibration_length_of_events_needs_more_than_chance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
