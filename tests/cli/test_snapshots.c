// SPDX-License-Identifier: GPL-3.0-or-later
//
// "snapshots" of `mesofit simulate`: the same files through threads, interruptions and kills.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/small_scenes.h"
#include "shared/testing.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SNAPSHOTS                                                                                  \
    "\"snapshots\": {\"every\": 40, \"formats\": [\"vtp\", \"json\", \"extxyz\", "                 \
    "\"lammps-dump\", \"gsd\", \"xtc\"]}, "
static const char plan[] = "\"measure\": {\"equilibration\": 100, \"samples\": 20, \"every\": 10}";
static const char *const files[] = {"snapshots/step_000001200.vtp",
                                    "snapshots/step_000001200.json",
                                    "snapshots/trajectory.gsd",
                                    "snapshots/step_000001240.vtp",
                                    "snapshots/step_000001800.json",
                                    "snapshots/step_000002400.json",
                                    "snapshots/trajectory.extxyz",
                                    "snapshots/step_000002400.vtp",
                                    "snapshots/trajectory.lammpstrj",
                                    "snapshots/trajectory.xtc",
                                    NULL};

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
    const struct run_program_how how = {.interrupt_with = SIGINT};
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
    // As a process that is killed leaves the list.
    FILE *list = fopen("out/.mesofit-run", "a");
    assert_non_null(list);
    fputs("-\t-\tsnapshots/trajectory.extxyz\n", list);
    fclose(list);
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

/// Other programs take extended XYZ to be in Angstrom: ours says its units, and reads them again.
static void test_measure_knows_the_units_of_snapshots(void **state) {
    static struct run_program_result result;
    static const struct {
        const char *units, *box;
    } variant[] = {{"nm-ps", "2"}, {"angstrom-fs", "20"}, {"reduced", "2"}};
    for (size_t k = 0; k < sizeof variant / sizeof *variant; k++) {
        char scene[512];
        snprintf(
            scene, sizeof scene,
            "{\"units\": \"%s\", \"box\": [%s, %s, %s], %s"
            "\"particles\": {\"count\": 100%s}, \"snapshots\": {\"every\": 5, \"formats\": "
            "[\"extxyz\"]}, \"measure\": {\"equilibration\": 0, \"samples\": 20, \"every\": 5}}",
            variant[k].units, variant[k].box, variant[k].box, variant[k].box,
            k < 2 ? "\"temperature\": 300, " : "", k < 2 ? ", \"mass\": 18" : "");
        temporary_folder_write(*state, "scene.json", scene, strlen(scene));
        RUN_PROGRAM(&result, "simulate", "scene.json", "--force");
        run_program_assert_code(&result, 0);
        RUN_PROGRAM(&result, "measure", "out/snapshots/trajectory.extxyz", "-o", "target",
                    "--force");
        run_program_assert_code(&result, 0);
        results_assert_number("target/summary.json", "density", 12.5);
    }
}

enum { BEADS = 60 };
static const double edge = 3, strength = 75;

struct bead {
    double position[3], force[3];
};

/// One frame after the others: "A x y z image velocity force mass id".
static bool read_frame(FILE *stream, struct bead *beads) {
    char line[512];
    if (fgets(line, sizeof line, stream) == NULL)
        return false;
    assert_int_equal(atoi(line), BEADS);
    assert_non_null(fgets(line, sizeof line, stream));
    assert_non_null(strstr(line, "pos:R:3:image:I:3:velo:R:3:forces:R:3:masses:R:1:id"));
    for (int k = 0; k < BEADS; k++) {
        struct bead *b = &beads[k];
        assert_non_null(fgets(line, sizeof line, stream));
        assert_int_equal(sscanf(line, "%*s %lf %lf %lf %*s %*s %*s %*s %*s %*s %lf %lf %lf",
                                &b->position[0], &b->position[1], &b->position[2], &b->force[0],
                                &b->force[1], &b->force[2]),
                         6);
    }
    return true;
}

/// What a bead's force differs from the sum of a (1 − r) over its neighbours, the largest.
static double compare_forces(const struct bead *beads) {
    double worst = 0;
    for (int i = 0; i < BEADS; i++) {
        double left[3];
        memcpy(left, beads[i].force, sizeof left);
        for (int j = 0; j < BEADS; j++) {
            double apart[3], square = 0;
            for (int d = 0; d < 3; d++) {
                apart[d] = beads[i].position[d] - beads[j].position[d];
                apart[d] -= edge * round(apart[d] / edge);
                square += apart[d] * apart[d];
            }
            const double r = sqrt(square);
            for (int d = 0; d < 3 && r > 0 && r < 1; d++)
                left[d] -= strength * (1 - r) / r * apart[d];
        }
        for (int d = 0; d < 3; d++)
            worst = fmax(worst, fabs(left[d]));
    }
    return worst;
}

/// Whatever an integrator keeps from step to step, from the first snapshot on.
static void test_forces_are_those_of_the_positions_beside_them(void **state) {
    static struct run_program_result result;
    static const char *const integrators[] = {"aboba",           "dpd-verlet",     "dpd-vv",
                                              "shardlow",        "lowe-andersen",  "monte-carlo",
                                              "velocity-verlet", "euler-maruyama", NULL};
    for (int n = 0; integrators[n]; n++) {
        const bool has_friction = n < 5;
        struct bead beads[BEADS];
        char scene[1024];
        int frames = 0;
        snprintf(scene, sizeof scene,
                 "{\"box\": [3, 3, 3], \"particles\": {\"count\": 60}, %s%s"
                 "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 75},"
                 "\"dynamics\": {\"integrator\": \"%s\"}, \"rdf\": {\"range\": 1},"
                 "\"snapshots\": {\"every\": 10, \"formats\": [\"extxyz\"]},"
                 "\"measure\": {\"equilibration\": 0, \"samples\": 2, \"every\": 15}}",
                 n == 5 ? "" : "\"time_step\": 0.01, ",
                 has_friction ? "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}, " : "",
                 integrators[n]);
        temporary_folder_write(*state, "scene.json", scene, strlen(scene));
        RUN_PROGRAM(&result, "simulate", "scene.json", "--force");
        run_program_assert_code(&result, 0);
        FILE *stream = fopen("out/snapshots/trajectory.extxyz", "r");
        assert_non_null(stream);
        for (; read_frame(stream, beads); frames++)
            if (!(compare_forces(beads) < 1e-3))
                fail_msg("%s, snapshot %d: a force is off by %g", integrators[n], frames,
                         compare_forces(beads));
        fclose(stream);
        assert_int_equal(frames, 4);
    }
}

static const char active[] =
    "{\"seed\": 5, \"dimensions\": 2, \"box\": [12, 12], \"temperature\": 0, "
    "\"particles\": {\"count\": 60, \"placement\": \"random\", \"separation\": 1},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 20, \"cutoff\": 2},\n"
    "\"interactions\": {\"self-propulsion\": {\"force\": 1}, "
    "\"polar-alignment\": {\"coupling\": 1, \"range\": 2}},\n"
    "\"dynamics\": {\"integrator\": \"euler-maruyama\"},\n"
    "\"snapshots\": {\"every\": 25, \"formats\": [\"json\"]},\n"
    "\"measure\": {\"equilibration\": 0, \"samples\": 20, \"every\": 10},\n"
    "\"polarity\": {\"every\": 5, \"lags\": 4}, \"clusters\": {\"distance\": 2},\n"
    "\"local_density\": {\"cell\": 3}}\n";
static const char *const active_files[] = {"polarity.tsv",
                                           "polar_order.tsv",
                                           "clusters.tsv",
                                           "local_density.tsv",
                                           "configuration.tsv",
                                           "snapshots/step_000000200.json",
                                           NULL};

/// As docs/theory.md has it: of a coarse step of `aboba` the velocities at its end are hotter than
/// those in its middle, of which the summary tells.
static void test_velocities_are_those_of_the_end_of_a_step(void **state) {
    static const double kelvin = 120.272;
    static struct run_program_result result;
    small_inputs_write(*state, "scene.json",
                       "{\"box\": [6, 6, 6], \"particles\": {\"count\": 648}, \"time_step\": 0.08, "
                       "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25}, "
                       "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}, "
                       "\"measure\": {\"equilibration\": 200, \"samples\": 40, \"every\": 10}, "
                       "\"snapshots\": {\"every\": 10, \"formats\": [\"extxyz\"]}}",
                       NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--quiet");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "measure", "out/snapshots/trajectory.extxyz", "--file-units", "lj", "-o",
                "target", "--quiet");
    run_program_assert_code(&result, 0);
    const double middle = results_number("out/summary.json", "temperature");
    const double end = results_number("target/summary.json", "temperature") / kelvin;
    print_message("in the middle %g, at the end %g\n", middle, end);
    assert_true(middle > 1.02 && end > middle + 0.03);
}

/// Both forms of the last configuration begin the same scene.
static void test_scene_begins_with_a_snapshot(void **state) {
    static struct run_program_result result;
    static const char random[] = "\"random\", \"separation\": 1";
    small_scenes_write(*state, active, NULL, NULL);
    small_scenes_simulate(&result, "first");
    small_scenes_write(*state, active, random,
                       "\"file\", \"file\": \"first/snapshots/step_000000200.json\"");
    small_scenes_simulate(&result, "second");
    small_scenes_write(*state, active, random, "\"file\", \"file\": \"first/configuration.tsv\"");
    small_scenes_simulate(&result, "third");
    results_assert_same("second", "third", active_files);
    results_assert_differ("first", "second", "polar_order.tsv");
    // The first snapshot of the second is the last of the first.
    small_scenes_write(*state, active, random,
                       "\"file\", \"file\": \"second/snapshots/step_000000000.json\"");
    small_scenes_simulate(&result, "fourth");
    results_assert_same("second", "fourth", active_files);
}

static void test_interrupted_active_particles_go_on_with_the_same_bits(void **state) {
    static struct run_program_result result;
    small_scenes_write(*state, active, "\"samples\": 20", "\"samples\": 400");
    small_scenes_simulate(&result, "whole");
    run_program_in_pieces(0, (const char *const[]){"simulate", "scene.json", "-o", "pieces", NULL});
    results_assert_same("whole", "pieces", active_files);
}

/// Six particles in the box about 0, as their tutorial's initial file has them, and as a table.
static const char tutorial[] =
    "{\"system\": {\"box\": {\"Lx\": 12.0, \"Ly\": 12}, \"particles\": [\n"
    "{\"id\": 0, \"r\": [-5, -3.25], \"n\": [0, 1], \"v\": [0, 0], \"f\": [0, 0], "
    "\"radius\": 0.5},\n"
    "{\"id\": 1, \"r\": [-4, -3.5], \"n\": [1, 0], \"radius\": 0.5},\n"
    "{\"id\": 2, \"r\": [1, 1], \"n\": [0, -1], \"radius\": 0.5},\n"
    "{\"id\": 3, \"r\": [2, 1.5], \"n\": [0, 1], \"radius\": 0.5},\n"
    "{\"id\": 4, \"r\": [4, 5], \"n\": [1, 0], \"radius\": 0.5},\n"
    "{\"id\": 5, \"r\": [5.5, 5], \"n\": [0, -1], \"radius\": 0.75}]}}\n";
static const char same_as_table[] = "# x y orientation radius\n"
                                    "1 2.75 1.5707963267948966 0.5\n2 2.5 0 0.5\n"
                                    "7 7 -1.5707963267948966 0.5\n8 7.5 1.5707963267948966 0.5\n"
                                    "10 11 0 0.5\n11.5 11 -1.5707963267948966 0.75\n";

static void write_tutorial(struct temporary_folder *folder, const char *from, const char *to) {
    small_inputs_write(folder, "init.json", tutorial, from, to);
    small_scenes_write(folder, active, "60, \"placement\": \"random\", \"separation\": 1",
                       "6, \"placement\": \"file\", \"file\": \"init.json\"");
}

static void test_scene_begins_with_the_tutorials_initial_file(void **state) {
    static struct run_program_result result;
    write_tutorial(*state, NULL, NULL);
    small_scenes_simulate(&result, "first");
    small_inputs_write(*state, "table.txt", same_as_table, NULL, NULL);
    small_scenes_write(*state, active, "60, \"placement\": \"random\", \"separation\": 1",
                       "6, \"placement\": \"file\", \"file\": \"table.txt\"");
    small_scenes_simulate(&result, "second");
    results_assert_same("first", "second", active_files);
}

static void test_broken_initial_file_of_the_tutorial_is_refused(void **state) {
    static const struct {
        const char *from, *to, *fault;
    } cases[] = {
        {"\"Lx\": 12.0", "\"Lx\": 13", "system.box: is [13, 12] here"},
        {"\"Lx\": 12.0, ", "", "system.box.Lx"},
        {"\"r\": [1, 1]", "\"r\": [1, null]",
         "system.particles: number 3 of the list: expected \"r\""},
        {"\"n\": [0, 1], \"radius\": 0.5},\n{\"id\": 4", "\"radius\": 0.5},\n{\"id\": 4",
         "number 4 of the list: expected \"n\""},
        {"0.75", "\"big\"", "number 6 of the list: expected \"radius\", a number"},
        {"\"particles\"", "\"others\"", "system.particles: expected a list of particles"},
    };
    static struct run_program_result result;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        write_tutorial(*state, cases[k].from, cases[k].to);
        RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
        run_program_assert_code(&result, 2);
        assert_contains(result.err, "scene.json: particles.file: init.json: ");
        assert_contains(result.err, cases[k].fault);
        assert_false(temporary_folder_exists("out/used.json"));
    }
}

static void test_broken_snapshot_is_refused_as_a_start(void **state) {
    static struct run_program_result result;
    small_scenes_write(*state, active, "\"random\", \"separation\": 1",
                       "\"file\", \"file\": \"start.json\"");
    small_inputs_write(*state, "start.json", "{\"particles\": {\"x\": [1, 2], \"y\": [1, null]}}",
                       NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json");
    run_program_assert_refused(&result, ".", "null", 1,
                               (const char *[]){"scene.json: particles.file: start.json: "
                                                "particles.y: number 2 of the list is not a number",
                                                NULL});
    small_inputs_write(*state, "start.json", "{\"particles\": {\"x\": [1, 2], \"y\": [1]}}", NULL,
                       NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json");
    run_program_assert_refused(&result, ".", "short", 1,
                               (const char *[]){"particles.y: expected a list of 2 numbers", NULL});
}

/// Types follow from the order of particles: that of the file is to be that of the scene.
static void test_snapshot_of_other_types_is_refused_as_a_start(void **state) {
    static struct run_program_result result;
    static const char scene[] =
        "{\"dimensions\": 2, \"box\": [10, 10], \"particles\": {\"types\": {\"small\": 2, "
        "\"large\": "
        "2},\n\"placement\": \"file\", \"file\": \"start.json\"}, \"time_step\": 0.1,\n"
        "\"dynamics\": {\"integrator\": \"event-driven\"}, \"rdf\": {\"range\": 1},\n"
        "\"measure\": {\"samples\": 4}}\n";
    static const char start[] =
        "{\"particles\": {\"type\": [\"large\", \"large\", \"small\", \"small\"],\n"
        "\"x\": [1, 3, 5, 7], \"y\": [1, 3, 5, 7], \"radius\": [1, 1, 0.1, 0.1]}}";
    small_inputs_write(*state, "scene.json", scene, NULL, NULL);
    small_inputs_write(*state, "start.json", start, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json");
    run_program_assert_refused(
        &result, ".", "order", 1,
        (const char *[]){"scene.json: particles.file: start.json: particles.type: particle 0 is "
                         "\"large\" here and \"small\" in the scene",
                         NULL});
    small_inputs_write(*state, "start.json", start, "\"small\"]", "3]");
    RUN_PROGRAM(&result, "simulate", "scene.json");
    run_program_assert_refused(
        &result, ".", "texts", 1,
        (const char *[]){"start.json: particles.type: expected a list of 4 texts", NULL});
    small_inputs_write(*state, "start.json", start, NULL, NULL);
    small_inputs_write(*state, "scene.json", scene, "\"small\": 2, \"large\": 2",
                       "\"large\": 2, \"small\": 2");
    RUN_PROGRAM(&result, "simulate", "scene.json");
    run_program_assert_code(&result, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_interrupted_run_leaves_the_same_snapshots,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_killed_run_leaves_the_same_snapshots,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_forces_are_those_of_the_positions_beside_them,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_snapshots_change_nothing_else_and_threads_not_them,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_new_run_removes_the_snapshots_of_an_earlier_one,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_measure_knows_the_units_of_snapshots,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_velocities_are_those_of_the_end_of_a_step,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_scene_begins_with_a_snapshot,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_interrupted_active_particles_go_on_with_the_same_bits,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_snapshot_of_other_types_is_refused_as_a_start,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_scene_begins_with_the_tutorials_initial_file,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_broken_initial_file_of_the_tutorial_is_refused,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_broken_snapshot_is_refused_as_a_start,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
