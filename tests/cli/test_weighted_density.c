// SPDX-License-Identifier: GPL-3.0-or-later
//
// "weighted_density" of a simulation is what `measure` finds in its trajectory, and goes on where
// it was interrupted; `measure` writes it as a target; bad cutoffs are refused by name.
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <stdlib.h>
#include <string.h>

static struct run_program_result result;

static const char scene[] =
    "{\"seed\": 5, \"box\": [5, 5, 5], \"time_step\": 0.03, \"particles\": {\"count\": 375},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25}, \"dissipative\": {\"law\": "
    "\"power\"},\n\"weighted_density\": {\"inner_cutoff\": 0.6, \"cutoff\": 1.4},\n"
    "\"snapshots\": {\"every\": 10, \"formats\": [\"lammps-dump\"]},\n"
    "\"measure\": {\"equilibration\": 100, \"samples\": 20, \"every\": 10}}\n";

static void test_weighted_density_is_that_of_the_trajectory(void **state) {
    static const char *const keys[] = {"weighted_density", "weighted_density_error",
                                       "weighted_density_variance"};
    small_inputs_write(*state, "scene.json", scene, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--quiet", "-o", "out");
    run_program_assert_code(&result, 0);
    run_program_in_pieces(0, (const char *const[]){"simulate", "scene.json", "-o", "pieces", NULL});
    results_assert_same("out", "pieces", (const char *const[]){"weighted_density.tsv", NULL});
    // The first frame is of the end of the equilibration, before the first sample.
    RUN_PROGRAM(&result, "measure", "out/snapshots/trajectory.lammpstrj", "--file-units", "lj",
                "--begin", "3.1", "--static", "--weighted-density", "0.6,1.4", "-o", "measured");
    run_program_assert_code(&result, 0);
    results_assert_number("measured/summary.json", "frames", 20);
    for (int k = 0; k < 3; k++) {
        const double expected = results_number("out/summary.json", keys[k]);
        assert_close(results_number("measured/summary.json", keys[k]), expected, 1e-4 * expected);
    }
    // A column that is called as the target would be taken for its values.
    char *table = temporary_folder_read("measured/weighted_density.tsv");
    assert_ptr_equal(strstr(table, "# rho[1]\tp[1]\terror[1]\n"), table);
    free(table);
    char *target = temporary_folder_read("measured/target.json");
    assert_non_null(strstr(target, "weighted_density.tsv"));
    free(target);
}

static void test_weighted_density_is_refused_without_a_range(void **state) {
    small_inputs_write(*state, "scene.json", scene, "\"cutoff\": 1.4", "\"cutoff\": 0.5");
    RUN_PROGRAM(&result, "simulate", "scene.json", "--quiet", "-o", "refused");
    run_program_assert_code(&result, 2);
    assert_non_null(strstr(result.err, "weighted_density.inner_cutoff"));
    small_inputs_write(*state, "scene.json", scene, "\"cutoff\": 1.4", "\"cutoff\": 2.6");
    RUN_PROGRAM(&result, "simulate", "scene.json", "--quiet", "-o", "refused");
    run_program_assert_code(&result, 2);
    assert_non_null(strstr(result.err, "weighted_density.cutoff"));
    RUN_PROGRAM(&result, "measure", "scene.json", "--weighted-density", "0.7,0.3", "-o", "refused");
    run_program_assert_code(&result, 2);
    assert_non_null(strstr(result.err, "the first below the second"));
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {TEST(test_weighted_density_is_that_of_the_trajectory),
                                       TEST(test_weighted_density_is_refused_without_a_range)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
