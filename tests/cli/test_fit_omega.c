// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit fit` of a friction weight to escape times, alone and together with the potential: its
// files, the same bits for any threads, from its used settings and after any interruption.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"
#include "shared/twins.h"

#include <stdio.h>
#include <stdlib.h>

/// A soft fluid whose escape times and g(r) are the targets.
static const char soft_fluid[] =
    "{\"seed\": 5, \"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02,\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3},\n"
    "\"measure\": {\"equilibration\": 100, \"samples\": 60, \"every\": 10},\n"
    "\"etd\": {\"r_minimum\": 0.4, \"r_maximum\": 0.9, \"bins\": 12, \"times\": 12, \"every\": "
    "2},\n"
    "\"rdf\": {\"range\": 1, \"bins\": 20}}\n";

#define ETD                                                                                        \
    "\"etd\": {\"file\": \"target/etd.tsv\", \"error_file\": \"target/etd_error.tsv\", "           \
    "\"r_minimum\": 0.4, \"r_maximum\": 0.9}"
#define POTENTIAL "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25}"
#define OMEGA                                                                                      \
    "\"omega\": {\"coefficients\": 4, \"maximum\": 6, \"truth\": {\"law\": \"power\", "            \
    "\"sigma\": 3}}"
#define METHOD "METHOD"

#define RUN(target, unknowns, scene)                                                               \
    "{\"seed\": 3, \"target\": {" target "}, \"unknowns\": {" unknowns "},\n"                      \
    "\"scene\": {\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02" scene    \
    "},\n"                                                                                         \
    "\"method\": {" METHOD ", \"equilibration\": 10, \"samples\": 4, \"every\": 8, "               \
    "\"temperature_tolerance\": 0.5},\n"                                                           \
    "\"core\": {\"threshold\": 0.05, \"stiffness\": 50},\n"                                        \
    "\"verification\": {\"replicas\": 2, \"equilibration\": 20, \"samples\": 5, \"every\": 8}}\n"

static const char omega_fit[] = RUN(ETD, OMEGA, ", " POTENTIAL);
static const char joint_fit[] = RUN(ETD ", \"rdf\": {\"file\": \"target/rdf.tsv\"}",
                                    OMEGA ", \"potential\": {\"coefficients\": 5, \"maximum\": 30, "
                                          "\"truth\": {\"law\": \"soft-repulsion\", \"a\": 25}}", );

/// White friction, friction across pairs and a memory, of which the time is found, too.
static const char memory_fit[] = RUN(
    ETD,
    OMEGA ", \"omega_transverse\": {\"coefficients\": 4, \"maximum\": 3, \"truth\": {\"law\": "
          "\"power\", \"sigma\": 1}}, \"memory\": {\"slow\": {\"coefficients\": 4, \"maximum\": "
          "9, \"truth\": {\"law\": \"power\", \"sigma\": 3}}}, \"numbers\": "
          "{\"memory.slow.time\": {\"minimum\": 0.05, \"maximum\": 0.5}}",
    ", " POTENTIAL ", \"memory\": {\"slow\": {\"time\": 0.2}}");

#define GENETIC "\"name\": \"genetic\", \"population\": 7, \"generations\": 3"
#define CMAES "\"name\": \"cma-es\", \"rounds\": 4, \"racing\": 1, \"warm_start\": \"yes\""
#define NLOPT "\"name\": \"nlopt\", \"algorithm\": \"LN_SBPLX\", \"evaluations\": 25"
#define GAUSS_NEWTON "\"name\": \"gauss-newton\", \"iterations\": 12, \"warm_start\": \"yes\""

static const char *const omega_tables[] = {"history.tsv", "omega_history.tsv", "omega.tsv",
                                           "etd_cells.tsv", NULL};
static const char *const memory_tables[] = {"history.tsv",         "omega_history.tsv",
                                            "omega.tsv",           "omega_transverse.tsv",
                                            "memory_slow.tsv",     "memory_slow_history.tsv",
                                            "numbers_history.tsv", "memory_slow_flat.tsv",
                                            "etd_cells.tsv",       NULL};
static const char *const joint_tables[] = {
    "history.tsv",           "omega_history.tsv", "omega.tsv", "potential.tsv",
    "potential_history.tsv", "etd_cells.tsv",     "rdf.tsv",   NULL};

/// A fit that was not given the time to converge.
enum { CONVERGED = 0, UNCONVERGED = 1 };

static void write_fit(struct temporary_folder *folder, const char *fit, const char *method) {
    small_inputs_write(folder, "scene.json", soft_fluid, NULL, NULL);
    twins_simulate("scene.json", "target");
    small_inputs_write(folder, "run.json", fit, METHOD, method);
}

static void run_fit(const char *file, const char *out, const char *threads, int code) {
    static struct run_program_result result;
    RUN_PROGRAM(&result, "fit", file, "-o", out, "--threads", threads, "--quiet");
    run_program_assert_code(&result, code);
}

/// The same bits for 1, 2 and 3 threads, from used.json, and in pieces.
static void check_bits(struct temporary_folder *folder, const char *fit, const char *method,
                       const char *const *tables, int code) {
    static const char *const words[] = {"fit", "run.json", "-o", "pieces", "--threads", "2", NULL};
    static const char *const used[] = {"used.json", NULL};
    static const char *const numbers[] = {"iterations", "evaluations",     "engine_steps",
                                          "etd_rmse",   "omega_truth_rms", "diffusion"};
    write_fit(folder, fit, method);
    run_fit("run.json", "1", "1", code);
    run_fit("run.json", "2", "2", code);
    run_fit("run.json", "3", "3", code);
    results_assert_same("1", "2", tables);
    results_assert_same("1", "3", tables);
    run_fit("1/used.json", "again", "1", code);
    results_assert_same("1", "again", tables);
    results_assert_same("1", "again", used);
    run_program_in_pieces(code, words);
    results_assert_same("1", "pieces", tables);
    results_assert_same("1", "pieces", used);
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
        results_assert_number("pieces/summary.json", numbers[k],
                              results_number("1/summary.json", numbers[k]));
}

static void test_genetic_gives_omega_of_the_same_bits(void **state) {
    check_bits(*state, omega_fit, GENETIC, omega_tables, CONVERGED);
}

static void test_cmaes_gives_omega_of_the_same_bits(void **state) {
    check_bits(*state, omega_fit, CMAES, omega_tables, CONVERGED);
}

static void test_nlopt_gives_omega_of_the_same_bits(void **state) {
    check_bits(*state, omega_fit, NLOPT, omega_tables, CONVERGED);
}

static void test_gauss_newton_gives_omega_of_the_same_bits(void **state) {
    check_bits(*state, omega_fit, GAUSS_NEWTON, omega_tables, CONVERGED);
}

static void test_gauss_newton_gives_both_unknowns_of_the_same_bits(void **state) {
    check_bits(*state, joint_fit, GAUSS_NEWTON, joint_tables, CONVERGED);
    static const char *const numbers[] = {"omega_truth_rms", "truth_rms", "rdf_rmse",  "etd_rmse",
                                          "diffusion_error", "rdf_noise", "etd_noise", NULL};
    results_assert_numbers("1/summary.json", numbers);
    results_assert_table("1/omega.tsv", 4, 201);
    results_assert_table("1/potential.tsv", 5, 21);
    results_assert_table("1/etd_cells.tsv", 6, 144);
}

static void test_cmaes_gives_both_unknowns_of_the_same_bits(void **state) {
    check_bits(*state, joint_fit, CMAES, joint_tables, CONVERGED);
}

static void test_gauss_newton_gives_memory_of_the_same_bits(void **state) {
    check_bits(*state, memory_fit, GAUSS_NEWTON, memory_tables, CONVERGED);
    static const char *const numbers[] = {"omega_truth_rms", "omega_transverse_truth_rms",
                                          "memory_slow_truth_rms", "memory_slow_flat_share", NULL};
    results_assert_numbers("1/summary.json", numbers);
    results_assert_table("1/memory_slow.tsv", 4, 201);
    results_assert_table("1/omega_transverse.tsv", 4, 201);
}

static void test_explain_and_describe_know_omega_and_its_targets(void **state) {
    static const char *const names[] = {"etd-target",    "curve-target", "rdf-target",
                                        "number-target", "omega",        "potential"};
    static struct run_program_result result;
    write_fit(*state, omega_fit, GENETIC);
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "a potential with cutoff 1");
    assert_contains(result.out, "a friction weight with cutoff 1; its pairs are kept");
    assert_contains(result.out, "pairs a particle within 0.9, one step in 2; an origin in 20");
    const char *verification = strstr(result.out, "A replica of the verification");
    assert_non_null(verification);
    assert_contains(verification, "diffusion                          on");
    RUN_PROGRAM(&result, "describe");
    run_program_assert_code(&result, 0);
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        assert_contains(result.out, names[k]);
    // Every group stands there once.
    const char *files = strstr(result.out, "files\n");
    assert_non_null(files);
    assert_null(strstr(files + 1, "\nfiles\n"));
    RUN_PROGRAM(&result, "describe", "omega");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "inner_cutoff");
}

/// Friction up to a third of the true one cannot slow the pairs down: the fit stands still away
/// from its target, and has finished.
static void test_gauss_newton_has_finished_at_a_standstill_above_its_noise(void **state) {
    static struct run_program_result result;
    write_fit(*state, omega_fit, "\"name\": \"gauss-newton\", \"iterations\": 100");
    small_inputs_write(*state, "scene.json", soft_fluid, "\"samples\": 60", "\"samples\": 1200");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "target", "--quiet");
    char *text = temporary_folder_read("run.json");
    small_inputs_write(*state, "run.json", text, "\"maximum\": 6", "\"maximum\": 1");
    free(text);
    text = temporary_folder_read("run.json");
    small_inputs_write(*state, "run.json", text, "\"samples\": 4", "\"samples\": 100");
    free(text);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, "finished after ");
    results_assert_text("out/summary.json", "status", "finished");
    text = temporary_folder_read("out/summary.json");
    assert_contains(text, "but the target is still off by ");
    assert_contains(text, "if the target can be met at all");
    free(text);
}

/// A time step at which stronger friction blows up: those candidates lose, and the fit goes on.
static void test_unstable_candidates_lose_and_never_stop_a_fit(void **state) {
    static const char *const methods[] = {GENETIC, CMAES, NLOPT, GAUSS_NEWTON};
    for (int k = 0; k < 4; k++) {
        static struct run_program_result result;
        write_fit(*state, omega_fit, methods[k]);
        char *text = temporary_folder_read("run.json");
        small_inputs_write(*state, "run.json", text, "\"maximum\": 6", "\"maximum\": 60");
        free(text);
        RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--quiet", "--force");
        if (result.code != CONVERGED && result.code != UNCONVERGED)
            run_program_assert_code(&result, CONVERGED);
        results_assert_table("out/history.tsv", 9, 0);
        assert_true(temporary_folder_exists("out/summary.json"));
    }
}

/// A tolerance that no simulation keeps to.
static void test_fit_of_omega_ends_and_says_so_when_no_candidate_survives(void **state) {
    static const char *const methods[] = {GENETIC, CMAES, NLOPT, GAUSS_NEWTON};
    for (int k = 0; k < 4; k++) {
        static struct run_program_result result;
        write_fit(*state, omega_fit, methods[k]);
        char *text = temporary_folder_read("run.json");
        small_inputs_write(*state, "run.json", text, "tolerance\": 0.5", "tolerance\": 1e-9");
        free(text);
        RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--quiet", "--force");
        run_program_assert_code(&result, UNCONVERGED);
        assert_contains(result.err, "not one simulation of the fit succeeded");
        text = temporary_folder_read("out/history.tsv");
        assert_contains(text, "\tnan\t");
        assert_null(strstr(text, "1000000000"));
        free(text);
        results_assert_table("out/omega.tsv", 4, 201);
        results_assert_text("out/summary.json", "status", "unconverged");
    }
}

/// What a fit with memory has written goes with it, when another replaces it; the user's own stays.
static void test_force_leaves_no_table_of_the_memory_before(void **state) {
    write_fit(*state, memory_fit, GAUSS_NEWTON);
    char *text = temporary_folder_read("run.json");
    small_inputs_write(*state, "run.json", text, "\"iterations\": 12", "\"iterations\": 1");
    free(text);
    run_fit("run.json", "out", "2", UNCONVERGED);
    for (const char *const *table = memory_tables; *table; table++) {
        char path[64];
        snprintf(path, sizeof path, "out/%s", *table);
        assert_true(temporary_folder_exists(path));
    }
    temporary_folder_write(*state, "out/memory-2026-11-23.tsv", "mine", 4);
    small_inputs_write(*state, "omega.json", omega_fit, METHOD, CMAES);
    static struct run_program_result result;
    RUN_PROGRAM(&result, "fit", "omega.json", "-o", "out", "--quiet", "--force");
    assert_in_range(result.code, CONVERGED, UNCONVERGED);
    assert_true(temporary_folder_exists("out/omega.tsv"));
    assert_false(temporary_folder_exists("out/omega_transverse.tsv"));
    assert_false(temporary_folder_exists("out/memory_slow.tsv"));
    assert_false(temporary_folder_exists("out/memory_slow_history.tsv"));
    assert_false(temporary_folder_exists("out/numbers_history.tsv"));
    assert_true(temporary_folder_exists("out/memory-2026-11-23.tsv"));
}

#define TEST_WITHOUT_FIGURES(name)                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST_WITHOUT_FIGURES(test_genetic_gives_omega_of_the_same_bits),
        TEST_WITHOUT_FIGURES(test_cmaes_gives_omega_of_the_same_bits),
        TEST_WITHOUT_FIGURES(test_nlopt_gives_omega_of_the_same_bits),
        TEST_WITHOUT_FIGURES(test_gauss_newton_gives_omega_of_the_same_bits),
        TEST_WITHOUT_FIGURES(test_gauss_newton_gives_both_unknowns_of_the_same_bits),
        TEST_WITHOUT_FIGURES(test_gauss_newton_gives_memory_of_the_same_bits),
        TEST_WITHOUT_FIGURES(test_cmaes_gives_both_unknowns_of_the_same_bits),
        TEST_WITHOUT_FIGURES(test_explain_and_describe_know_omega_and_its_targets),
        TEST_WITHOUT_FIGURES(test_fit_of_omega_ends_and_says_so_when_no_candidate_survives),
        TEST_WITHOUT_FIGURES(test_gauss_newton_has_finished_at_a_standstill_above_its_noise),
        TEST_WITHOUT_FIGURES(test_force_leaves_no_table_of_the_memory_before),
        TEST_WITHOUT_FIGURES(test_unstable_candidates_lose_and_never_stop_a_fit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
