// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit simulate` gives the same bits again: from its used settings, with any number of threads,
// and interrupted and resumed.
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/small_scenes.h"
#include "shared/testing.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>

static const char flat[] =
    "{\"seed\": 5, \"dimensions\": 2, \"box\": [11, 11], \"particles\": {\"count\": 300},\n"
    "\"conservative\": {\"law\": \"gaussian\", \"epsilon\": 2, \"cutoff\": 2.5},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}, " SMALL_SCENES_LONG_MEASURE "}\n";

static void test_used_settings_run_again_give_the_same_bits(void **state) {
    static struct run_program_result result;
    small_scenes_write(*state, small_scenes_dpd, NULL, NULL);
    small_scenes_simulate(&result, "a/b/one");
    RUN_PROGRAM(&result, "simulate", "a/b/one/used.json", "-o", "two");
    run_program_assert_code(&result, 0);
    results_assert_same("a/b/one", "two", small_scenes_tables);
    results_assert_same("a/b/one", "two", (const char *const[]){"used.json", NULL});
}

static void test_the_seed_of_the_command_line_counts(void **state) {
    static struct run_program_result result;
    small_scenes_write(*state, small_scenes_dpd, NULL, NULL);
    small_scenes_simulate(&result, "one");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "two", "--seed", "6");
    run_program_assert_code(&result, 0);
    results_assert_number("two/summary.json", "seed", 6);
    results_assert_differ("one", "two", "rdf.tsv");
    small_scenes_write(*state, small_scenes_dpd, "\"seed\": 5", "\"seed\": 6");
    small_scenes_simulate(&result, "three");
    results_assert_same("three", "two", small_scenes_tables);
}

static void test_threads_do_not_change_the_bits(void **state) {
    static struct run_program_result result;
    small_scenes_write(
        *state, small_scenes_dpd, "4.64, 4.64, 4.64], \"particles\": {\"count\": 300}",
        "6.94, 6.94, 6.94], " SMALL_SCENES_MOTION "\"particles\": {\"count\": 1000}");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "one", "--threads", "1");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "two", "--threads", "2");
    run_program_assert_code(&result, 0);
    results_assert_same("one", "two", small_scenes_moving_tables);
}

/// Interrupted again and again at different places, the run ends with the bits of one in peace.
static void check_interruption_of(struct temporary_folder *folder, const char *scene,
                                  const char *from, const char *to, const char *const *expected) {
    static struct run_program_result result;
    small_scenes_write(folder, scene, from, to);
    small_scenes_simulate(&result, "whole");
    const char *const words[] = {"simulate", "scene.json", "-o", "pieces", NULL};
    run_program_in_pieces(0, words);
    assert_false(temporary_folder_exists("pieces/checkpoint.bin"));
    results_assert_same("whole", "pieces", expected);
    results_assert_same("whole", "pieces", (const char *const[]){"used.json", NULL});
    // The seconds are of all steps, whichever piece they are in.
    const char *const summary = "pieces/summary.json";
    assert_close(results_number(summary, "steps_per_second") * results_number(summary, "seconds"),
                 results_number(summary, "engine_steps"), 1e-6);
}

static void check_interruption(struct temporary_folder *folder, const char *scene, const char *from,
                               const char *to) {
    check_interruption_of(folder, scene, from, to, small_scenes_tables);
}

static void test_interrupted_mixture_goes_on_with_the_same_bits(void **state) {
    check_interruption_of(*state, small_scenes_mixture,
                          "\"measure\": {\"equilibration\": 100, \"samples\": 20, \"every\": 10}",
                          SMALL_SCENES_LONG_MEASURE, small_scenes_mixture_tables);
}

static void test_interrupted_dpd_goes_on_with_the_same_bits(void **state) {
    check_interruption(*state, small_scenes_dpd,
                       "\"measure\": {\"equilibration\": 100, \"samples\": 20, \"every\": 10}",
                       SMALL_SCENES_LONG_MEASURE);
}

static void test_interrupted_diffusion_goes_on_with_the_same_bits(void **state) {
    check_interruption(*state, small_scenes_dpd,
                       "\"measure\": {\"equilibration\": 100, \"samples\": 20, \"every\": 10}",
                       SMALL_SCENES_MOTION SMALL_SCENES_LONG_MEASURE);
    results_assert_same("whole", "pieces", small_scenes_moving_tables);
}

/// Shardlow's step begins with pairs that no checkpoint holds; ABOBA's samples need a force pass of
/// their own.
static void
test_interrupted_dpd_goes_on_with_the_same_bits_when_friction_is_split_off(void **state) {
    check_interruption(*state, flat, "\"seed\": 5",
                       "\"seed\": 5, \"dynamics\": {\"integrator\": \"shardlow\"}");
    check_interruption(*state, flat, "\"seed\": 5",
                       "\"seed\": 5, \"dynamics\": {\"integrator\": \"aboba\"}");
}

static void test_interrupted_dpd_in_the_plane_goes_on_with_the_same_bits(void **state) {
    check_interruption(*state, flat, NULL, NULL);
}

static void test_interrupted_force_rdf_goes_on_with_the_same_bits(void **state) {
    check_interruption(*state, small_scenes_dpd,
                       "\"measure\": {\"equilibration\": 100, \"samples\": 20, \"every\": 10}",
                       SMALL_SCENES_FORCE_RDF SMALL_SCENES_LONG_MEASURE);
}

/// The forces of the steps are their own again after a sample, so thermodynamics.tsv stays.
static void test_force_rdf_leaves_the_steps_alone(void **state) {
    static struct run_program_result result;
    small_scenes_write(*state, small_scenes_dpd, NULL, NULL);
    small_scenes_simulate(&result, "one");
    small_scenes_write(*state, small_scenes_dpd, "\"measure\"",
                       SMALL_SCENES_FORCE_RDF "\"measure\"");
    small_scenes_simulate(&result, "two");
    results_assert_table("two/rdf.tsv", 6, 100);
    results_assert_same("one", "two", (const char *const[]){"thermodynamics.tsv", NULL});
}

static void test_interrupted_nve_goes_on_with_the_same_bits(void **state) {
    check_interruption(*state, small_scenes_nve, NULL, NULL);
}

static void test_interrupted_run_says_so_and_refuses_other_settings(void **state) {
    static struct run_program_result result;
    const struct run_program_how how = {.interrupt_with = SIGINT};
    small_scenes_write(*state, small_scenes_dpd, "\"samples\": 20", "\"samples\": 100000");
    run_program(&result, &how, (const char *const[]){"simulate", "scene.json", NULL});
    run_program_assert_code(&result, 130);
    assert_contains(result.err, "mesofit: interrupted at step ");
    assert_contains(result.err, "--resume");
    assert_true(temporary_folder_exists("out/checkpoint.bin"));
    if (temporary_folder_exists("out/summary.json")) // two samples or more
        results_assert_text("out/summary.json", "status", "interrupted");
    run_program(&result, &how, (const char *const[]){"simulate", "scene.json", "--resume", NULL});
    run_program_assert_code(&result, 130);
    assert_null(strstr(result.err, "T 0.000")); // nothing is known before the first step
    assert_null(strstr(result.err, "? left"));
    char *used = temporary_folder_read("out/used.json");
    small_scenes_write(*state, small_scenes_dpd, "\"samples\": 20", "\"samples\": 100001");
    RUN_PROGRAM(&result, "simulate", "scene.json", "--resume");
    // A summary of the interrupted run may stay.
    run_program_assert_refused(&result, "", "other settings", 1,
                               (const char *[]){"checkpoint.bin", "settings have changed", NULL});
    run_program_assert_no_partial(".");
    char *used_now = temporary_folder_read("out/used.json");
    assert_string_equal(used, used_now);
    free(used);
    free(used_now);
}

static void test_a_new_run_removes_the_results_of_the_one_before(void **state) {
    static struct run_program_result result;
    small_scenes_write(*state, small_scenes_dpd, NULL, NULL);
    small_scenes_simulate(&result, "out");
    small_scenes_write(*state, small_scenes_dpd, "0.04", "4");
    RUN_PROGRAM(&result, "simulate", "scene.json");
    run_program_assert_code(&result, 1);
    assert_false(temporary_folder_exists("out/summary.json"));
    assert_false(temporary_folder_exists("out/rdf.tsv"));
    // It would be unstable again: the next one may begin without a word.
    assert_false(temporary_folder_exists("out/checkpoint.bin"));
    small_scenes_write(*state, small_scenes_dpd, NULL, NULL);
    small_scenes_simulate(&result, "out");
}

#define TEST_WITHOUT_FIGURES(name)                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST_WITHOUT_FIGURES(test_interrupted_mixture_goes_on_with_the_same_bits),
        TEST_WITHOUT_FIGURES(test_used_settings_run_again_give_the_same_bits),
        TEST_WITHOUT_FIGURES(test_the_seed_of_the_command_line_counts),
        TEST_WITHOUT_FIGURES(test_threads_do_not_change_the_bits),
        TEST_WITHOUT_FIGURES(test_interrupted_dpd_goes_on_with_the_same_bits),
        TEST_WITHOUT_FIGURES(test_interrupted_diffusion_goes_on_with_the_same_bits),
        TEST_WITHOUT_FIGURES(
            test_interrupted_dpd_goes_on_with_the_same_bits_when_friction_is_split_off),
        TEST_WITHOUT_FIGURES(test_interrupted_dpd_in_the_plane_goes_on_with_the_same_bits),
        TEST_WITHOUT_FIGURES(test_interrupted_force_rdf_goes_on_with_the_same_bits),
        TEST_WITHOUT_FIGURES(test_force_rdf_leaves_the_steps_alone),
        TEST_WITHOUT_FIGURES(test_interrupted_nve_goes_on_with_the_same_bits),
        TEST_WITHOUT_FIGURES(test_interrupted_run_says_so_and_refuses_other_settings),
        TEST_WITHOUT_FIGURES(test_a_new_run_removes_the_results_of_the_one_before),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
