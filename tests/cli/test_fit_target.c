// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit fit --target DIR`: a target folder is fitted without a run file, and with the shortest
// one; the choices are told and give the same bits again.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"
#include "shared/twins.h"

#include <string.h>

/// With a verification that does not take long.
static const char shortest[] =
    "{\"target\": {\"rdf\": {\"file\": \"rdf.tsv\", \"particles\": 81}},\n"
    "\"scene\": {\"density\": 3, \"particles\": {\"count\": 81}, \"temperature\": 1},\n"
    "\"verification\": {\"equilibration\": 50, \"samples\": 10}}\n";

static const char *const tables[] = {"history.tsv", "potential.tsv", "rdf.tsv", NULL};

static struct run_program_result result;

/// g(r) of the small fluid in the folder "target", where `file` is target.json or "".
static void make_target(struct temporary_folder *folder, const char *file) {
    small_inputs_write(folder, "scene.json", small_inputs_scene,
                       "{\"equilibration\": 2, \"samples\": 4, \"every\": 1}",
                       "{\"equilibration\": 200, \"samples\": 10, \"every\": 10}, "
                       "\"rdf\": {\"range\": 1.25, \"bins\": 25}");
    twins_simulate("scene.json", "target");
    if (file[0])
        small_inputs_write(folder, "target/target.json", file, NULL, NULL);
}

static void test_fit_target_is_the_fit_of_the_run_file_in_the_folder(void **state) {
    make_target(*state, shortest);
    RUN_PROGRAM(&result, "fit", "--target", "target/", "-o", "a", "--threads", "2");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, "chosen: time step ");
    assert_contains(result.err, "chosen: friction omega = ");
    assert_contains(result.err, "chosen: method \"auto\"");
    RUN_PROGRAM(&result, "fit", "target/target.json", "-o", "b", "--threads", "1", "--quiet");
    run_program_assert_code(&result, 0);
    results_assert_same("a", "b", tables);
    // used.json says it all, so that nothing is chosen.
    RUN_PROGRAM(&result, "fit", "a/used.json", "-o", "c", "--threads", "2");
    run_program_assert_code(&result, 0);
    assert_null(strstr(result.err, "chosen:"));
    results_assert_same("a", "c", tables);
}

/// Friction that is chosen holds the temperature: D of it is printed as no result.
static void test_fit_target_prints_no_motion_by_chosen_friction_as_a_result(void **state) {
    make_target(*state, shortest);
    small_inputs_write(
        *state, "target/target.json", shortest, "81}},",
        "81}, \"diffusion\": {\"value\": 0.2, \"window\": 0.3, \"fitted\": \"no\"}},");
    RUN_PROGRAM(&result, "fit", "target/target.json", "-o", "moves", "--threads", "2");
    assert_contains(result.err, "chosen: friction omega = ");
    assert_contains(result.err, "D = ");
    assert_contains(result.err, "the friction that was chosen to hold the temperature, and no "
                                "result");
}

static void test_fit_target_takes_density_and_temperature_where_there_is_g_alone(void **state) {
    make_target(*state, "");
    RUN_PROGRAM(&result, "fit", "--target", "target", "-o", "out", "--quiet");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "target/target.json not found: give --density");
    RUN_PROGRAM(&result, "fit", "--target", "target", "--density", "3", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "1000 particles");
    RUN_PROGRAM(&result, "fit", "--target", "target", "--density", "many", "--explain");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "--density takes a number above 0");
}

/// A temperature that the file lacks is the one of the command line, with the same bits.
static void test_fit_target_takes_what_its_file_lacks(void **state) {
    make_target(*state, shortest);
    small_inputs_write(*state, "target/target.json", shortest, "\"temperature\": 1",
                       "\"temperature\": 1.1");
    RUN_PROGRAM(&result, "fit", "target/target.json", "-o", "whole", "--quiet");
    run_program_assert_code(&result, 0);
    small_inputs_write(*state, "target/target.json", shortest, ", \"temperature\": 1", "");
    RUN_PROGRAM(&result, "fit", "--target", "target", "--temperature", "1.1", "-o", "filled",
                "--quiet");
    run_program_assert_code(&result, 0);
    results_assert_same("whole", "filled", tables);
    RUN_PROGRAM(&result, "fit", "--target", "target", "--temperature", "-1", "-o", "cold");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "--temperature takes a number above 0");
}

static void test_fit_target_tells_what_goes_together(void **state) {
    make_target(*state, shortest);
    RUN_PROGRAM(&result, "fit", "--target", "target", "--density", "3");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "--density: target/target.json has scene.density");
    RUN_PROGRAM(&result, "fit", "--target", "nowhere");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "nowhere/target.json not found, nor rdf.tsv");
    RUN_PROGRAM(&result, "fit", "target");
    run_program_assert_code(&result, 2);
    assert_contains(result.err,
                    "target is a folder: fit the target in it by mesofit fit --target target");
    small_inputs_write(*state, "target/history.tsv", "0\n", NULL, NULL);
    RUN_PROGRAM(&result, "fit", "target");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "target is the folder of a result: fit its run file");
    small_inputs_write(*state, "target/run.json", "{}", NULL, NULL);
    RUN_PROGRAM(&result, "fit", "target");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "target is a folder: fit its file by mesofit fit target/run.json");
    RUN_PROGRAM(&result, "fit");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "usage: mesofit fit RUN.json, or mesofit fit --target DIR");
    RUN_PROGRAM(&result, "fit", "target/target.json", "--density", "3");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "are for --target DIR");
}

#define TEST_WITHOUT_FIGURES(name)                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST_WITHOUT_FIGURES(test_fit_target_is_the_fit_of_the_run_file_in_the_folder),
        TEST_WITHOUT_FIGURES(test_fit_target_prints_no_motion_by_chosen_friction_as_a_result),
        TEST_WITHOUT_FIGURES(test_fit_target_takes_density_and_temperature_where_there_is_g_alone),
        TEST_WITHOUT_FIGURES(test_fit_target_takes_what_its_file_lacks),
        TEST_WITHOUT_FIGURES(test_fit_target_tells_what_goes_together),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
