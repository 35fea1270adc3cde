// SPDX-License-Identifier: GPL-3.0-or-later
//
// How long tasks take several workers, by the model of discrete events.
#include "shared/testing.h"
#include "work/fit_tasks.h"

#include <math.h>

static void test_equal_tasks_take_as_many_turns_as_it_needs(void **state) {
    (void)state;
    for (int workers = 1; workers <= 20; workers++)
        for (size_t tasks = 1; tasks <= 40; tasks++) {
            const double turns = ceil((double)tasks / workers);
            assert_true(fabs(mf_fit_tasks_span(tasks, 0.5, 0, workers) - 0.5 * turns) < 1e-12);
        }
}

/// One worker does everything, and as many as there are tasks wait for the longest: the mean of the
/// largest of n log-normal times, here by the integral of 1 − P(all are shorter).
static double longest(size_t tasks, double mean, double spread) {
    const double width = sqrt(log1p(spread * spread / (mean * mean)));
    const double middle = log(mean) - width * width / 2;
    const double step = mean / 2000, end = 40 * mean;
    double sum = 0;
    for (double x = step / 2; x < end; x += step)
        sum += step * (1 - pow(0.5 * erfc(-(log(x) - middle) / (width * M_SQRT2)), (double)tasks));
    return sum;
}

static void test_scattered_tasks_wait_for_the_longest(void **state) {
    (void)state;
    for (size_t tasks = 4; tasks <= 64; tasks *= 4) {
        const double exact = longest(tasks, 2, 1);
        // 200 draws of the longest of a few, whose standard deviation is about its mean's half.
        assert_true(fabs(mf_fit_tasks_span(tasks, 2, 1, 1000) / exact - 1) < 0.1);
        assert_true(fabs(mf_fit_tasks_span(tasks, 2, 1, 1) / (2 * (double)tasks) - 1) < 0.1);
    }
}

/// A worker more never makes it longer; what all wait for is at least the share of each.
static void test_more_workers_are_never_slower(void **state) {
    (void)state;
    double before = INFINITY;
    for (int workers = 1; workers <= 64; workers *= 2) {
        const double now = mf_fit_tasks_span(50, 1, 0.4, workers);
        assert_true(now <= before && now > 0.98 * 50 / workers);
        before = now;
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_equal_tasks_take_as_many_turns_as_it_needs),
        cmocka_unit_test(test_scattered_tasks_wait_for_the_longest),
        cmocka_unit_test(test_more_workers_are_never_slower),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
