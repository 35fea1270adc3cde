// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/checkpoint.h"
#include "shared/testing.h"

static void test_quick_saves_come_at_their_interval(void **state) {
    struct checkpoint_pace pace = {.interval = 60};
    (void)state;
    mf_checkpoint_pace_saved(&pace, 100, 100.01);
    assert_true(pace.next == 160.01);
}

/// A save that takes longer than the interval: the clock begins after it, and saving takes a
/// hundredth of the time.
static void test_slow_saves_take_a_hundredth_of_the_time(void **state) {
    struct checkpoint_pace pace = {.interval = 60};
    double now = 0, saving = 0;
    (void)state;
    for (int k = 0; k < 100; k++) {
        const double took = 1 + k; // it grows with what was sampled
        mf_checkpoint_pace_saved(&pace, now, now + took);
        saving += took;
        assert_true(pace.next - (now + took) >= 60);
        now = pace.next;
        assert_true(saving <= 0.01 * now * (1 + 1e-12));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_quick_saves_come_at_their_interval),
        cmocka_unit_test(test_slow_saves_take_a_hundredth_of_the_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
