// SPDX-License-Identifier: GPL-3.0-or-later
//
// What `mesofit simulate` measures of pairs, from outside: escape times and the force covariance.
#include "targets/target_files.h"
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// The fluid of Groot and Warren (1997), without its last members: what is measured of it.
#define GROOT_WARREN(box, count)                                                                   \
    "{\"seed\": 5, \"box\": [" box "], \"particles\": {\"count\": " count "},\n"                   \
    "\"time_step\": 0.04, \"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"           \
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 2.1213},\n"

#define MEASURE "\"measure\": {\"equilibration\": 100, \"samples\": 20, \"every\": 10}"
#define LONG_MEASURE "\"measure\": {\"equilibration\": 1200, \"samples\": 60, \"every\": 20}"
#define DPD_VERLET "\"dynamics\": {\"integrator\": \"dpd-verlet\"}, "

static const char *const tables[] = {"rdf.tsv", "thermodynamics.tsv", NULL};
/// Of 9 (1 - r)^2, the mean over a ball of radius 0.02.
#define EXACT 8.7320
static const char *const covariance[] = {"force_covariance.tsv", NULL};

/// Escape times in windows of 24 steps, two or three of them open.
#define ETD                                                                                        \
    "\"etd\": {\"r_minimum\": 0.4, \"r_maximum\": 0.9, \"bins\": 5, \"times\": 9, "                \
    "\"every\": 3, \"origin_every\": 3}, "
static const char *const etd_tables[] = {"rdf.tsv",       "thermodynamics.tsv", "etd.tsv",
                                         "etd_error.tsv", "etd_bins.tsv",       NULL};

static void write_scene(struct temporary_folder *folder, const char *measurements,
                        const char *measure) {
    char text[1024];
    const int length = snprintf(text, sizeof text, "%s%s%s}\n",
                                GROOT_WARREN("4.64, 4.64, 4.64", "300"), measurements, measure);
    temporary_folder_write(folder, "scene.json", text, (size_t)length);
}

static void simulate(struct run_program_result *result, const char *out) {
    RUN_PROGRAM(result, "simulate", "scene.json", "-o", out);
    run_program_assert_code(result, 0);
}

/// Interrupted again and again at different places, the run ends with the bits of one in peace.
static void check_interruption(struct temporary_folder *folder, const char *measurements) {
    static struct run_program_result result;
    write_scene(folder, measurements, LONG_MEASURE);
    simulate(&result, "whole");
    const char *const words[] = {"simulate", "scene.json", "-o", "pieces", NULL};
    run_program_in_pieces(0, words);
    assert_false(temporary_folder_exists("pieces/checkpoint.bin"));
    results_assert_same("whole", "pieces", (const char *const[]){"used.json", NULL});
}

static void test_simulate_measures_escape_times_when_asked(void **state) {
    static struct run_program_result result;
    write_scene(*state, "", MEASURE);
    simulate(&result, "without");
    assert_false(temporary_folder_exists("without/etd.tsv"));
    write_scene(*state, ETD, MEASURE);
    simulate(&result, "with");
    results_assert_same("without", "with", tables);
    results_assert_table("with/etd.tsv", 6, 9);
    results_assert_table("with/etd_error.tsv", 6, 9);
    results_assert_table("with/etd_bins.tsv", 2, 5);
    // 200 steps are 66 samples after the first: windows of 8 begin at 0, 3, … 57.
    results_assert_number("with/summary.json", "etd.origins", 20);
    results_assert_number("with/summary.json", "etd.interval", 0.12);
    assert_true(results_number("with/summary.json", "etd.pairs") > 1000);
    RUN_PROGRAM(&result, "simulate", "with/used.json", "-o", "again");
    run_program_assert_code(&result, 0);
    results_assert_same("with", "again", etd_tables);
    results_assert_same("with", "again", (const char *const[]){"used.json", NULL});
    RUN_PROGRAM(&result, "simulate", "scene.json", "--explain");
    assert_contains(result.out, "escape times                       on ");
    assert_contains(result.out, "within 0.9, one step in 3; an origin in 9");
    RUN_PROGRAM(&result, "describe", "etd");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "r_maximum");
    assert_contains(result.out, "origin_every");
}

/// What one run has measured can be the target of another.
static void test_simulated_escape_times_can_be_a_target(void **state) {
    static struct run_program_result result;
    static const char text[] =
        "{\"etd\": {\"file\": \"out/etd.tsv\", \"error_file\": \"out/etd_error.tsv\", "
        "\"r_minimum\": 0, \"r_maximum\": 0.9}}";
    struct json_document *document;
    struct target_etd target;
    write_scene(*state, "\"etd\": {\"r_maximum\": 0.9, \"bins\": 90, \"times\": 7, \"every\": 3}, ",
                MEASURE);
    simulate(&result, "out");
    const char *file = temporary_folder_write(*state, "target.json", text, sizeof text - 1);
    assert_ok(mf_json_open(&document, file));
    struct json_object root = mf_json_root(document);
    struct json_object object = mf_json_child(&root, "etd", true);
    assert_ok(mf_target_etd_read(&target, &object));
    assert_ok(mf_json_close(document, STATUS_OK));
    assert_int_equal(target.grid.times, 7);
    assert_int_equal(target.grid.bins, 90);
    // No pair is nearer than 0.01 λ; most bins are known.
    assert_in_range(target.left_out, 7, 7 * 30);
    assert_int_equal(target.left_out % 7, 0);
    assert_true(target.survival[7 * 90 - 1] < 0.6 && target.error[7 * 90 - 1] > 0);
    assert_close(target.interval, 3 * 0.04, 1e-9);
    mf_target_etd_clear(&target);
}

static void test_simulate_refuses_escape_times_that_it_cannot_measure(void **state) {
    static struct run_program_result result;
    write_scene(*state, "\"etd\": {}, ", MEASURE);
    RUN_PROGRAM(&result, "simulate", "scene.json");
    run_program_assert_refused(&result, ".", "no range", 1,
                               (const char *[]){"etd.r_maximum", NULL});
    write_scene(*state, "\"etd\": {\"r_maximum\": 0.9, \"times\": 300}, ", MEASURE);
    RUN_PROGRAM(&result, "simulate", "scene.json");
    run_program_assert_refused(&result, ".", "long windows", 1,
                               (const char *[]){"scene.json", "299 times of 1 steps", NULL});
}

static void test_simulate_draws_escape_times_when_gnuplot_is_there(void **state) {
    static struct run_program_result result;
    small_inputs_need_gnuplot();
    // Bins that no pair is in, at the beginning, and one bin alone.
    static const char *const ranges[] = {"\"r_minimum\": 0, \"bins\": 300", "\"bins\": 1"};
    for (int k = 0; k < 2; k++) {
        char to[128];
        snprintf(to, sizeof to, "\"etd\": {\"r_maximum\": 0.9, \"times\": 9, %s}, ", ranges[k]);
        write_scene(*state, to, MEASURE);
        simulate(&result, k ? "one" : "many");
        assert_true(temporary_folder_exists(k ? "one/figures/etd.svg" : "many/figures/etd.svg"));
        assert_true(temporary_folder_exists(k ? "one/figures/etd.png" : "many/figures/etd.png"));
        if (strstr(result.err, "warning"))
            fail_msg("%s", result.err);
    }
}

/// The checkpoint holds as many pairs as were followed at the time.
static void test_interrupted_escape_times_go_on_with_the_same_bits(void **state) {
    check_interruption(*state, ETD);
    results_assert_same("whole", "pieces", etd_tables);
}

static void test_threads_do_not_change_what_is_measured_of_pairs(void **state) {
    static struct run_program_result result;
    static const char text[] = GROOT_WARREN("6.94, 6.94, 6.94", "1000") ETD DPD_VERLET
        "\"force_covariance\": {}, " MEASURE "}\n";
    temporary_folder_write(*state, "scene.json", text, sizeof text - 1);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "one", "--threads", "1");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "two", "--threads", "2");
    run_program_assert_code(&result, 0);
    results_assert_same("one", "two", etd_tables);
    results_assert_same("one", "two", covariance);
}

static void test_simulate_measures_the_force_covariance_when_asked(void **state) {
    static struct run_program_result result;
    write_scene(*state, "\"force_covariance\": {}, " DPD_VERLET, MEASURE);
    simulate(&result, "with");
    results_assert_table("with/force_covariance.tsv", 4, 50);
    // 2 k_B T ω² of the first bin, 0 to 0.02, of sigma 3 in Groot and Warren's notation.
    char *table = temporary_folder_read("with/force_covariance.tsv");
    const char *row = strchr(table, '\n') + 1;
    while (row[0] == '#')
        row = strchr(row, '\n') + 1;
    assert_true(fabs(strtod(strchr(strchr(strchr(row, '\t') + 1, '\t') + 1, '\t') + 1, NULL) -
                     EXACT) < 1e-3);
    free(table);
    write_scene(*state, DPD_VERLET, MEASURE);
    simulate(&result, "without");
    assert_false(temporary_folder_exists("without/force_covariance.tsv"));
    results_assert_same("without", "with", tables);
    RUN_PROGRAM(&result, "simulate", "with/used.json", "-o", "again");
    run_program_assert_code(&result, 0);
    results_assert_same("with", "again", covariance);
    RUN_PROGRAM(&result, "simulate", "with/used.json", "--explain");
    assert_contains(result.out, "force covariance                   on ");
    RUN_PROGRAM(&result, "describe", "force_covariance");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "range");
}

static void test_simulate_refuses_a_force_covariance_without_friction_forces(void **state) {
    static struct run_program_result result;
    write_scene(*state, "\"force_covariance\": {}, ", MEASURE);
    RUN_PROGRAM(&result, "simulate", "scene.json");
    run_program_assert_refused(
        &result, ".", "friction split off", 1,
        (const char *[]){"scene.json", "\"aboba\" splits friction", "dpd-verlet", NULL});
}

static void test_interrupted_force_covariance_goes_on_with_the_same_bits(void **state) {
    check_interruption(*state, "\"force_covariance\": {\"bins\": 9}, " ETD DPD_VERLET);
    results_assert_same("whole", "pieces", covariance);
    results_assert_same("whole", "pieces", etd_tables);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, small_inputs_enter, small_inputs_leave)
#define TEST_WITHOUT_FIGURES(name)                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

/// Beads in wells of 6.4 k_B T are frozen for as long as the samples take, and scatter little.
static void test_simulate_tells_of_pairs_that_stay_together_for_the_whole_run(void **state) {
    static struct run_program_result result;
    static const char scene[] =
        "{\"box\": [5, 5, 5], \"time_step\": 0.01, \"particles\": {\"types\": {\"A\": 24, "
        "\"B\": 150}, \"placement\": \"random\"}, \"conservative\": {\"A-A\": {\"law\": "
        "\"expression\", \"formula\": \"30*exp(-(r/0.3)^2)-7*exp(-((r-0.6)/0.15)^2)\", "
        "\"cutoff\": 1.1}, \"A-B\": {\"law\": \"soft-repulsion\", \"a\": 10}, \"B-B\": {\"law\": "
        "\"soft-repulsion\", \"a\": 10}}, \"dissipative\": {\"law\": \"power\", \"sigma\": 2.5}, "
        "\"measure\": {\"equilibration\": 100, \"samples\": 20, \"every\": 10}}";
    temporary_folder_write(*state, "sticky.json", scene, sizeof scene - 1);
    RUN_PROGRAM(&result, "simulate", "sticky.json", "-o", "sticky", "--quiet");
    run_program_assert_code(&result, 0);
    assert_contains(result.err,
                    "warning: pairs A-A stay for 49.3 or longer in their well of 6.4 k_B T");
    write_scene(*state, "", MEASURE);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "loose", "--quiet");
    run_program_assert_code(&result, 0);
    assert_null(strstr(result.err, "stay for"));
}

/// In four units of time this fluid forgets its pairs, in one step it does not. Bond lengths go by
/// the pairs and their own counts.
static void test_simulate_says_whether_errors_are_of_samples(void **state) {
    static struct run_program_result result;
    static const char dumbbells[] =
        "{\"seed\": 5, \"box\": [4.64, 4.64, 4.64], \"time_step\": 0.04, "
        "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25}, "
        "\"dissipative\": {\"law\": \"power\", \"sigma\": 2.1213}, "
        "\"bonds\": {\"spring\": {\"law\": \"harmonic\", \"k\": 20, \"length\": 0.8}}, "
        "\"molecules\": {\"two\": {\"count\": 150, \"beads\": [\"A\", \"A\"], "
        "\"bonds\": {\"spring\": [[1, 2]]}}}, "
        "\"bond_lengths\": {}, \"rdf\": {\"bins\": 10}, "
        "\"measure\": {\"equilibration\": 100, \"samples\": SAMPLES}}";
    static const char *const samples[] = {"400, \"every\": 1", "60, \"every\": 100"};
    static const char *const file[] = {"out/rdf.tsv", "out/bond_lengths.tsv"};
    static const char comment[] = "# errors of samples\n";
    for (int k = 0; k < 2; k++) {
        small_inputs_write(*state, "scene.json", dumbbells, "SAMPLES", samples[k]);
        RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
        run_program_assert_code(&result, 0);
        for (int n = 0; n < 2; n++) {
            char *table = temporary_folder_read(file[n]);
            assert_int_equal(strncmp(table, comment, strlen(comment)) == 0, k == 1);
            free(table);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST_WITHOUT_FIGURES(test_simulate_measures_escape_times_when_asked),
        TEST_WITHOUT_FIGURES(test_simulated_escape_times_can_be_a_target),
        TEST_WITHOUT_FIGURES(test_simulate_refuses_escape_times_that_it_cannot_measure),
        TEST(test_simulate_draws_escape_times_when_gnuplot_is_there),
        TEST_WITHOUT_FIGURES(test_interrupted_escape_times_go_on_with_the_same_bits),
        TEST_WITHOUT_FIGURES(test_threads_do_not_change_what_is_measured_of_pairs),
        TEST_WITHOUT_FIGURES(test_simulate_measures_the_force_covariance_when_asked),
        TEST_WITHOUT_FIGURES(test_simulate_refuses_a_force_covariance_without_friction_forces),
        TEST_WITHOUT_FIGURES(test_interrupted_force_covariance_goes_on_with_the_same_bits),
        TEST_WITHOUT_FIGURES(test_simulate_tells_of_pairs_that_stay_together_for_the_whole_run),
        TEST_WITHOUT_FIGURES(test_simulate_says_whether_errors_are_of_samples),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
