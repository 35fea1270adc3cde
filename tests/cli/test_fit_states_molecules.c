// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bonds, angles and pairs of several states: one state is the fit of a file without states; the
// same bits whatever the threads and through a restart; bins of one state that the other has not;
// states that contradict each other; and groups that states cannot share.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"
#include "shared/twins.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHAINS                                                                                     \
    "\"molecules\": {\"trimer\": {\"count\": 60, \"chain\": {\"beads\": [\"A\", \"B\", \"A\"],\n"  \
    "  \"bond\": \"backbone\", \"angle\": \"bend\"}}}"
#define SETUP "\"box\": [4, 4, 4], \"time_step\": 0.005, " CHAINS
#define FRICTION "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}"
#define TEMPERATURE(T) "\"temperature\": " T

/// The truth; the temperature and the angle at rest are replaced.
static const char scene[] = "{\"seed\": 11, " TEMPERATURE(
    "0.8") ", " SETUP ",\n"
           "\"bonds\": {\"backbone\": {\"law\": \"harmonic\", \"k\": 100, \"length\": 0.6}},\n"
           "\"angles\": {\"bend\": {\"law\": \"harmonic\", \"k\": 12, \"angle\": 110}},\n"
           "\"conservative\": {\"A-A\": {\"law\": \"soft-repulsion\", \"a\": 20},\n"
           "  \"A-B\": {\"law\": \"soft-repulsion\", \"a\": 12},\n"
           "  \"B-B\": {\"law\": \"soft-repulsion\", \"a\": 25}},\n" FRICTION ",\n"
           "\"rdf\": {\"range\": 1.4, \"bins\": 28}, \"bond_lengths\": {\"bins\": 60},\n"
           "\"bond_angles\": {\"bins\": 45},\n"
           "\"measure\": {\"equilibration\": 1000, \"samples\": 300, \"every\": 25}}\n";

#define TARGET(name)                                                                               \
    "\"target\": {\"rdf\": {\"A-A\": {\"file\": \"" name "/rdf_A-A.tsv\"},\n"                      \
    "   \"A-B\": {\"file\": \"" name "/rdf_A-B.tsv\"}, \"B-B\": {\"file\": \"" name                \
    "/rdf_B-B.tsv\"}},\n"                                                                          \
    "  \"bond_lengths\": {\"backbone\": {\"file\": \"" name "/bond_lengths.tsv\"}},\n"             \
    "  \"bond_angles\": {\"bend\": {\"file\": \"" name "/bond_angles.tsv\"}}}"
#define STATE(name, T) "\"" name "\": {\"scene\": {" TEMPERATURE(T) "},\n " TARGET(name) "}"
#define COMMON                                                                                     \
    "\"seed\": 2, \"verification\": {\"replicas\": 2, \"equilibration\": 300, \"samples\": 60, "   \
    "\"every\": 25}"
#define METHOD(name)                                                                               \
    "\"method\": {\"name\": \"" name "\", \"replicas\": 2, \"equilibration\": 40,\n"               \
    "  \"samples\": 60, \"iterations\": 4, \"precision\": 0.02}"
#define SCENE "\"scene\": {" SETUP ", " FRICTION "}"
static const char run[] =
    "{" COMMON ", " SCENE
    ",\n" METHOD("imc") ",\n"
                        "\"states\": {" STATE("cold", "0.8") ",\n" STATE("hot", "1.6") "}}\n";

static struct run_program_result result;

static void simulate(struct temporary_folder *folder, const char *name, const char *from,
                     const char *to) {
    char file[64];
    snprintf(file, sizeof file, "%s.json", name);
    small_inputs_write(folder, file, scene, from, to);
    twins_simulate(file, name);
}

static int enter(void **state) {
    if (small_inputs_enter_without_gnuplot(state) != 0)
        return -1;
    simulate(*state, "cold", NULL, NULL);
    simulate(*state, "hot", TEMPERATURE("0.8"), TEMPERATURE("1.6"));
    return 0;
}

static const char *const tables[] = {"potential_A-A.tsv",
                                     "potential_A-B.tsv",
                                     "bonds_backbone.tsv",
                                     "angles_bend.tsv",
                                     "history.tsv",
                                     "bonds_backbone_history.tsv",
                                     "bond_angles_bend.tsv",
                                     "rdf_A-B.tsv",
                                     "bond_lengths_backbone.tsv",
                                     NULL};
static const char *const tables_of_states[] = {"potential_A-A.tsv",
                                               "bonds_backbone.tsv",
                                               "angles_bend.tsv",
                                               "history.tsv",
                                               "states/hot/bond_lengths_backbone.tsv",
                                               "states/hot/rdf_A-B.tsv",
                                               NULL};

static void assert_fitted(void) {
    assert_true(result.code == 0 || result.code == 1);
}

static void test_one_state_of_chains_is_a_fit_without_states(void **state) {
    small_inputs_write(*state, "one.json",
                       "{" COMMON ", " SCENE
                       ",\n" METHOD("imc") ",\n"
                                           "\"states\": {" STATE("hot", "1.6") "}}\n",
                       NULL, NULL);
    small_inputs_write(*state, "plain.json",
                       "{" COMMON
                       ", \"scene\": {" TEMPERATURE("1.6") ", " SETUP ", " FRICTION "},\n" METHOD(
                           "imc") ", " TARGET("hot") "}\n",
                       NULL, NULL);
    RUN_PROGRAM(&result, "fit", "one.json", "-o", "one");
    assert_fitted();
    RUN_PROGRAM(&result, "fit", "plain.json", "-o", "plain");
    assert_fitted();
    results_assert_same("one", "plain", tables);
}

/// Threads, interruptions and the written file change no bits, from coarse steps to the equations
/// of both states.
static void test_chains_of_two_states_again_with_the_same_bits(void **state) {
    static const char *const pieces[] = {"fit", "run.json", "-o", "pieces", NULL};
    small_inputs_write(*state, "run.json", run, "\"iterations\": 4", "\"iterations\": 8");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--threads", "1");
    assert_fitted();
    const int code = result.code;
    RUN_PROGRAM(&result, "fit", "out/used.json", "-o", "again", "--threads", "2");
    run_program_assert_code(&result, code);
    run_program_in_pieces(code, pieces);
    results_assert_same("out", "again", tables_of_states);
    results_assert_same("out", "pieces", tables_of_states);
}

/// Rows of a table that are no comments.
static size_t count_rows(const char *file) {
    char *text = temporary_folder_read(file);
    size_t rows = 0;
    for (const char *line = text; *line; line = strchr(line, '\n') + 1)
        rows += *line != '#';
    free(text);
    return rows;
}

/// p of a cold bond ends before that of a hot one does. Both are then fitted in the bins of the hot
/// one.
static void test_bins_of_states_are_those_of_all(void **state) {
    static struct run_program_result explained;
    small_inputs_write(*state, "run.json", run, NULL, NULL);
    RUN_PROGRAM(&explained, "fit", "run.json", "--explain");
    run_program_assert_code(&explained, 0);
    assert_contains(explained.out, "verification of state \"cold\"");
    assert_contains(explained.out, "verification of state \"hot\"");
    small_inputs_write(*state, "plain.json",
                       "{" COMMON
                       ", \"scene\": {" TEMPERATURE("0.8") ", " SETUP ", " FRICTION "},\n" METHOD(
                           "imc") ", " TARGET("cold") "}\n",
                       NULL, NULL);
    RUN_PROGRAM(&result, "fit", "plain.json", "-o", "cold_alone", "--force");
    assert_fitted();
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--force");
    assert_fitted();
    const size_t alone = count_rows("cold_alone/bond_lengths_backbone.tsv");
    const size_t cold = count_rows("out/bond_lengths_backbone.tsv");
    const size_t hot = count_rows("out/states/hot/bond_lengths_backbone.tsv");
    print_message("%zu bins of cold bonds alone, %zu with hot ones, which have %zu\n", alone, cold,
                  hot);
    assert_true(alone < cold);
    assert_int_equal(cold, hot);
    assert_true(results_number("out/summary.json", "states.cold.rdf_rmse") < 0.05);
    assert_true(results_number("out/summary.json", "states.hot.rdf_rmse") < 0.05);
}

/// Chains that bend otherwise have no potential in common.
static void test_chains_that_contradict_each_other_do_not_converge(void **state) {
    simulate(*state, "bent", "\"angle\": 110", "\"angle\": 80");
    small_inputs_write(
        *state, "run.json",
        "{" COMMON ", " SCENE
        ",\n" METHOD("imc") ",\n"
                            "\"states\": {" STATE("cold", "0.8") ",\n" STATE("bent", "0.8") "}}\n",
        "\"iterations\": 4", "\"iterations\": 40");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--force");
    run_program_assert_code(&result, 1);
    print_message("%s", result.err);
    assert_contains(result.err, "no step improves all states together");
    assert_contains(result.err, "bond_angles of \"");
    results_assert_text("out/summary.json", "status", "unconverged");
}

static void test_groups_that_states_cannot_share_are_refused(void **state) {
    static const struct {
        const char *from, *to, *words[4];
    } cases[] = {
        {"\"hot/bond_lengths.tsv\"",
         "\"narrow/bond_lengths.tsv\"",
         {"states.hot", "target.bond_lengths.backbone", "common edges", NULL}},
        {"\"hot\": {\"scene\": {",
         "\"hot\": {\"scene\": {\"angles\": {\"bend\": {\"law\": \"harmonic\", \"k\": 12, "
         "\"angle\": 110}}, ",
         {"states.hot", "targets for, and no laws", NULL}},
    };
    simulate(*state, "narrow", "\"bond_lengths\": {\"bins\": 60}",
             "\"bond_lengths\": {\"bins\": 70}");
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        small_inputs_write(*state, "bad.json", run, cases[k].from, cases[k].to);
        RUN_PROGRAM(&result, "fit", "bad.json", "-o", "bad");
        print_message("%s", result.err);
        run_program_assert_code(&result, 2);
        for (size_t w = 0; cases[k].words[w]; w++)
            assert_contains(result.err, cases[k].words[w]);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_one_state_of_chains_is_a_fit_without_states),
        cmocka_unit_test(test_chains_of_two_states_again_with_the_same_bits),
        cmocka_unit_test(test_bins_of_states_are_those_of_all),
        cmocka_unit_test(test_chains_that_contradict_each_other_do_not_converge),
        cmocka_unit_test(test_groups_that_states_cannot_share_are_refused),
    };
    return cmocka_run_group_tests(tests, enter, small_inputs_leave);
}
