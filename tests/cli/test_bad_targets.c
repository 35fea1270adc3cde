// SPDX-License-Identifier: GPL-3.0-or-later
//
// Fits of a friction weight that cannot be right: exit code 2, one line with the file and the key,
// found when the run file is read. And what is unusual but right.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>

/// Times 0.04 apart and a window of 0.16: 8 steps.
static const char escape[] = "# t E E E\n0 1 1 1\n0.04 0.98 0.9 0.7\n0.08 0.95 0.8 0.6\n"
                             "0.12 0.9 0.75 0.5\n0.16 0.88 0.7 0.45\n";
static const char escape_with_holes[] = "# t E E E\n0 1 1 1\n0.04 nan 0.9 0.7\n0.08 nan 0.8 0.6\n"
                                        "0.12 0.9 0.75 nan\n0.16 0.88 0.7 0.45\n";

#define ETD "\"etd\": {\"file\": \"etd.tsv\", \"r_minimum\": 0.4, \"r_maximum\": 0.9}"
#define OMEGA "\"omega\": {\"coefficients\": 4, \"maximum\": 6}"
#define POTENTIAL "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25}"
#define STEP "\"time_step\": 0.02"
#define GENETIC "\"name\": \"genetic\", \"population\": 4, \"generations\": 1"
#define MEMORY(omega) ", \"memory\": {\"slow\": {\"time\": 0.2" omega "}}"
#define FIT_PLAN "\"samples\": 4, \"every\": 4"
#define CHECK_PLAN "\"samples\": 3, \"every\": 5"

static const char good[] =
    "{\"seed\": 3, \"target\": {" ETD "}, \"unknowns\": {" OMEGA "},\n"
    "\"scene\": {\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, " STEP ", " POTENTIAL "},\n"
    "\"method\": {" GENETIC ", \"equilibration\": 10, " FIT_PLAN
    ", \"temperature_tolerance\": 0.9},\n"
    "\"verification\": {\"replicas\": 2, \"equilibration\": 10, " CHECK_PLAN "}}\n";

enum { MAX_WORDS = 5 };

struct fault {
    const char *what, *from, *to; ///< in the good file
    const char *words[MAX_WORDS];
};

#define FAULT(name, old, new, ...)                                                                 \
    {                                                                                              \
        .what = (name), .from = (old), .to = (new), .words = { "run.json", __VA_ARGS__ }           \
    }

static const struct fault faults[] = {
    FAULT("a time step that does not divide the interval", STEP, "\"time_step\": 0.03",
          "scene.time_step", "etd.tsv", "a time step of 0.02 or 0.04"),
    FAULT("the same of the verification", CHECK_PLAN, CHECK_PLAN ", \"time_step\": 0.015",
          "verification.time_step", "etd.tsv", "a time step of 0.0133333 or 0.02"),
    FAULT("a fit shorter than the window", FIT_PLAN, "\"samples\": 2, \"every\": 3",
          "method.samples: 2", "6 steps", "\"etd\" looks at 8; 3 would do"),
    FAULT("a verification shorter than the window", CHECK_PLAN, "\"samples\": 1, \"every\": 7",
          "verification.samples: 1", "7 steps", "looks at 8; 2 would do"),
    FAULT("a verification that is too short by its time step", CHECK_PLAN,
          CHECK_PLAN ", \"time_step\": 0.01", "verification.samples: 3", "looks at 16; 4 would do"),
    FAULT("a window of motion", ETD, "\"diffusion\": {\"value\": 0.2}", "method.samples",
          "\"diffusion\" looks at"),
    FAULT("a cutoff longer than half the cell", "\"coefficients\": 4",
          "\"coefficients\": 4, \"cutoff\": 1.6", "scene", "box", "1.6"),
    FAULT("a cutoff below the inner one", "\"coefficients\": 4",
          "\"coefficients\": 4, \"cutoff\": 0.5, \"inner_cutoff\": 0.6", "unknowns.omega.cutoff",
          "0.6"),
    FAULT("variables without a range", "\"maximum\": 6", "\"maximum\": 0",
          "unknowns.omega.maximum"),
    FAULT("no unknown", OMEGA, "", "unknowns",
          "needs \"potential\", \"omega\", \"numbers\", or \"bonds\""),
    FAULT("another unknown", OMEGA, OMEGA ", \"mass\": {}", "unknowns.mass", "unknown key"),
    FAULT("a potential that is known and unknown", OMEGA, OMEGA ", \"potential\": {}",
          "scene.conservative", "unknown key"),
    FAULT("no potential", ", " POTENTIAL, "", "scene.conservative", "missing"),
    FAULT("a friction weight that is known and unknown", POTENTIAL,
          POTENTIAL ", \"dissipative\": {\"law\": \"power\"}", "scene.dissipative", "unknown key"),
    FAULT("a memory that the scene has not", OMEGA,
          OMEGA ", \"memory\": {\"slow\": {\"coefficients\": 4}}", "unknowns.memory.slow",
          "unknown key"),
    FAULT("a memory that is known and unknown",
          OMEGA "},\n\"scene\": {\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, " STEP,
          OMEGA
          ", \"memory\": {\"slow\": {\"coefficients\": 4}}},\n\"scene\": {\"box\": [3, 3, 3], "
          "\"particles\": {\"count\": 81}, " STEP MEMORY(", \"omega\": {\"law\": \"power\"}"),
          "unknowns.memory.slow", "has an \"omega\""),
    FAULT("a memory that is neither",
          OMEGA "},\n\"scene\": {\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, " STEP,
          OMEGA
          ", \"memory\": {\"fast\": {\"coefficients\": 4}}},\n\"scene\": {\"box\": [3, 3, 3], "
          "\"particles\": {\"count\": 81}, " STEP
          ", \"memory\": {\"slow\": {\"time\": 0.2}, \"fast\": {\"time\": 0.1}}",
          "unknowns.memory.slow", "is missing"),
    FAULT("a memory whose range no step follows",
          OMEGA "},\n\"scene\": {\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, " STEP,
          OMEGA ", \"memory\": {\"slow\": {\"coefficients\": 4}}, \"numbers\": "
                "{\"memory.slow.time\": {\"minimum\": 0.03, \"maximum\": 1}}},\n\"scene\": "
                "{\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, " STEP MEMORY(""),
          "unknowns.numbers.memory.slow.time.minimum", "0.03 is below two time steps, 0.04"),
    FAULT("a memory that may swing faster than steps",
          OMEGA "},\n\"scene\": {\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, " STEP,
          OMEGA
          ", \"memory\": {\"slow\": {\"coefficients\": 4}}, \"numbers\": "
          "{\"memory.slow.frequency\": {\"minimum\": 1, \"maximum\": 30}}},\n\"scene\": "
          "{\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, " STEP MEMORY(", \"frequency\": 5"),
          "unknowns.numbers.memory.slow.frequency.maximum", "30 is beyond 25"),
    FAULT("a memory without omega that nothing finds", POTENTIAL, POTENTIAL MEMORY(""),
          "scene.memory.slow.omega", "missing"),
    FAULT("a formula across pairs", OMEGA, OMEGA ", \"omega_transverse\": {\"curve\": \"power\"}",
          "unknowns.omega_transverse.curve", "\"numbers\""),
    FAULT("friction across pairs that is known and unknown",
          OMEGA "},\n\"scene\": {\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, " STEP,
          OMEGA ", \"omega_transverse\": {}},\n\"scene\": {\"box\": [3, 3, 3], \"particles\": "
                "{\"count\": 81}, " STEP ", \"dissipative_transverse\": {\"law\": \"power\"}",
          "scene.dissipative_transverse", "it is to be found"),
    FAULT("a potential without its g(r)",
          OMEGA "},\n\"scene\": {\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, " STEP
                ", " POTENTIAL,
          "\"potential\": {}},\n\"scene\": {\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, "
          "" STEP,
          "target.rdf is required"),
    FAULT("a potential whose g(r) is not fitted",
          ETD "}, \"unknowns\": {" OMEGA "},\n\"scene\": {\"box\": [3, 3, 3], \"particles\": "
              "{\"count\": 81}, " STEP ", " POTENTIAL,
          ETD ", \"rdf\": {\"file\": \"target.tsv\", \"fitted\": \"no\"}}, \"unknowns\": "
              "{\"potential\": {}},\n\"scene\": {\"box\": [3, 3, 3], \"particles\": {\"count\": "
              "81}, " STEP,
          "target.rdf.fitted"),
    FAULT("nothing to be fitted", "\"etd\": {", "\"etd\": {\"fitted\": \"no\", ",
          "target: nothing to fit"),
    FAULT("no target", ETD, "", "target: nothing to fit"),
    FAULT("IMC of a friction weight",
          GENETIC ", \"equilibration\": 10, " FIT_PLAN ", \"temperature_tolerance\": 0.9",
          "\"name\": \"imc\"", "method.name", "\"imc\" does not find omega"),
    FAULT("an algorithm that NLopt does not know", GENETIC,
          "\"name\": \"nlopt\", \"algorithm\": \"LN_FOO\"", "method.algorithm", "LN_SBPLX",
          "GN_ESCH"),
    FAULT("escape farther than half the cell", "\"r_maximum\": 0.9", "\"r_maximum\": 1.6",
          "scene.box", "etd", "1.6"),
};

static void test_fit_of_omega_refuses_with_a_line_for_each_fault(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "etd.tsv", escape, NULL, NULL);
    small_inputs_write(*state, "target.tsv", small_inputs_target, NULL, NULL);
    for (size_t k = 0; k < sizeof faults / sizeof *faults; k++) {
        small_inputs_write(*state, "run.json", good, faults[k].from, faults[k].to);
        RUN_PROGRAM(&result, "fit", "run.json");
        run_program_assert_refused(&result, ".", faults[k].what, 1, faults[k].words);
        RUN_PROGRAM(&result, "fit", "run.json", "--explain");
        run_program_assert_refused(&result, ".", faults[k].what, 1, faults[k].words);
        assert_false(temporary_folder_exists("out"));
    }
}

static void test_imc_refuses_to_fit_more_than_rdf_and_pressure(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "etd.tsv", escape, NULL, NULL);
    small_inputs_write(*state, "target.tsv", small_inputs_target, NULL, NULL);
    small_inputs_write(*state, "run.json", small_inputs_run, "\"target\": {",
                       "\"target\": {\"diffusion\": {\"value\": 1}, ");
    RUN_PROGRAM(&result, "fit", "run.json");
    run_program_assert_refused(
        &result, ".", "diffusion", 1,
        (const char *[]){"run.json: target.diffusion.fitted: \"imc\" does not", "\"gauss-newton\"",
                         "\"no\" compares", NULL});
    small_inputs_write(*state, "run.json", small_inputs_run, "\"target\": {",
                       "\"target\": {\"pressure\": {\"value\": 20, \"fitted\": \"no\"}, ");
    RUN_PROGRAM(&result, "fit", "run.json");
    assert_in_range(result.code, 0, 1);
    results_number("out/summary.json", "pressure_rmse");
}

/// As many bins as there is no memory for, at bins² numbers a matrix: refused before it is asked
/// for.
static void test_imc_refuses_more_bins_than_it_can_solve_for(void **state) {
    enum { ROWS = 100000 };
    static struct run_program_result result;
    char *table = malloc(ROWS * 32), *end = table;
    assert_non_null(table);
    for (int k = 0; k < ROWS; k++)
        end += sprintf(end, "%.7f 1 0.01\n", (k + 0.5) * 1e-5);
    temporary_folder_write(*state, "target.tsv", table, (size_t)(end - table));
    free(table);
    small_inputs_write(*state, "run.json", small_inputs_run, "\"file\": \"target.tsv\"",
                       "\"file\": \"target.tsv\", \"bin_width\": 1e-5");
    RUN_PROGRAM(&result, "fit", "run.json");
    const char *const words[] = {"run.json: target.rdf: expected at most 4000 bins",
                                 "found 100000: merge bins", NULL};
    run_program_assert_refused(&result, ".", "too many bins", 1, words);
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_refused(&result, ".", "too many bins, explained", 1, words);
}

static void test_fit_of_omega_refuses_more_variables_than_a_round_can_hold(void **state) {
    static struct run_program_result result;
    char *text;
    small_inputs_write(*state, "etd.tsv", escape, NULL, NULL);
    small_inputs_write(*state, "run.json", good, GENETIC, "\"name\": \"gauss-newton\"");
    text = temporary_folder_read("run.json");
    small_inputs_write(*state, "run.json", text, "\"coefficients\": 4", "\"coefficients\": 340");
    free(text);
    RUN_PROGRAM(&result, "fit", "run.json");
    const char *const words[] = {"run.json: method.name", "1030", "1024", NULL};
    run_program_assert_refused(&result, ".", "too many variables", 1, words);
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_refused(&result, ".", "too many variables, explained", 1, words);
}

/// The fit is told once, and the number is in the summary.
static void check_left_out(struct temporary_folder *folder, const char *table, double cells) {
    static struct run_program_result result;
    char line[128];
    small_inputs_write(folder, "etd.tsv", table, NULL, NULL);
    small_inputs_write(folder, "run.json", good, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--force");
    run_program_assert_code(&result, 0);
    results_assert_number("out/summary.json", "etd_cells_left_out", cells);
    snprintf(line, sizeof line,
             "target.etd: %.0f of 15 cells of the target are not known and left out\n", cells);
    if (cells > 0)
        assert_ptr_equal(strstr(result.err, line), result.err);
    else
        assert_null(strstr(result.err, "left out"));
}

static void test_fit_of_omega_tells_how_many_cells_are_left_out(void **state) {
    check_left_out(*state, escape, 0);
    check_left_out(*state, escape_with_holes, 3);
}

/// One replica has no error, a table of no use no distance, and a friction weight that ends before
/// the first bin no truth: the rest of the summary is written.
static void test_fit_of_omega_leaves_out_what_it_does_not_know(void **state) {
    static struct run_program_result result;
    char *text;
    small_inputs_write(*state, "etd.tsv", escape, NULL, NULL);
    small_inputs_write(*state, "run.json", good, "\"replicas\": 2", "\"replicas\": 1");
    text = temporary_folder_read("run.json");
    small_inputs_write(*state, "run.json", text, "\"maximum\": 6",
                       "\"maximum\": 6, \"cutoff\": 0.3, \"truth\": {\"law\": \"power\"}");
    free(text);
    RUN_PROGRAM(&result, "fit", "run.json", "--force");
    run_program_assert_code(&result, 0);
    results_number("out/summary.json", "etd_rmse");
    text = temporary_folder_read("out/summary.json");
    assert_null(strstr(text, "etd_rmse_error"));
    assert_null(strstr(text, "omega_truth_rms"));
    free(text);
}

/// A D whose window has steps longer than its intervals is measured at every step.
static void test_fit_to_a_diffusion_coefficient_has_a_window_for_any_time_step(void **state) {
    static struct run_program_result result;
    char *text;
    small_inputs_write(*state, "run.json", good, ETD, "\"diffusion\": {\"value\": 0.2}");
    text = temporary_folder_read("run.json");
    small_inputs_write(*state, "run.json", text, FIT_PLAN, "\"samples\": 20, \"every\": 4");
    free(text);
    text = temporary_folder_read("run.json");
    small_inputs_write(*state, "run.json", text, CHECK_PLAN, "\"samples\": 20, \"every\": 4");
    free(text);
    text = temporary_folder_read("run.json");
    small_inputs_write(*state, "run.json", text, STEP, "\"time_step\": 0.08");
    free(text);
    RUN_PROGRAM(&result, "fit", "run.json", "--quiet", "--force");
    run_program_assert_code(&result, 0);
    results_number("out/summary.json", "diffusion_rmse");
}

static void test_fit_refuses_to_resume_when_the_curve_to_begin_with_is_another(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "etd.tsv", escape, NULL, NULL);
    small_inputs_write(*state, "start.tsv", "0 3\n0.5 2\n1 0\n", NULL, NULL);
    small_inputs_write(
        *state, "run.json", good, "\"coefficients\": 4",
        "\"coefficients\": 4, \"start\": {\"law\": \"table\", \"file\": \"start.tsv\"}");
    RUN_PROGRAM(&result, "fit", "run.json", "--quiet");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "fit", "run.json", "--resume", "--quiet");
    run_program_assert_code(&result, 0);
    small_inputs_write(*state, "start.tsv", "0 3\n0.5 1\n1 0\n", NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "--resume", "--quiet");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "settings have changed");
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_fit_of_omega_refuses_with_a_line_for_each_fault),
        TEST(test_imc_refuses_to_fit_more_than_rdf_and_pressure),
        TEST(test_imc_refuses_more_bins_than_it_can_solve_for),
        TEST(test_fit_of_omega_refuses_more_variables_than_a_round_can_hold),
        TEST(test_fit_of_omega_tells_how_many_cells_are_left_out),
        TEST(test_fit_of_omega_leaves_out_what_it_does_not_know),
        TEST(test_fit_to_a_diffusion_coefficient_has_a_window_for_any_time_step),
        TEST(test_fit_refuses_to_resume_when_the_curve_to_begin_with_is_another),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
