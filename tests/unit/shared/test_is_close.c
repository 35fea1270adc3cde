// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

static void test_is_close_accepts_when_within_tolerance(void **state) {
    (void)state;
    assert_true(is_close(1, 1, 0));
    assert_true(is_close(1, 1.5, 0.5));
    assert_true(is_close(-1, -1.5, 0.5));
    assert_true(is_close_relative(1000, 1001, 1e-3));
}

static void test_is_close_refuses_when_beyond_tolerance(void **state) {
    (void)state;
    assert_false(is_close(1, 1.5, 0.49));
    assert_false(is_close(1.5, 1, 0.49));
    assert_false(is_close(1, -1, 1.9));
    assert_false(is_close_relative(1000, 1002, 1e-3));
    assert_false(is_close_relative(0, 1e-300, 1e-3));
}

static void test_is_close_refuses_when_a_number_is_not_finite(void **state) {
    (void)state;
    assert_false(is_close(1, INFINITY, 1e300));
    assert_false(is_close(INFINITY, INFINITY, 1));
    assert_false(is_close(1, NAN, 1));
    assert_false(is_close(NAN, NAN, 1));
    assert_false(is_close(1, 1, NAN));
    assert_false(is_close(1, 2, INFINITY));
    assert_false(is_close_relative(1, INFINITY, 1));
    assert_false(is_close_relative(NAN, 1, 1));
}

static void test_is_identical_compares_bits_when_values_are_equal(void **state) {
    (void)state;
    assert_true(is_identical(0.1, 0.1));
    assert_true(is_identical(NAN, NAN));
    assert_false(is_identical(0.0, -0.0));
    assert_false(is_identical(1, nextafter(1, 2)));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_is_close_accepts_when_within_tolerance),
        cmocka_unit_test(test_is_close_refuses_when_beyond_tolerance),
        cmocka_unit_test(test_is_close_refuses_when_a_number_is_not_finite),
        cmocka_unit_test(test_is_identical_compares_bits_when_values_are_equal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
