// SPDX-License-Identifier: GPL-3.0-or-later
//
// Scenes without velocities and with forces beside the pairs, from outside.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>

static const char drop[] =
    "{\"seed\": 2, \"box\": [6, 6, 6], \"particles\": {\"count\": 200}, \"time_step\": 0.002,\n"
    "\"temperature_limit\": 100, \"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "\"interactions\": {\"harmonic-trap\": {\"stiffness\": [3, 3, 3], \"centre\": [1, 2, 3]}},\n"
    "\"dynamics\": {\"integrator\": \"brownian\", \"friction\": 2},\n"
    "\"measure\": {\"equilibration\": 1500, \"samples\": 300, \"every\": 20}}\n";

static const char *const tables[] = {"rdf.tsv", "thermodynamics.tsv", "used.json", NULL};

static void write(struct temporary_folder *folder, const char *from, const char *to) {
    small_inputs_write(folder, "scene.json", drop, from, to);
}

static void test_simulate_takes_a_trap_and_dynamics_without_velocities(void **state) {
    static struct run_program_result result;
    write(*state, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    assert_null(strstr(result.err, "warning: the temp"));
    char *summary = temporary_folder_read("out/summary.json");
    assert_contains(summary, "\"temperature\":\tnull");
    free(summary);
    assert_true(results_number("out/summary.json", "temperature_configurational") > 0.9);
    assert_true(results_number("out/summary.json", "temperature_configurational") < 1.1);
    char *used = temporary_folder_read("out/used.json");
    assert_contains(used, "\"centre\":\t[1, 2, 3]");
    assert_contains(used, "\"friction\":\t2");
    free(used);
    RUN_PROGRAM(&result, "simulate", "out/used.json", "-o", "again");
    run_program_assert_code(&result, 0);
    results_assert_same("out", "again", tables);
}

static void test_simulate_leaves_out_what_needs_velocities(void **state) {
    static struct run_program_result result;
    write(*state, "\"measure\": {\"equilibration\": 1500, \"samples\": 300",
          "\"motion\": {\"every\": 2}, \"measure\": {\"equilibration\": 1500, \"samples\": 300");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, "by the MSD from ");
    assert_null(strstr(result.err, "Green"));
    assert_null(strstr(result.err, "warning: D"));
    char *summary = temporary_folder_read("out/summary.json");
    assert_contains(summary, "\"diffusion_green_kubo\":\tnull");
    assert_contains(summary, "\"diffusion_green_kubo_error\":\tnull");
    free(summary);
    char *table = temporary_folder_read("out/motion.tsv");
    assert_contains(table, "\tnan\tnan\n");
    free(table);
}

static void test_figure_of_motion_is_drawn_without_velocities(void **state) {
    static struct run_program_result result;
    small_inputs_need_gnuplot();
    write(*state, "\"measure\": {\"equilibration\": 1500, \"samples\": 300",
          "\"motion\": {\"lags\": 10}, \"measure\": {\"equilibration\": 50, \"samples\": 10");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    assert_null(strstr(result.err, "no figure"));
    assert_true(temporary_folder_exists("out/figures/motion.svg"));
}

static void test_errors_of_one_sample_are_null(void **state) {
    static struct run_program_result result;
    write(*state, "\"samples\": 300", "\"samples\": 1");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    char *summary = temporary_folder_read("out/summary.json");
    assert_contains(summary, "\"potential_energy_error\":\tnull");
    assert_contains(summary, "\"pressure_error\":\tnull");
    assert_contains(summary, "\"temperature_configurational_error\":\tnull");
    free(summary);
}

static void test_bench_accuracy_is_refused_without_velocities(void **state) {
    static struct run_program_result result;
    write(*state, NULL, NULL);
    RUN_PROGRAM(&result, "bench", "accuracy", "scene.json", "--time", "1");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "scene.json: dynamics.integrator: bench accuracy needs velocities");
    assert_int_equal(run_program_lines(result.err), 1);
}

static void test_simulate_goes_on_with_the_same_bits_without_velocities(void **state) {
    static struct run_program_result result;
    write(*state, "\"samples\": 300", "\"samples\": 900");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "whole");
    run_program_assert_code(&result, 0);
    const char *const words[] = {"simulate", "scene.json", "-o", "pieces", NULL};
    run_program_in_pieces(0, words);
    results_assert_same("whole", "pieces", tables);
}

/// Forces that are all 0, and that are 0 along the last axis: a vector has all of its numbers.
static void test_used_scene_runs_again_when_forces_are_zero(void **state) {
    static const char *const forces[] = {"[0, 0, 0]", "[0.5, 0, 0]"};
    static struct run_program_result result;
    for (size_t k = 0; k < sizeof forces / sizeof *forces; k++) {
        char text[128];
        snprintf(
            text, sizeof text,
            "{\"uniform-force\": {\"force\": %s}, \"harmonic-trap\": {\"stiffness\": [0, 0, 0]}}",
            forces[k]);
        write(*state, "{\"harmonic-trap\": {\"stiffness\": [3, 3, 3], \"centre\": [1, 2, 3]}}",
              text);
        RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--force");
        run_program_assert_code(&result, 0);
        char *used = temporary_folder_read("out/used.json");
        assert_contains(used, forces[k]);
        free(used);
        RUN_PROGRAM(&result, "simulate", "out/used.json", "-o", "again", "--force");
        run_program_assert_code(&result, 0);
        results_assert_same("out", "again", tables);
    }
}

/// In two dimensions a third number acts on nothing.
static void test_scene_in_a_plane_refuses_a_third_number(void **state) {
    static const char plane[] =
        "{\"seed\": 1, \"dimensions\": 2, \"box\": [6, 6], \"particles\": {\"count\": 50},\n"
        "\"interactions\": {\"uniform-force\": {\"force\": [1, 2, 3]}},\n"
        "\"measure\": {\"equilibration\": 10, \"samples\": 2, \"every\": 1}, \"rdf\": {\"range\": "
        "2}}";
    static struct run_program_result result;
    small_inputs_write(*state, "scene.json", plane, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "refused");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "force: has 3 numbers, but the scene has 2 dimensions");
    assert_int_equal(run_program_lines(result.err), 1);
    small_inputs_write(*state, "scene.json", plane, "[1, 2, 3]", "[1, 0]");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "simulate", "out/used.json", "-o", "again");
    run_program_assert_code(&result, 0);
}

static void test_explain_and_describe_tell_of_interactions(void **state) {
    static struct run_program_result result;
    write(*state, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "brownian, and a watch over the steps");
    assert_contains(result.out, "harmonic-trap");
    RUN_PROGRAM(&result, "describe", "interactions");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "uniform-force (interactions)");
    RUN_PROGRAM(&result, "describe", "brownian");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "D = T/gamma");
}

/// What a scene is refused for, each in one line.
static void test_scenes_are_refused_when_interactions_do_not_suit(void **state) {
    static const struct {
        const char *from, *to, *line;
    } cases[] = {
        {"\"harmonic-trap\"", "\"harmonic-tarp\"",
         "interactions.harmonic-tarp: unknown key; did you mean \"harmonic-trap\"?"},
        {"\"stiffness\": [3, 3, 3], ", "", "interactions.harmonic-trap.stiffness: missing"},
        {"[3, 3, 3]", "[3, -3, 3]", "interactions.harmonic-trap.stiffness[1]: "},
        {"[3, 3, 3]", "[3, 3]",
         "interactions.harmonic-trap.stiffness: has 2 numbers, but the scene has 3 dimensions"},
        {"[1, 2, 3]", "[1, 2]",
         "interactions.harmonic-trap.centre: has 2 numbers, but the scene has 3 dimensions"},
        {"[1, 2, 3]", "[1, 2, 1e300]",
         "interactions.harmonic-trap.centre[2]: 1e+300 is more than 100 boxes of 6 away"},
        {"\"friction\": 2", "\"friction\": 0", "dynamics.friction: "},
        {"\"interactions\"",
         "\"dissipative\": {\"law\": \"power\", \"inner_cutoff\": 3, \"cutoff\": 1}, "
         "\"interactions\"",
         "dissipative: the inner_cutoff 3 is not below the cutoff 1"},
        {"\"interactions\"", "\"dissipative\": {\"law\": \"power\"}, \"interactions\"",
         "brownian has no friction"},
        {"\"measure\"", "\"rdf\": {\"estimator\": \"force\"}, \"measure\"",
         "supports only pair forces"},
    };
    static struct run_program_result result;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        write(*state, cases[k].from, cases[k].to);
        RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "refused");
        run_program_assert_code(&result, 2);
        assert_contains(result.err, cases[k].line);
        assert_int_equal(run_program_lines(result.err), 1);
    }
}

static void test_inversion_is_refused_when_the_scene_has_interactions(void **state) {
    static struct run_program_result result;
    temporary_folder_write(*state, "target.tsv", small_inputs_target, strlen(small_inputs_target));
    small_inputs_write(*state, "run.json", small_inputs_run, "\"box\"",
                       "\"interactions\": {\"uniform-force\": {\"force\": [1, 0, 0]}}, \"box\"");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "refused");
    run_program_assert_code(&result, 2);
    assert_contains(
        result.err,
        "run.json: scene.interactions: \"imc\" samples only pairs, molecules and \"many_body\"");
}

static void test_vacf_is_refused_when_there_are_no_velocities(void **state) {
    static struct run_program_result result;
    static const char vacf[] = "0 1 0.1\n0.1 0.8 0.1\n0.2 0.5 0.1\n0.3 0.3 0.1\n0.4 0.2 0.1\n";
    temporary_folder_write(*state, "target.tsv", small_inputs_target, strlen(small_inputs_target));
    temporary_folder_write(*state, "vacf.tsv", vacf, strlen(vacf));
    static const char run[] =
        "{\"target\": {\"rdf\": {\"file\": \"target.tsv\"}, \"vacf\": {\"file\": \"vacf.tsv\"}},\n"
        "\"scene\": {\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02,\n"
        "\"dynamics\": {\"integrator\": \"brownian\"}},\n"
        "\"method\": {\"name\": \"genetic\", \"samples\": 100}}\n";
    temporary_folder_write(*state, "run.json", run, strlen(run));
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "refused");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "run.json: target.vacf: \"brownian\" has no velocities");
}

/// The target is no drop's: what counts is that candidates are simulated in the trap, not refused
/// as collapsed, with dynamics whose temperature is told by their positions.
static void test_candidates_are_simulated_with_interactions_and_without_velocities(void **state) {
    static struct run_program_result result;
    static const char run[] =
        "{\"seed\": 1, \"target\": {\"rdf\": {\"file\": \"target.tsv\"}},\n"
        "\"scene\": {\"box\": [8, 8, 8], \"particles\": {\"count\": 81}, \"time_step\": 0.002,\n"
        "\"temperature_limit\": 1000,\n"
        "\"interactions\": {\"harmonic-trap\": {\"stiffness\": [4, 4, 4]}},\n"
        "\"dynamics\": {\"integrator\": \"brownian\"}},\n"
        "\"unknowns\": {\"potential\": {\"coefficients\": 5, \"minimum\": 0, \"maximum\": 10}},\n"
        "\"method\": {\"name\": \"genetic\", \"population\": 6, \"generations\": 2,\n"
        "\"equilibration\": 300, \"samples\": 8, \"every\": 20, \"temperature_tolerance\": 0.5},\n"
        "\"verification\": {\"replicas\": 2, \"equilibration\": 300, \"samples\": 10, \"every\": "
        "20}}\n";
    temporary_folder_write(*state, "target.tsv", small_inputs_target, strlen(small_inputs_target));
    temporary_folder_write(*state, "run.json", run, strlen(run));
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out");
    run_program_assert_code(&result, 0);
    char *summary = temporary_folder_read("out/summary.json");
    assert_contains(summary, "\"temperature\":\tnull");
    free(summary);
    assert_true(results_number("out/summary.json", "temperature_configurational") > 0.5);
}

/// Velocity Verlet of dissipative particles parts the two temperatures at a step at which another
/// integrator does not; no line at a step that is short.
static void test_long_steps_are_told_by_the_temperatures(void **state) {
    static const char fluid[] =
        "{\"seed\": 3, \"density\": 3, \"time_step\": STEP, \"particles\": {\"count\": 375},\n"
        "\"conservative\": {\"law\": \"soft-repulsion\"}, \"dissipative\": {\"law\": \"power\"},\n"
        "\"dynamics\": {\"integrator\": \"dpd-verlet\"},\n"
        "\"measure\": {\"equilibration\": 300, \"samples\": 300, \"every\": 5}}\n";
    static const struct {
        const char *step, *says;
    } cases[] = {{"0.02", NULL},
                 {"0.05", "% off: the time step is long for this potential"},
                 {"0.06", ": lower \"time_step\", or equilibrate for longer"}};
    static struct run_program_result result;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        small_inputs_write(*state, "scene.json", fluid, "STEP", cases[k].step);
        RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--force");
        run_program_assert_code(&result, 0);
        if (cases[k].says)
            assert_contains(result.err, cases[k].says);
        else
            assert_null(strstr(result.err, "temperature is"));
    }
}

int main(void) {
#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)
    const struct CMUnitTest tests[] = {
        TEST(test_simulate_takes_a_trap_and_dynamics_without_velocities),
        TEST(test_simulate_leaves_out_what_needs_velocities),
        TEST(test_long_steps_are_told_by_the_temperatures),
        cmocka_unit_test_setup_teardown(test_figure_of_motion_is_drawn_without_velocities,
                                        small_inputs_enter, small_inputs_leave),
        TEST(test_errors_of_one_sample_are_null),
        TEST(test_bench_accuracy_is_refused_without_velocities),
        TEST(test_simulate_goes_on_with_the_same_bits_without_velocities),
        TEST(test_used_scene_runs_again_when_forces_are_zero),
        TEST(test_scene_in_a_plane_refuses_a_third_number),
        TEST(test_explain_and_describe_tell_of_interactions),
        TEST(test_scenes_are_refused_when_interactions_do_not_suit),
        TEST(test_inversion_is_refused_when_the_scene_has_interactions),
        TEST(test_vacf_is_refused_when_there_are_no_velocities),
        TEST(test_candidates_are_simulated_with_interactions_and_without_velocities),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
