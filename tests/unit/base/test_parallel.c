// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel.h"

#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

enum { COUNT = 100003 };
static double values[COUNT];
static int visits[COUNT];

static void visit(void *context, size_t begin, size_t end) {
    (void)context;
    for (size_t k = begin; k < end; k++)
        visits[k]++;
}

static double add_up(const void *context, size_t begin, size_t end) {
    const double *value = context;
    double sum = 0;
    for (size_t k = begin; k < end; k++)
        sum += value[k];
    return sum;
}

static void test_parallel_for_visits_each_element_once_when_threads_are_many(void **state) {
    (void)state;
    for (int threads = 1; threads <= 5; threads++)
        mf_parallel_for(COUNT, threads, visit, NULL);
    for (size_t k = 0; k < COUNT; k++)
        assert_int_equal(visits[k], 5);
}

static void test_parallel_sum_has_the_same_bits_for_any_threads(void **state) {
    (void)state;
    for (size_t k = 0; k < COUNT; k++)
        values[k] = sin((double)k) * exp(10 * cos(3.0 * (double)k));
    for (size_t count = 0; count <= COUNT; count = 3 * count + 1) {
        const double one = mf_parallel_sum(count, 1, add_up, values);
        assert_close(one, add_up(values, 0, count), 1e-6);
        for (int threads = 2; threads <= 5; threads++)
            assert_identical(mf_parallel_sum(count, threads, add_up, values), one);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_parallel_for_visits_each_element_once_when_threads_are_many),
        cmocka_unit_test(test_parallel_sum_has_the_same_bits_for_any_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
