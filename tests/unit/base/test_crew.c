// SPDX-License-Identifier: GPL-3.0-or-later
// A crew takes as many threads as pay, and finds out when that has changed.
#include "base/crew.h"

#include "shared/testing.h"

// Turns of which a share of 1 in `spike` takes ten times as long, as lists are built.
static int turns_with_most(struct crew *crew, int turns, uint64_t many, uint64_t one) {
    int with_most = 0;
    for (int k = 0; k < turns; k++) {
        with_most += crew->now == crew->most;
        mf_crew_end_turn(crew, (crew->now == crew->most ? many : one) * (k % 3 == 0 ? 10 : 1));
    }
    return with_most;
}

static void one_thread_stays_one(void **state) {
    (void)state;
    struct crew crew;
    mf_crew_init(&crew, 1);
    assert_int_equal(turns_with_most(&crew, 1000, 1, 1), 1000);
    assert_int_equal(crew.now, 1);
}

static void threads_that_pay_are_taken(void **state) {
    (void)state;
    struct crew crew;
    mf_crew_init(&crew, 4);
    // Nine turns of a trial are tried with one thread: at most one trial in 128 turns.
    assert_true(turns_with_most(&crew, 10000, 100, 300) >= 10000 - 9 * 8);
}

static void threads_that_hinder_are_left_out(void **state) {
    (void)state;
    struct crew crew;
    mf_crew_init(&crew, 2);
    assert_true(turns_with_most(&crew, 10000, 300, 100) <= 9 * 8);
}

static void a_change_is_found(void **state) {
    (void)state;
    struct crew crew;
    mf_crew_init(&crew, 2);
    turns_with_most(&crew, 1000, 300, 100);
    turns_with_most(&crew, CREW_LONGEST_REST + 100, 100, 300);
    assert_int_equal(crew.better, 2);
    turns_with_most(&crew, CREW_LONGEST_REST + 100, 300, 100);
    assert_int_equal(crew.better, 1);
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
