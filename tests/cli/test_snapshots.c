// SPDX-License-Identifier: GPL-3.0-or-later
//
// "snapshots" of `mesofit simulate`: the same files through threads, interruptions and kills.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/small_scenes.h"
#include "shared/testing.h"

#include <stdio.h>

#define SNAPSHOTS "\"snapshots\": {\"every\": 40, \"formats\": [\"vtp\", \"json\", \"extxyz\"]}, "
static const char plan[] = "\"measure\": {\"equilibration\": 100, \"samples\": 20, \"every\": 10}";
static const char *const files[] = {
    "snapshots/step_000001200.vtp",  "snapshots/step_000001200.json",
    "snapshots/step_000001240.vtp",  "snapshots/step_000001800.json",
    "snapshots/step_000002400.json", "snapshots/trajectory.extxyz",
    "snapshots/step_000002400.vtp",  NULL};

static void test_interrupted_run_leaves_the_same_snapshots(void **state) {
    static struct run_program_result result;
    small_scenes_write(*state, small_scenes_dpd, plan, SNAPSHOTS SMALL_SCENES_LONG_MEASURE);
    small_scenes_simulate(&result, "whole");
    results_assert_number("whole/summary.json", "snapshots", 31);
    run_program_in_pieces(0, (const char *const[]){"simulate", "scene.json", "-o", "pieces", NULL});
    results_assert_same("whole", "pieces", files);
    run_program_assert_no_partial(".");
}

/// A run that was killed after its checkpoint has written more than the checkpoint knows of.
static void test_killed_run_leaves_the_same_snapshots(void **state) {
    static struct run_program_result result;
    const struct run_program_how how = {.interrupt_after = 0.001};
    small_scenes_write(*state, small_scenes_dpd, plan,
                       SNAPSHOTS "\"measure\": {\"equilibration\": 0, \"samples\": 400, "
                                 "\"every\": 10}");
    small_scenes_simulate(&result, "whole");
    run_program(&result, &how, (const char *const[]){"simulate", "scene.json", NULL});
    if (result.code == 0)
        skip(); // faster than the signal
    run_program_assert_code(&result, 130);
    FILE *trajectory = fopen("out/snapshots/trajectory.extxyz", "a");
    assert_non_null(trajectory);
    fputs("300\nhalf a frame\n", trajectory);
    fclose(trajectory);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--resume");
    run_program_assert_code(&result, 0);
    results_assert_same("whole", "out",
                        (const char *const[]){"snapshots/trajectory.extxyz",
                                              "snapshots/step_000004000.json", NULL});
}

static void test_snapshots_change_nothing_else_and_threads_not_them(void **state) {
    static struct run_program_result result;
    small_scenes_write(*state, small_scenes_dpd, NULL, NULL);
    small_scenes_simulate(&result, "without");
    small_scenes_write(*state, small_scenes_dpd, plan,
                       SNAPSHOTS "\"measure\": {\"equilibration\": 100, \"samples\": 20, "
                                 "\"every\": 10}");
    small_scenes_simulate(&result, "with");
    results_assert_same("without", "with", small_scenes_tables);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "threads", "--threads", "2");
    run_program_assert_code(&result, 0);
    results_assert_same(
        "with", "threads",
        (const char *const[]){"snapshots/trajectory.extxyz", "snapshots/step_000000300.vtp", NULL});
}

static void test_new_run_removes_the_snapshots_of_an_earlier_one(void **state) {
    static struct run_program_result result;
    small_scenes_write(*state, small_scenes_dpd, plan,
                       SNAPSHOTS "\"measure\": {\"equilibration\": 0, \"samples\": 8, "
                                 "\"every\": 10}");
    small_scenes_simulate(&result, "out");
    assert_true(temporary_folder_exists("out/snapshots/step_000000040.vtp"));
    small_scenes_write(*state, small_scenes_dpd, plan,
                       "\"snapshots\": {\"every\": 80, \"formats\": [\"vtp\"]}, \"measure\": "
                       "{\"equilibration\": 0, \"samples\": 8, \"every\": 10}");
    small_scenes_simulate(&result, "out");
    assert_true(temporary_folder_exists("out/snapshots/step_000000080.vtp"));
    assert_false(temporary_folder_exists("out/snapshots/step_000000040.vtp"));
    assert_false(temporary_folder_exists("out/snapshots/trajectory.extxyz"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_interrupted_run_leaves_the_same_snapshots,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_killed_run_leaves_the_same_snapshots,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_snapshots_change_nothing_else_and_threads_not_them,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_new_run_removes_the_snapshots_of_an_earlier_one,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
