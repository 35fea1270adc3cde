// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a run may do to the folder that it is given: never to its own inputs, nor to what is not of
// a run, nor to a fit without --force, and only one process at a time.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

extern char **environ;

static struct run_program_result result;

static void write_inputs(struct temporary_folder *folder) {
    small_inputs_write(folder, "scene.json", small_inputs_scene, NULL, NULL);
    small_inputs_write(folder, "run.json", small_inputs_run, NULL, NULL);
    small_inputs_write(folder, "target.tsv", small_inputs_target, NULL, NULL);
}

/// All of the files' bytes, to be compared later.
struct kept {
    const char *const *names;
    char *text[8];
};

static struct kept keep(const char *const *names) {
    struct kept kept = {.names = names};
    for (int k = 0; names[k]; k++)
        kept.text[k] = temporary_folder_read(names[k]);
    return kept;
}

static void assert_kept(struct kept *kept) {
    for (int k = 0; kept->names[k]; k++) {
        char *now = temporary_folder_read(kept->names[k]);
        assert_string_equal(now, kept->text[k]);
        free(now);
        free(kept->text[k]);
    }
}

static void assert_refused(const char *part, const char *also) {
    run_program_assert_code(&result, 2);
    assert_int_equal(run_program_lines(result.err), 1);
    assert_contains(result.err, part);
    assert_contains(result.err, also);
}

/// A target that is called like a result, by another name or through a hard link.
static void test_inputs_of_a_run_survive_it(void **state) {
    write_inputs(*state);
    assert_int_equal(mkdir("a", 0777), 0);
    small_inputs_write(*state, "a/rdf.tsv", small_inputs_target, NULL, NULL);
    small_inputs_write(*state, "run.json", small_inputs_run, "target.tsv", "./a/../a/rdf.tsv");
    static const char *const files[] = {"a/rdf.tsv", "run.json", NULL};
    struct kept kept = keep(files);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "a");
    assert_refused("a/rdf.tsv would be replaced", "reads it as ./a/../a/rdf.tsv");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "a", "--force");
    assert_refused("a/rdf.tsv would be replaced", "-o");
    assert_kept(&kept);
    assert_false(temporary_folder_exists("a/used.json"));
    small_inputs_write(*state, "run.json", small_inputs_run, NULL, NULL);
    assert_int_equal(unlink("a/rdf.tsv"), 0);
    assert_int_equal(link("target.tsv", "a/rdf.tsv"), 0);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "a", "--force");
    assert_refused("a/rdf.tsv would be replaced", "reads it as target.tsv");
}

static void test_a_finished_fit_is_not_replaced_by_the_simulation_of_it(void **state) {
    write_inputs(*state);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "fo", "--quiet");
    assert_in_range(result.code, 0, 1);
    small_inputs_write(*state, "scene.json", small_inputs_scene,
                       "{\"law\": \"soft-repulsion\", \"a\": 25}",
                       "{\"law\": \"table\", \"file\": \"fo/potential.tsv\"}");
    static const char *const files[] = {"fo/potential.tsv", "fo/summary.json", "fo/used.json",
                                        "fo/history.tsv", NULL};
    struct kept kept = keep(files);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "fo");
    assert_refused("fo/potential.tsv would be replaced", "-o");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "fo", "--force");
    assert_refused("fo/potential.tsv would be replaced", "-o");
    small_inputs_write(*state, "scene.json", small_inputs_scene, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "fo");
    assert_refused("fo holds a finished fit", "--force");
    assert_true(temporary_folder_exists("fo/checkpoint.bin"));
    assert_kept(&kept);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "fo", "--force", "--quiet");
    run_program_assert_code(&result, 0);
    assert_false(temporary_folder_exists("fo/potential.tsv"));
    assert_false(temporary_folder_exists("fo/checkpoint.bin"));
}

static void test_a_fit_is_replaced_by_force_alone(void **state) {
    write_inputs(*state);
    RUN_PROGRAM(&result, "fit", "run.json", "--quiet");
    assert_in_range(result.code, 0, 1);
    static const char *const files[] = {"out/potential.tsv", "out/summary.json", "out/used.json",
                                        NULL};
    struct kept kept = keep(files);
    RUN_PROGRAM(&result, "fit", "run.json", "--seed", "7", "--quiet");
    assert_refused("out holds a finished fit: --force replaces it, -o OTHER keeps it", "mesofit: ");
    RUN_PROGRAM(&result, "fit", "run.json", "--force", "--resume");
    assert_refused("exclude each other", "--force");
    assert_kept(&kept);
    RUN_PROGRAM(&result, "fit", "run.json", "--seed", "7", "--force", "--quiet");
    assert_in_range(result.code, 0, 1);
    results_assert_number("out/summary.json", "seed", 7);
    assert_int_equal(unlink("out/summary.json"), 0);
    RUN_PROGRAM(&result, "fit", "run.json", "--quiet");
    assert_refused("out holds an unfinished fit: --resume continues it, --force starts again",
                   "out");
    small_inputs_write(*state, "out/used.json", "{", NULL, NULL); // not to be known: the safe side
    RUN_PROGRAM(&result, "simulate", "scene.json", "--quiet");
    assert_refused("out holds an unfinished fit", "--force");
}

static void test_a_simulation_is_replaced_by_another_without_a_word(void **state) {
    write_inputs(*state);
    for (int time = 0; time < 2; time++) {
        RUN_PROGRAM(&result, "simulate", "scene.json", "--quiet");
        run_program_assert_code(&result, 0);
    }
    RUN_PROGRAM(&result, "fit", "run.json", "--quiet");
    assert_refused("out holds a simulation: --force replaces it, -o OTHER keeps it", "mesofit: ");
    assert_true(temporary_folder_exists("out/thermodynamics.tsv"));
    RUN_PROGRAM(&result, "fit", "run.json", "--force", "--quiet");
    assert_in_range(result.code, 0, 1);
    assert_false(temporary_folder_exists("out/thermodynamics.tsv"));
    RUN_PROGRAM(&result, "simulate", "scene.json", "--quiet");
    assert_refused("out holds a finished fit", "--force");
}

static void test_files_of_no_run_are_not_replaced(void **state) {
    write_inputs(*state);
    assert_int_equal(mkdir("mine", 0777), 0);
    small_inputs_write(*state, "mine/rdf.tsv", "precious\n", NULL, NULL);
    small_inputs_write(*state, "mine/etd.tsv", "precious\n", NULL, NULL);
    static const char *const files[] = {"mine/rdf.tsv", "mine/etd.tsv", NULL};
    struct kept kept = keep(files);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "mine");
    assert_refused("mine/rdf.tsv is there, and mesofit did not write it", "elsewhere with -o");
    assert_kept(&kept);
    assert_false(temporary_folder_exists("mine/used.json"));
    kept = keep(files + 1);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "mine", "--force", "--quiet");
    run_program_assert_code(&result, 0);
    results_assert_table("mine/rdf.tsv", 3, 0);
    assert_kept(&kept); // such a table is not of this run
}

/// A run that cannot begin leaves what an earlier one left.
static void test_an_earlier_run_stays_when_the_new_one_cannot_begin(void **state) {
    write_inputs(*state);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--quiet");
    run_program_assert_code(&result, 0);
    static const char *const files[] = {"out/rdf.tsv", "out/summary.json", "out/used.json", NULL};
    struct kept kept = keep(files);
    small_inputs_write(*state, "scene.json", small_inputs_scene, "\"measure\"",
                       "\"rdf\": {\"range\": 100}, \"measure\"");
    RUN_PROGRAM(&result, "simulate", "scene.json");
    assert_refused("scene.json", "100");
    assert_kept(&kept);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "fo", "--quiet");
    assert_in_range(result.code, 0, 1);
    static const char *const fitted[] = {"fo/potential.tsv", "fo/summary.json", "fo/used.json",
                                         NULL};
    kept = keep(fitted);
    small_inputs_write(*state, "run.json", small_inputs_run, "\"imc\", \"replicas\": 2",
                       "\"pareto\", \"replicas\": 2");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "fo", "--force");
    run_program_assert_code(&result, 2);
    assert_kept(&kept);
}

static void test_a_resumed_run_may_read_its_own_settings(void **state) {
    write_inputs(*state);
    RUN_PROGRAM(&result, "fit", "run.json", "--quiet");
    assert_in_range(result.code, 0, 1);
    static const char *const results[] = {"out/used.json", "out/potential.tsv", "out/history.tsv",
                                          "out/rdf.tsv", NULL};
    struct kept kept = keep(results);
    RUN_PROGRAM(&result, "fit", "out/used.json", "-o", "out", "--resume");
    assert_in_range(result.code, 0, 1);
    assert_contains(result.err, "the fit is finished: only its result is verified");
    assert_kept(&kept);
    RUN_PROGRAM(&result, "fit", "out/used.json", "-o", "out", "--force", "--quiet");
    assert_refused("out/used.json would be replaced", "reads it as out/used.json");
}

/// What processes that were killed had begun goes; what only looks like it stays.
static void test_partial_files_of_killed_runs_are_removed(void **state) {
    write_inputs(*state);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--quiet");
    run_program_assert_code(&result, 0);
    static const char *const stale[] = {"out/rdf.tsv.12-0.partial", "out/used.json.7-13.partial",
                                        "out/summary.json.1-1.partial"};
    static const char *const own[] = {"out/notes.12-1.partial",
                                      "out/rdf.tsv.partial",
                                      "out/rdf.tsv.x-1.partial",
                                      "out/rdf.tsv.1-.partial",
                                      "out/rdf.tsv.12.partial",
                                      "out/.1-1.partial",
                                      NULL};
    for (int k = 0; k < 3; k++)
        small_inputs_write(*state, stale[k], "x\n", NULL, NULL);
    for (int k = 0; own[k]; k++)
        small_inputs_write(*state, own[k], "x\n", NULL, NULL);
    struct kept kept = keep(own);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--quiet");
    run_program_assert_code(&result, 0);
    for (int k = 0; k < 3; k++)
        assert_false(temporary_folder_exists(stale[k]));
    assert_kept(&kept);
}

static void test_a_path_that_is_too_long_is_refused(void **state) {
    static char path[6000];
    write_inputs(*state);
    for (size_t length = 0; length < 4050; length += 5)
        memcpy(path + length, "abcd/", 5);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", path);
    assert_refused("the path of a run's folder has at most", "bytes");
    assert_false(temporary_folder_exists("abcd"));
}

/// Start `simulate` with a long run in "out", wait until it has begun, and give its process.
static pid_t start_long_run(void) {
    char *const words[] = {getenv("MESOFIT"), "simulate", "long.json", "-o", "out",
                           "--quiet",         NULL};
    pid_t process;
    assert_int_equal(posix_spawn(&process, words[0], NULL, NULL, words, environ), 0);
    while (!temporary_folder_exists("out/used.json") && waitpid(process, NULL, WNOHANG) == 0)
        nanosleep(&(struct timespec){.tv_nsec = 10000000}, NULL);
    assert_true(temporary_folder_exists("out/used.json"));
    return process;
}

static void test_one_process_a_folder(void **state) {
    write_inputs(*state);
    small_inputs_write(*state, "long.json", small_inputs_scene, "\"equilibration\": 2",
                       "\"equilibration\": 100000000");
    const pid_t process = start_long_run();
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    assert_refused("out: another process is running in this folder", "mesofit: ");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--force");
    assert_refused("out: another process is running in this folder", "mesofit: ");
    kill(process, SIGKILL);
    waitpid(process, NULL, 0);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--quiet", "--force");
    run_program_assert_code(&result, 0);
}

/// Names that would be something else to a shell, a format or a parser of options are names.
static void test_folders_may_have_any_name(void **state) {
    static const char *const names[] = {
        "$(touch pwned)", "`touch pwned`", "it's; touch pwned", "a \"b\" c",    "x\ny",
        "%n%s",           "./-o",          "naïve Φ",           "<touch pwned", "|touch pwned"};
    char search_path[4096];
    snprintf(search_path, sizeof search_path, "%s", getenv("PATH"));
    write_inputs(*state);
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        char path[256];
        setenv("PATH", "/nowhere", 1); // it would draw, too
        RUN_PROGRAM(&result, "fit", "run.json", "-o", names[k], "--quiet");
        setenv("PATH", search_path, 1);
        assert_in_range(result.code, 0, 1);
        snprintf(path, sizeof path, "%s/potential.tsv", names[k]);
        assert_true(temporary_folder_exists(path));
        RUN_PROGRAM(&result, "compare", names[k], "-o", "compared");
        run_program_assert_code(&result, 0);
        RUN_PROGRAM(&result, "plot", names[k]);
        assert_false(temporary_folder_exists("pwned"));
        snprintf(path, sizeof path, "%s/pwned", names[k]);
        assert_false(temporary_folder_exists(path));
        assert_false(temporary_folder_exists("compared/pwned"));
    }
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_inputs_of_a_run_survive_it),
        TEST(test_a_finished_fit_is_not_replaced_by_the_simulation_of_it),
        TEST(test_a_fit_is_replaced_by_force_alone),
        TEST(test_a_simulation_is_replaced_by_another_without_a_word),
        TEST(test_files_of_no_run_are_not_replaced),
        TEST(test_an_earlier_run_stays_when_the_new_one_cannot_begin),
        TEST(test_a_resumed_run_may_read_its_own_settings),
        TEST(test_partial_files_of_killed_runs_are_removed),
        TEST(test_a_path_that_is_too_long_is_refused),
        TEST(test_one_process_a_folder),
        cmocka_unit_test_setup_teardown(test_folders_may_have_any_name, small_inputs_enter,
                                        small_inputs_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
