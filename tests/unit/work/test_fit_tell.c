// SPDX-License-Identifier: GPL-3.0-or-later
//
// The words of an iteration's progress.
#include "shared/testing.h"
#include "work/fit_tell.h"

#include <math.h>

static const struct inverse_progress nothing = {
    .iteration = 3, .best = NAN, .least = NAN, .mean = NAN};

static void assert_says(const struct inverse_progress *now, const struct units *units,
                        const char *expected) {
    char text[FIT_TELL_SIZE];
    mf_fit_tell_iteration(now, units, text);
    assert_string_equal(text, expected);
}

static void test_iteration_tells_the_errors_that_it_knows(void **state) {
    (void)state;
    const struct units units = {0};
    struct inverse_progress now = nothing;
    assert_says(&now, &units, "iteration 3");
    now.best = 0.01234;
    assert_says(&now, &units, "iteration 3  error 0.0123 so far");
    now.least = 0.02, now.mean = 0.5, now.failures = 2;
    assert_says(&now, &units,
                "iteration 3  error 0.0123 so far  now least 0.0200  mean 0.5000  failed 2");
}

/// Integrals have a unit, in which the files speak: here 2 nm is the unit of length.
static void test_iteration_tells_of_samples_that_are_doubled(void **state) {
    (void)state;
    struct units units = {0};
    struct inverse_progress now = nothing;
    now.best = 0.01234;
    now.doubling = (struct inverse_doubling){3, 7, 0.00641, 0.004, ""};
    assert_says(&now, &units, "iteration 3  doubling samples, 3 of 7: noise 0.0064, wanted 0.004");
    units = (struct units){.system = UNITS_NM_PS, .length = 2, .dimensions = 3};
    assert_says(&now, &units, "iteration 3  doubling samples, 3 of 7: noise 0.0064, wanted 0.004");
    now.doubling.unit = "lambda^d";
    assert_says(&now, &units,
                "iteration 3  doubling samples, 3 of 7: noise 0.051, wanted 0.032 nm^3");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_iteration_tells_the_errors_that_it_knows),
        cmocka_unit_test(test_iteration_tells_of_samples_that_are_doubled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
