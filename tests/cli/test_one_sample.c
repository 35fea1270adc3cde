// SPDX-License-Identifier: GPL-3.0-or-later
//
// A simulation of one sample has no standard errors: its tables, summary and figures say so, and so
// does a fit to its g(r).
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static struct run_program_result result;

/// One sample, one window of the motion.
static const char scene[] =
    "{\"box\": [5, 5, 5], \"particles\": {\"count\": 375}, \"time_step\": 0.02,\n"
    "\"conservative\": {\"law\": \"soft-repulsion\"},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3},\n"
    "\"measure\": {\"equilibration\": 200, \"samples\": 1, \"every\": 20},\n"
    "\"rdf\": {\"range\": 2.2, \"bins\": 22}, \"structure_factor\": {\"q_maximum\": 6},\n"
    "\"motion\": {\"every\": 1, \"lags\": 20}}\n";

/// A fit to the g(r) of such a simulation, verified by another one of one sample.
static const char run[] =
    "{\"target\": {\"rdf\": {\"file\": \"one/rdf.tsv\"},\n"
    "            \"msd\": {\"file\": \"one/motion.tsv\", \"fitted\": \"no\"}},\n"
    "\"scene\": {\"box\": [5, 5, 5], \"particles\": {\"count\": 375}, \"time_step\": 0.02,\n"
    "          \"dissipative\": {\"law\": \"power\", \"sigma\": 3}},\n"
    "\"method\": {\"name\": \"imc\", \"replicas\": 2, \"equilibration\": 10, \"samples\": 20,\n"
    "           \"iterations\": 1},\n"
    "\"verification\": {\"replicas\": 1, \"equilibration\": 100, \"samples\": 1}}\n";

/// Every entry of a column, from 1, is nan; or not one is.
static void assert_column(const char *file, int column, bool unknown) {
    char *text = temporary_folder_read(file), *rest, *line = strtok_r(text, "\n", &rest);
    size_t rows = 0;
    for (; line; line = strtok_r(NULL, "\n", &rest)) {
        if (line[0] == '#')
            continue;
        char *at = line;
        for (int k = 1; k < column; k++)
            at += strcspn(at, "\t") + 1;
        if (isnan(strtod(at, NULL)) != unknown)
            fail_msg("%s: column %d of \"%s\"", file, column, line);
        rows++;
    }
    assert_true(rows > 0);
    free(text);
}

static void simulate(void *state, const char *samples, const char *folder) {
    small_inputs_write(state, "scene.json", scene, "\"samples\": 1", samples);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", folder);
    run_program_assert_code(&result, 0);
}

static void test_errors_of_one_sample_are_not_known_and_of_more_are(void **state) {
    static const struct {
        const char *file;
        int column;
    } errors[] = {{"one/rdf.tsv", 3},
                  {"one/motion.tsv", 3},
                  {"one/motion.tsv", 5},
                  {"one/structure_factor.tsv", 3}};
    for (int samples = 1; samples <= 40; samples += 39) {
        char text[32];
        snprintf(text, sizeof text, "\"samples\": %d", samples);
        simulate(*state, text, "one");
        for (size_t k = 0; k < sizeof errors / sizeof *errors; k++)
            assert_column(errors[k].file, errors[k].column, samples == 1);
        assert_column("one/rdf.tsv", 2, false);
        char *summary = temporary_folder_read("one/summary.json");
        assert_int_equal(strstr(summary, "\"diffusion_msd_error\":\tnull") != NULL, samples == 1);
        assert_int_equal(strstr(summary, "\"pressure_error\":\tnull") != NULL, samples == 1);
        free(summary);
    }
}

/// Lags that few samples reach have one block, or none: what is not known is no error of 0. At lag
/// 0 the correlation is 1, and its error is 0.
static void test_errors_of_lags_with_one_block_are_not_known(void **state) {
    small_inputs_write(
        *state, "scene.json",
        "{\"box\": [5, 5, 5], \"time_step\": 0.01, \"bonds\": {\"b\": {\"law\": "
        "\"harmonic\", \"k\": 100, \"length\": 0.6}},\n\"molecules\": {\"d\": {\"count\": "
        "40, \"chain\": {\"type\": \"A\", \"length\": 3, \"bond\": \"b\"}}},\n"
        "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}, \"measure\": "
        "{\"equilibration\": 10, \"samples\": 40, \"every\": 5}, \"molecule_sizes\": {}}",
        NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "few");
    run_program_assert_code(&result, 0);
    char *text = temporary_folder_read("few/end_to_end.tsv"), *rest;
    size_t known = 0, unknown = 0;
    for (char *line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        double time, correlation, error;
        if (line[0] == '#')
            continue;
        assert_int_equal(sscanf(line, "%lf %lf %lf", &time, &correlation, &error), 3);
        if (time > 0 && error == 0)
            fail_msg("end_to_end.tsv: an error of 0 in \"%s\"", line);
        known += error > 0;
        unknown += isnan(error);
    }
    assert_true(known > 20 && unknown > 0);
    free(text);
}

static void test_results_without_errors_are_drawn_and_compared(void **state) {
    small_inputs_need_gnuplot();
    simulate(*state, "\"samples\": 1", "one");
    assert_null(strstr(result.err, "warning"));
    assert_true(temporary_folder_exists("one/figures/simulation.svg"));
    assert_true(temporary_folder_exists("one/figures/motion.svg"));
    assert_true(temporary_folder_exists("one/figures/structure_factor.svg"));
    simulate(*state, "\"samples\": 10", "ten");
    RUN_PROGRAM(&result, "compare", "one", "ten", "-o", "both");
    run_program_assert_code(&result, 0);
    assert_null(strstr(result.err, "warning"));
    assert_column("both/compare.tsv", 1, false);
}

/// As a table without a third column; its own errors are not known either.
static void test_fit_takes_a_target_whose_errors_are_nan_for_one_without(void **state) {
    simulate(*state, "\"samples\": 1", "one");
    temporary_folder_write(*state, "run.json", run, strlen(run));
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out");
    assert_contains(result.err, "target rdf: no errors given: ");
    assert_null(strstr(result.err, "warning: no figure"));
    assert_column("out/rdf.tsv", 3, false);
    assert_column("out/rdf.tsv", 5, true);
    char *summary = temporary_folder_read("out/summary.json");
    assert_contains(summary, "\"temperature_error\":\tnull");
    assert_null(strstr(summary, "\"rdf_rmse_error\""));
    assert_null(strstr(summary, "_error\":\t0,"));
    free(summary);
    // Some that are nan are a mistake.
    char *table = temporary_folder_read("one/rdf.tsv");
    small_inputs_write(*state, "one/rdf.tsv", table, "nan\n", "0.01\n");
    free(table);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--force");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "one/rdf.tsv:3: column 3: \"nan\" is not a finite number");
    assert_int_equal(run_program_lines(result.err), 1);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, small_inputs_enter, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_errors_of_one_sample_are_not_known_and_of_more_are),
        TEST(test_errors_of_lags_with_one_block_are_not_known),
        TEST(test_results_without_errors_are_drawn_and_compared),
        TEST(test_fit_takes_a_target_whose_errors_are_nan_for_one_without),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
