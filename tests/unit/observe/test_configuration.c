// SPDX-License-Identifier: GPL-3.0-or-later
//
// Observables are told what a simulation holds, and of a trajectory what they ask for, or are not
// begun.
#include "observe/measure.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"

static const struct measure_plan plan = {.samples = 10, .every = 5};

static void test_configuration_is_what_a_simulation_holds(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    fluid_groot_warren(&fluid, 200, 0.02);
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    const struct configuration now = mf_configuration_of(&simulation);
    assert_ptr_equal(now.simulation, &simulation);
    assert_ptr_equal(now.particles, &simulation.particles);
    assert_ptr_equal(now.composition, &simulation.setup.composition);
    assert_null(now.molecules);
    assert_int_equal(now.dimensions, 3);
    assert_true(now.time_step == fluid.setup.time_step && !now.sweeps);
    assert_true(now.temperature == fluid.setup.temperature);
    assert_true(now.box.volume == mf_box_volume(&fluid.setup.box));
    double share[200];
    mf_configuration_shares(&now, 1, share);
    for (size_t k = 0; k < now.count; k++)
        assert_close(share[now.particles->id[k]] * fluid.setup.box.length[1],
                     now.particles->position[1][k], 1e-12);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

static void test_configuration_of_a_trajectory_has_beads_in_the_order_of_types(void **state) {
    (void)state;
    int32_t place[3] = {INT32_MIN, 0, 1 << 30}, *const fraction[3] = {NULL, NULL, place};
    const struct configuration frame = {.dimensions = 3, .count = 3, .fraction = fraction};
    double share[3];
    mf_configuration_shares(&frame, 2, share);
    assert_close(share[0], -0.5, 0);
    assert_close(share[1], 0, 0);
    assert_close(share[2], 0.25, 0);
}

/// By molecules that a trajectory tells of, or by what the topology of a simulation excludes.
static void test_configuration_leaves_out_what_is_no_pair(void **state) {
    (void)state;
    const uint32_t molecule[] = {7, 8, 7};
    const struct configuration frame = {.count = 3, .molecule = molecule};
    assert_true(mf_configuration_leaves_out(&frame, 0, 2));
    assert_false(mf_configuration_leaves_out(&frame, 0, 1));
    size_t start[] = {0, 1, 2, 2};
    uint32_t excluded[] = {1, 0};
    const struct topology chain = {.excluded_start = start, .excluded = excluded};
    const struct particles joined = {.count = 3, .topology = &chain}, single = {.count = 3};
    const struct configuration of_chain = {.count = 3, .particles = &joined};
    const struct configuration of_singles = {.count = 3, .particles = &single};
    assert_true(mf_configuration_leaves_out(&of_chain, 0, 1));
    assert_true(mf_configuration_leaves_out(&of_chain, 1, 0));
    assert_false(mf_configuration_leaves_out(&of_chain, 1, 2));
    assert_false(mf_configuration_leaves_out(&of_singles, 0, 1));
}

/// Nothing of them is called: what a trajectory has not would be read.
static void test_configuration_of_a_trajectory_is_refused_by_who_asks_for_more(void **state) {
    (void)state;
    const struct configuration frame = {.dimensions = 3};
    size_t refused = 0;
    for (size_t k = 0; mf_observables[k]; k++) {
        struct observable_use use = {.observable = mf_observables[k]};
        if (mf_observables[k]->of_places)
            continue;
        assert_fails(mf_observable_begin(&use, &frame, &plan), STATUS_BAD_INPUT,
                     mf_observables[k]->name);
        assert_null(use.state);
        refused++;
    }
    assert_true(refused > 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_configuration_is_what_a_simulation_holds),
        cmocka_unit_test(test_configuration_of_a_trajectory_has_beads_in_the_order_of_types),
        cmocka_unit_test(test_configuration_leaves_out_what_is_no_pair),
        cmocka_unit_test(test_configuration_of_a_trajectory_is_refused_by_who_asks_for_more),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
