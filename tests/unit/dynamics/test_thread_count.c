// SPDX-License-Identifier: GPL-3.0-or-later
// As many threads are used as pay, and it is found out when that has changed.
#include "dynamics/thread_count.h"

#include "shared/testing.h"

// Steps of which a share of 1 in `spike` takes ten times as long, as lists are built.
static int steps_with_most(struct thread_count *count, int steps, uint64_t many, uint64_t one) {
    int with_most = 0;
    for (int k = 0; k < steps; k++) {
        with_most += count->now == count->max;
        mf_thread_count_update(count,
                               (count->now == count->max ? many : one) * (k % 3 == 0 ? 10 : 1));
    }
    return with_most;
}

static void one_thread_stays_one(void **state) {
    (void)state;
    struct thread_count count;
    mf_thread_count_init(&count, 1);
    assert_int_equal(steps_with_most(&count, 1000, 1, 1), 1000);
    assert_int_equal(count.now, 1);
}

static void threads_that_pay_are_taken(void **state) {
    (void)state;
    struct thread_count count;
    mf_thread_count_init(&count, 4);
    // Nine steps of a trial are tried with one thread: at most one trial in 128 steps.
    assert_true(steps_with_most(&count, 10000, 100, 300) >= 10000 - 9 * 8);
}

static void threads_that_hinder_are_left_out(void **state) {
    (void)state;
    struct thread_count count;
    mf_thread_count_init(&count, 2);
    assert_true(steps_with_most(&count, 10000, 300, 100) <= 9 * 8);
}

static void a_change_is_found(void **state) {
    (void)state;
    struct thread_count count;
    mf_thread_count_init(&count, 2);
    steps_with_most(&count, 1000, 300, 100);
    steps_with_most(&count, THREAD_COUNT_LONGEST + 100, 100, 300);
    assert_int_equal(count.better, 2);
    steps_with_most(&count, THREAD_COUNT_LONGEST + 100, 300, 100);
    assert_int_equal(count.better, 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_thread_stays_one),
        cmocka_unit_test(threads_that_pay_are_taken),
        cmocka_unit_test(threads_that_hinder_are_left_out),
        cmocka_unit_test(a_change_is_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
