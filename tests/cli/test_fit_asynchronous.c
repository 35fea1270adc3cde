// SPDX-License-Identifier: GPL-3.0-or-later
//
// Fits in which nobody waits for the end of a round.
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>

#define SCENE                                                                                      \
    "\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02, "                    \
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}"
#define FIT(method)                                                                                \
    "{\"seed\": 3, \"target\": {\"rdf\": {\"file\": \"target/rdf.tsv\"}}, \"unknowns\": "          \
    "{\"potential\": {\"coefficients\": 4, \"maximum\": 30}}, \"scene\": {" SCENE "}, "            \
    "\"method\": {\"asynchronous\": \"yes\", " method                                              \
    ", \"equilibration\": 40, \"samples\": 8, \"every\": 5, \"temperature_tolerance\": 0.5}, "     \
    "\"core\": {\"threshold\": 0.05, \"stiffness\": 50}, \"verification\": {\"replicas\": 2, "     \
    "\"equilibration\": 20, \"samples\": 8, \"every\": 5}}\n"
#define GENETIC "\"name\": \"genetic\", \"population\": 8, \"generations\": 5, \"step\": 0.1"

static const char sentence[] = "not the same bits from run to run, nor after --resume";

static void write_inputs(struct temporary_folder *folder, const char *fit) {
    static struct run_program_result result;
    small_inputs_write(folder, "scene.json",
                       "{\"seed\": 5, \"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25}, "
                       "\"measure\": {\"equilibration\": 100, \"samples\": 40}, "
                       "\"rdf\": {\"range\": 1, \"bins\": 20}, " SCENE "}",
                       NULL, NULL);
    small_inputs_write(folder, "run.json", fit, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "target", "--quiet");
    run_program_assert_code(&result, 0);
}

/// Rows of a table that are no headings.
static int count_rows(const char *path) {
    char *text = temporary_folder_read(path), *rest;
    int rows = 0;
    for (char *line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest))
        rows += line[0] != '#';
    free(text);
    return rows;
}

/// Simulations have seeds of their own: no two of them have the same error, though elites and
/// challengers are measured again.
static void check_errors(void) {
    enum { MOST = 200 };
    char *text = temporary_folder_read("out/individuals.tsv"), *rest;
    double error[MOST];
    int rows = 0;
    for (char *line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        if (line[0] == '#')
            continue;
        assert_true(rows < MOST);
        assert_int_equal(sscanf(line, "%*d %*d %lf", &error[rows]), 1);
        for (int k = 0; k < rows; k++)
            assert_true(error[k] != error[rows]);
        rows++;
    }
    free(text);
}

/// A row a generation, one for the last challenger, and an individual for each evaluation that is
/// no check; whoever reads the folder sees that another run gives other bits.
static void check_folder(int generations, int population) {
    char *summary = temporary_folder_read("out/summary.json");
    char *used = temporary_folder_read("out/used.json");
    assert_contains(summary, "\"depends_on_timing\":\t\"yes\"");
    assert_contains(used, "\"asynchronous\":\t\"yes\"");
    free(summary);
    free(used);
    assert_int_equal(count_rows("out/history.tsv"), generations + 1);
    assert_true(count_rows("out/individuals.tsv") >= generations * population);
    assert_true(count_rows("out/population_potential.tsv") > 0);
    check_errors();
}

static void test_fit_has_a_row_a_generation_when_asynchronous(void **state) {
    static struct run_program_result result;
    write_inputs(*state, FIT(GENETIC));
    RUN_PROGRAM(&result, "fit", "run.json", "--threads", "3");
    assert_in_range(result.code, 0, 1);
    assert_contains(result.err, sentence);
    check_folder(5, 8);
    RUN_PROGRAM(&result, "fit", "run.json", "--explain", "--ranks", "8", "--threads", "2");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, sentence);
    assert_contains(result.out, " 8 ranks: ");
}

static void test_fit_has_a_row_a_round_when_cmaes_is_asynchronous(void **state) {
    static struct run_program_result result;
    write_inputs(*state,
                 FIT("\"name\": \"cma-es\", \"population\": 8, \"rounds\": 5, \"step\": 0.1"));
    RUN_PROGRAM(&result, "fit", "run.json", "--threads", "3", "--quiet");
    assert_in_range(result.code, 0, 1);
    check_folder(5, 8);
}

static void test_fit_ends_when_asynchronous_and_interrupted(void **state) {
    static struct run_program_result result;
    const struct run_program_how how = {.interrupt_with = SIGINT};
    write_inputs(*state, FIT(GENETIC));
    run_program(&result, &how, (const char *const[]){"fit", "run.json", "--threads", "3", NULL});
    run_program_assert_code(&result, 130);
    RUN_PROGRAM(&result, "fit", "run.json", "--threads", "2", "--resume", "--quiet");
    assert_in_range(result.code, 0, 1);
    check_folder(5, 8);
}

static void test_fit_refuses_what_rounds_have_when_asynchronous(void **state) {
    static struct run_program_result result;
    static const struct {
        const char *fit, *name;
    } refused[] = {
        {FIT(GENETIC ", \"racing\": 2"), "\"racing\""},
        {FIT(GENETIC ", \"warm_start\": \"yes\""), "\"warm_start\""},
        {FIT(GENETIC ", \"common_noise\": \"yes\""), "\"common_noise\""},
        {FIT(GENETIC ", \"surrogate\": \"join\""), "\"surrogate\""},
        {FIT(GENETIC ", \"islands\": 2"), "\"islands\""},
        {FIT("\"name\": \"nlopt\""), "asynchronous: unknown key"},
    };
    for (size_t k = 0; k < sizeof refused / sizeof *refused; k++) {
        write_inputs(*state, refused[k].fit);
        RUN_PROGRAM(&result, "fit", "run.json", "--quiet");
        run_program_assert_refused(&result, "out", refused[k].name, 1,
                                   (const char *[]){"run.json", refused[k].name, NULL});
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_fit_has_a_row_a_generation_when_asynchronous,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_fit_has_a_row_a_round_when_cmaes_is_asynchronous,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_fit_ends_when_asynchronous_and_interrupted,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_fit_refuses_what_rounds_have_when_asynchronous,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
