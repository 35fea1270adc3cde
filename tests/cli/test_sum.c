// SPDX-License-Identifier: GPL-3.0-or-later
//
// The law "sum" from outside: the same energies, forces and pressures as its parts as one table,
// written back as it was read, and faults in one line each.
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define CORE "\"core\": {\"law\": \"lennard-jones\", \"cutoff\": 1.122462048309373}"
#define COULOMB                                                                                    \
    "\"coulomb\": {\"law\": \"expression\", \"formula\": \"2*exp(-r/0.8)/r\", "                    \
    "\"inner_cutoff\": 0.3, \"cutoff\": 2}"
#define SUM "{\"law\": \"sum\", \"of\": {" CORE ", " COULOMB "}}"
static const char scene[] =
    "{\"seed\": 5, \"box\": [6, 6, 6], \"particles\": {\"count\": 120}, \"time_step\": 0.004,\n"
    "\"conservative\": " SUM ", \"precision\": \"double\",\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 6, \"cutoff\": 2},\n"
    "\"measure\": {\"equilibration\": 40, \"samples\": 5, \"every\": 1}}\n";

static struct run_program_result result;

/// r and the sum of both, each 0 at its cutoff, by their formulas.
static void write_table(struct temporary_folder *folder) {
    enum { ROWS = 2001 };
    char *text = malloc(ROWS * 64L);
    size_t used = 0;
    assert_non_null(text);
    const double end = -1, last = 2 * exp(-2 / 0.8) / 2;
    for (int k = 600; k < ROWS; k++) {
        const double r = 0.001 * k;
        const double core = r < 1.122462048309373 ? 4 * (pow(r, -12) - pow(r, -6)) - end : 0;
        used += (size_t)snprintf(text + used, 64, "%.4f %.12g\n", r,
                                 core + 2 * exp(-r / 0.8) / r - last);
    }
    temporary_folder_write(folder, "sum.tsv", text, used);
    free(text);
}

static void simulate(struct temporary_folder *folder, const char *law, const char *out) {
    small_inputs_write(folder, "scene.json", scene, SUM, law);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", out, "--quiet");
    assert_in_range(result.code, 0, 1); // it is over before it is in equilibrium
}

static void test_sum_acts_as_its_table(void **state) {
    static const char *const numbers[] = {"potential_energy", "pressure",
                                          "temperature_configurational", "temperature"};
    write_table(*state);
    simulate(*state, SUM, "sum");
    simulate(*state, "{\"law\": \"table\", \"file\": \"sum.tsv\"}", "table");
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
        assert_close_relative(results_number("sum/summary.json", numbers[k]),
                              results_number("table/summary.json", numbers[k]), 1e-4);
}

static void test_sum_of_one_is_that_law_and_is_written_back(void **state) {
    static const char *const same[] = {"rdf.tsv", "thermodynamics.tsv", NULL};
    simulate(*state, "{\"law\": \"sum\", \"of\": {" COULOMB "}}", "sum");
    RUN_PROGRAM(&result, "simulate", "sum/used.json", "-o", "again", "--quiet");
    results_assert_same("sum", "again", same);
    results_assert_text("sum/used.json", "conservative.of.coulomb.law", "expression");
    simulate(*state,
             "{\"law\": \"expression\", \"formula\": \"2*exp(-r/0.8)/r\", \"inner_cutoff\": 0.3, "
             "\"cutoff\": 2}",
             "alone");
    assert_close_relative(results_number("sum/summary.json", "pressure"),
                          results_number("alone/summary.json", "pressure"), 1e-6);
}

static void refuse(void *state, const char *law, const char *word) {
    const char *words[] = {word, NULL};
    small_inputs_write(state, "scene.json", scene, SUM, law);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "wrong", "--quiet");
    run_program_assert_refused(&result, "wrong", word, 1, words);
}

static void test_what_is_wrong_is_said_in_one_line(void **state) {
    refuse(*state, "{\"law\": \"sum\"}", "conservative.of: missing");
    refuse(*state, "{\"law\": \"sum\", \"of\": {}}", "conservative.of: is empty");
    refuse(*state, "{\"law\": \"sum\", \"of\": [{\"law\": \"gaussian\"}]}", "conservative.of");
    refuse(*state, "{\"law\": \"sum\", \"of\": {\"a\": {\"law\": \"yukawa\"}}}",
           "conservative.of.a.law");
    refuse(*state, "{\"law\": \"sum\", \"of\": {\"a\": {\"law\": \"gaussian\", \"width\": 1}}}",
           "conservative.of.a.width: unknown key");
    refuse(*state,
           "{\"law\": \"sum\", \"of\": {\"a\": {\"law\": \"table\", \"file\": \"no.tsv\"}}}",
           "no.tsv");
    refuse(*state, "{\"law\": \"sum\", \"of\": {\"a\": {\"law\": \"none\"}}}",
           "conservative.of: is empty");
    refuse(*state, "{\"law\": \"gaussian\", \"of\": {" CORE "}}", "conservative.of: unknown key");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_sum_acts_as_its_table,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_sum_of_one_is_that_law_and_is_written_back,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_what_is_wrong_is_said_in_one_line,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
