// SPDX-License-Identifier: GPL-3.0-or-later
//
// Scenes of collision dynamics from outside: results, the same bits, restarts, what is refused.
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const char channel[] =
    "{\"seed\": 2, \"dimensions\": 2, \"box\": [24, 12], \"particles\": {\"count\": 0},\n"
    "\"time_step\": 0.1, \"dynamics\": {\"integrator\": \"collision-dynamics\",\n"
    "\"angle\": 130, \"thermostat\": \"yes\", \"walls\": \"plates\",\n"
    "\"acceleration\": [0.03, 0], \"obstacle_centre\": [8, 6], \"obstacle_radius\": 2},\n"
    "\"measure\": {\"equilibration\": 200, \"samples\": 100, \"every\": 5},\n"
    "\"flow_profile\": {}, \"flow_field\": {}}\n";

static const char *const tables[] = {"flow_profile.tsv", "flow_field.tsv", "used.json", NULL};

#define SNAPSHOTS                                                                                  \
    "\"snapshots\": {\"every\": 500, \"formats\": [\"vtp\", \"json\", \"extxyz\"], \"solvent\": "  \
    "\"yes\"},\n"
static const char *const snapshots[] = {"snapshots/step_000000500.vtp",
                                        "snapshots/step_000000500.json",
                                        "snapshots/trajectory.extxyz", NULL};

static void write(struct temporary_folder *folder, const char *from, const char *to) {
    small_inputs_write(folder, "scene.json", channel, from, to);
}

static void test_simulate_measures_a_solvent_without_beads(void **state) {
    static struct run_program_result result;
    write(*state, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--threads", "1");
    run_program_assert_code(&result, 0);
    assert_null(strstr(result.err, "there is no thermostat"));
    assert_contains(result.err, "a viscosity needs"); // past an obstacle the flow is no parabola
    assert_true(results_number("out/summary.json", "solvent_temperature") > 0.98);
    assert_true(results_number("out/summary.json", "solvent_temperature") < 1.02);
    assert_true(results_number("out/summary.json", "flow_field.drag") > 0);
    RUN_PROGRAM(&result, "simulate", "out/used.json", "-o", "again", "--threads", "2");
    run_program_assert_code(&result, 0);
    results_assert_same("out", "again", tables);
}

/// solvent.tsv has the places of the last 2754 lines, to six digits.
static void assert_solvent_is_that_of_the_last_frame(const char *frames) {
    enum { COUNT = 2754 };
    const char *line = frames + strlen(frames);
    for (int lines = 0; lines <= COUNT; lines += *--line == '\n')
        ;
    char *table = temporary_folder_read("out/solvent.tsv"), *rest;
    char *row = strtok_r(table, "\n", &rest);
    assert_string_equal(row, "# x[lambda]\ty[lambda]");
    for (int k = 0; k < COUNT; k++) {
        double x, y, wanted_x, wanted_y;
        line = strchr(line, '\n') + 1;
        row = strtok_r(NULL, "\n", &rest);
        assert_non_null(row);
        assert_int_equal(sscanf(row, "%lf %lf", &x, &y), 2);
        assert_int_equal(sscanf(line, "%*s %lf %lf", &wanted_x, &wanted_y), 2);
        assert_true(fabs(x - wanted_x) < 1e-4 && fabs(y - wanted_y) < 1e-4);
    }
    assert_null(strtok_r(NULL, "\n", &rest));
    free(table);
}

static void test_snapshots_show_the_solvent_where_it_is_wanted(void **state) {
    static struct run_program_result result;
    write(*state, "\"measure\": {\"equilibration\": 200,",
          SNAPSHOTS "\"measure\": {\"equilibration\": 500,");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--threads", "1");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "threads", "--threads", "2");
    run_program_assert_code(&result, 0);
    results_assert_same("out", "threads", snapshots);
    char *frames = temporary_folder_read("out/snapshots/trajectory.extxyz");
    assert_true(strncmp(frames, "2754\nLattice=", 13) == 0);
    assert_solvent_is_that_of_the_last_frame(frames);
    free(frames);
    write(*state, "\"measure\"", "\"snapshots\": {\"every\": 500}, \"measure\"");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "scene.json: snapshots: no particles; \"solvent\": \"yes\"");
}

static void test_a_flow_tells_its_viscosity_and_whether_it_has_settled(void **state) {
    static struct run_program_result result;
    write(*state, "\"obstacle_radius\": 2", "\"obstacle_radius\": 0");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    assert_true(results_number("out/summary.json", "viscosity") > 0);
    assert_true(results_number("out/summary.json", "viscosity_theory") > 1.2);
    assert_true(results_number("out/summary.json", "viscosity_theory") < 1.3);
    assert_null(strstr(result.err, "is not stationary"));
    write(*state,
          "0.03, 0], \"obstacle_centre\": [8, 6], \"obstacle_radius\": 2},\n"
          "\"measure\": {\"equilibration\": 200, \"samples\": 100, \"every\": 5}",
          "0.3, 0]}, \"measure\": {\"equilibration\": 10, \"samples\": 40, \"every\": 1}");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "early");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, "is not stationary");
}

/// Beads in a solvent do not keep their momentum: what they do together is their motion, too.
static void test_beads_that_drift_with_the_solvent_move(void **state) {
    static struct run_program_result result;
    small_inputs_write(
        *state, "scene.json",
        "{\"dimensions\": 2, \"box\": [20, 20], \"particles\": {\"count\": 4}, \"time_step\": "
        "0.1,\n"
        "\"dynamics\": {\"integrator\": \"collision-dynamics\", \"drift\": [3, 0]},\n"
        "\"motion\": {\"every\": 5, \"lags\": 10}, \"flow_profile\": {},\n"
        "\"measure\": {\"equilibration\": 200, \"samples\": 40, \"every\": 5}}\n",
        NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    // MSD = (3 t)² and its slope over 4 at t of 2.5 to 5: 2 · 9 · 3.75/4
    assert_close(results_number("out/summary.json", "motion.diffusion_msd"), 16.9, 4);
    // … but not across the drift, where beads diffuse.
    assert_true(results_number("out/summary.json", "bead_diffusion") < 0.5);
    assert_null(strstr(result.err, "by the positions"));
}

/// Of two bins between plates the flow is as fast in both; a drag coefficient wants a flow.
static void test_no_viscosity_and_no_coefficient_where_there_is_none(void **state) {
    static struct run_program_result result;
    static const char scene[] =
        "{\"dimensions\": 2, \"box\": [20, 2], \"particles\": {\"count\": 0}, "
        "\"time_step\": 0.1,\n\"dynamics\": {\"integrator\": \"collision-dynamics\", "
        "\"thermostat\": \"yes\", \"walls\": \"plates\",\n\"acceleration\": [1, 0]},\n"
        "\"measure\": {\"equilibration\": 100, \"samples\": 100, \"every\": 2}, "
        "\"flow_profile\": {}}\n";
    small_inputs_write(*state, "scene.json", scene, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 2);
    assert_contains(result.err,
                    "scene.json: flow_profile.bins: 2 along y are too few for a viscosity");
    small_inputs_write(*state, "scene.json", scene, "\"flow_profile\": {}",
                       "\"flow_profile\": {\"bins\": 6}");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    assert_true(results_number("out/summary.json", "viscosity") > 0);
    write(*state, "\"acceleration\": [0.03, 0], ", "");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "still");
    run_program_assert_code(&result, 0);
    char *summary = temporary_folder_read("still/summary.json");
    assert_contains(summary, "\"drag_coefficient\":\tnull");
    free(summary);
}

static void test_figures_of_flow_are_drawn(void **state) {
    static struct run_program_result result;
    small_inputs_need_gnuplot();
    write(*state, "\"measure\"", SNAPSHOTS "\"measure\"");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    assert_null(strstr(result.err, "no figure"));
    char *panels = temporary_folder_read("out/figures/flow_panels.svg");
    assert_contains(panels, "streamlines");
    assert_contains(panels, ">particles<");
    free(panels);
    assert_true(temporary_folder_exists("out/figures/flow_profile.svg"));
    assert_true(temporary_folder_exists("out/figures/flow_field.png"));
}

static void test_explain_tells_the_solvents_share(void **state) {
    static struct run_program_result result;
    write(*state, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "2754 particles of collision-dynamics");
}

/// A scene that is refused with one line naming file and key.
static void assert_refused(void **state, const char *from, const char *to, const char *line) {
    static struct run_program_result result;
    write(*state, from, to);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, line);
}

static void test_simulate_refuses_bad_solvents_by_file_and_key(void **state) {
    assert_refused(state, "\"thermostat\": \"yes\"", "\"thermostat\": true",
                   "scene.json: dynamics.thermostat: \"true\" is unknown; known: no, yes");
    assert_refused(state, "\"angle\": 130", "\"cell\": 0.7",
                   "scene.json: dynamics.cell: cells of 0.7 do not divide box[0] = 24");
    assert_refused(state, "\"time_step\": 0.1", "\"time_step\": 5",
                   "scene.json: dynamics.interval: between two collisions, a time of 5");
    assert_refused(state, "[8, 6]", "[8, 1]",
                   "scene.json: dynamics.obstacle_centre[1]: with 1 an obstacle of radius 2");
    assert_refused(state, "\"obstacle_radius\": 2", "\"obstacle_radius\": -2",
                   "dynamics.obstacle_radius: -2 is out of range; allowed: at least 0");
    assert_refused(state, "\"flow_field\": {}", "\"motion\": {}",
                   "scene.json: motion: there are fewer than two particles to measure");
    assert_refused(state, "\"angle\": 130", "\"mass\": 0", "dynamics.mass");
}

static void test_simulate_refuses_a_flow_without_solvent(void **state) {
    static struct run_program_result result;
    assert_refused(
        state,
        "\"particles\": {\"count\": 0},\n"
        "\"time_step\": 0.1, \"dynamics\": {\"integrator\": \"collision-dynamics\",\n"
        "\"angle\": 130, \"thermostat\": \"yes\", \"walls\": \"plates\",\n"
        "\"acceleration\": [0.03, 0], \"obstacle_centre\": [8, 6], \"obstacle_radius\": 2},\n",
        "\"particles\": {\"count\": 10}, \"rdf\": {\"range\": 1},\n",
        "scene.json: flow_profile: velocity-verlet has no solvent");
    small_inputs_write(*state, "scene.json",
                       "{\"box\": [6, 6, 6], \"particles\": {\"count\": 10}, \"rdf\": {\"range\": "
                       "1},\n\"dynamics\": {\"integrator\": \"velocity-verlet\"}, "
                       "\"time_step\": 0.01,\n" SNAPSHOTS "\"measure\": {\"samples\": 2}}\n",
                       NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "scene.json: snapshots.solvent: velocity-verlet has no solvent");
    assert_refused(state,
                   "\"collision-dynamics\",\n\"angle\": 130, \"thermostat\": \"yes\", "
                   "\"walls\": \"plates\",\n\"acceleration\": [0.03, 0], "
                   "\"obstacle_centre\": [8, 6], \"obstacle_radius\": 2}",
                   "\"velocity-verlet\"}",
                   "particles.count: 0 is out of range; allowed: 2 to 1e+08");
}

static void test_simulate_warns_of_few_particles_in_a_cell(void **state) {
    static struct run_program_result result;
    write(*state, "\"angle\": 130", "\"angle\": 130, \"particles_per_cell\": 2");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, "warning: dynamics.particles_per_cell: below 3");
}

/// A lattice knows of no obstacle: the beads inside begin elsewhere; those of a file do not.
static void test_beads_begin_outside_the_obstacle(void **state) {
    static struct run_program_result result;
    static const char beads[] =
        "{\"dimensions\": 2, \"box\": [10, 10], \"particles\": {\"count\": 100}, "
        "\"time_step\": 0.1,\n\"dynamics\": {\"integrator\": \"collision-dynamics\", "
        "\"walls\": \"plates\",\n\"obstacle_centre\": [5, 5], \"obstacle_radius\": 2},\n"
        "\"measure\": {\"equilibration\": 0, \"samples\": 2, \"every\": 20},\n"
        "\"snapshots\": {\"every\": 20, \"formats\": [\"json\"]}, \"flow_field\": {}}\n";
    small_inputs_write(*state, "scene.json", beads, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    FILE *table = fopen("out/configuration.tsv", "r");
    assert_non_null(table);
    char line[512];
    size_t rows = 0;
    for (double x, y; fgets(line, sizeof line, table);)
        if (sscanf(line, "%lf %lf", &x, &y) == 2) {
            assert_true((x - 5) * (x - 5) + (y - 5) * (y - 5) >= 4 * (1 - 1e-9));
            rows++;
        }
    fclose(table);
    assert_int_equal(rows, 100);
#define FROM_FILE "{\"count\": 2, \"placement\": \"file\", \"file\": \"beads.tsv\"}"
    small_inputs_write(*state, "scene.json", beads, "{\"count\": 100}", FROM_FILE);
    small_inputs_write(*state, "beads.tsv", "1 1\n4 5.5\n", NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 2);
    assert_contains(result.err,
                    "scene.json: particles.file: particle 1 begins inside the obstacle");
    small_inputs_write(*state, "beads.tsv", "1 -1\n1 2\n", NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "scene.json: particles.file: particle 0 begins beyond a plate");
}

static void test_simulate_warns_of_what_plates_and_flows_do_to_beads(void **state) {
    static struct run_program_result result;
    static const char beads[] =
        "{\"dimensions\": 2, \"box\": [10, 10], \"particles\": {\"count\": 10}, "
        "\"time_step\": 0.05,\n\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 5},\n"
        "\"dynamics\": {\"integrator\": \"collision-dynamics\", \"walls\": \"plates\"},\n"
        "\"measure\": {\"equilibration\": 0, \"samples\": 2, \"every\": 1}}\n";
    small_inputs_write(*state, "scene.json", beads, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    assert_contains(result.err, "warning: dynamics.walls: pair forces are not cut by plates");
    small_inputs_write(*state, "scene.json", beads, "\"walls\": \"plates\"",
                       "\"wave_acceleration\": 0.1");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    assert_contains(result.err, "warning: dynamics: the flow contributes to the temperature");
    small_inputs_write(*state, "scene.json", beads, "\"walls\": \"plates\"",
                       "\"acceleration\": [0.1, 0]");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    assert_null(strstr(result.err, "flow contributes")); // all fall alike
}

/// With beads that carry forces, in space, killed and resumed.
static void test_simulate_goes_on_with_the_same_bits_with_a_solvent(void **state) {
    static const char beads[] =
        "{\"seed\": 2, \"box\": [12, 12, 12], \"particles\": {\"count\": 60, \"mass\": 5},\n"
        "\"time_step\": 0.05, \"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
        "\"dynamics\": {\"integrator\": \"collision-dynamics\", \"interval\": 4,\n"
        "\"thermostat\": \"yes\", \"wave_acceleration\": 0.1},\n"
        "\"measure\": {\"equilibration\": 500, \"samples\": 300, \"every\": 20},\n" SNAPSHOTS
        "\"flow_profile\": {}, \"flow_field\": {\"spacing\": 2}}\n";
    static struct run_program_result result;
    small_inputs_write(*state, "scene.json", beads, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "whole");
    run_program_assert_code(&result, 0);
    const char *const words[] = {"simulate", "scene.json", "-o", "pieces", NULL};
    run_program_in_pieces(0, words);
    results_assert_same("whole", "pieces", tables);
    results_assert_same("whole", "pieces", snapshots);
}

/// From a time step of 0.25, where ν is 0.4 and the Schmidt number below 5, towards those targets.
/// Targets at times have no such unknown.
static void test_fit_looks_for_angle_and_time_step(void **state) {
    static const char run[] =
        "{\"seed\": 3, \"target\": {\"viscosity\": {\"value\": 0.87, \"error\": 0.05},\n"
        "\"schmidt_number\": {\"value\": 15, \"error\": 2}},\n"
        "\"unknowns\": {\"numbers\": {\"dynamics.angle\": {\"minimum\": 80, \"maximum\": 150},\n"
        "\"time_step\": {\"minimum\": 0.08, \"maximum\": 0.3}}},\n"
        "\"scene\": {\"box\": [6, 12, 6], \"particles\": {\"count\": 200}, \"time_step\": 0.25,\n"
        "\"dynamics\": {\"integrator\": \"collision-dynamics\", \"angle\": 90,\n"
        "\"thermostat\": \"yes\", \"wave_acceleration\": 0.1}},\n"
        "\"method\": {\"name\": \"gauss-newton\", \"iterations\": 4, \"equilibration\": 100,\n"
        "\"samples\": 64, \"every\": 5, \"temperature_tolerance\": 1},\n"
        "\"verification\": {\"replicas\": 2, \"equilibration\": 100, \"samples\": 64, \"every\": "
        "5}}\n";
    static struct run_program_result result;
    small_inputs_write(*state, "run.json", run, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out");
    assert_true(result.code == 0 || result.code == 1);
    const double step = results_number("out/summary.json", "parameters.time_step.value");
    print_message("time step %.3f\n", step);
    assert_true(step > 0.08 && step < 0.2);
    small_inputs_write(*state, "vacf.tsv", "0 1\n0.25 0.5\n0.5 0.3\n0.75 0.2\n", NULL, NULL);
    small_inputs_write(*state, "run.json", run, "\"schmidt_number\":",
                       "\"vacf\": {\"file\": \"vacf.tsv\"}, \"schmidt_number\":");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "timed");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "run.json: unknowns.numbers.time_step: target.vacf is measured in "
                                "whole time steps");
}

int main(void) {
#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)
    const struct CMUnitTest tests[] = {
        TEST(test_simulate_measures_a_solvent_without_beads),
        TEST(test_beads_that_drift_with_the_solvent_move),
        TEST(test_a_flow_tells_its_viscosity_and_whether_it_has_settled),
        cmocka_unit_test_setup_teardown(test_figures_of_flow_are_drawn, small_inputs_enter,
                                        small_inputs_leave),
        TEST(test_no_viscosity_and_no_coefficient_where_there_is_none),
        TEST(test_explain_tells_the_solvents_share),
        TEST(test_simulate_refuses_bad_solvents_by_file_and_key),
        TEST(test_simulate_refuses_a_flow_without_solvent),
        TEST(test_snapshots_show_the_solvent_where_it_is_wanted),
        TEST(test_beads_begin_outside_the_obstacle),
        TEST(test_simulate_warns_of_what_plates_and_flows_do_to_beads),
        TEST(test_simulate_warns_of_few_particles_in_a_cell),
        TEST(test_simulate_goes_on_with_the_same_bits_with_a_solvent),
        TEST(test_fit_looks_for_angle_and_time_step),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
