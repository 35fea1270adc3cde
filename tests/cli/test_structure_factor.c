// SPDX-License-Identifier: GPL-3.0-or-later
//
// An observable of which nothing but its record and the list knows, from outside: in a scene, in a
// restart, and as a target.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>

#include <stdio.h>
#include <stdlib.h>

#define FLUID                                                                                      \
    "\"box\": [4.64, 4.64, 4.64], \"particles\": {\"count\": 300}, \"time_step\": 0.04,\n"         \
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 2.1213}"
#define LAW "{\"law\": \"soft-repulsion\", \"a\": 25}"

static const char scene[] =
    "{\"seed\": 5, " FLUID ", \"conservative\": " LAW ", \"rdf\": {\"bins\": 20},\n"
    "\"structure_factor\": {\"q_maximum\": 9, \"bins\": 30},\n"
    "\"measure\": {\"equilibration\": 200, \"samples\": 80, \"every\": 20}}\n";

/// The target is what the fluid of the true potential has, with which the fit begins.
static const char fit[] =
    "{\"seed\": 6, \"target\": {\"rdf\": {\"file\": \"whole/rdf.tsv\"}, \"structure_factor\":\n"
    "{\"file\": \"whole/structure_factor.tsv\", \"q_maximum\": 9, \"bins\": 30}},\n"
    "\"unknowns\": {\"potential\": {\"maximum\": 30, \"coefficients\": 5, \"start\": " LAW "}},\n"
    "\"scene\": {" FLUID "}, \"method\": {\"name\": \"genetic\", \"population\": 4,\n"
    "\"generations\": 1, \"equilibration\": 50, \"samples\": 8, \"every\": 10},\n"
    "\"verification\": {\"replicas\": 4, \"equilibration\": 100, \"samples\": 20, \"every\": "
    "20}}\n";

static const char *const tables[] = {"structure_factor.tsv", "rdf.tsv", "used.json", NULL};

static void write_text(struct temporary_folder *folder, const char *name, const char *text) {
    small_inputs_write(folder, name, text, NULL, NULL);
}

static void test_structure_factor_goes_on_with_the_same_bits(void **state) {
    static struct run_program_result result;
    write_text(*state, "scene.json", scene);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "whole");
    run_program_assert_code(&result, 0);
    const char *const words[] = {"simulate", "scene.json", "-o", "pieces", NULL};
    run_program_in_pieces(0, words);
    results_assert_same("whole", "pieces", tables);
    RUN_PROGRAM(&result, "simulate", "whole/used.json", "-o", "again", "--threads", "2");
    run_program_assert_code(&result, 0);
    results_assert_same("whole", "again", tables);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--explain");
    assert_contains(result.out, "structure factor                   on ");
    RUN_PROGRAM(&result, "describe", "structure_factor");
    assert_contains(result.out, "q_maximum");
}

/// Its distance from the target is noise: of 23 rows the mean square is beyond 9 noise² with
/// p < 1e-6, also if only five of them were independent.
static void test_structure_factor_can_be_a_target(void **state) {
    static struct run_program_result result;
    write_text(*state, "scene.json", scene);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "whole");
    run_program_assert_code(&result, 0);
    write_text(*state, "fit.json", fit);
    RUN_PROGRAM(&result, "fit", "fit.json", "-o", "fit");
    run_program_assert_code(&result, 0);
    results_assert_table("fit/structure_factor.tsv", 5, 23);
    const double rms = results_number("fit/summary.json", "structure_factor_rmse"),
                 noise = results_number("fit/summary.json", "structure_factor_noise");
    assert_true(noise > 0 && noise < 0.05);
    assert_true(rms < 3 * noise);
    RUN_PROGRAM(&result, "fit", "fit/used.json", "-o", "again");
    run_program_assert_code(&result, 0);
    results_assert_same("fit", "again", (const char *const[]){"structure_factor.tsv", NULL});
    RUN_PROGRAM(&result, "fit", "fit.json", "--explain");
    assert_contains(result.out, "structure factor                   on ");
}

static void test_structure_factor_says_what_its_target_lacks(void **state) {
    static struct run_program_result result;
    static const struct {
        const char *from, *to, *key, *why;
    } faults[] = {
        {"\"q_maximum\": 9, ", "", "target.structure_factor.q_maximum", "missing"},
        {"\"bins\": 30}", "\"bins\": 30, \"time_column\": 1}",
         "target.structure_factor.time_column", "unknown key"},
        {"whole/structure_factor.tsv", "falls.tsv", "target.structure_factor.file",
         "does not increase"},
        // Found now, and not by the verification of a fit that has ended.
        {"\"q_maximum\": 9, \"bins\": 30}", "\"q_maximum\": 1, \"bins\": 30, \"fitted\": \"no\"}",
         "q_maximum 1", "longest wave"},
    };
    write_text(*state, "scene.json", scene);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "whole");
    write_text(*state, "falls.tsv", "1 1\n3 1\n2 1\n");
    for (size_t k = 0; k < sizeof faults / sizeof *faults; k++) {
        small_inputs_write(*state, "fit.json", fit, faults[k].from, faults[k].to);
        RUN_PROGRAM(&result, "fit", "fit.json", "-o", "fit");
        run_program_assert_code(&result, 2);
        assert_contains(result.err, faults[k].key);
        assert_contains(result.err, faults[k].why);
    }
}

/// a of the potential from S(q), begun far away, whose error as a whole is at its noise long before
/// a is found. A row beyond q_maximum is told to be left out. False alarms: 1 in 10,000 for another
/// seed, if the error is honest.
static void test_number_is_found_from_a_structure_factor_begun_far_away(void **state) {
    static struct run_program_result result;
    static const char numbers[] =
        "{\"seed\": 6, \"target\": {\"structure_factor\": {\"file\": \"target.tsv\", "
        "\"q_maximum\": 14,\n"
        "\"bins\": 200}}, \"unknowns\": {\"numbers\": {\"conservative.a\": {\"minimum\": 5, "
        "\"maximum\": 50}}},\n"
        "\"scene\": {" FLUID ", \"conservative\": {\"law\": \"soft-repulsion\", \"a\": 12}},\n"
        "\"method\": {\"name\": \"gauss-newton\", \"equilibration\": 200, \"samples\": 10, "
        "\"every\": 10,\n"
        "\"temperature_tolerance\": 0.4}, \"verification\": {\"replicas\": 4, \"equilibration\": "
        "100,\n"
        "\"samples\": 20, \"every\": 20}}\n";
    small_inputs_write(*state, "scene.json", scene, "\"q_maximum\": 9, \"bins\": 30",
                       "\"q_maximum\": 14, \"bins\": 200");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "whole");
    char *table = temporary_folder_read("whole/structure_factor.tsv"), longer[32768];
    snprintf(longer, sizeof longer, "%s30\t1\t0.01\t9\n", table);
    free(table);
    write_text(*state, "target.tsv", longer);
    write_text(*state, "numbers.json", numbers);
    RUN_PROGRAM(&result, "fit", "numbers.json", "-o", "numbers");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, ": no others were measured");
    const double a = results_parameter("numbers/summary.json", "conservative.a", "value");
    const double error = results_parameter("numbers/summary.json", "conservative.a", "error");
    print_message("a = %g(%g)\n", a, error);
    assert_true(error < 2);
    assert_true(fabs(a - 25) < 4 * error);
}

/// A molecule's form is in S(q): the length of its bonds and the repulsion of its beads at once.
static void test_bonds_are_found_from_a_structure_factor_alone(void **state) {
    static struct run_program_result result;
    static const char melt[] =
        "\"box\": [4.4, 4.4, 4.4], \"time_step\": 0.01,\n"
        "\"dissipative\": {\"law\": \"power\", \"sigma\": 3},\n"
        "\"molecules\": {\"trimer\": {\"count\": 80, \"exclude\": 0,\n"
        "  \"chain\": {\"type\": \"A\", \"length\": 3, \"bond\": \"backbone\"}}},\n";
    static const char laws[] = "\"bonds\": {\"backbone\": {\"law\": \"harmonic\", \"k\": 100, "
                               "\"length\": %g}},\n"
                               "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": %g}";
    char text[4096], truth[512], start[512];
    snprintf(truth, sizeof truth, laws, 0.6, 25.0);
    snprintf(start, sizeof start, laws, 0.7, 15.0);
    snprintf(text, sizeof text,
             "{\"seed\": 61, %s%s, \"structure_factor\": {\"q_maximum\": 14},\n"
             "\"measure\": {\"equilibration\": 1000, \"samples\": 500, \"every\": 25}}",
             melt, truth);
    write_text(*state, "melt.json", text);
    RUN_PROGRAM(&result, "simulate", "melt.json", "-o", "melt");
    run_program_assert_code(&result, 0);
    snprintf(text, sizeof text,
             "{\"seed\": 3, \"target\": {\"structure_factor\": {\"q_maximum\": 14,\n"
             "\"file\": \"melt/structure_factor.tsv\"}}, \"unknowns\": {\"numbers\": {\n"
             "\"bonds.backbone.length\": {\"minimum\": 0.3, \"maximum\": 1},\n"
             "\"conservative.a\": {\"minimum\": 5, \"maximum\": 60}}},\n"
             "\"scene\": {%s%s}, \"method\": {\"name\": \"gauss-newton\", \"iterations\": 10,\n"
             "\"equilibration\": 300, \"samples\": 60, \"every\": 25,\n"
             "\"temperature_tolerance\": 0.5}, \"verification\": {\"replicas\": 2,\n"
             "\"equilibration\": 300, \"samples\": 60, \"every\": 25}}",
             melt, start);
    write_text(*state, "bonds.json", text);
    RUN_PROGRAM(&result, "fit", "bonds.json", "-o", "bonds");
    run_program_assert_code(&result, 0);
    static const struct {
        const char *name;
        double truth, max;
    } number[] = {{"bonds.backbone.length", 0.6, 0.02}, {"conservative.a", 25, 2}};
    for (int k = 0; k < 2; k++) {
        const double value = results_parameter("bonds/summary.json", number[k].name, "value");
        const double error = results_parameter("bonds/summary.json", number[k].name, "error");
        print_message("%s = %g(%g)\n", number[k].name, value, error);
        assert_true(error < number[k].max);
        assert_true(fabs(value - number[k].truth) < 4 * error);
    }
}

#define TEST(test)                                                                                 \
    cmocka_unit_test_setup_teardown(test, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_structure_factor_goes_on_with_the_same_bits),
        TEST(test_structure_factor_can_be_a_target),
        TEST(test_structure_factor_says_what_its_target_lacks),
        TEST(test_number_is_found_from_a_structure_factor_begun_far_away),
        TEST(test_bonds_are_found_from_a_structure_factor_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
