// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit fit` by the method "formulas", and formulas in scenes: the same bits for any threads and
// after any interruption, what is written, and what is refused.
#include "io/data_table.h"
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"
#include "shared/twins.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// A soft fluid whose escape times and g(r) are the targets.
static const char soft_fluid[] =
    "{\"seed\": 5, \"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02,\n"
    "\"conservative\": {\"law\": \"expression\", \"formula\": \"12.5*(1 - r)^2\"},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3},\n"
    "\"measure\": {\"equilibration\": 100, \"samples\": 60, \"every\": 10},\n"
    "\"etd\": {\"r_minimum\": 0.4, \"r_maximum\": 0.9, \"bins\": 12, \"times\": 12, \"every\": "
    "2},\n"
    "\"rdf\": {\"range\": 1, \"bins\": 20}}\n";

static const char fit_potential[] =
    "{\"seed\": 3, \"target\": {\"rdf\": {\"file\": \"target/rdf.tsv\"}},\n"
    "\"scene\": {\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02},\n"
    "\"method\": {\"name\": \"formulas\", \"nodes\": 9, \"islands\": 3, \"rounds\": 3, "
    "\"children\": 800, \"cycles\": 2,\n"
    "\"equilibration\": 50, \"samples\": 10, \"every\": 8, \"temperature_tolerance\": 0.5},\n"
    "\"core\": {\"threshold\": 0.05, \"stiffness\": 50},\n"
    "\"verification\": {\"replicas\": 2, \"equilibration\": 20, \"samples\": 5, \"every\": 8}}\n";

static const char fit_omega[] =
    "{\"seed\": 3, \"target\": {\"etd\": {\"file\": \"target/etd.tsv\", \"error_file\": "
    "\"target/etd_error.tsv\", \"r_minimum\": 0.4, \"r_maximum\": 0.9}},\n"
    "\"unknowns\": {\"omega\": {\"maximum\": 6, \"start\": {\"law\": \"power\", \"sigma\": 3}}},\n"
    "\"scene\": {\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02,\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25}},\n"
    "\"method\": {\"name\": \"formulas\", \"islands\": 3, \"rounds\": 2, \"children\": 200,\n"
    "\"equilibration\": 50, \"samples\": 100, \"every\": 8, \"checks\": 8, "
    "\"temperature_tolerance\": 0.5},\n"
    "\"verification\": {\"replicas\": 2, \"equilibration\": 20, \"samples\": 5, \"every\": 8}}\n";

static const char *const tables[] = {"history.tsv",  "potential.tsv", "formulas.tsv",
                                     "formulas.tex", "formulas.h",    NULL};

static struct run_program_result result;

static void write_fit(struct temporary_folder *folder, const char *fit, const char *from,
                      const char *to) {
    small_inputs_write(folder, "scene.json", soft_fluid, NULL, NULL);
    twins_simulate("scene.json", "target");
    small_inputs_write(folder, "run.json", fit, from, to);
}

static void run_fit(const char *file, const char *out, const char *threads) {
    RUN_PROGRAM(&result, "fit", file, "-o", out, "--threads", threads, "--quiet");
    run_program_assert_code(&result, 0);
}

static void test_formulas_gives_the_same_bits_for_any_threads_and_in_pieces(void **state) {
    static const char *const words[] = {"fit", "run.json", "-o", "pieces", "--threads", "2", NULL};
    write_fit(*state, fit_potential, NULL, NULL);
    run_fit("run.json", "1", "1");
    run_fit("run.json", "2", "2");
    results_assert_same("1", "2", tables);
    run_fit("1/used.json", "again", "1");
    results_assert_same("1", "again", tables);
    run_program_in_pieces(0, words);
    results_assert_same("1", "pieces", tables);
}

/// Text of a file.
static void read_file(const char *path, char *text, size_t size) {
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    text[fread(text, 1, size - 1, file)] = '\0';
    fclose(file);
}

/// A friction weight that is a straight line is found as one, in the summary and in each language.
static void test_formulas_finds_a_friction_weight_from_its_curve(void **state) {
    static char text[20000];
    write_fit(*state, fit_omega, NULL, NULL);
    run_fit("run.json", "out", "2");
    read_file("out/summary.json", text, sizeof text);
    assert_contains(text, "\"formula\":\t\"-3*(r - 1)\"");
    assert_contains(text, "\"status\":\t\"finished\"");
    read_file("out/formulas.tsv", text, sizeof text);
    assert_contains(text, "# nodes\tchosen\texpected\terror[1]\terror_error[1]\tformula\n");
    assert_contains(text, "\t-3*(r - 1)\n");
    read_file("out/formulas.tex", text, sizeof text);
    assert_contains(text, "\\omega(r) = -3 \\, \\left(r - 1\\right)\n");
    read_file("out/formulas.h", text, sizeof text);
    assert_contains(text, "double formula_5(double r) {\n    return -3.0*(r - 1.0) - (0);\n}\n");
    struct data_table table;
    assert_ok(mf_data_table_read(&table, "out/omega.tsv", 2));
    for (size_t k = 0; k < table.rows; k++) {
        const double *row = table.values + k * table.columns;
        assert_close(row[1], 3 * (1 - row[0]), 1e-6);
    }
    mf_data_table_clear(&table);
}

/// A scene whose law is a formula gives what the same law by its name gives, for as few steps as
/// differences of rounding have not grown.
static void test_formulas_in_a_scene_are_the_laws_that_they_write_down(void **state) {
    struct data_table one, other;
    static char named[sizeof soft_fluid], *law;
    small_inputs_write(*state, "scene.json", soft_fluid, "\"equilibration\": 100",
                       "\"equilibration\": 1");
    read_file("scene.json", named, sizeof named);
    law = strstr(named, "\"expression\", \"formula\": \"12.5*(1 - r)^2\"");
    assert_non_null(law);
    memcpy(law, "\"soft-repulsion\", \"a\": 25, \"cutoff\": 1.00", 41); // as long
    small_inputs_write(*state, "named.json", named, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "formula", "--quiet");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "simulate", "named.json", "-o", "named", "--quiet");
    run_program_assert_code(&result, 0);
    assert_ok(mf_data_table_read(&one, "formula/rdf.tsv", 2));
    assert_ok(mf_data_table_read(&other, "named/rdf.tsv", 2));
    assert_int_equal(one.rows, other.rows);
    for (size_t k = 0; k < one.rows; k++)
        assert_close(one.values[k * one.columns + 1], other.values[k * other.columns + 1], 1e-6);
    mf_data_table_clear(&one);
    mf_data_table_clear(&other);
}

static void assert_refused(void *folder, const char *fit, const char *from, const char *to,
                           const char *message) {
    write_fit(folder, fit, from, to);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--quiet");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, message);
}

static void test_formulas_is_refused_where_it_finds_none(void **state) {
    assert_refused(*state, fit_omega, ", \"start\": {\"law\": \"power\", \"sigma\": 3}", "",
                   "needs the curve of which it finds a formula: unknowns.omega.start");
    assert_refused(*state, fit_potential, "\"scene\": {",
                   "\"unknowns\": {\"potential\": {}, \"omega\": {}},\n\"scene\": {",
                   "finds the formula of one unknown: the potential, or omega");
}

static void test_formulas_of_a_scene_are_refused_with_their_place(void **state) {
    small_inputs_write(*state, "scene.json", soft_fluid, "(1 - r)^2", "(1 - s)^2");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--quiet");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "scene.json");
    assert_contains(result.err, "character 11: unknown name");
    small_inputs_write(*state, "scene.json", soft_fluid, "12.5*(1 - r)^2", "1/r - 1");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--quiet");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "\"inner_cutoff\"");
}

#define TEST_WITHOUT_FIGURES(name)                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST_WITHOUT_FIGURES(test_formulas_gives_the_same_bits_for_any_threads_and_in_pieces),
        TEST_WITHOUT_FIGURES(test_formulas_finds_a_friction_weight_from_its_curve),
        TEST_WITHOUT_FIGURES(test_formulas_in_a_scene_are_the_laws_that_they_write_down),
        TEST_WITHOUT_FIGURES(test_formulas_is_refused_where_it_finds_none),
        TEST_WITHOUT_FIGURES(test_formulas_of_a_scene_are_refused_with_their_place),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
