// SPDX-License-Identifier: GPL-3.0-or-later
//
// "conserved": particles, momentum and energy of dynamics that keep them, with rotations by one
// angle and by any, in the plane and in space; and of a gravity, which changes both as it must.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const char plane[] =
    "{\"seed\": 1, \"dimensions\": 2, \"box\": [16, 8], \"particles\": {\"count\": 0}, "
    "\"temperature\": 1, \"time_step\": 0.5, \"dynamics\": {\"integrator\": "
    "\"collision-dynamics\", \"particles_per_cell\": 8, \"angle\": 130}, "
    "\"measure\": {\"equilibration\": 0, \"samples\": 40, \"every\": 1}, \"conserved\": {}}";
static const char space[] =
    "{\"seed\": 1, \"box\": [6, 6, 6], \"particles\": {\"count\": 0}, \"temperature\": 1, "
    "\"time_step\": 0.5, \"dynamics\": {\"integrator\": \"collision-dynamics\", "
    "\"particles_per_cell\": 8, \"angle\": 130}, \"measure\": {\"equilibration\": 0, \"samples\": "
    "40, \"every\": 1}, \"conserved\": {}}";

static void simulate(struct temporary_folder *folder, const char *text, const char *from,
                     const char *to) {
    static struct run_program_result result;
    small_inputs_write(folder, "scene.json", text, from, to);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--quiet");
    run_program_assert_code(&result, 0);
}

static double number(const char *key) {
    return results_number("out/summary.json", key);
}

static void check_kept(struct temporary_folder *folder, const char *text) {
    static const char *const angles[] = {"\"angle\": 130",
                                         "\"angle\": 130, \"angles\": \"random\""};
    for (int k = 0; k < 2; k++) {
        simulate(folder, text, angles[0], angles[k]);
        assert_true(number("particles_change") == 0);
        assert_true(number("momentum_change") < 1e-12);
        assert_true(number("energy_change") < 1e-12);
    }
}

static void test_collisions_keep_all_three(void **state) {
    check_kept(*state, plane);
    check_kept(*state, space);
}

/// 1024 particles of mass 1 that fall for 39 steps of 0.5 with 0.01 along x: 199.68.
static void test_gravity_adds_its_momentum(void **state) {
    simulate(*state, plane, "\"angle\": 130",
             "\"acceleration\": [0.01, 0], \"angles\": \"random\"");
    char *table = temporary_folder_read("out/conserved.tsv");
    double first[7] = {0}, last[7] = {0};
    for (const char *row = table; *row; row = strchr(row, '\n') + 1) {
        char *at = (char *)row;
        for (int k = 0; row[0] != '#' && k < 6; k++)
            last[k] = strtod(at, &at);
        if (row[0] != '#' && first[2] == 0)
            memcpy(first, last, sizeof first);
    }
    assert_true(first[2] == 1024);
    assert_true(fabs(last[4] - first[4] - 199.68) < 1e-6);
    assert_true(fabs(last[5] - first[5]) < 1e-6);
    assert_true(last[3] > first[3]);
    free(table);
}

/// Between two lists beads of a periodic box stand a little outside: none is lost.
static void test_beads_that_a_list_has_not_wrapped_yet_are_kept(void **state) {
    simulate(
        *state,
        "{\"seed\": 1, \"box\": [5, 5, 5], \"particles\": {\"count\": 300}, \"time_step\": 0.005, "
        "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25}, \"dynamics\": "
        "{\"integrator\": \"velocity-verlet\"}, \"measure\": {\"equilibration\": 0, "
        "\"samples\": 50, \"every\": 3}, \"conserved\": {}}",
        NULL, NULL);
    assert_true(number("particles_change") == 0);
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_collisions_keep_all_three),
        TEST(test_gravity_adds_its_momentum),
        TEST(test_beads_that_a_list_has_not_wrapped_yet_are_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
