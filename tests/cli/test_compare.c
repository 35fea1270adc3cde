// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit compare` of simulations, alone and beside a fit.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>

static struct run_program_result result;

static void simulate(struct temporary_folder *folder, const char *out, const char *temperature) {
    small_inputs_write(
        folder, "scene.json",
        "{\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02,\n"
        "\"conservative\": {\"law\": \"soft-repulsion\"}, \"temperature\": 1.5,\n"
        "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}, \"motion\": {\"lags\": 10},\n"
        "\"rdf\": {\"range\": 1, \"bins\": 20},\n"
        "\"measure\": {\"equilibration\": 100, \"samples\": 40, \"every\": 10}}",
        "1.5", temperature);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", out, "--quiet");
    run_program_assert_code(&result, 0);
}

/// The last row of a simulation's g(r) is a row of the comparison without a target.
static void assert_has_last_row(const char *table, const char *comparison) {
    double r, g, error;
    char row[160], *text = temporary_folder_read(table), *end = text + strlen(text) - 1;
    *end = '\0';
    assert_int_equal(sscanf(strrchr(text, '\n') + 1, "%lf %lf %lf", &r, &g, &error), 3);
    snprintf(row, sizeof row, "%.10g\tnan\tnan\t%.10g\t%.10g\n", r, g, error);
    assert_contains(comparison, row);
    free(text);
}

static void test_compare_puts_simulations_side_by_side(void **state) {
    small_inputs_need_gnuplot();
    simulate(*state, "cold", "1");
    simulate(*state, "hot", "1.5");
    RUN_PROGRAM(&result, "compare", "cold", "hot", "-o", "both");
    run_program_assert_code(&result, 0);
    assert_string_equal(result.err, "");
    assert_contains(result.out, " D ");
    assert_contains(result.out, "simulate");
    assert_false(temporary_folder_exists("both/error_compare.tsv"));
    char *text = temporary_folder_read("both/rdf_compare.tsv");
    assert_has_last_row("cold/rdf.tsv", text);
    assert_has_last_row("hot/rdf.tsv", text);
    free(text);
    char diffusion[64];
    text = temporary_folder_read("both/compare.tsv");
    snprintf(diffusion, sizeof diffusion, "\t%.16g\t",
             results_number("hot/summary.json", "motion.diffusion_msd"));
    assert_contains(text, diffusion);
    free(text);
    text = temporary_folder_read("both/figures/compare.svg");
    assert_contains(text, "cold");
    assert_null(strstr(text, "target"));
    free(text);
}

static void test_compare_takes_a_simulation_beside_a_fit(void **state) {
    small_inputs_need_gnuplot();
    simulate(*state, "cold", "1");
    small_inputs_write(*state, "target.tsv", small_inputs_target, NULL, NULL);
    small_inputs_write(*state, "run.json", small_inputs_run, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "fit", "--quiet");
    assert_in_range(result.code, 0, 1);
    RUN_PROGRAM(&result, "compare", "cold", "fit", "-o", "both");
    run_program_assert_code(&result, 0);
    assert_string_equal(result.err, "");
    assert_contains(result.out, "p_open");
    char *text = temporary_folder_read("both/figures/compare.svg");
    assert_contains(text, "target");
    free(text);
}

/// A verification that blows up, and what stopping leaves, which is the same but for the status:
/// both stand in the table with it. A file without either is no result.
static void test_compare_shows_fits_that_were_not_verified_with_their_status(void **state) {
    static const char *const shown[] = {"interrupted", "unstable"};
    small_inputs_write(*state, "target.tsv", small_inputs_target, NULL, NULL);
    small_inputs_write(*state, "run.json", small_inputs_run, "\"verification\": {",
                       "\"verification\": {\"time_step\": 100, ");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "fit", "--quiet");
    run_program_assert_code(&result, 1);
    char *summary = temporary_folder_read("fit/summary.json");
    assert_contains(summary, "\"unstable\"");
    for (int k = 0; k < 2; k++) {
        small_inputs_write(*state, "fit/summary.json", summary, "unstable", shown[k]);
        RUN_PROGRAM(&result, "compare", "fit", "fit", "-o", "both");
        run_program_assert_code(&result, 0);
        assert_contains(result.out, shown[k]);
    }
    small_inputs_write(*state, "fit/summary.json", summary, "unstable", "ok");
    RUN_PROGRAM(&result, "compare", "fit", "fit", "-o", "both");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "fit/summary.json: not the result of a fit");
    free(summary);
}

/// All files of a folder and their contents, but those that are called "…compare…".
static char *snapshot(const char *folder) {
    static char text[4096];
    char command[512];
    snprintf(command, sizeof command, "find %s -type f ! -name '*compare*' -exec cksum {} + | sort",
             folder);
    FILE *stream = popen(command, "r");
    assert_non_null(stream);
    text[fread(text, 1, sizeof text - 1, stream)] = '\0';
    assert_int_equal(pclose(stream), 0);
    return strdup(text);
}

static void test_compare_leaves_a_run_in_its_own_folder_alone(void **state) {
    small_inputs_need_gnuplot();
    simulate(*state, "cold", "1");
    small_inputs_write(*state, "target.tsv", small_inputs_target, NULL, NULL);
    small_inputs_write(*state, "run.json", small_inputs_run, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "fit", "--quiet");
    assert_in_range(result.code, 0, 1);
    static const char *const folders[] = {"cold", "fit"};
    for (int k = 0; k < 2; k++) {
        char *before = snapshot(folders[k]);
        assert_contains(before, "rdf.tsv");
        assert_contains(before, "figures/");
        RUN_PROGRAM(&result, "compare", "cold", "fit", "-o", folders[k]);
        run_program_assert_code(&result, 0);
        char *after = snapshot(folders[k]);
        assert_string_equal(before, after);
        free(before);
        free(after);
    }
}

static void test_compare_refuses_results_of_different_units_of_length(void **state) {
    static const char units[] = "\"units\": {\"length\": 0.7, \"temperature\": 300, \"mass\": "
                                "9e-26}, \"temperature\": 1";
    simulate(*state, "reduced", "1");
    char *text = temporary_folder_read("scene.json");
    small_inputs_write(*state, "wide.json", text, "\"temperature\": 1", units);
    small_inputs_write(*state, "narrow.json", text, "\"temperature\": 1",
                       "\"units\": {\"length\": 0.465, \"temperature\": 300, \"mass\": 9e-26}, "
                       "\"temperature\": 1");
    free(text);
    RUN_PROGRAM(&result, "simulate", "wide.json", "-o", "wide", "--quiet");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "simulate", "narrow.json", "-o", "narrow", "--quiet");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "compare", "reduced", "wide", "narrow", "-o", "all");
    run_program_assert_code(&result, 2);
    assert_string_equal(result.err, "mesofit: compare: the unit of length is 0.7 nm in wide and "
                                    "0.465 nm in narrow: tables over r in it do not go together\n");
    assert_false(temporary_folder_exists("all"));
    RUN_PROGRAM(&result, "compare", "reduced", "wide", "wide", "-o", "all");
    run_program_assert_code(&result, 0);
    assert_contains(result.err,
                    "mesofit: warning: compare: lambda is 0.7 nm in wide and has no \"units\" in "
                    "reduced: all is compared in reduced units");
    RUN_PROGRAM(&result, "compare", "wide", "wide", "-o", "all");
    assert_null(strstr(result.err, "lambda"));
    RUN_PROGRAM(&result, "compare", "reduced", "reduced", "-o", "all");
    assert_null(strstr(result.err, "lambda"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_compare_puts_simulations_side_by_side,
                                        small_inputs_enter, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_compare_leaves_a_run_in_its_own_folder_alone,
                                        small_inputs_enter, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_compare_refuses_results_of_different_units_of_length,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(
            test_compare_shows_fits_that_were_not_verified_with_their_status,
            small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_compare_takes_a_simulation_beside_a_fit,
                                        small_inputs_enter, small_inputs_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
