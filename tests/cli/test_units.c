// SPDX-License-Identifier: GPL-3.0-or-later
//
// "units" of a scene: tables stand in nm, ps, kJ/mol and bar beside the reduced units.
#include "io/data_table.h"
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>

static const char scene[] =
    "{\"seed\": 7, \"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02,\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3},\n"
    "\"measure\": {\"equilibration\": 100, \"samples\": 40, \"every\": 10},\n"
    "\"motion\": {\"every\": 8, \"lags\": 10},\n"
    "\"units\": {\"length\": 0.7, \"temperature\": 300, \"mass\": 9e-26}}\n";

/// A fit of a friction to what the scene shows.
static const char fit[] =
    "{\"seed\": 3, \"target\": {\"msd\": {\"file\": \"out/motion.tsv\"},\n"
    "\"vacf\": {\"file\": \"out/motion.tsv\", \"value_column\": 4, \"error_column\": 5}},\n"
    "\"unknowns\": {\"omega\": {\"curve\": \"power\", \"maximum\": 6}},\n"
    "\"scene\": {\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02,\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "\"units\": {\"length\": 0.7, \"temperature\": 300, \"mass\": 9e-26}},\n"
    "\"method\": {\"name\": \"genetic\", \"population\": 4, \"generations\": 1,\n"
    "\"equilibration\": 20, \"samples\": 20, \"every\": 10, \"temperature_tolerance\": 0.5},\n"
    "\"verification\": {\"replicas\": 2, \"equilibration\": 20, \"samples\": 20, \"every\": 10}}\n";

/// The last number of a table's column of that name and unit.
static double last_in_column(const char *file, const char *name) {
    char *text = temporary_folder_read(file);
    char *lines, *rest, *word, *last = NULL, *names = NULL;
    for (char *line = strtok_r(text, "\n", &lines); line; line = strtok_r(NULL, "\n", &lines)) {
        if (line[0] == '#')
            names = line + 2; // below a comment there may be
        last = line;
    }
    size_t place = 0;
    for (word = strtok_r(names, "\t", &rest); word && strcmp(word, name) != 0;
         word = strtok_r(NULL, "\t", &rest))
        place++;
    if (word == NULL)
        fail_msg("%s has no column %s", file, name);
    word = strtok_r(last, "\t", &rest);
    for (; place > 0; place--)
        word = strtok_r(NULL, "\t", &rest);
    const double value = strtod(word, NULL);
    free(text);
    return value;
}

/// λ = 0.7 nm, 300 K, 9e-26 kg: k_B T_0 = 2.494339 kJ/mol, τ = 0.7 nm sqrt(m/(k_B T_0)) = 3.2630
/// ps, k_B T_0/λ³ = 120.756 bar.
static void test_tables_of_a_simulation_stand_in_physical_units_too(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "scene.json", scene, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--quiet");
    run_program_assert_code(&result, 0);
    static const struct {
        const char *file, *reduced, *physical;
        double factor;
    } columns[] = {
        {"out/rdf.tsv", "r[lambda]", "r[nm]", 0.7},
        {"out/thermodynamics.tsv", "time[tau]", "time[ps]", 3.2629996},
        {"out/thermodynamics.tsv", "potential_energy[k_B.T_0]", "potential_energy[kJ/mol]",
         2.4943388},
        {"out/thermodynamics.tsv", "pressure[k_B.T_0/lambda^d]", "pressure[bar]", 120.75647},
        {"out/motion.tsv", "time[tau]", "time[ps]", 3.2629996},
        {"out/motion.tsv", "msd[lambda^2]", "msd[nm^2]", 0.49},
        {"out/motion.tsv", "vacf[lambda^2/tau^2]", "vacf[nm^2/ps^2]", 0.046021633},
    };
    for (size_t k = 0; k < sizeof columns / sizeof *columns; k++)
        assert_close_relative(
            last_in_column(columns[k].file, columns[k].physical),
            columns[k].factor * last_in_column(columns[k].file, columns[k].reduced), 1e-6);
}

/// There pressure is energy over an area, which no bar is.
static void test_flat_scenes_have_no_pressure_in_bar(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "scene.json", scene, "\"box\": [3, 3, 3]",
                       "\"dimensions\": 2, \"box\": [6, 6]");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--quiet");
    run_program_assert_code(&result, 0);
    char *summary = temporary_folder_read("out/summary.json");
    assert_contains(summary, "potential_energy_kJ_per_mol");
    assert_null(strstr(summary, "bar"));
    free(summary);
}

/// Compared it is the number of the folder, over an area.
static void test_flat_scenes_are_compared_by_areas(void **state) {
    static struct run_program_result result;
    static const char flat[] =
        "{\"units\": \"nm-ps\", \"dimensions\": 2, \"box\": [6, 6], \"temperature\": 300,\n"
        "\"particles\": {\"count\": 100, \"mass\": 18}, \"time_step\": 0.005,\n"
        "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 60, \"cutoff\": 0.7},\n"
        "\"dissipative\": {\"law\": \"power\", \"sigma\": 5, \"cutoff\": 0.7},\n"
        "\"measure\": {\"equilibration\": 10, \"samples\": 4, \"every\": 5}}\n";
    small_inputs_write(*state, "scene.json", flat, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "a", "--quiet");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "compare", "a", "a", "-o", "both", "--quiet");
    run_program_assert_code(&result, 0);
    char *table = temporary_folder_read("both/compare.tsv");
    assert_contains(table, "pressure[kJ/mol/nm^2]");
    assert_null(strstr(table, "nm^3"));
    free(table);
    struct data_table numbers;
    assert_ok(mf_data_table_read(&numbers, "both/compare.tsv", 1));
    const size_t column = mf_data_table_find(&numbers, "pressure");
    assert_true(column > 0);
    assert_close_relative(numbers.values[column - 1], results_number("a/summary.json", "pressure"),
                          1e-12);
    mf_data_table_clear(&numbers);
}

static void test_tables_of_a_fit_stand_in_physical_units_too(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "scene.json", scene, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--quiet");
    run_program_assert_code(&result, 0);
    small_inputs_write(*state, "run.json", fit, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "fit", "--quiet");
    assert_in_range(result.code, 0, 1);
    assert_close_relative(last_in_column("fit/omega.tsv", "r[nm]"), 0.7, 1e-6);
    assert_close_relative(last_in_column("fit/msd.tsv", "time[ps]"), 1.6 * 3.2629996, 1e-6);
    assert_close_relative(last_in_column("fit/msd.tsv", "result[nm^2]"),
                          0.49 * last_in_column("fit/msd.tsv", "result[lambda^2]"), 1e-6);
    assert_close_relative(last_in_column("fit/vacf.tsv", "target[nm^2/ps^2]"),
                          0.046021633 * last_in_column("fit/vacf.tsv", "target[lambda^2/tau^2]"),
                          1e-6);
}

#define TEST_WITHOUT_FIGURES(name)                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST_WITHOUT_FIGURES(test_tables_of_a_simulation_stand_in_physical_units_too),
        TEST_WITHOUT_FIGURES(test_flat_scenes_have_no_pressure_in_bar),
        TEST_WITHOUT_FIGURES(test_flat_scenes_are_compared_by_areas),
        TEST_WITHOUT_FIGURES(test_tables_of_a_fit_stand_in_physical_units_too),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
