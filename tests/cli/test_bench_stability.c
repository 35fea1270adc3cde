// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit bench stability` from outside: what is known of integrators and friction, the same
// numbers from any number of threads, its figure, bad input.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>

/// Few beads, since there are 300 runs.
static const char scene[] = "{\"box\": [2.2, 2.2, 2.2], \"particles\": {\"count\": 32}, "
                            "\"temperature\": 1, \"time_step\": 0.02, \"conservative\": "
                            "{\"law\": \"soft-repulsion\", \"a\": 25}, "
                            "\"dissipative\": {\"law\": \"power\", \"sigma\": 2}}";

static void run_small(struct temporary_folder *folder, const char *threads, const char *output) {
    static struct run_program_result result;
    small_inputs_write(folder, "small.json", scene, NULL, NULL);
    RUN_PROGRAM(&result, "bench", "stability", "small.json", "--integrators", "dpd-vv,aboba",
                "--time", "0.5", "--threads", threads, "-o", output, "--quiet");
    run_program_assert_code(&result, 0);
    assert_string_equal(result.err, "");
    assert_contains(result.out, "aboba, friction by time step:");
    assert_contains(result.out, "dpd-vv, stiffness by time step:");
}

/// Number `column` of the row of a map, an integrator, a row and a column of the map.
static double number_of(const char *table, const char *map, const char *integrator, int row,
                        int step, int column) {
    char wanted[128];
    snprintf(wanted, sizeof wanted, "\n%s\t%s\t%d\t%d\t", map, integrator, row, step);
    const char *at = strstr(table, wanted);
    assert_non_null(at);
    at++;
    for (int k = 0; k < column; k++)
        at = strchr(at, '\t') + 1;
    return strtod(at, NULL);
}

enum { TIME_STEP = 5, OFF = 10, UNSTABLE = 11, FIRST = 0, LAST = 11, STRONGEST = 5, OWN = 1 };

/// Friction as a force is a decay that a long step overshoots; as an exact change of velocities it
/// is not. A stiff potential is too much for both.
static void test_friction_as_a_force_wants_short_steps(void **state) {
    run_small(*state, "1", "one.tsv");
    char *table = temporary_folder_read("one.tsv");
    assert_true(number_of(table, "friction", "aboba", OWN, FIRST, TIME_STEP) == 0.00125);
    assert_true(number_of(table, "friction", "dpd-vv", STRONGEST, 5, UNSTABLE) == 1);
    assert_true(number_of(table, "friction", "aboba", STRONGEST, 5, UNSTABLE) == 0);
    assert_true(number_of(table, "friction", "aboba", STRONGEST, 5, OFF) < 0.3);
    assert_true(number_of(table, "stiffness", "aboba", STRONGEST, LAST, UNSTABLE) == 1);
    assert_true(number_of(table, "stiffness", "dpd-vv", STRONGEST, LAST, UNSTABLE) == 1);
    assert_true(number_of(table, "stiffness", "dpd-vv", OWN, 2, UNSTABLE) == 0);
    assert_true(number_of(table, "stiffness", "dpd-vv", OWN, 2, OFF) < 0.3);
    run_small(*state, "3", "three.tsv");
    char *three = temporary_folder_read("three.tsv");
    assert_string_equal(table, three);
    free(table);
    free(three);
    if (system("gnuplot --version >/dev/null 2>&1") == 0)
        assert_true(temporary_folder_exists("figures/three.png"));
}

/// Without friction velocity Verlet conserves the energy to second order of the time step.
static void test_energy_tells_of_steps_without_friction(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "free.json",
                       "{\"box\": [2.2, 2.2, 2.2], \"particles\": {\"count\": 32}, "
                       "\"temperature\": 1, \"time_step\": 0.02, \"conservative\": "
                       "{\"law\": \"soft-repulsion\", \"a\": 25}}",
                       NULL, NULL);
    RUN_PROGRAM(&result, "bench", "stability", "free.json", "--time", "2", "--threads", "1", "-o",
                "free.tsv", "--quiet");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "energy of a particle, which is conserved, scatters");
    char *table = temporary_folder_read("free.tsv");
    const double fine = number_of(table, "stiffness", "velocity-verlet", OWN, 2, OFF);
    const double coarse = number_of(table, "stiffness", "velocity-verlet", OWN, 5, OFF);
    print_message("energy off by %g at 0.005, %g at 0.02\n", fine, coarse);
    assert_true(fine > 0 && coarse > 8 * fine && coarse < 32 * fine); // four times the step: 16
    free(table);
}

static const struct {
    const char *words[8];
    const char *says[3];
} bad_lines[] = {
    {{"bench", "stability", "a.json", "b.json"}, {"usage: mesofit bench stability [SCENE.json]"}},
    {{"bench", "stability", "no/such.json"}, {"no/such.json: No such file"}},
    {{"bench", "stability", "small.json", "--time", "0"}, {"--time takes a number above 0"}},
    {{"bench", "stability", "small.json", "--skips"}, {"bench stability takes no --skips"}},
    {{"bench", "stability", "small.json", "--integrators", "verlet"},
     {"--integrators: \"verlet\" does not suit"}},
    {{"bench", "stability", "driven.json"},
     {"driven: bench stability has no measure: \"shear-wave\" does work"}},
    {{"bench", "stability", "gas.json"}, {"gas: bench stability wants \"conservative\""}},
};

static void test_bad_lines_are_refused_before_anything_runs(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "small.json", small_inputs_scene, NULL, NULL);
    small_inputs_write(*state, "gas.json", small_inputs_scene,
                       "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25}",
                       "\"conservative\": {\"law\": \"none\"}");
    small_inputs_write(*state, "driven.json",
                       "{\"box\": [2.2, 2.2, 2.2], \"particles\": {\"count\": 32}, "
                       "\"temperature\": 1, \"time_step\": 0.02, \"conservative\": "
                       "{\"law\": \"soft-repulsion\", \"a\": 25}, \"interactions\": "
                       "{\"shear-wave\": {\"acceleration\": 0.1}}}",
                       NULL, NULL);
    for (size_t k = 0; k < sizeof bad_lines / sizeof *bad_lines; k++) {
        run_program(&result, &(struct run_program_how){0}, bad_lines[k].words);
        run_program_assert_refused(&result, ".", bad_lines[k].says[0], 1, bad_lines[k].says);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, small_inputs_enter, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_friction_as_a_force_wants_short_steps),
        TEST(test_energy_tells_of_steps_without_friction),
        TEST(test_bad_lines_are_refused_before_anything_runs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
