// SPDX-License-Identifier: GPL-3.0-or-later
//
// The heat capacity in summary.json, against what is known: of particles in a trap without pairs 3,
// of a gas that has but its velocities 3/2; and of one fluid the same by its two formulas, at a
// given temperature and at a given energy.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const char trap[] =
    "{\"box\": [20, 20, 20], \"particles\": {\"count\": 50}, \"temperature\": 1.7, \"time_step\": "
    "0.05, \"conservative\": {\"law\": \"none\"}, \"dynamics\": {\"integrator\": \"brownian\"}, "
    "\"interactions\": {\"harmonic-trap\": {\"stiffness\": [2, 2, 2], \"centre\": [10, 10, 10]}}, "
    "\"rdf\": {\"range\": 2, \"bins\": 4}, "
    "\"measure\": {\"equilibration\": 400, \"samples\": 3000, \"every\": 20}}";
static const char fluid[] =
    "{\"box\": [4, 4, 4], \"particles\": {\"count\": 128}, \"temperature\": 1, \"time_step\": "
    "0.02, "
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25}, \"dissipative\": {\"law\": "
    "\"power\", \"sigma\": 2.5}, \"measure\": {\"equilibration\": 500, \"samples\": 2000, "
    "\"every\": 10}}";

struct capacity {
    double value, error;
};

static struct capacity measure(struct temporary_folder *folder, const char *text, const char *from,
                               const char *to) {
    static struct run_program_result result;
    small_inputs_write(folder, "scene.json", text, from, to);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--quiet", "--threads", "1");
    run_program_assert_code(&result, 0);
    const struct capacity c = {results_number("out/summary.json", "heat_capacity"),
                               results_number("out/summary.json", "heat_capacity_error")};
    print_message("%.3f(%.3f)\n", c.value, c.error);
    return c;
}

/// Errors are 0.16 at most on average, that of the fluid at a given temperature, which scatters by
/// 0.03 from seed to seed.
static void assert_near(struct capacity found, double wanted, double error) {
    assert_true(fabs(found.value - wanted) < 4 * hypot(found.error, error));
    assert_true(found.error > 0 && found.error < 0.28);
}

static void test_trap_has_half_a_k_for_each_square(void **state) {
    assert_near(measure(*state, trap, NULL, NULL), 3, 0);
}

static void test_energy_and_temperature_tell_the_same(void **state) {
    const struct capacity held = measure(*state, fluid, NULL, NULL);
    const struct capacity kept =
        measure(*state, fluid, "{\"law\": \"power\", \"sigma\": 2.5}", "{\"law\": \"none\"}");
    assert_near(held, kept.value, kept.error);
    assert_true(kept.value > 1.5 + 4 * kept.error); // of more than the velocities
    char *table = temporary_folder_read("out/thermodynamics.tsv");
    assert_contains(table, "\ttotal_energy[k_B.T_0]");
    free(table);
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_trap_has_half_a_k_for_each_square),
        TEST(test_energy_and_temperature_tell_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
