// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit fit` of a mixture from outside: a potential for each pair type, its files, the same
// bits for any threads and after any interruption, and faults in one line each.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"
#include "shared/twins.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

/// A soft mixture whose partial g(r) are the target.
static const char mixture[] =
    "{\"seed\": 5, \"box\": [3, 3, 3], \"particles\": {\"types\": {\"A\": 40, \"B\": 41}},\n"
    "\"time_step\": 0.04, \"conservative\": {\"A-A\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "\"A-B\": {\"law\": \"soft-repulsion\", \"a\": 15},\n"
    "\"B-B\": {\"law\": \"soft-repulsion\", \"a\": 35}},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3},\n"
    "\"measure\": {\"equilibration\": 100, \"samples\": 80, \"every\": 10},\n"
    "\"rdf\": {\"range\": 1, \"bins\": 20}}\n";

#define METHOD "METHOD"
#define TARGET_BB "\"B-B\": {\"file\": \"target/rdf_B-B.tsv\"}"
#define TRUTH_AB ", \"A-B\": {\"law\": \"soft-repulsion\", \"a\": 15}"
static const char fit[] =
    "{\"seed\": 3, \"target\": {\"rdf\": {\"A-A\": {\"file\": \"target/rdf_A-A.tsv\"},\n"
    "\"B-A\": {\"file\": \"target/rdf_A-B.tsv\"}, " TARGET_BB "}},\n"
    "\"unknowns\": {\"potential\": {\"coefficients\": 5, \"maximum\": 30, \"truth\": {\n"
    "\"A-A\": {\"law\": \"soft-repulsion\", \"a\": 25}" TRUTH_AB ",\n"
    "\"B-B\": {\"law\": \"soft-repulsion\", \"a\": 35}}}},\n"
    "\"scene\": {\"box\": [3, 3, 3], \"particles\": {\"types\": {\"A\": 40, \"B\": 41}},\n"
    "\"time_step\": 0.02, \"dissipative\": {\"law\": \"power\", \"sigma\": 3}},\n"
    "\"method\": {" METHOD "}, \"core\": {\"threshold\": 0.05, \"stiffness\": 50},\n"
    "\"verification\": {\"replicas\": 2, \"equilibration\": 50, \"samples\": 10, \"every\": 5}}\n";

/// Few samples: where g agrees they double nine times, as the precision is out of reach.
#define INVERSION(name)                                                                            \
    "\"name\": \"" name                                                                            \
    "\", \"replicas\": 4, \"equilibration\": 10, \"samples\": 8, \"every\": 1, "                   \
    "\"iterations\": 4, \"precision\": 1e-4"

#define EVALUATION                                                                                 \
    "\"equilibration\": 60, \"samples\": 10, \"every\": 5, \"temperature_tolerance\": 0.5"
#define CMA_ES                                                                                     \
    "\"name\": \"cma-es\", \"population\": 7, \"rounds\": 3, \"step\": 0.05, \"warm_start\": "     \
    "\"yes\", " EVALUATION
#define GAUSS_NEWTON "\"name\": \"gauss-newton\", \"reach\": 0.05, \"iterations\": 2, " EVALUATION

static const char *const tables[] = {"history.tsv",
                                     "rdf_A-A.tsv",
                                     "rdf_A-B.tsv",
                                     "rdf_B-B.tsv",
                                     "potential_A-A.tsv",
                                     "potential_A-B.tsv",
                                     "potential_B-B.tsv",
                                     "potential_A-A_history.tsv",
                                     "potential_A-B_history.tsv",
                                     "potential_B-B_history.tsv",
                                     NULL};

/// A fit that was not given the time to converge; an optimiser ends as asked.
enum { CONVERGED = 0, UNCONVERGED = 1 };

static void write_fit(struct temporary_folder *folder, const char *method) {
    small_inputs_write(folder, "scene.json", mixture, NULL, NULL);
    twins_simulate("scene.json", "target");
    small_inputs_write(folder, "run.json", fit, METHOD, method);
}

static void run_fit(const char *out, const char *threads, int code) {
    static struct run_program_result result;
    RUN_PROGRAM(&result, "fit", "run.json", "-o", out, "--threads", threads, "--quiet", "--force");
    run_program_assert_code(&result, code);
}

static void check_summary(void) {
    static const char *const numbers[] = {"rdf_rmse",
                                          "truth_rms_A-A",
                                          "truth_rms_A-B",
                                          "truth_rms_B-B",
                                          "truth_ramp_A-A",
                                          "truth_ramp_A-B",
                                          "truth_ramp_B-B",
                                          "truth_rms_without_ramp_A-A",
                                          "truth_rms_without_ramp_A-B",
                                          "truth_rms_without_ramp_B-B",
                                          NULL};
    results_assert_numbers("out/summary.json", numbers);
    char *summary = temporary_folder_read("out/summary.json");
    // What is defined for one type alone.
    assert_null(strstr(summary, "\"kirkwood_buff\""));
    assert_null(strstr(summary, "\"truth_rms\""));
    free(summary);
}

/// Columns of a potential's table: with a band that knows the ramp, or without.
static void check_tables(size_t potential, size_t iterations) {
    static const char *const kinds[] = {"A-A", "A-B", "B-B"};
    for (int pair = 0; pair < 3; pair++) {
        char name[64];
        snprintf(name, sizeof name, "out/potential_%s.tsv", kinds[pair]);
        results_assert_table(name, potential, 21);
        snprintf(name, sizeof name, "out/potential_%s_history.tsv", kinds[pair]);
        results_assert_table(name, iterations + 1, 21);
        snprintf(name, sizeof name, "out/rdf_%s.tsv", kinds[pair]);
        results_assert_table(name, 5, 20);
    }
    assert_false(temporary_folder_exists("out/potential.tsv"));
    assert_false(temporary_folder_exists("out/rdf.tsv"));
}

/// The truth of each pair type stands in its own table: a (1 − 0.025)²/2 at the first point.
static void check_truth(void) {
    static const struct {
        const char *file, *truth;
    } kinds[] = {{"out/potential_A-A.tsv", "\t11.882812\n"},
                 {"out/potential_A-B.tsv", "\t7.1296875\n"},
                 {"out/potential_B-B.tsv", "\t16.635938\n"}};
    for (int pair = 0; pair < 3; pair++) {
        char *text = temporary_folder_read(kinds[pair].file);
        assert_contains(text, "\ttruth[k_B.T_0]\n");
        assert_contains(text, kinds[pair].truth);
        free(text);
    }
}

static void test_imc_of_a_mixture_writes_a_potential_for_each_pair_type(void **state) {
    write_fit(*state, INVERSION("imc"));
    run_fit("out", "2", UNCONVERGED);
    check_tables(6, 4);
    check_truth();
    check_summary();
    results_assert_table("out/history.tsv", 18, 4);
    results_assert_table("out/excess_A-B_history.tsv", 5, 20);
    assert_true(temporary_folder_exists("out/potential_A-B_flat.tsv"));
    assert_true(results_number("out/summary.json", "directions_of") > 40);
    // The target stands in the table of its own pair type, whichever name the run file calls it by.
    char *target = temporary_folder_read("target/rdf_A-B.tsv"), *table;
    char line[64];
    table = temporary_folder_read("out/rdf_A-B.tsv");
    const char *last = strstr(target, "\n0.97"), *beside = strstr(table, "\n0.97");
    assert_non_null(last);
    assert_non_null(beside);
    snprintf(line, sizeof line, "%.5s", strchr(last, '\t') + 1);
    assert_memory_equal(strchr(beside, '\t') + 1, line, 5);
    free(target);
    free(table);
}

static void test_cma_es_of_a_mixture_writes_a_potential_for_each_pair_type(void **state) {
    write_fit(*state, CMA_ES);
    run_fit("out", "2", CONVERGED);
    check_tables(5, 3);
    check_truth();
    check_summary();
}

static void test_gauss_newton_of_a_mixture_tells_its_bands(void **state) {
    write_fit(*state, GAUSS_NEWTON);
    run_fit("out", "2", UNCONVERGED); // two iterations
    check_tables(5, 2);
    assert_true(temporary_folder_exists("out/potential_B-B_flat.tsv"));
    check_summary();
}

static void check_threads(int code) {
    run_fit("1", "1", code);
    for (int threads = 2; threads <= 3; threads++) {
        char out[16];
        snprintf(out, sizeof out, "%d", threads);
        run_fit(out, out, code);
        results_assert_same("1", out, tables);
    }
}

static void test_imc_of_a_mixture_gives_the_same_bits_for_any_threads(void **state) {
    write_fit(*state, INVERSION("imc"));
    check_threads(UNCONVERGED);
}

static void test_auto_of_a_mixture_by_dynamics_gives_the_same_bits_for_any_threads(void **state) {
    write_fit(*state, INVERSION("auto") ", \"sampler\": \"dynamics\", \"particles\": 120");
    check_threads(UNCONVERGED);
}

static void test_cma_es_of_a_mixture_gives_the_same_bits_for_any_threads(void **state) {
    write_fit(*state, CMA_ES);
    check_threads(CONVERGED);
}

static void check_interruption(int code) {
    static const char *const words[] = {"fit", "run.json", "-o", "pieces", "--threads", "2", NULL};
    run_fit("whole", "2", code);
    run_program_in_pieces(code, words);
    results_assert_same("whole", "pieces", tables);
    results_assert_same("whole", "pieces", (const char *const[]){"used.json", NULL});
}

static void test_interrupted_imc_of_a_mixture_goes_on_with_the_same_bits(void **state) {
    write_fit(*state, INVERSION("imc"));
    check_interruption(UNCONVERGED);
}

static void test_interrupted_hnc_of_a_mixture_by_dynamics_goes_on_with_the_same_bits(void **state) {
    write_fit(*state, INVERSION("hnc") ", \"sampler\": \"dynamics\"");
    check_interruption(UNCONVERGED);
}

static void test_interrupted_cma_es_of_a_mixture_goes_on_with_the_same_bits(void **state) {
    write_fit(*state, CMA_ES);
    check_interruption(CONVERGED);
}

static void test_fit_of_a_mixture_gives_the_same_bits_from_its_used_settings(void **state) {
    static struct run_program_result result;
    write_fit(*state, INVERSION("imc"));
    run_fit("a/one", "2", UNCONVERGED);
    RUN_PROGRAM(&result, "fit", "a/one/used.json", "-o", "two", "--quiet");
    run_program_assert_code(&result, UNCONVERGED);
    results_assert_same("a/one", "two", tables);
    results_assert_same("a/one", "two", (const char *const[]){"used.json", NULL});
}

static void refuse(struct temporary_folder *folder, const char *from, const char *to, size_t lines,
                   const char *const *words) {
    static struct run_program_result result;
    char *text = temporary_folder_read("good.json");
    small_inputs_write(folder, "run.json", text, from, to);
    free(text);
    RUN_PROGRAM(&result, "fit", "run.json", "--quiet");
    run_program_assert_refused(&result, "out", from, lines, words);
}

static void test_fit_of_a_mixture_is_refused_in_a_line_when_a_pair_is_wrong(void **state) {
    write_fit(*state, INVERSION("imc"));
    small_inputs_write(*state, "good.json", fit, METHOD, INVERSION("imc"));
    assert_int_equal(mkdir("out", 0700), 0);
    refuse(*state, ", " TARGET_BB, "", 1,
           (const char *[]){"run.json: target.rdf.B-B: missing", NULL});
    refuse(
        *state, "\"B-A\"", "\"B-C\"", 1,
        (const char *[]){"run.json: target.rdf.B-C: unknown pair", "expected A-A, A-B, B-B", NULL});
    refuse(*state, TARGET_BB, TARGET_BB ", \"C-B\": {}", 1,
           (const char *[]){"run.json: target.rdf.C-B: unknown pair", NULL});
    refuse(*state, "target/rdf_A-B.tsv", "target/none.tsv", 1,
           (const char *[]){"run.json: target.rdf.B-A.file", "none.tsv", NULL});
    refuse(
        *state, "target/rdf_A-B.tsv", "target/rdf_B-A.tsv", 1,
        (const char *[]){"target/rdf_B-A.tsv: No such file or directory, but target/rdf_A-B.tsv, "
                         "the same pair in the other order, is there",
                         NULL});
    refuse(*state, TRUTH_AB, "", 1,
           (const char *[]){"run.json: unknowns.potential.truth.A-B: missing", NULL});
    refuse(*state, "{\n\"A-A\": {\"law\"", "{\n\"A-C\": {\"law\"", 1,
           (const char *[]){"run.json: unknowns.potential.truth.A-C: unknown pair", NULL});
    // A fault of the types is told alone: those of their pairs would mislead.
    refuse(*state, "\"A\": 40", "\"A\": 1", 1,
           (const char *[]){"run.json: target.rdf.A-A: a single bead is of that type", NULL});
}

/// It counted them by a histogram without a word.
static void test_fit_of_a_mixture_refuses_to_estimate_g_from_forces(void **state) {
    write_fit(*state, CMA_ES); // and the targets
    small_inputs_write(*state, "good.json", fit, METHOD, CMA_ES);
    assert_int_equal(mkdir("out", 0700), 0);
    refuse(*state, "\"population\": 7", "\"population\": 7, \"estimator\": \"force\"", 1,
           (const char *[]){"run.json: method.estimator: \"force\" is not for mixtures", NULL});
}

/// Of 4 A in 81 beads 20 have 1, which becomes 2.
static void test_imc_of_a_mixture_refuses_particles_that_change_its_shares(void **state) {
    static struct run_program_result result;
    write_fit(*state, INVERSION("imc"));
    char *text = temporary_folder_read("run.json");
    small_inputs_write(*state, "run.json", text, "\"A\": 40, \"B\": 41", "\"A\": 4, \"B\": 77");
    free(text);
    text = temporary_folder_read("run.json");
    small_inputs_write(*state, "run.json", text, "\"iterations\"",
                       "\"particles\": 20, \"iterations\"");
    free(text);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--quiet");
    run_program_assert_code(&result, 2);
    assert_contains(result.err,
                    "run.json: method.particles: 20 change the share of a type by 93 %; "
                    "34 are the next that keep all shares");
    // Before particles are placed, which takes long of many: here there is no room for them.
    small_inputs_change(*state, "run.json", "\"types\"",
                        "\"placement\": \"random\", \"separation\": 3, \"types\"");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--quiet");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "method.particles: 20 change the share");
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_imc_of_a_mixture_writes_a_potential_for_each_pair_type),
        TEST(test_cma_es_of_a_mixture_writes_a_potential_for_each_pair_type),
        TEST(test_gauss_newton_of_a_mixture_tells_its_bands),
        TEST(test_fit_of_a_mixture_refuses_to_estimate_g_from_forces),
        TEST(test_imc_of_a_mixture_gives_the_same_bits_for_any_threads),
        TEST(test_auto_of_a_mixture_by_dynamics_gives_the_same_bits_for_any_threads),
        TEST(test_cma_es_of_a_mixture_gives_the_same_bits_for_any_threads),
        TEST(test_interrupted_imc_of_a_mixture_goes_on_with_the_same_bits),
        TEST(test_interrupted_hnc_of_a_mixture_by_dynamics_goes_on_with_the_same_bits),
        TEST(test_interrupted_cma_es_of_a_mixture_goes_on_with_the_same_bits),
        TEST(test_fit_of_a_mixture_gives_the_same_bits_from_its_used_settings),
        TEST(test_fit_of_a_mixture_is_refused_in_a_line_when_a_pair_is_wrong),
        TEST(test_imc_of_a_mixture_refuses_particles_that_change_its_shares),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
