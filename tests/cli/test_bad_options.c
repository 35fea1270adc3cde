// SPDX-License-Identifier: GPL-3.0-or-later
//
// Command lines that cannot be right, and folders that cannot be written.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_disk.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MAX_WORDS = 8 };

struct command_line {
    const char *words[MAX_WORDS];
    const char *says[3];
};

static const struct command_line bad_lines[] = {
    {{"simulat", "scene.json"}, {"unknown command \"simulat\"", "did you mean \"simulate\"?"}},
    {{"watch", "out"}, {"the command \"watch\" was removed: use mesofit live", "mesofit live"}},
    {{"dance"}, {"unknown command \"dance\"", "known: measure, fit"}},
    {{"simulate", "scene.json", "--thread", "2"},
     {"unknown option --thread", "did you mean \"--threads\"?"}},
    {{"simulate", "scene.json", "--fast"}, {"unknown option --fast", "known: -o"}},
    {{"simulate", "scene.json", "-o"}, {"-o takes a folder"}},
    {{"simulate", "scene.json", "-o", ""}, {"-o takes a folder"}},
    {{"simulate", "scene.json", "--threads"}, {"--threads takes a whole number from 1"}},
    {{"simulate", "scene.json", "--threads", "0"}, {"--threads takes a whole number from 1"}},
    {{"simulate", "scene.json", "--threads", "two"}, {"--threads takes a whole number from 1"}},
    {{"simulate", "scene.json", "--seed", "9007199254740992"}, {"--seed", "to 9007199254740991"}},
    {{"simulate", "scene.json", "--seed", "99999999999999999999"}, {"--seed takes a whole number"}},
    {{"simulate", "scene.json", "--seed", "-1"}, {"--seed takes a whole number"}},
    {{"simulate", "scene.json", "--seed", "1.5"}, {"--seed takes a whole number"}},
    {{"measure", "scene.json", "--begin", "30", "--end", "20"},
     {"--begin 30 is after --end 20", "exchange them"}},
    {{"measure", "scene.json", "--force", "1.0"},
     {"--force takes no value such as 1.0: did you mean --forces R?"}},
    {{"simulate", "scene.json", "--quiet", "2"},
     {"--quiet takes no value, and there is no file 2"}},
    {{"simulate", "scene.json", "--live", "8000"},
     {"--live takes no value such as 8000: did you mean --live[=PORT]?"}},
    {{"simulate"}, {"usage: mesofit simulate SCENE.json"}},
    {{"fit"}, {"usage: mesofit fit RUN.json"}},
    {{"fit", "scene.json", "scene.json"}, {"usage: mesofit fit RUN.json"}},
    {{"compare"}, {"usage: mesofit compare DIR"}},
    {{"describe", "fit"}, {"\"fit\" is not known", "did you mean \"run\"?"}},
    {{"describe", "simulate"}, {"did you mean \"scene\"?"}},
    {{"describe", "gaussan"}, {"\"gaussan\" is not known", "did you mean \"gaussian\"?"}},
    {{"simulate", "no/such.json"}, {"no/such.json: No such file"}},
    {{"fit", "no/such.json"}, {"no/such.json: No such file"}},
    {{"fit", "/"}, {"/: is a folder"}},
    {{"plot", "no/such"}, {"no/such"}},
    {{"plot", "."}, {"mesofit: .: there is nothing to draw"}},
    {{"compare", "no/such", "no/such"}, {"no/such"}},
    {{"simulate", "scene.json", "--resume"}, {"checkpoint.bin: No such file"}},
};

static void test_bad_lines_are_refused_with_a_hint(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "scene.json", small_inputs_scene, NULL, NULL);
    for (size_t k = 0; k < sizeof bad_lines / sizeof *bad_lines; k++) {
        run_program(&result, &(struct run_program_how){0}, bad_lines[k].words);
        run_program_assert_refused(&result, ".", bad_lines[k].says[0], 1, bad_lines[k].says);
    }
}

static void test_help_is_on_stdout_when_asked_for(void **state) {
    static struct run_program_result result;
    (void)state;
    RUN_PROGRAM(&result, "fit", "--help");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "mesofit fit RUN.json: ");
    assert_contains(result.out, "--resume");
    assert_contains(result.out, "--explain");
    assert_null(strstr(result.out, "mesofit measure"));
    assert_string_equal(result.err, "");
    char *own = strdup(result.out);
    RUN_PROGRAM(&result, "help", "fit");
    run_program_assert_code(&result, 0);
    assert_string_equal(result.out, own);
    free(own);
    RUN_PROGRAM(&result, "fit", "-h");
    assert_int_equal(strncmp(result.out, "mesofit fit RUN.json: ", 22), 0);
    RUN_PROGRAM(&result, "help", "fitt");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "fitt");
    RUN_PROGRAM(&result, "help");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "mesofit measure");
    RUN_PROGRAM(&result, "--help");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "mesofit measure");
    assert_contains(result.out, "--explain");
    RUN_PROGRAM(&result, "--version");
    run_program_assert_code(&result, 0);
    assert_int_equal(run_program_lines(result.out), 1);
    own = strdup(result.out);
    RUN_PROGRAM(&result, "-V");
    assert_string_equal(result.out, own);
    free(own);
}

static void test_without_words_it_shows_a_first_day(void **state) {
    static struct run_program_result result;
    static const char *const words[] = {"mesofit measure ", "mesofit fit ", "mesofit export ",
                                        "mesofit --help"};
    (void)state;
    run_program(&result, &(struct run_program_how){0}, (const char *const[]){NULL});
    run_program_assert_code(&result, 2);
    for (size_t k = 0; k < sizeof words / sizeof *words; k++)
        assert_contains(result.out, words[k]);
    assert_true(run_program_lines(result.out) < 10);
}

/// Permissions mean nothing to root: a regular file in the way and /proc mean something to all.
static void test_unwritable_folders_are_refused_before_any_step(void **state) {
    static struct run_program_result result;
    static const char *const folders[] = {"scene.json/out", "/proc/mesofit", "/proc/self/task"};
    small_inputs_write(*state, "scene.json", small_inputs_scene, NULL, NULL);
    for (size_t k = 0; k < 3; k++) {
        RUN_PROGRAM(&result, "simulate", "scene.json", "-o", folders[k]);
        run_program_assert_refused(&result, ".", folders[k], 1, (const char *[]){folders[k], NULL});
    }
}

/// Run until files grow to `limit` bytes: a failed write ends the run with exit code 2 and the name
/// of the file.
static void check_file_limit(const char *verb, const char *input, long limit) {
    static struct run_program_result result;
    const struct run_program_how how = {.largest_file = limit};
    run_program(&result, &how, (const char *const[]){verb, input, "--quiet", NULL});
    // LLVM's OpenMP wants 1024 bytes of its own, before anything else.
    if (limit < 1024 && strstr(result.err, "OMP: Error"))
        return;
    run_program_assert_refused(&result, ".", verb, 1,
                               (const char *[]){"cannot write out/", "File too large", NULL});
}

/// used.json has about a thousand bytes, rdf.tsv and history.tsv come later and hold more or less:
/// each limit meets another file.
static void test_full_disk_is_an_error_and_leaves_nothing_half_written(void **state) {
    small_inputs_write(*state, "scene.json", small_inputs_scene, NULL, NULL);
    small_inputs_write(*state, "run.json", small_inputs_run, NULL, NULL);
    small_inputs_write(*state, "target.tsv", small_inputs_target, NULL, NULL);
    for (long limit = 1; limit < 4000; limit = 3 * limit + 100) {
        if (limit < 2000)
            check_file_limit("simulate", "scene.json", limit);
        check_file_limit("fit", "run.json", limit);
    }
}

/// From a disk that holds nothing to one that holds all: the fit fails at one file after another.
static void test_full_file_system_is_an_error_wherever_it_is_met(void **state) {
    static struct run_program_result result;
    int failures = 0;
    assert_int_equal(mkdir("disk", 0777), 0);
    small_inputs_write(*state, "run.json", small_inputs_run, NULL, NULL);
    small_inputs_write(*state, "target.tsv", small_inputs_target, NULL, NULL);
    for (int pages = 1; failures == pages - 1; pages++) {
        if (!small_disk_mount("disk", pages))
            skip();
        RUN_PROGRAM(&result, "fit", "run.json", "--quiet", "-o", "disk");
        if (result.code == 2) {
            run_program_assert_refused(
                &result, ".", "full file system", 1,
                (const char *[]){"cannot write disk/", "No space left", NULL});
            failures++;
        }
        small_disk_unmount("disk");
    }
    assert_in_range(result.code, 0, 1);
    assert_in_range(failures, 8, 100);
}

static void assert_text(const char *name, const char *text) {
    char *now = temporary_folder_read(name);
    assert_string_equal(now, text);
    free(now);
}

/// What keeps a forced fit on a disk with so many free pages from replacing the one that it holds.
enum barrier { AT_SETTINGS, AT_CHECKPOINT, LATER, NOWHERE, BARRIERS };

static enum barrier force_fit(int pages) {
    enum { KEPT = 4 };
    static const char *const names[KEPT] = {"disk/summary.json", "disk/potential.tsv",
                                            "disk/history.tsv", "disk/used.json"};
    static struct run_program_result result;
    char *text[KEPT];
    RUN_PROGRAM(&result, "fit", "run.json", "--quiet", "-o", "disk");
    assert_in_range(result.code, 0, 1);
    for (int k = 0; k < KEPT; k++)
        text[k] = temporary_folder_read(names[k]);
    small_disk_fill("disk", pages);
    RUN_PROGRAM(&result, "fit", "run.json", "--quiet", "-o", "disk", "--seed", "7", "--force");
    const enum barrier barrier = result.code != 2 ? NOWHERE
                                 : strstr(result.err, "cannot write disk/.mesofit-run") ||
                                         strstr(result.err, "cannot write disk/used.json")
                                     ? AT_SETTINGS
                                 : strstr(result.err, "cannot write disk/checkpoint.bin")
                                     ? AT_CHECKPOINT
                                     : LATER;
    for (int k = 0; k < KEPT; k++) {
        if (barrier == AT_SETTINGS || barrier == AT_CHECKPOINT)
            assert_text(names[k], text[k]);
        free(text[k]);
    }
    if (barrier == LATER)
        assert_false(temporary_folder_exists("disk/summary.json"));
    if (barrier == NOWHERE)
        results_assert_number("disk/summary.json", "seed", 7);
    else
        assert_contains(result.err, "No space left");
    return barrier;
}

/// A forced fit replaces used.json and the checkpoint once there is room for both, and then removes
/// what else the earlier one left: from a disk without room for the first to one with room for all.
static void test_forced_fit_on_a_full_disk_keeps_the_earlier_one_until_it_has_begun(void **state) {
    enum { PAGES = 64, MAX = 32 };
    int met[BARRIERS] = {0};
    assert_int_equal(mkdir("disk", 0777), 0);
    small_inputs_write(*state, "run.json", small_inputs_run, NULL, NULL);
    small_inputs_write(*state, "target.tsv", small_inputs_target, NULL, NULL);
    for (int pages = 0; met[NOWHERE] == 0 && pages < MAX; pages++) {
        if (!small_disk_mount("disk", PAGES))
            skip();
        met[force_fit(pages)]++;
        small_disk_unmount("disk");
    }
    assert_true(met[AT_SETTINGS] > 0 && met[AT_CHECKPOINT] > 0 && met[NOWHERE] > 0);
}

static int leave_disk(void **state) {
    small_disk_unmount("disk"); // if the test has failed
    return small_inputs_leave(state);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, small_inputs_enter, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_bad_lines_are_refused_with_a_hint),
        TEST(test_help_is_on_stdout_when_asked_for),
        TEST(test_without_words_it_shows_a_first_day),
        TEST(test_unwritable_folders_are_refused_before_any_step),
        TEST(test_full_disk_is_an_error_and_leaves_nothing_half_written),
        cmocka_unit_test_setup_teardown(test_full_file_system_is_an_error_wherever_it_is_met,
                                        small_inputs_enter, leave_disk),
        cmocka_unit_test_setup_teardown(
            test_forced_fit_on_a_full_disk_keeps_the_earlier_one_until_it_has_begun,
            small_inputs_enter_without_gnuplot, leave_disk),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
