// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the program removes and replaces in a folder is what it has written there, whatever the
// names of other files are: every command that writes, with files of a person, edited files, links,
// folders that are removed meanwhile, and those of versions that kept no list.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static struct run_program_result result;

/// With snapshots of one step in two.
static const char scene[] =
    "{\"seed\": 1, \"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"temperature\": 1,\n"
    "\"time_step\": 0.02, \"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "\"measure\": {\"equilibration\": 2, \"samples\": 4, \"every\": 1},\n"
    "\"snapshots\": {\"every\": 2}}\n";

static int enter(void **state) {
    if (small_inputs_enter_without_gnuplot(state) != 0)
        return -1;
    small_inputs_write(*state, "scene.json", scene, NULL, NULL);
    small_inputs_write(*state, "long.json", scene, "\"equilibration\": 2",
                       "\"equilibration\": 100000000");
    small_inputs_write(*state, "run.json", small_inputs_run, NULL, NULL);
    small_inputs_write(*state, "target.tsv", small_inputs_target, NULL, NULL);
    return 0;
}

static void simulate(void) {
    RUN_PROGRAM(&result, "simulate", "scene.json", "--quiet");
    run_program_assert_code(&result, 0);
}

static void fit(void) {
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "fit", "--quiet");
    assert_in_range(result.code, 0, 1);
}

static void put(void **state, const char *name) {
    temporary_folder_write(*state, name, "mine", 4);
}

static void assert_mine(const char *name) {
    char *text = temporary_folder_read(name);
    assert_string_equal(text, "mine");
    free(text);
}

static void assert_refused(const char *part, const char *also) {
    run_program_assert_code(&result, 2);
    const int warnings = strstr(result.err, "mesofit: warning: ") != NULL;
    assert_int_equal(run_program_lines(result.err), 1 + warnings);
    assert_contains(result.err, part);
    assert_contains(result.err, also);
}

/// Names that results of other runs have.
static void test_files_of_a_person_stay_whatever_they_are_called(void **state) {
    static const char *const names[] = {"potential.tsv",
                                        "rdf_A-B.tsv",
                                        "bonds_my.tsv",
                                        "memory_notes.tsv",
                                        "potential_A-B.pot",
                                        "snapshots/step_1.vtp",
                                        "snapshots/trajectory.lammpstrj",
                                        "potential_2026-11-22.tsv",
                                        "rdf.tsv.12-3.partial.txt"};
    char path[128];
    simulate();
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        snprintf(path, sizeof path, "out/%s", names[k]);
        put(state, path);
    }
    simulate();
    RUN_PROGRAM(&result, "simulate", "scene.json", "--quiet", "--force", "--seed", "2");
    run_program_assert_code(&result, 0);
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        snprintf(path, sizeof path, "out/%s", names[k]);
        assert_mine(path);
    }
}

/// A table of another run's, and its snapshots, go with it.
static void test_what_a_run_wrote_goes_with_it(void **state) {
    simulate();
    assert_true(temporary_folder_exists("out/snapshots/step_000000004.vtp"));
    small_inputs_write(*state, "scene.json", small_inputs_scene, NULL, NULL);
    simulate();
    assert_false(temporary_folder_exists("out/snapshots"));
    assert_false(temporary_folder_exists("out/configuration.tsv"));
}

static void test_files_that_were_changed_are_not_replaced(void **state) {
    simulate();
    put(state, "out/rdf.tsv");
    RUN_PROGRAM(&result, "simulate", "scene.json", "--quiet");
    assert_refused("out/rdf.tsv was changed since mesofit wrote it", "--force replaces it");
    assert_mine("out/rdf.tsv");
    RUN_PROGRAM(&result, "simulate", "scene.json", "--quiet", "--force");
    run_program_assert_code(&result, 0);
    results_assert_table("out/rdf.tsv", 3, 0);
}

/// A fit is replaced by --force alone; who may give it knows of the change.
static void test_fit_in_which_a_file_was_changed_is_told_with_it(void **state) {
    fit();
    put(state, "fit/potential.tsv");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "fit", "--quiet");
    assert_refused("fit holds a finished fit, in which potential.tsv was changed since mesofit "
                   "wrote it: --force replaces it, -o OTHER keeps it",
                   "mesofit: ");
    assert_mine("fit/potential.tsv");
}

static const char mixture[] =
    "{\"seed\": 1, \"box\": [3, 3, 3], \"particles\": {\"types\": {\"A\": 40, \"B\": 41}},\n"
    "\"temperature\": 1, \"time_step\": 0.02, \"conservative\": {\"law\": \"soft-repulsion\", "
    "\"a\": 25},\n\"measure\": {\"equilibration\": 2, \"samples\": 4, \"every\": 1}}\n";

/// Not after hours of work: a run that is refused has made no settings.
static void test_names_are_refused_at_the_start(void **state) {
    static const char *const names[] = {"potential.tsv", "potential_history.tsv",
                                        "rdf.tsv",       "configuration.tsv",
                                        "history.tsv",   "summary.json"};
    char path[128];
    small_inputs_write(*state, "mixture.json", mixture, NULL, NULL);
    assert_int_equal(mkdir("mixed", 0777) | mkdir("fit", 0777), 0);
    put(state, "mixed/rdf_A-B.tsv");
    RUN_PROGRAM(&result, "simulate", "mixture.json", "-o", "mixed", "--quiet");
    assert_refused("mixed/rdf_A-B.tsv is there, and mesofit did not write it", "-o");
    assert_false(temporary_folder_exists("mixed/used.json"));
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        snprintf(path, sizeof path, "fit/%s", names[k]);
        put(state, path);
        RUN_PROGRAM(&result, "fit", "run.json", "-o", "fit", "--quiet");
        assert_refused(path, "mesofit: fit/");
        assert_false(temporary_folder_exists("fit/used.json"));
        assert_int_equal(unlink(path), 0);
    }
}

/// Nothing of the old results goes before the run is refused.
static void test_folders_in_the_place_of_files_are_refused(void **state) {
    static const char *const how[] = {NULL, "--force"};
    (void)state;
    for (int k = 0; k < 2; k++) {
        assert_int_equal(mkdir("new", 0777) | mkdir("new/rdf.tsv", 0777), 0);
        RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "new", "--quiet", how[k]);
        assert_refused("new/rdf.tsv is a folder: move it away, or write elsewhere with -o\n",
                       "mesofit: ");
        assert_int_equal(rmdir("new/rdf.tsv") | rmdir("new"), 0);
    }
    simulate();
    assert_int_equal(unlink("out/configuration.tsv") | mkdir("out/configuration.tsv", 0777), 0);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--quiet", "--force");
    assert_refused("out/configuration.tsv is a folder: move it away", "-o");
    assert_true(temporary_folder_exists("out/summary.json"));
    results_assert_table("out/rdf.tsv", 3, 0);
}

static void interrupt(const char *folder, const char *how) {
    run_program(&result,
                &(struct run_program_how){.interrupt_with = SIGINT, .interrupt_after = 0.02},
                (const char *const[]){"simulate", "long.json", "-o", folder, how, NULL});
    assert_int_equal(result.code, 130);
}

/// An interrupted simulation is worth as much as an interrupted fit.
static void test_forgotten_resume_keeps_the_simulation(void **state) {
    (void)state;
    interrupt("out", NULL);
    RUN_PROGRAM(&result, "simulate", "long.json");
    assert_refused(
        "out holds an unfinished simulation: --resume continues it, --force starts again",
        "mesofit: ");
    RUN_PROGRAM(&result, "simulate", "scene.json", "--seed", "9");
    assert_refused("out holds an unfinished simulation", "--resume");
    RUN_PROGRAM(&result, "simulate", "scene.json", "--force", "--quiet");
    run_program_assert_code(&result, 0);
    simulate(); // which is finished
}

/// --force would throw away what there is.
static void test_file_in_the_way_of_a_run_that_goes_on(void **state) {
    interrupt("out", NULL);
    put(state, "out/rdf.tsv");
    RUN_PROGRAM(&result, "simulate", "long.json", "--resume");
    assert_refused("out/rdf.tsv is there, and mesofit did not write it: move it away, and continue "
                   "with --resume\n",
                   "mesofit: ");
    assert_mine("out/rdf.tsv");
    assert_int_equal(unlink("out/rdf.tsv"), 0);
    // Names of snapshots are not known before they are written.
    assert_int_equal(mkdir("new", 0777) | mkdir("new/snapshots", 0777), 0);
    put(state, "new/snapshots/step_000000004.vtp");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "new", "--quiet");
    assert_refused("new/snapshots/step_000000004.vtp is there, and mesofit did not write it: ",
                   "move it away, and continue with --resume\n");
    assert_int_equal(unlink("new/snapshots/step_000000004.vtp"), 0);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "new", "--quiet", "--resume");
    run_program_assert_code(&result, 0);
}

static void test_resume_makes_no_folder(void **state) {
    (void)state;
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "nowhere", "--resume");
    assert_refused("nowhere/checkpoint.bin: No such file or directory", "nothing to resume");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "nowhere", "--resume");
    assert_refused("nowhere/checkpoint.bin: No such file or directory", "nothing to resume");
    assert_false(temporary_folder_exists("nowhere"));
    // Nor does a run that is refused.
    small_inputs_write(*state, "scene.json", scene, "\"measure\"",
                       "\"rdf\": {\"range\": 100}, \"measure\"");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "nowhere");
    assert_refused("scene.json", "100");
    assert_false(temporary_folder_exists("nowhere"));
}

/// As of version 0.2.0, or a part of a folder that was copied.
static void test_results_without_a_list_are_left_alone(void **state) {
    static const char *const how[] = {NULL, "--force"};
    (void)state;
    simulate();
    fit();
    assert_int_equal(unlink("out/.mesofit-run"), 0);
    assert_int_equal(unlink("fit/.mesofit-run"), 0);
    for (int k = 0; k < 2; k++) {
        RUN_PROGRAM(&result, "simulate", "scene.json", how[k]);
        assert_refused("out holds results without a list of files (.mesofit-run): write elsewhere "
                       "with -o\n",
                       "mesofit: ");
        RUN_PROGRAM(&result, "fit", "run.json", "-o", "fit", how[k]);
        assert_refused("fit holds results without a list of files (.mesofit-run): --resume may "
                       "continue it, -o OTHER keeps them\n",
                       "mesofit: ");
    }
    // What else is of that run is not known.
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "fit", "--resume");
    assert_refused("fit/summary.json is there, and mesofit did not write it: move it away, and "
                   "continue with --resume\n",
                   "mesofit: ");
    assert_false(temporary_folder_exists("fit/.mesofit-run"));
    // Nor is a checkpoint of somebody.
    put(state, "out/checkpoint.bin");
    assert_int_equal(system("/bin/rm -r out/summary.json out/snapshots out/*.tsv"), 0);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--resume");
    assert_refused("out/checkpoint.bin", "mesofit: ");
    assert_mine("out/checkpoint.bin");
    assert_false(temporary_folder_exists("out/.mesofit-run"));
    // They are read as ever.
    RUN_PROGRAM(&result, "compare", "fit", "--quiet");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "export", "fit", "--engine", "lammps", "--quiet");
    run_program_assert_code(&result, 0);
}

/// `cp out/* copy` leaves out a list, whose name begins with a dot.
static void test_copy_without_a_list_goes_on(void **state) {
    (void)state;
    interrupt("out", NULL);
    assert_int_equal(system("/bin/mkdir copy && /bin/cp out/* copy"), 0);
    RUN_PROGRAM(&result, "simulate", "long.json", "-o", "copy");
    assert_refused("copy holds results without a list of files", "--resume may continue it");
    for (int times = 0; times < 2; times++)
        interrupt("copy", "--resume");
    RUN_PROGRAM(&result, "simulate", "long.json", "-o", "copy");
    assert_refused("copy holds an unfinished simulation", "--resume continues");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "copy", "--force", "--quiet");
    run_program_assert_code(&result, 0);
    assert_false(temporary_folder_exists("copy/checkpoint.bin"));
}

static void test_links_to_folders_are_refused(void **state) {
    assert_int_equal(mkdir("elsewhere", 0777), 0);
    put(state, "elsewhere/step_000000002.vtp");
    put(state, "elsewhere/compare.svg");
    assert_int_equal(symlink("elsewhere", "linked"), 0);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "linked/", "--force");
    assert_refused("linked is a link", "-o");
    simulate();
    fit();
    RUN_PROGRAM(&result, "export", "fit", "--engine", "lammps", "-o", "linked", "--force");
    assert_refused("linked is a link", "-o");
    RUN_PROGRAM(&result, "compare", "fit", "-o", "linked", "--force");
    assert_refused("linked is a link", "-o");
    // A folder of somebody, whose snapshots and figures are somewhere else.
    assert_int_equal(system("/bin/rm -r out/snapshots"), 0);
    assert_int_equal(symlink("../elsewhere", "out/snapshots"), 0);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--force");
    assert_refused("out/snapshots is a link, and links are not followed", "mesofit: ");
    assert_int_equal(unlink("out/snapshots"), 0);
    rmdir("out/figures"); // that of a run without gnuplot is empty
    assert_int_equal(symlink("../elsewhere", "out/figures"), 0);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--force");
    assert_refused("out/figures is a link", "not followed");
    RUN_PROGRAM(&result, "compare", "fit", "-o", "out", "--force");
    assert_refused("out/figures is a link", "not followed");
    RUN_PROGRAM(&result, "plot", "out", "--force");
    assert_refused("out/figures is a link", "not followed");
    assert_mine("elsewhere/step_000000002.vtp");
    assert_mine("elsewhere/compare.svg");
}

/// The program sees to it itself: a table at its end, or a snapshot, has no place any more.
static void test_folder_that_is_removed_is_not_made_anew(void **state) {
    static const char *const words[] = {"simulate", "long.json", "--quiet", NULL};
    small_inputs_write(*state, "long.json", scene, "\"samples\": 4", "\"samples\": 100000");
    // Who waits for the first snapshot, and removes all.
    assert_int_equal(system("(PATH=/bin:/usr/bin; n=0; "
                            "until [ -e out/snapshots/step_000000004.vtp ] || [ $n = 30000 ]; "
                            "do sleep 0.01; n=$((n + 1)); done; mv out away) &"),
                     0);
    run_program(&result, &(struct run_program_how){0}, words);
    assert_refused("out is gone: it was removed, or replaced, while it was used", "mesofit: ");
    assert_false(temporary_folder_exists("out"));
}

static void test_comparison_replaces_its_own_tables(void **state) {
    fit();
    put(state, "compare.tsv");
    RUN_PROGRAM(&result, "compare", "fit", "-o", ".");
    assert_refused("./compare.tsv is there, and mesofit did not write it", "--force replaces it");
    assert_mine("compare.tsv");
    assert_false(temporary_folder_exists("rdf_compare.tsv"));
    RUN_PROGRAM(&result, "compare", "fit", "-o", ".", "--force", "--quiet");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "compare", "fit", "fit", "-o", ".", "--quiet");
    run_program_assert_code(&result, 0);
    assert_true(temporary_folder_exists("potential_compare.tsv"));
    // No fit has a potential then.
    simulate();
    RUN_PROGRAM(&result, "compare", "out", "-o", ".", "--quiet");
    run_program_assert_code(&result, 0);
    assert_false(temporary_folder_exists("potential_compare.tsv"));
    // The next run of the folder leaves a comparison alone.
    RUN_PROGRAM(&result, "compare", "out", "-o", "out", "--quiet");
    simulate();
    assert_true(temporary_folder_exists("out/compare.tsv"));
}

static void run_export(const char *from, const char *option, int code) {
    RUN_PROGRAM(&result, "export", from, "--engine", "hoomd", "-o", "hoomd", "--quiet", option);
    run_program_assert_code(&result, code);
}

static void test_export_replaces_its_own_files(void **state) {
    simulate();
    small_inputs_write(*state, "scene.json", mixture, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "mixed", "--quiet");
    run_export("mixed", NULL, 0);
    assert_true(temporary_folder_exists("hoomd/B-B.txt"));
    put(state, "hoomd/trajectory.gsd"); // of the program that has run there
    run_export("out", NULL, 0);
    assert_false(temporary_folder_exists("hoomd/B-B.txt"));
    assert_mine("hoomd/trajectory.gsd");
    put(state, "hoomd/run.py");
    run_export("out", NULL, 2);
    assert_refused("hoomd/run.py was changed since mesofit wrote it", "--force replaces it");
    assert_mine("hoomd/run.py");
    put(state, "hoomd/B-B.txt");
    run_export("out", "--force", 0);
    assert_mine("hoomd/B-B.txt");
    run_export("mixed", NULL, 2);
    assert_refused("hoomd/B-B.txt is there, and mesofit did not write it", "-o");
    assert_mine("hoomd/B-B.txt");
    // An export of version 0.2.0 kept no list.
    assert_int_equal(unlink("hoomd/.mesofit-export"), 0);
    run_export("out", NULL, 2);
    assert_refused("hoomd: the folder holds files that are not of an export (.mesofit-export): ",
                   "--force replaces those of the same names");
    put(state, "hoomd/run.py");
    run_export("out", "--force", 0);
    assert_mine("hoomd/B-B.txt");
    run_export("out", NULL, 0);
    char *text = temporary_folder_read("hoomd/run.py");
    assert_contains(text, "hoomd");
    free(text);
}

static void test_measurement_replaces_its_own_files(void **state) {
    static const char gro[] = "two\n    2\n    1SOL     OW    1   0.100   0.100   0.100\n"
                              "    2SOL     OW    2   0.500   0.400   0.300\n   2.0 2.0 2.0\n";
    small_inputs_write(*state, "two.gro", gro, NULL, NULL);
    for (int time = 0; time < 2; time++) {
        RUN_PROGRAM(&result, "measure", "two.gro", "--quiet");
        run_program_assert_code(&result, 0);
    }
    put(state, "target/notes.tsv");
    put(state, "target/target.json"); // a temperature, perhaps
    RUN_PROGRAM(&result, "measure", "two.gro", "--quiet");
    assert_refused("target/target.json was changed since mesofit wrote it", "-o");
    assert_mine("target/target.json");
    RUN_PROGRAM(&result, "measure", "two.gro", "--quiet", "--force");
    run_program_assert_code(&result, 0);
    assert_mine("target/notes.tsv");
}

static void test_benchmark_replaces_no_file(void **state) {
    small_inputs_write(*state, "scene.json", small_inputs_scene, NULL, NULL);
    put(state, "speed.tsv");
    RUN_PROGRAM(&result, "bench", "engine", "scene.json", "-o", "speed.tsv", "--isa", "portable");
    assert_refused("speed.tsv is there: --force replaces it, -o OTHER keeps it", "mesofit: ");
    assert_int_equal(mkdir("figures", 0777), 0);
    put(state, "figures/points.png");
    RUN_PROGRAM(&result, "bench", "accuracy", "scene.json", "-o", "points.tsv");
    run_program_assert_code(&result, 2);
    assert_mine("speed.tsv");
    assert_mine("figures/points.png");
}

/// A figure that somebody has worked on stays; the others are drawn again.
static void test_figures_are_drawn_over_its_own(void **state) {
    small_inputs_leave(state);
    if (small_inputs_enter(state) != 0)
        fail();
    small_inputs_need_gnuplot();
    small_inputs_write(*state, "scene.json", small_inputs_scene, NULL, NULL);
    simulate();
    RUN_PROGRAM(&result, "plot", "out");
    run_program_assert_code(&result, 0);
    put(state, "out/figures/simulation.svg");
    RUN_PROGRAM(&result, "plot", "out");
    assert_refused("out/figures/simulation.svg was changed since mesofit wrote it", "--force");
    assert_mine("out/figures/simulation.svg");
    RUN_PROGRAM(&result, "plot", "out", "--force");
    run_program_assert_code(&result, 0);
    char *text = temporary_folder_read("out/figures/simulation.svg");
    assert_contains(text, "</svg>");
    free(text);
    simulate();
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, enter, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_files_of_a_person_stay_whatever_they_are_called),
        TEST(test_what_a_run_wrote_goes_with_it),
        TEST(test_files_that_were_changed_are_not_replaced),
        TEST(test_fit_in_which_a_file_was_changed_is_told_with_it),
        TEST(test_names_are_refused_at_the_start),
        TEST(test_folders_in_the_place_of_files_are_refused),
        TEST(test_forgotten_resume_keeps_the_simulation),
        TEST(test_file_in_the_way_of_a_run_that_goes_on),
        TEST(test_resume_makes_no_folder),
        TEST(test_results_without_a_list_are_left_alone),
        TEST(test_copy_without_a_list_goes_on),
        TEST(test_links_to_folders_are_refused),
        TEST(test_folder_that_is_removed_is_not_made_anew),
        TEST(test_comparison_replaces_its_own_tables),
        TEST(test_export_replaces_its_own_files),
        TEST(test_measurement_replaces_its_own_files),
        TEST(test_benchmark_replaces_no_file),
        TEST(test_figures_are_drawn_over_its_own),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
