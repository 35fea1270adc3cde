// SPDX-License-Identifier: GPL-3.0-or-later
//
// Fits of what is left beside a part of the potential that is known, from outside. Groot and
// Warren's repulsion is linear in its strength, so that the rest of it is one, too.
#include "export/export_model.h"
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"
#include "shared/twins.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define SETUP                                                                                      \
    "\"box\": [5, 5, 5], \"time_step\": 0.02, \"particles\": {\"count\": 250}, "                   \
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}"

static const char scene[] =
    "{\"seed\": 1, " SETUP ", \"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "\"rdf\": {\"range\": 1.2, \"bins\": 30},\n"
    "\"measure\": {\"equilibration\": 500, \"samples\": 1000, \"every\": 20}}\n";

#define KNOWN "\"known\": {\"law\": \"soft-repulsion\", \"a\": 15}"
#define TRUTH "{\"law\": \"soft-repulsion\", \"a\": 10}"
#define METHOD "\"method\": {\"name\": \"imc\", \"precision\": 0.004}"
#define COARSE                                                                                     \
    "\"method\": {\"name\": \"imc\", \"replicas\": 4, \"equilibration\": 10, \"samples\": 30, "    \
    "\"iterations\": 3, \"precision\": 0.1}"
static const char run[] =
    "{\"seed\": 4, \"scene\": {" SETUP ", " KNOWN "},\n"
    "\"target\": {\"rdf\": {\"file\": \"truth/rdf.tsv\"}},\n"
    "\"unknowns\": {\"potential\": {\"truth\": " TRUTH "}},\n" METHOD ",\n"
    "\"verification\": {\"replicas\": 2, \"equilibration\": 300, \"samples\": 100, \"every\": "
    "20}}\n";

static struct run_program_result result;

static int enter(void **state) {
    if (small_inputs_enter_without_gnuplot(state) != 0)
        return -1;
    small_inputs_write(*state, "truth.json", scene, NULL, NULL);
    small_inputs_write(*state, "run.json", run, NULL, NULL);
    twins_simulate("truth.json", "truth");
    return 0;
}

static void run_fit(const char *file, const char *out) {
    RUN_PROGRAM(&result, "fit", file, "-o", out, "--quiet", "--force");
    run_program_assert_code(&result, 0);
}

enum { R, PHI, FORCE, ERROR, WITHOUT, COLUMNS = 7 };

/// A row of potential.tsv; NULL after the last.
static const char *read_row(const char *text, double row[COLUMNS]) {
    while (text && *text == '#')
        text = strchr(text, '\n') + 1;
    if (text == NULL || *text == '\0')
        return NULL;
    for (int c = 0; c < COLUMNS && *text != '\n'; c++) {
        char *end;
        row[c] = strtod(text, &end);
        text = end;
    }
    return strchr(text, '\n') + 1;
}

/// rms of (Φ − truth)/error over the points that have an error. After the columns of errors come
/// the truth, if there is one, and the total.
static double rms_deviation(const char *file, bool truth) {
    char *text = temporary_folder_read(file);
    const char *at = text;
    double row[COLUMNS], squares = 0, count = 0;
    while ((at = read_row(at, row)) != NULL) {
        if (!(row[ERROR] > 0))
            continue;
        squares += pow((row[PHI] - (truth ? row[WITHOUT + 1] : 0)) / row[ERROR], 2);
        count++;
    }
    free(text);
    assert_true(count > 15);
    return sqrt(squares / count);
}

static void test_the_rest_of_a_known_part_is_found(void **state) {
    (void)state;
    run_fit("run.json", "out");
    const double z = rms_deviation("out/potential.tsv", true);
    print_message("(phi - truth)/error %.2f rms\n", z);
    assert_true(z < 1.3);
    char *text = temporary_folder_read("out/potential.tsv");
    const char *at = text;
    double row[COLUMNS];
    assert_non_null(strstr(text, "truth[k_B.T_0]\ttotal[k_B.T_0]\n"));
    while ((at = read_row(at, row)) != NULL) // a (1 − r)²/2
        assert_close(row[6] - row[PHI], row[R] < 1 ? 7.5 * pow(1 - row[R], 2) : 0, 1e-9);
    free(text);
}

static void test_nothing_is_left_where_all_is_known(void **state) {
    small_inputs_change(*state, "run.json", "\"a\": 15", "\"a\": 25");
    small_inputs_change(*state, "run.json", "\"truth\": " TRUTH, "");
    run_fit("run.json", "out");
    char *text = temporary_folder_read("out/potential.tsv");
    assert_null(strstr(text, "truth"));
    free(text);
    const double z = rms_deviation("out/potential.tsv", false);
    print_message("phi/error %.2f rms\n", z);
    assert_true(z < 1.3);
}

/// The pressure has both parts, and g(r) with it: what is verified is the fluid of the target.
static void test_the_verification_has_both_parts(void **state) {
    (void)state;
    run_fit("run.json", "out");
    const double own = results_number("out/summary.json", "pressure");
    const double truth = results_number("truth/summary.json", "pressure");
    assert_true(fabs(own - truth) < 3 * results_number("out/summary.json", "pressure_left_open"));
    assert_true(own > 0.8 * truth); // the rest alone has hardly half
    assert_true(results_number("out/summary.json", "rdf_rmse") < 0.02);
}

static void test_an_export_has_both_parts(void **state) {
    (void)state;
    small_inputs_change(*state, "run.json", METHOD, COARSE);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--quiet");
    assert_in_range(result.code, 0, 1);
    struct export_model model;
    double row[COLUMNS], value;
    assert_ok(mf_export_model_read(&model, "out"));
    char *text = temporary_folder_read("out/potential.tsv");
    const char *at = text;
    while ((at = read_row(at, row)) != NULL) {
        mf_table_evaluate(model.setup.potential, row[R], &value, NULL, NULL);
        assert_close(value, row[6], 2e-3);
    }
    free(text);
    mf_export_model_clear(&model);
    RUN_PROGRAM(&result, "export", "out", "--engine", "lammps", "-o", "exported");
    run_program_assert_code(&result, 0);
    assert_non_null(strstr(result.err, "of the known part beside it"));
}

static void test_compare_shows_both_parts(void **state) {
    small_inputs_change(*state, "run.json", METHOD, COARSE);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "beside", "--quiet");
    small_inputs_change(*state, "run.json", ", " KNOWN, "");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "alone", "--quiet");
    RUN_PROGRAM(&result, "compare", "beside", "alone", "-o", "both");
    run_program_assert_code(&result, 0);
    char *text = temporary_folder_read("beside/potential.tsv"), total[160];
    const char *at = text;
    double row[COLUMNS];
    for (int k = 0; k < 10; k++)
        at = read_row(at, row);
    snprintf(total, sizeof total, "\n%.10g\t%.10g\t", row[R], row[6]);
    free(text);
    text = temporary_folder_read("both/potential_compare.tsv");
    assert_contains(text, total);
    free(text);
}

static void test_used_and_explain_tell_what_is_known(void **state) {
    (void)state;
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_non_null(strstr(result.out, "known beside the potential that is looked for: "
                                       "soft-repulsion; simulations have both"));
    small_inputs_change(*state, "run.json", METHOD, COARSE);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--quiet");
    results_assert_number("out/used.json", "scene.known.a", 15);
    // What was used is a run file of the same fit.
    RUN_PROGRAM(&result, "fit", "out/used.json", "-o", "again", "--quiet");
    results_assert_same("out", "again", (const char *const[]){"potential.tsv", "rdf.tsv", NULL});
}

static void test_an_interrupted_fit_has_the_same_bits(void **state) {
    static const char *const same[] = {"potential.tsv", "rdf.tsv", "history.tsv", NULL};
    small_inputs_change(*state, "run.json", METHOD, COARSE);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "whole", "--quiet");
    const char *const words[] = {"fit", "run.json", "-o", "pieces", NULL};
    run_program_in_pieces(result.code, words);
    results_assert_same("whole", "pieces", same);
}

/// Two fluids whose repulsions differ, and what is known of them by as much: they share the rest.
static void test_states_share_the_rest_when_each_has_a_known_part(void **state) {
    small_inputs_write(*state, "weak.json", scene, "\"a\": 25", "\"a\": 20");
    twins_simulate("weak.json", "weak");
    small_inputs_change(*state, "run.json", "\"target\": {\"rdf\": {\"file\": \"truth/rdf.tsv\"}}",
                        "\"states\": {\"strong\": {\"target\": {\"rdf\": {\"file\": "
                        "\"truth/rdf.tsv\"}}}, \"weak\": {\"target\": {\"rdf\": {\"file\": "
                        "\"weak/rdf.tsv\"}}, \"scene\": {\"known\": {\"a\": 10}}}}");
    run_fit("run.json", "out");
    // Measured with five seeds: 0.02 to 0.14; the two known parts differ by 2.5 k_B T.
    assert_true(results_number("out/summary.json", "truth_rms") < 0.4);
    results_assert_number("out/used.json", "states.weak.scene.known.a", 10);
}

#define SAME "{\"law\": \"soft-repulsion\", \"a\": 25}"
#define OTHER "{\"law\": \"soft-repulsion\", \"a\": 40}"
#define LAWS(PAIR) "{\"A-A\": " SAME ", \"A-B\": " PAIR ", \"B-B\": " SAME "}"

/// None of them is named as one that would do.
static void assert_methods_of_all_pairs_are_refused(struct temporary_folder *folder) {
    static const char *const method[] = {"hnc", "cma-es"};
    char *text = temporary_folder_read("run.json");
    for (int k = 0; k < 2; k++) {
        char name[40], refused[80];
        snprintf(name, sizeof name, "{\"name\": \"%s\"}", method[k]);
        snprintf(refused, sizeof refused, "no g(r) is given of the pair A-A, which \"%s\" needs; ",
                 method[k]);
        small_inputs_write(folder, "needs.json", text, METHOD, "\"method\": METHOD");
        small_inputs_change(folder, "needs.json", "METHOD", name);
        RUN_PROGRAM(&result, "fit", "needs.json", "-o", "refused", "--quiet");
        run_program_assert_code(&result, 2);
        assert_contains(result.err, refused);
        const char *others = strstr(result.err, refused) + strlen(refused);
        assert_non_null(strstr(others, "\"imc\""));
        assert_null(strstr(others, "\"hnc\""));
    }
    free(text);
}

/// Where a solute meets a solvent: g(r) of the pairs that are looked for is enough, if the others
/// are known.
static void test_pairs_without_a_target_are_known(void **state) {
    small_inputs_change(*state, "truth.json", "{\"count\": 250}",
                        "{\"types\": {\"A\": 150, \"B\": 100}}");
    small_inputs_change(*state, "truth.json", SAME, LAWS(OTHER));
    twins_simulate("truth.json", "mixture");
    small_inputs_change(*state, "run.json", "{\"count\": 250}",
                        "{\"types\": {\"A\": 150, \"B\": 100}}");
    small_inputs_change(*state, "run.json", "{\"file\": \"truth/rdf.tsv\"}",
                        "{\"A-B\": {\"file\": \"mixture/rdf_A-B.tsv\"}}");
    small_inputs_change(*state, "run.json",
                        "\"unknowns\": {\"potential\": {\"truth\": " TRUTH "}},", "");
    small_inputs_change(*state, "run.json", KNOWN, "\"known\": " LAWS("{\"law\": \"none\"}"));
    small_inputs_change(*state, "run.json", METHOD,
                        "\"unknowns\": {\"potential\": {\"truth\": {\"A-A\": {\"law\": \"none\"}, "
                        "\"A-B\": " OTHER ", \"B-B\": {\"law\": \"none\"}}}}, " METHOD);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--force");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, "no g(r) is given of A-A, B-B: their potential is not looked for; "
                                "it is that of scene.known");
    assert_null(strstr(result.err, "nan"));
    assert_true(temporary_folder_exists("out/potential_A-B_history.tsv"));
    assert_false(temporary_folder_exists("out/potential_A-A_history.tsv"));
    assert_false(temporary_folder_exists("out/potential_B-B_flat.tsv"));
    char *summary = temporary_folder_read("out/summary.json");
    assert_null(strstr(summary, "potential_A-A"));
    free(summary);
    const double z = rms_deviation("out/potential_A-B.tsv", true);
    print_message("(phi - truth)/error %.2f rms\n", z);
    assert_true(z < 1.3);
    assert_true(results_number("out/summary.json", "rdf_rmse") < 0.02);
    RUN_PROGRAM(&result, "fit", "out/used.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_methods_of_all_pairs_are_refused(*state);
    small_inputs_change(*state, "run.json", ", \"known\": " LAWS("{\"law\": \"none\"}"), "");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "refused", "--quiet");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "target.rdf.A-A: missing: give its g(r), or");
}

/// Dimers: a bond that is looked for, too, and pairs that are excluded from both parts.
static void test_bonds_are_found_beside_a_known_part(void **state) {
    static const char dimers[] =
        "\"box\": [5, 5, 5], \"time_step\": 0.01, \"particles\": {}, \"molecules\": {\"dimer\": "
        "{\"count\": 125, \"chain\": {\"type\": \"A\", \"length\": 2, \"bond\": \"stick\"}}}, "
        "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}";
    small_inputs_change(*state, "truth.json", SETUP, dimers);
    small_inputs_change(*state, "truth.json", "\"rdf\"",
                        "\"bonds\": {\"stick\": {\"law\": \"harmonic\", \"k\": 100, \"length\": "
                        "0.6}}, \"bond_lengths\": {\"bins\": 40}, \"rdf\"");
    twins_simulate("truth.json", "dimers");
    small_inputs_change(*state, "run.json", SETUP, dimers);
    small_inputs_change(*state, "run.json", "{\"rdf\": {\"file\": \"truth/rdf.tsv\"}}",
                        "{\"rdf\": {\"file\": \"dimers/rdf.tsv\"}, \"bond_lengths\": {\"stick\": "
                        "{\"file\": \"dimers/bond_lengths.tsv\"}}}");
    small_inputs_change(*state, "run.json", "\"unknowns\": {",
                        "\"unknowns\": {\"bonds\": "
                        "{\"stick\": {}}, ");
    run_fit("run.json", "out");
    const double z = rms_deviation("out/potential.tsv", true);
    print_message("(phi - truth)/error %.2f rms\n", z);
    assert_true(z < 1.3);
}

/// Methods that simulate candidates have both parts, too.
static void test_a_search_finds_the_rest(void **state) {
    small_inputs_change(*state, "run.json", "\"truth\": " TRUTH,
                        "\"coefficients\": 5, \"maximum\": 1, \"truth\": " TRUTH);
    small_inputs_change(
        *state, "run.json", METHOD,
        "\"core\": {\"threshold\": 0.05, \"stiffness\": 50}, \"method\": {\"name\": "
        "\"genetic\", \"population\": 6, \"generations\": 2, "
        "\"equilibration\": 200, \"samples\": 20}");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--quiet");
    run_program_assert_code(&result, 0);
    assert_true(results_number("out/summary.json", "rdf_rmse") < 0.1);
}

static void refuse(void *state, const char *from, const char *to, const char *word) {
    const char *words[] = {word, NULL};
    small_inputs_write(state, "wrong.json", run, from, to);
    RUN_PROGRAM(&result, "fit", "wrong.json", "-o", "wrong", "--quiet");
    run_program_assert_refused(&result, "wrong", word, 1, words);
}

/// The range of g(r) is 1.2: that of the known part decides.
static void test_a_small_box_holds_the_range_of_the_known_part(void **state) {
    small_inputs_change(*state, "run.json", KNOWN,
                        "\"known\": {\"law\": \"gaussian\", \"cutoff\": 2}");
    small_inputs_change(*state, "run.json", "\"precision\"", "\"particles\": 100, \"precision\"");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "wrong", "--quiet");
    const char *words[] = {"method.particles: 100 make a box whose shortest edge, 3.68",
                           "2.1 times the cutoff of \"known\", 4.2; 149 are", NULL};
    run_program_assert_refused(&result, "wrong", words[0], 1, words);
}

static void test_what_is_wrong_is_said_in_one_line(void **state) {
    refuse(*state, KNOWN, "\"known\": {\"law\": \"coulomb\"}", "scene.known.law");
    refuse(*state, KNOWN, "\"known\": {\"A-A\": {\"law\": \"gaussian\"}}",
           "scene.known.A-A: pairs are named in mixtures");
    refuse(*state, KNOWN, "\"conservative\": {\"law\": \"soft-repulsion\"}",
           "a part that is known as \"scene.known\"");
    refuse(*state, KNOWN, "\"known\": {\"law\": \"lennard-jones\", \"sigma\": 1.4}",
           "scene.known: it is above 50 at r = ");
    refuse(*state, KNOWN, "\"known\": {\"law\": \"gaussian\", \"cutoff\": 3}", "box");
    small_inputs_change(*state, "truth.json", "\"conservative\"", KNOWN ", \"conservative\"");
    RUN_PROGRAM(&result, "simulate", "truth.json", "-o", "wrong", "--quiet");
    const char *words[] = {"known", "beside a potential that a fit looks for", NULL};
    run_program_assert_refused(&result, "wrong", "known", 1, words);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, enter, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_the_rest_of_a_known_part_is_found),
        TEST(test_nothing_is_left_where_all_is_known),
        TEST(test_the_verification_has_both_parts),
        TEST(test_an_export_has_both_parts),
        TEST(test_compare_shows_both_parts),
        TEST(test_used_and_explain_tell_what_is_known),
        TEST(test_an_interrupted_fit_has_the_same_bits),
        TEST(test_states_share_the_rest_when_each_has_a_known_part),
        TEST(test_pairs_without_a_target_are_known),
        TEST(test_bonds_are_found_beside_a_known_part),
        TEST(test_a_search_finds_the_rest),
        TEST(test_a_small_box_holds_the_range_of_the_known_part),
        TEST(test_what_is_wrong_is_said_in_one_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
