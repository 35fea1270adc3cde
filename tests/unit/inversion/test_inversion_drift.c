// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_drift.h"

#include "shared/testing.h"

static bool drifts(int iterations, double step, double error, double factor) {
    struct inversion_drift drift = {0};
    for (int k = 0; k < iterations; k++, error *= factor)
        mf_inversion_drift_add(&drift, k * step, error);
    return mf_inversion_drifts(&drift, 1);
}

static void test_inversion_drifts_when_the_ramp_grows_and_helps_nothing(void **state) {
    (void)state;
    assert_true(drifts(5, 1, 0.012, 0.98));
    assert_true(drifts(12, -0.6, 0.01, 1));
    assert_true(drifts(8, 1, 0.01, 1.1));
}

static void test_inversion_does_not_drift_when_it_gets_anywhere(void **state) {
    (void)state;
    assert_false(drifts(4, 1, 0.012, 1));   // too early to tell
    assert_false(drifts(12, 1, 0.1, 0.9));  // the error becomes less
    assert_false(drifts(12, 0.3, 0.01, 1)); // a short way
    assert_false(drifts(12, 0, 0.01, 1));
}

static void test_inversion_does_not_drift_to_and_fro(void **state) {
    (void)state;
    struct inversion_drift drift = {0};
    for (int k = 0; k < 20; k++) {
        mf_inversion_drift_add(&drift, k % 2 ? 3 : -3, 0.01);
        assert_false(mf_inversion_drifts(&drift, 1));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_inversion_drifts_when_the_ramp_grows_and_helps_nothing),
        cmocka_unit_test(test_inversion_does_not_drift_when_it_gets_anywhere),
        cmocka_unit_test(test_inversion_does_not_drift_to_and_fro),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
