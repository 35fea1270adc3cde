// SPDX-License-Identifier: GPL-3.0-or-later
//
// Which of several states is the first does not matter: a cold one, which has not seen the core
// that a hot one reaches, says nothing of the potential there. Each has the pairs of all.
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"
#include "shared/twins.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define LAW "{\"law\": \"lennard-jones\", \"cutoff\": 1.122462048309373}"
static const char scene[] =
    "{\"seed\": 3, \"box\": [7, 7, 7], \"temperature\": 3, \"particles\": {\"count\": 200},\n"
    "\"time_step\": 0.002, \"conservative\": " LAW ",\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3, \"cutoff\": 1.5},\n"
    "\"rdf\": {\"range\": 1.8, \"bins\": 90},\n"
    "\"measure\": {\"equilibration\": 3000, \"samples\": 700, \"every\": 20}}\n";

#define STATE(name, temperature)                                                                   \
    "\"" name "\": {\"scene\": {\"temperature\": " temperature "},\n"                              \
    "  \"target\": {\"rdf\": {\"file\": \"" name "/rdf.tsv\"}}}"
#define HOT STATE("hot", "3")
#define COLD STATE("cold", "0.7")
#define RUN(first, second)                                                                         \
    "{\"seed\": 5, \"scene\": {\"box\": [7, 7, 7], \"particles\": {\"count\": 200}},\n"            \
    "\"states\": {" first ",\n" second "},\n"                                                      \
    "\"unknowns\": {\"potential\": {\"truth\": " LAW "}},\n"                                       \
    "\"verification\": {\"samples\": 50, \"every\": 20},\n"                                        \
    "\"method\": {\"name\": \"imc\", \"iterations\": 20, \"precision\": 0.02}}\n"

static struct run_program_result result;

/// rms of (Φ − truth)/error where there is an error.
static double read_deviation(const char *out) {
    char file[64], line[256];
    double squares = 0, count = 0;
    snprintf(file, sizeof file, "%s/potential.tsv", out);
    FILE *stream = fopen(file, "r");
    assert_non_null(stream);
    while (fgets(line, sizeof line, stream)) {
        double r, phi, force, error, without_ramp, truth;
        if (sscanf(line, "%lf %lf %lf %lf %lf %lf", &r, &phi, &force, &error, &without_ramp,
                   &truth) != 6 ||
            !(error > 0))
            continue;
        squares += pow((phi - truth) / error, 2);
        if (count++ < 3)
            print_message("%s: r = %.2f: %.2f, error %.2f, truth %.2f\n", out, r, phi, error,
                          truth);
    }
    fclose(stream);
    print_message("%s: off by %.2f stated errors\n", out, sqrt(squares / count));
    return sqrt(squares / count);
}

static void test_states_find_the_law_in_either_order(void **state) {
    static const char *const out[] = {"hot-first", "cold-first"};
    small_inputs_write(*state, "hot.json", scene, NULL, NULL);
    small_inputs_write(*state, "cold.json", scene, "\"temperature\": 3", "\"temperature\": 0.7");
    twins_simulate("hot.json", "hot");
    twins_simulate("cold.json", "cold");
    small_inputs_write(*state, "run.json", RUN(HOT, COLD), NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", out[0]);
    run_program_assert_code(&result, 0);
    small_inputs_write(*state, "run.json", RUN(COLD, HOT), NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", out[1]);
    run_program_assert_code(&result, 0);
    for (int k = 0; k < 2; k++)
        assert_true(read_deviation(out[k]) < 1.5);
}

#define MIXTURE(name, a, b, more)                                                                  \
    "\"" name "\": {\"scene\": {\"particles\": {\"types\": {\"A\": " a ", \"B\": " b "}}},\n"      \
    " \"target\": {\"rdf\": {\"A-A\": {\"file\": \"g.tsv\"}, \"A-B\": {\"file\": \"g.tsv\"}" more  \
    "}}}"
static const char mixtures[] =
    "{\"scene\": {\"box\": [7, 7, 7], \"temperature\": 1},\n"
    "\"states\": {" MIXTURE("mix", "100", "100", ", \"B-B\": {\"file\": \"g.tsv\"}") ",\n" MIXTURE(
        "dilute", "200", "1", "") "}}\n";

/// A single bead has no pair of its type.
static void test_states_have_the_same_pairs(void **state) {
    char table[4096] = "# r g g_error\n";
    for (int k = 0; k < 60; k++) {
        const double r = 0.05 * k + 0.025;
        const size_t used = strlen(table);
        snprintf(table + used, sizeof table - used, "%g %g 0.01\n", r, 1 - exp(-4 * r * r));
    }
    small_inputs_write(*state, "g.tsv", table, NULL, NULL);
    small_inputs_write(*state, "run.json", mixtures, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out");
    run_program_assert_code(&result, 2);
    assert_non_null(strstr(result.err, "states.dilute: target.rdf: one state has g(r) of B-B"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_states_have_the_same_pairs,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_states_find_the_law_in_either_order,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
