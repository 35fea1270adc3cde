// SPDX-License-Identifier: GPL-3.0-or-later
//
// The choice of the skin: where its answer is known without a clock.
#include "dynamics/skin.h"
#include "shared/is_close.h"
#include "shared/testing.h"

static const struct box cube = {3, {20, 20, 20}};

static struct skin_scene scene(double time_step, double temperature) {
    return (struct skin_scene){.box = &cube,
                               .count = 24000,
                               .cutoff = 1,
                               .temperature = temperature,
                               .time_step = time_step};
}

static void test_skin_interval_is_one_step_when_there_is_no_skin(void **state) {
    (void)state;
    const struct skin_scene fluid = scene(0.01, 1);
    assert_close(mf_skin_interval(&fluid, 0), 1, 0);
}

/// sqrt(2 ln 24001) = 4.49 thermal speeds: 0.2 λ, there and back, in 2.2 steps of 0.01.
static void test_skin_interval_is_the_time_of_flight_of_the_fastest(void **state) {
    (void)state;
    const struct skin_scene fluid = scene(0.01, 1);
    assert_close(mf_skin_interval(&fluid, 0.2), 0.2 / (2 * 4.4915 * 0.01) + 0.5, 1e-3);
}

static void test_skin_shrinks_when_particles_fly_farther_in_a_step(void **state) {
    (void)state;
    const struct skin_scene slow = scene(0.001, 1), usual = scene(0.01, 1), hot = scene(0.01, 4),
                            fast = scene(0.06, 4);
    assert_true(mf_skin_choose(&slow) > 0.1);
    assert_true(mf_skin_choose(&hot) >= mf_skin_choose(&usual));
    assert_close(mf_skin_choose(&fast), 0, 0); // a list that lasts a step needs no skin
}

static void test_skin_stays_within_the_nearest_images_when_the_box_is_small(void **state) {
    (void)state;
    static const struct box small = {3, {2.1, 2.2, 2.3}}, smallest = {3, {2, 2, 2}};
    const struct skin_scene tight = {&small, 30, 1, 1, 0.0001, 0, 0},
                            tightest = {&smallest, 24, 1, 1, 0.0001, 0, 0};
    assert_in_range(1000 * mf_skin_choose(&tight), 10, 50);
    assert_close(mf_skin_choose(&tightest), 0, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_skin_interval_is_one_step_when_there_is_no_skin),
        cmocka_unit_test(test_skin_interval_is_the_time_of_flight_of_the_fastest),
        cmocka_unit_test(test_skin_shrinks_when_particles_fly_farther_in_a_step),
        cmocka_unit_test(test_skin_stays_within_the_nearest_images_when_the_box_is_small),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
