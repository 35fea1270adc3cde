// SPDX-License-Identifier: GPL-3.0-or-later
//
// Fits of several states that share a potential: that of one state is the fit of a file without
// states, of several `auto` is `imc`; two densities find a known potential, with their pressures,
// too; states that contradict each other do not converge; and what is refused.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"
#include "shared/twins.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define LAW "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25}"
#define SETUP                                                                                      \
    "\"box\": [5, 5, 5], \"time_step\": 0.02, \"dissipative\": {\"law\": \"power\", \"sigma\": 3}"

/// The truth; the number of particles and a are replaced.
static const char scene[] =
    "{\"seed\": 3, " SETUP ", " LAW ", \"particles\": {\"count\": 250},\n"
    "\"rdf\": {\"range\": 1.2, \"bins\": 30},\n"
    "\"measure\": {\"equilibration\": 500, \"samples\": 400, \"every\": 20}}\n";

#define STATES                                                                                     \
    "\"states\": {\n"                                                                              \
    " \"dilute\": {\"scene\": {\"particles\": {\"count\": 250}},\n"                                \
    "  \"target\": {\"rdf\": {\"file\": \"dilute/rdf.tsv\", \"errors_of\": \"samples\"}}},\n"      \
    " \"dense\": {\"scene\": {\"particles\": {\"count\": 500}},\n"                                 \
    "  \"target\": {\"rdf\": {\"file\": \"dense/rdf.tsv\", \"errors_of\": \"samples\"}}}}"
#define PLAN "\"replicas\": 4, \"samples\": 100, \"precision\": 0.008"
#define COMMON                                                                                     \
    "\"scene\": {" SETUP "},\n"                                                                    \
    "\"unknowns\": {\"potential\": {\"truth\": {\"law\": \"soft-repulsion\", \"a\": 25}}},\n"      \
    "\"verification\": {\"replicas\": 2, \"equilibration\": 300, \"samples\": 100, \"every\": "    \
    "20},\n"                                                                                       \
    "\"method\": {\"name\": \"imc\", " PLAN "}"
static const char run[] = "{\"seed\": 4, " COMMON ",\n" STATES "}\n";

static struct run_program_result result;

/// A run file with two iterations of few samples, for what does not ask how good its result is.
static void write_coarse(struct temporary_folder *folder, const char *file, const char *text,
                         const char *from, const char *to) {
    small_inputs_write(folder, file, text, from, to);
    small_inputs_change(folder, file, PLAN,
                        "\"replicas\": 2, \"equilibration\": 10, \"samples\": 20, "
                        "\"precision\": 0.1, \"iterations\": 2");
    small_inputs_change(folder, file, "\"equilibration\": 300, \"samples\": 100",
                        "\"equilibration\": 30, \"samples\": 4");
}

static void fit(const char *file, const char *out) {
    RUN_PROGRAM(&result, "fit", file, "-o", out, "--force");
    assert_in_range(result.code, 0, 1);
}

static int enter(void **state) {
    if (small_inputs_enter_without_gnuplot(state) != 0)
        return -1;
    small_inputs_write(*state, "dilute.json", scene, NULL, NULL);
    small_inputs_write(*state, "dense.json", scene, "250", "500");
    small_inputs_write(*state, "other.json", scene, "\"a\": 25", "\"a\": 12");
    twins_simulate("dilute.json", "dilute");
    twins_simulate("dense.json", "dense");
    twins_simulate("other.json", "other");
    return 0;
}

static void test_one_state_is_a_fit_without_states(void **state) {
    static const char *const same[] = {"potential.tsv", "rdf.tsv", NULL};
    write_coarse(*state, "one.json",
                 "{\"seed\": 4, " COMMON ",\n\"states\": {\"dense\": {\n"
                 "\"scene\": {\"particles\": {\"count\": 500}},\n"
                 "\"target\": {\"rdf\": {\"file\": \"dense/rdf.tsv\"}}}}}\n",
                 NULL, NULL);
    write_coarse(*state, "plain.json",
                 "{\"seed\": 4, \"scene\": {" SETUP ", \"particles\": {\"count\": 500}},\n"
                 "\"target\": {\"rdf\": {\"file\": \"dense/rdf.tsv\"}},\n"
                 "\"verification\": {\"replicas\": 2, \"equilibration\": 300, \"samples\": "
                 "100, \"every\": 20},\n"
                 "\"unknowns\": {\"potential\": {\"truth\": {\"law\": \"soft-repulsion\", "
                 "\"a\": 25}}},\n"
                 "\"method\": {\"name\": \"imc\", " PLAN "}}\n",
                 NULL, NULL);
    fit("one.json", "one");
    fit("plain.json", "plain");
    results_assert_same("one", "plain", same);
    assert_int_equal(access("one/states", F_OK), -1);
}

/// The ramp is what g(r) of one state hardly tells. Five errors: a false alarm in a million seeds
/// if the errors are honest.
static double assert_found(const char *folder) {
    char file[64];
    snprintf(file, sizeof file, "%s/summary.json", folder);
    const double ramp = results_number(file, "truth_ramp");
    const double error = results_number(file, "ramp_error");
    print_message("%s: ramp %.4f +- %.4f, %.4f beside it\n", folder, ramp, error,
                  results_number(file, "truth_rms_without_ramp"));
    assert_true(error > 0);
    assert_true(fabs(ramp) < 5 * error);
    assert_true(results_number(file, "truth_rms_without_ramp") < 0.05);
    return error;
}

static int compare(const void *a, const void *b) {
    const double first = *(const double *)a, second = *(const double *)b;
    return (first > second) - (first < second);
}

static void test_two_densities_find_a_known_potential(void **state) {
    small_inputs_write(*state, "run.json", run, NULL, NULL);
    // One fit in four ends while the ramp still drifts, and says so by a larger error.
    double error[3];
    for (int k = 0; k < 3; k++) {
        const char *const seed[] = {"6", "5", "4"};
        RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--force", "--seed", seed[k]);
        run_program_assert_code(&result, 0);
        error[k] = assert_found("out");
    }
    qsort(error, 3, sizeof *error, compare);
    assert_true(error[1] < 0.25);
    assert_non_null(strstr(result.err, "state \"dilute\":"));
    assert_non_null(strstr(result.err, "state \"dense\":"));
    // Progress counts the simulations of both: it is at its end once.
    const char *end = strstr(result.err, "verification  100 %");
    assert_non_null(end);
    assert_null(strstr(end + 1, "verification  100 %"));
    results_assert_table("out/states/dense/rdf.tsv", 5, 30);
    results_number("out/summary.json", "states.dilute.rdf_rmse");
    results_number("out/summary.json", "states.dense.pressure");
}

/// The settings of a fit, and the pieces of a run that is interrupted, make the same result.
static void test_fit_of_states_has_the_same_bits_again(void **state) {
    static const char *const pieces[] = {"fit", "run.json", "-o", "pieces", NULL};
    static const char *const same[] = {"potential.tsv", "rdf.tsv", "states/dense/rdf.tsv",
                                       "states/dense/configuration.tsv", NULL};
    write_coarse(*state, "run.json", run, NULL, NULL);
    fit("run.json", "whole");
    const int code = result.code;
    fit("whole/used.json", "again");
    results_assert_same("whole", "again", same);
    run_program_in_pieces(code, pieces);
    results_assert_same("whole", "pieces", same);
}

/// Of several states `auto` has no other steps.
static void test_auto_takes_the_steps_of_imc_when_there_are_several_states(void **state) {
    static const char *const same[] = {"potential.tsv", "potential_history.tsv", "rdf.tsv", NULL};
    write_coarse(*state, "imc.json", run, NULL, NULL);
    write_coarse(*state, "auto.json", run, "\"imc\"", "\"auto\"");
    fit("imc.json", "imc");
    fit("auto.json", "auto");
    results_assert_same("imc", "auto", same);
}

/// The run with the pressures of the truth among the targets.
static void write_with_pressures(struct temporary_folder *folder) {
    static const char with[] =
        "{\"seed\": 4, " COMMON ",\n\"states\": {\n"
        " \"dilute\": {\"scene\": {\"particles\": {\"count\": 250}},\n"
        "  \"target\": {\"rdf\": {\"file\": \"dilute/rdf.tsv\", \"particles\": 250},\n"
        "  \"pressure\": {\"value\": %.6g, \"error\": 0.05}}},\n"
        " \"dense\": {\"scene\": {\"particles\": {\"count\": 500}},\n"
        "  \"target\": {\"rdf\": {\"file\": \"dense/rdf.tsv\", \"particles\": 500},\n"
        "  \"pressure\": {\"value\": %.6g, \"error\": 0.05}}}}}\n";
    char text[4096];
    snprintf(text, sizeof text, with, results_number("dilute/summary.json", "pressure"),
             results_number("dense/summary.json", "pressure"));
    small_inputs_write(folder, "run.json", text, NULL, NULL);
}

static void test_pressures_of_two_densities_are_met(void **state) {
    write_with_pressures(*state);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--force");
    run_program_assert_code(&result, 0);
    assert_true(assert_found("out") < 0.05);
}

static void test_states_that_contradict_each_other_do_not_converge(void **state) {
    small_inputs_write(*state, "run.json", run, "dilute/rdf.tsv", "other/rdf.tsv");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--force");
    run_program_assert_code(&result, 1);
    assert_non_null(strstr(result.err, "no step improves all states together"));
    results_assert_text("out/summary.json", "status", "unconverged");
}

static void test_what_no_states_can_be_is_refused(void **state) {
    static const struct {
        const char *from, *to, *words[4];
    } cases[] = {
        {"\"imc\"", "\"ibi\"", {"method.name", "\"ibi\" fits one state", NULL}},
        {"\"dense/rdf.tsv\"", "\"dense/rdf.tsv\", \"cutoff\": 1", {"states.dense", "same bins"}},
        {"\"dense\": {", "\"../dense\": {", {"states", "\"../dense\"", "letters"}},
        {"\"dense\": {", "\"dense\": 4, \"x\": {", {"states.dense", "expected an object"}},
        {"\"dense\": {",
         "\"dense\": {\"core\": {},",
         {"states.dense.core", "shared keys belong outside"}},
        {"{\"count\": 500}", "{\"types\": {\"A\": 500}}", {"states.dense", NULL}},
        {"\"errors_of\": \"samples\"}",
         "\"errors_of\": \"samples\"}, \"pressure\": {\"value\": 3, \"error\": 1}",
         {"target.pressure", "all states fit the same targets"}},
        {"{\"count\": 500}", "{\"cuont\": 500}", {"states.dense", "cuont", NULL}},
        {"dense/rdf.tsv", "none.tsv", {"states.dense", "none.tsv", NULL}},
    };
    assert_int_equal(mkdir("bad", 0777), 0);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        small_inputs_write(*state, "bad.json", run, cases[k].from, cases[k].to);
        RUN_PROGRAM(&result, "fit", "bad.json", "-o", "bad");
        print_message("%s", result.err);
        run_program_assert_refused(&result, "bad", cases[k].to, 1, cases[k].words);
    }
    small_inputs_write(*state, "bad.json", "{" COMMON ", \"states\": [1]}\n", NULL, NULL);
    RUN_PROGRAM(&result, "fit", "bad.json", "-o", "bad");
    run_program_assert_refused(&result, "bad", "list", 1,
                               (const char *const[]){"states: expected an object", NULL});
    small_inputs_write(*state, "bad.json", "{" COMMON ", \"states\": {}}\n", NULL, NULL);
    RUN_PROGRAM(&result, "fit", "bad.json", "-o", "bad");
    run_program_assert_refused(&result, "bad", "none", 1,
                               (const char *const[]){"states", "there are 0", NULL});
}

/// Folders of states are those of this fit: another run's in its place, a link, and a file are
/// refused before the fit begins, and a simulation does not look at them.
static void test_folders_of_states_are_the_fits_own(void **state) {
    small_inputs_write(*state, "run.json", run, NULL, NULL);
    assert_int_equal(mkdir("taken", 0777), 0);
    assert_int_equal(mkdir("taken/states", 0777), 0);
    RUN_PROGRAM(&result, "simulate", "dilute.json", "-o", "taken/states/dense");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "taken");
    run_program_assert_code(&result, 2);
    assert_non_null(strstr(result.err, "taken/states/dense holds another run"));
    RUN_PROGRAM(&result, "simulate", "dilute.json", "-o", "taken");
    RUN_PROGRAM(&result, "simulate", "dilute.json", "-o", "taken");
    run_program_assert_code(&result, 0);
    assert_int_equal(access("taken/states/dense/rdf.tsv", F_OK), 0);
    assert_int_equal(mkdir("linked", 0777), 0);
    assert_int_equal(mkdir("linked/states", 0777), 0);
    assert_int_equal(symlink("../../dense", "linked/states/dense"), 0);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "linked");
    run_program_assert_code(&result, 2);
    assert_non_null(strstr(result.err, "linked/states/dense is a link"));
    assert_int_equal(access("dense/rdf.tsv", F_OK), 0);
}

/// What a forced run finds of states with other names is removed, but for files of others.
static void test_states_with_other_names_leave_nothing(void **state) {
    static const char note[] = "kept";
    write_coarse(*state, "run.json", run, NULL, NULL);
    fit("run.json", "out");
    temporary_folder_write(*state, "out/states/dilute-notes.txt", note, strlen(note));
    write_coarse(*state, "run.json", run, "\"dense\": {", "\"thick\": {");
    fit("run.json", "out");
    assert_int_equal(access("out/states/thick/rdf.tsv", F_OK), 0);
    assert_int_equal(access("out/states/dilute-notes.txt", F_OK), 0);
    assert_int_equal(access("out/states/dense", F_OK), -1);
    // What is not of a run stays, and its folder with it.
    mkdir("out/states/thick/figures", 0777);
    temporary_folder_write(*state, "out/states/thick/figures/notes.svg", note, strlen(note));
    fit("run.json", "out");
    write_coarse(*state, "run.json", run, NULL, NULL);
    fit("run.json", "out");
    assert_int_equal(access("out/states/thick/figures/notes.svg", F_OK), 0);
    assert_int_equal(access("out/states/thick/rdf.tsv", F_OK), -1);
}

/// What is chosen of the precision is the least of the states': that of the second, whose target is
/// better known.
static void test_precision_is_that_of_the_most_exact_state(void **state) {
    static const char text[] = "{\"seed\": 4, \"scene\": {\"box\": [5, 5, 5]},\n\"states\": {\n"
                               " \"dilute\": {\"scene\": {\"particles\": {\"count\": 250}},\n"
                               "  \"target\": {\"rdf\": {\"file\": \"dilute/rdf.tsv\"}}},\n"
                               " \"dense\": {\"scene\": {\"particles\": {\"count\": 500}},\n"
                               "  \"target\": {\"rdf\": {\"file\": \"dense/rdf.tsv\"}}}}}\n";
    small_inputs_write(*state, "chosen.json", text, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "chosen.json", "--explain");
    run_program_assert_code(&result, 0);
    print_message("%s", result.out);
    assert_contains(result.out, "of all states: the least that was chosen for one");
    assert_contains(result.out, "verification of state \"dilute\"");
    assert_contains(result.out, "verification of state \"dense\"");
}

/// Of a fit of states the first is exported; a run file of states is no scene.
static void test_results_of_states_are_exported(void **state) {
    write_coarse(*state, "run.json", run, NULL, NULL);
    fit("run.json", "out");
    RUN_PROGRAM(&result, "export", "out", "--engine", "lammps", "-o", "lammps");
    run_program_assert_code(&result, 0);
    assert_int_equal(access("lammps/in.mesofit", F_OK), 0);
    RUN_PROGRAM(&result, "simulate", "run.json", "-o", "no");
    run_program_assert_code(&result, 2);
    assert_non_null(strstr(result.err, "use: mesofit fit run.json"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_one_state_is_a_fit_without_states),
        cmocka_unit_test(test_two_densities_find_a_known_potential),
        cmocka_unit_test(test_fit_of_states_has_the_same_bits_again),
        cmocka_unit_test(test_auto_takes_the_steps_of_imc_when_there_are_several_states),
        cmocka_unit_test(test_pressures_of_two_densities_are_met),
        cmocka_unit_test(test_states_that_contradict_each_other_do_not_converge),
        cmocka_unit_test(test_what_no_states_can_be_is_refused),
        cmocka_unit_test(test_folders_of_states_are_the_fits_own),
        cmocka_unit_test(test_states_with_other_names_leave_nothing),
        cmocka_unit_test(test_precision_is_that_of_the_most_exact_state),
        cmocka_unit_test(test_results_of_states_are_exported),
    };
    return cmocka_run_group_tests(tests, enter, small_inputs_leave);
}
