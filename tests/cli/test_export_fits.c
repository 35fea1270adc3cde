// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit export` of fits: numbers that were found stand in the tables, and so does a friction
// weight.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// A soft fluid whose escape times are the target.
static const char soft_fluid[] =
    "{\"seed\": 5, \"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02,\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3},\n"
    "\"measure\": {\"equilibration\": 100, \"samples\": 60, \"every\": 10},\n"
    "\"etd\": {\"r_minimum\": 0.4, \"r_maximum\": 0.9, \"bins\": 12, \"times\": 12, \"every\": "
    "2}}\n";

static const char fit[] =
    "{\"seed\": 3, \"target\": {\"etd\": {\"file\": \"target/etd.tsv\", \"error_file\": "
    "\"target/etd_error.tsv\", \"r_minimum\": 0.4, \"r_maximum\": 0.9}},\n"
    "\"unknowns\": {UNKNOWNS},\n"
    "\"scene\": {\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02,\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25}FRICTION},\n"
    "\"method\": {\"name\": \"genetic\", \"population\": 7, \"generations\": 2, "
    "\"equilibration\": 10, \"samples\": 4, \"every\": 8, \"temperature_tolerance\": 0.5},\n"
    "\"verification\": {\"replicas\": 2, \"equilibration\": 20, \"samples\": 5, \"every\": 8}}\n";

static void fit_and_export(struct temporary_folder *folder, const char *unknowns,
                           const char *friction) {
    static struct run_program_result result;
    small_inputs_write(folder, "scene.json", soft_fluid, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "target", "--quiet");
    run_program_assert_code(&result, 0);
    small_inputs_write(folder, "run.json", fit, "UNKNOWNS", unknowns);
    char *text = temporary_folder_read("run.json");
    small_inputs_write(folder, "run.json", text, "FRICTION", friction);
    free(text);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "fit"); // that need not converge
    RUN_PROGRAM(&result, "export", "fit", "--engine", "lammps", "-o", "lammps");
    run_program_assert_code(&result, 0);
}

/// The number behind `words` in a file.
static double number_behind(const char *path, const char *words) {
    char *text = temporary_folder_read(path);
    const char *found = strstr(text, words);
    if (found == NULL)
        fail_msg("%s has no %s", path, words);
    const double number = strtod(found + strlen(words), NULL);
    free(text);
    return number;
}

static void test_numbers_that_were_found_are_exported(void **state) {
    fit_and_export(*state,
                   "\"numbers\": {\"dissipative.sigma\": {\"minimum\": 1, \"maximum\": 8}, "
                   "\"conservative.a\": {\"minimum\": 10, \"maximum\": 60}}",
                   ", \"dissipative\": {\"law\": \"power\", \"sigma\": 5}");
    const double sigma = results_parameter("fit/summary.json", "dissipative.sigma", "value");
    const double a = results_parameter("fit/summary.json", "conservative.a", "value");
    const double gamma = number_behind("lammps/in.mesofit", "pair_coeff 1 1 dpd/tstat ");
    assert_true(fabs(sigma - 5) > 1e-6 && fabs(gamma / (sigma * sigma) - 1) < 1e-6);
    // Φ of the first row, which is at r = 1e-4: ½ a (1 − r)².
    char *text = temporary_folder_read("lammps/mesofit.table");
    double phi;
    assert_int_equal(sscanf(strstr(text, "\n1 ") + 1, "%*d %*f %lf", &phi), 1);
    free(text);
    assert_true(fabs(phi / (0.5 * a * 0.9999 * 0.9999) - 1) < 1e-5);
}

static void test_friction_weight_that_was_found_is_exported(void **state) {
    fit_and_export(*state, "\"omega\": {\"coefficients\": 4, \"maximum\": 6}", "");
    // Both have straight pieces, of different length: at r = 0.5, between rows of both.
    char *text = temporary_folder_read("fit/omega.tsv");
    double r = 0, omega = 0, next_r = 0, next = 0, expected = NAN;
    for (char *line = strchr(text, '\n'); line && line[1]; line = strchr(line + 1, '\n')) {
        r = next_r, omega = next;
        assert_int_equal(sscanf(line + 1, "%lf %lf", &next_r, &next), 2);
        if (r <= 0.5 && next_r > 0.5)
            expected = omega + (next - omega) * (0.5 - r) / (next_r - r);
    }
    free(text);
    text = temporary_folder_read("lammps/mesofit.table");
    size_t rows;
    double low, high, found = NAN;
    char *section = strstr(text, "OMEGA_A-A\n");
    assert_non_null(section);
    assert_int_equal(sscanf(section, "OMEGA_A-A\nN %zu R %lf %lf", &rows, &low, &high), 3);
    assert_true(low == 0 && fabs(high - 1) < 0.2);
    next_r = 0, next = 0;
    for (char *line = strstr(section, "\n\n") + 1; line && line[1]; line = strchr(line + 1, '\n')) {
        r = next_r, omega = next;
        assert_int_equal(sscanf(line + 1, "%*d %lf %lf", &next_r, &next), 2);
        if (r <= 0.5 && next_r > 0.5)
            found = omega + (next - omega) * (0.5 - r) / (next_r - r);
    }
    free(text);
    assert_true(expected > 0 && fabs(found / expected - 1) < 1e-3);
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_numbers_that_were_found_are_exported),
        TEST(test_friction_weight_that_was_found_is_exported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
