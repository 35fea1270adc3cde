// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit fit --friction`, and the same as a key: ω is looked for in a family that other engines
// run, and a twin of that family is found again.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"
#include "shared/twins.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char soft_fluid[] =
    "{\"seed\": 5, \"box\": [4, 4, 4], \"particles\": {\"count\": 192}, \"time_step\": 0.02,\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 6, \"exponent\": 0.5},\n"
    "\"measure\": {\"equilibration\": 200, \"samples\": 600, \"every\": 10},\n"
    "\"etd\": {\"r_minimum\": 0.4, \"r_maximum\": 0.9, \"bins\": 12, \"times\": 12, \"every\": "
    "2}}\n";

static const char fit[] =
    "{\"seed\": 3, FRICTION\"target\": {\"etd\": {\"file\": \"target/etd.tsv\", \"error_file\": "
    "\"target/etd_error.tsv\", \"r_minimum\": 0.4, \"r_maximum\": 0.9}},\n"
    "\"unknowns\": {UNKNOWNS},\n"
    "\"scene\": {\"box\": [4, 4, 4], \"particles\": {\"count\": 192}, \"time_step\": 0.02,\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25}},\n"
    "\"method\": {\"name\": \"gauss-newton\", \"iterations\": 4, \"equilibration\": 100, "
    "\"samples\": 120, \"every\": 8},\n"
    "\"verification\": {\"replicas\": 1, \"equilibration\": 50, \"samples\": 50, \"every\": 8}}\n";

static const char omega[] = "\"omega\": {\"minimum\": 0, \"maximum\": 16}";

static void write_run(struct temporary_folder *folder, const char *friction, const char *unknowns) {
    small_inputs_write(folder, "scene.json", soft_fluid, NULL, NULL);
    twins_simulate("scene.json", "target");
    small_inputs_write(folder, "run.json", fit, "FRICTION", friction);
    char *text = temporary_folder_read("run.json");
    small_inputs_write(folder, "run.json", text, "UNKNOWNS", unknowns);
    free(text);
}

/// The exponent within four of its errors, and those small enough that 1.5 would be told.
static void test_twin_of_the_family_is_found(void **state) {
    static struct run_program_result result;
    write_run(*state, "", omega);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "fit", "--friction", "exportable");
    assert_contains(result.err, "inner_cutoff = 0 (fixed), cutoff = 1 (fixed)\n");
    assert_contains(result.err, "LAMMPS runs this omega as it is: dpd/ext/tstat");
    const double exponent = results_number("fit/summary.json", "parameters.omega.exponent.value");
    const double error = results_number("fit/summary.json", "parameters.omega.exponent.error");
    print_message("exponent %.3f(%.3f) of 0.5\n", exponent, error);
    assert_true(fabs(exponent - 0.5) < 4 * error && error < 0.25);
    assert_true(results_number("fit/summary.json", "parameters.omega.inner_cutoff.value") == 0);
    RUN_PROGRAM(&result, "export", "fit", "--engine", "lammps", "--quiet");
    run_program_assert_code(&result, 0);
    char *text = temporary_folder_read("lammps/in.mesofit");
    assert_contains(text, "pair_coeff 1 1 dpd/ext/tstat ");
    free(text);
}

/// Where "unknowns" are left to the program.
static void test_family_is_chosen_with_the_rest(void **state) {
    static struct run_program_result result;
    static const char target[] =
        "{KEY\"target\": {\"rdf\": {\"file\": \"rdf.tsv\", \"particles\": 192}, \"etd\": "
        "{\"file\": \"etd.tsv\", \"error_file\": \"etd_error.tsv\"}}, \"scene\": "
        "{\"density\": 3, \"temperature\": 1}}\n";
    small_inputs_write(*state, "scene.json", soft_fluid, NULL, NULL);
    twins_simulate("scene.json", "target");
    small_inputs_write(*state, "target/target.json", target, "KEY", "");
    RUN_PROGRAM(&result, "fit", "--target", "target", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "omega: 8 coefficients");
    RUN_PROGRAM(&result, "fit", "--target", "target", "--explain", "--friction", "linear");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "omega: a power law of 1 - r/");
    const double most = strtod(strstr(result.out, "at r = 0 from 0 to ") + 19, NULL);
    small_inputs_write(*state, "target/target.json", target, "KEY",
                       "\"friction\": \"exportable\", ");
    RUN_PROGRAM(&result, "fit", "--target", "target", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "omega: a power law of 1 - r/");
    assert_true(strtod(strstr(result.out, "at r = 0 from 0 to ") + 19, NULL) > 2 * most);
}

static void assert_refused(const char *option, const char *word) {
    static struct run_program_result result;
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "none", option, option ? "exportable" : NULL);
    run_program_assert_refused(&result, "none", word, 1, (const char *const[]){word, NULL});
}

static void test_what_does_not_go_together_is_one_line(void **state) {
    static const char exportable[] = "\"friction\": \"exportable\", ";
    write_run(*state, exportable,
              "\"omega\": {\"curve\": \"bspline\", \"coefficients\": 4, \"maximum\": 8}");
    assert_refused(NULL, "\"bspline\" is not the power law that \"friction\" asks for");
    write_run(*state, exportable, omega);
    assert_refused("--friction", "--friction: run.json has friction");
    write_run(*state, "\"friction\": \"exportible\", ", omega);
    assert_refused(NULL, "exportable");
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_twin_of_the_family_is_found),
        TEST(test_family_is_chosen_with_the_rest),
        TEST(test_what_does_not_go_together_is_one_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
