// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/clock.h"
#include "report/program.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

enum { TEXT_SIZE = 1024 };

static enum status run_shell(const char *script, enum program_says says, char *text) {
    const char *const words[] = {"sh", "-c", script, NULL};
    return mf_program_run("/", words, says, 0, text, TEXT_SIZE);
}

static void test_program_run_keeps_what_was_asked_for_when_both_streams_speak(void **state) {
    char text[TEXT_SIZE];
    (void)state;
    assert_ok(run_shell("echo out; echo err >&2", PROGRAM_ERRORS, text));
    assert_string_equal(text, "err\n");
    assert_ok(run_shell("echo out; echo err >&2", PROGRAM_EVERYTHING, text));
    assert_string_equal(text, "out\nerr\n");
    assert_ok(run_shell("cat", PROGRAM_EVERYTHING, text)); // there is no input
    assert_string_equal(text, "");
}

/// Where decimals have a comma, awk would write and read others.
static void test_program_run_has_the_plain_locale_whatever_the_user_speaks(void **state) {
    char text[TEXT_SIZE];
    (void)state;
    static const char *const names[] = {"LANG", "LC_ALL", "LC_NUMERIC"};
    for (int k = 0; k < 3; k++)
        assert_int_equal(setenv(names[k], "de_DE.UTF-8", 1), 0);
    assert_ok(run_shell("env | grep -c '^LC_ALL='; echo $LC_ALL", PROGRAM_EVERYTHING, text));
    assert_string_equal(text, "1\nC.UTF-8\n");
    assert_string_equal(getenv("LC_ALL"), "de_DE.UTF-8");
    for (int k = 0; k < 3; k++)
        assert_int_equal(unsetenv(names[k]), 0);
    assert_ok(run_shell("echo $LC_ALL", PROGRAM_EVERYTHING, text));
    assert_string_equal(text, "C.UTF-8\n");
}

static void test_program_run_keeps_the_end_when_there_is_much(void **state) {
    char text[TEXT_SIZE];
    (void)state;
    assert_ok(run_shell("seq 1 100000", PROGRAM_EVERYTHING, text));
    assert_int_equal(strlen(text), TEXT_SIZE - 1);
    assert_string_equal(text + TEXT_SIZE - 1 - 14, "\n99999\n100000\n");
}

static void keep(void *context, const char *text) {
    snprintf(context, TEXT_SIZE, "%s", text);
}

static void test_program_hear_tells_all_that_is_said(void **state) {
    char text[TEXT_SIZE], heard[TEXT_SIZE] = "";
    const char *const words[] = {"sh", "-c", "echo 1; echo 2; echo 3 >&2", NULL};
    const struct program_ear ear = {keep, heard};
    (void)state;
    assert_ok(mf_program_hear("/", words, PROGRAM_EVERYTHING, 0, &ear, text, sizeof text));
    assert_string_equal(heard, "1\n2\n3\n");
    assert_string_equal(text, heard);
}

static void test_program_run_works_in_the_folder_when_given_one(void **state) {
    struct temporary_folder *folder = *state;
    char text[TEXT_SIZE];
    const char *const words[] = {"ls", NULL};
    temporary_folder_write(folder, "file", "x", 1);
    assert_ok(mf_program_run(folder->path, words, PROGRAM_EVERYTHING, 0, text, sizeof text));
    assert_string_equal(text, "file\n");
}

static void test_program_run_says_why_when_the_program_fails(void **state) {
    char text[TEXT_SIZE];
    const char *const words[] = {"no-such-program", NULL};
    (void)state;
    assert_fails(mf_program_run("/", words, PROGRAM_ERRORS, 0, text, sizeof text), STATUS_IO,
                 "no-such-program is not installed");
    assert_fails(run_shell("echo first; echo last; echo; exit 3", PROGRAM_EVERYTHING, text),
                 STATUS_IO, "sh failed: last");
    assert_fails(run_shell("exit 3", PROGRAM_EVERYTHING, text), STATUS_IO,
                 "sh ended with exit code 3 and said nothing");
    assert_fails(run_shell("kill -9 $$", PROGRAM_EVERYTHING, text), STATUS_IO,
                 "sh was ended by signal 9");
}

/// A program that waits for ever, and one whose child does and keeps the pipe open: both are
/// stopped.
static void test_program_run_stops_what_takes_too_long(void **state) {
    static const char *const scripts[] = {"exec sleep 1000", "exec >&- 2>&-; sleep 1000",
                                          "sleep 1000 & echo $!; wait"};
    char text[TEXT_SIZE];
    (void)state;
    for (int k = 0; k < 3; k++) {
        const char *const words[] = {"sh", "-c", scripts[k], NULL};
        const double begun = clock_seconds();
        assert_fails(mf_program_run("/", words, PROGRAM_EVERYTHING, 0.3, text, sizeof text),
                     STATUS_IO, "sh had not ended after 0.3 s and was stopped");
        assert_true(clock_seconds() - begun < 500);
    }
    const pid_t left = (pid_t)atol(text);
    assert_true(left > 1);
    for (int wait = 0; wait < 50000 && kill(left, 0) == 0; wait++)
        nanosleep(&(struct timespec){.tv_nsec = 10000000}, NULL);
    char about[64];
    snprintf(about, sizeof about, "/proc/%ld/stat", (long)left);
    if (access(about, F_OK) == 0) { // ended, and nobody has asked how
        char *stat = temporary_folder_read(about);
        assert_contains(stat, ") Z");
        free(stat);
    }
}

static void test_program_find_folder_goes_up_when_the_program_is_being_built(void **state) {
    char path[4096], style[4200];
    (void)state;
    assert_ok(mf_program_find_folder(path, sizeof path, "plots", "style.gp"));
    snprintf(style, sizeof style, "%s/style.gp", path);
    assert_int_equal(access(style, R_OK), 0);
    assert_fails(mf_program_find_folder(path, sizeof path, "plots", "no-such.gp"), STATUS_IO,
                 "no folder plots with no-such.gp near the program, where `make install` puts it");
}

#define IN_FOLDER(test)                                                                            \
    cmocka_unit_test_setup_teardown(test, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_program_run_keeps_what_was_asked_for_when_both_streams_speak),
        cmocka_unit_test(test_program_run_has_the_plain_locale_whatever_the_user_speaks),
        cmocka_unit_test(test_program_run_keeps_the_end_when_there_is_much),
        cmocka_unit_test(test_program_hear_tells_all_that_is_said),
        IN_FOLDER(test_program_run_works_in_the_folder_when_given_one),
        cmocka_unit_test(test_program_run_says_why_when_the_program_fails),
        cmocka_unit_test(test_program_run_stops_what_takes_too_long),
        cmocka_unit_test(test_program_find_folder_goes_up_when_the_program_is_being_built),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
