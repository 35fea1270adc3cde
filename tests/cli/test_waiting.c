// SPDX-License-Identifier: GPL-3.0-or-later
//
// How long threads wait for each other is in the environment of the program, and of what it
// starts: here a gnuplot that writes it down.
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static char path[4096];

static int enter(void **state) {
    char here[4096], with_own[8300], script[4200];
    if (small_inputs_enter(state) != 0 || getcwd(here, sizeof here) == NULL)
        return -1;
    snprintf(path, sizeof path, "%s", getenv("PATH"));
    snprintf(with_own, sizeof with_own, "%s:%s", here, path);
    snprintf(script, sizeof script, "#!/bin/sh\necho \"turns: $GOMP_SPINCOUNT\" > '%s/turns'\n",
             here);
    small_inputs_write(*state, "gnuplot", script, NULL, NULL);
    small_inputs_write(*state, "scene.json", small_inputs_scene, NULL, NULL);
    setenv("PATH", with_own, 1);
    unsetenv("OMP_WAIT_POLICY");
    unsetenv("GOMP_SPINCOUNT");
    return chmod("gnuplot", 0700);
}

static int leave(void **state) {
    setenv("PATH", path, 1);
    unsetenv("OMP_WAIT_POLICY");
    unsetenv("GOMP_SPINCOUNT");
    return small_inputs_leave(state);
}

/// How many turns what the program started would wait.
static char *find_turns(void) {
    static struct run_program_result result;
    RUN_PROGRAM(&result, "simulate", "scene.json", "--threads", "2");
    run_program_assert_code(&result, 0);
    return temporary_folder_read("turns");
}

static void test_threads_wait_briefly_when_the_user_says_nothing(void **state) {
    (void)state;
    char *turns = find_turns();
    assert_contains(turns, "turns: 1000\n");
    free(turns);
}

static void test_threads_wait_as_the_user_says(void **state) {
    (void)state;
    setenv("OMP_WAIT_POLICY", "active", 1);
    char *turns = find_turns();
    assert_contains(turns, "turns: \n");
    free(turns);
    unsetenv("OMP_WAIT_POLICY");
    setenv("GOMP_SPINCOUNT", "77", 1);
    turns = find_turns();
    assert_contains(turns, "turns: 77\n");
    free(turns);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, enter, leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_threads_wait_briefly_when_the_user_says_nothing),
        TEST(test_threads_wait_as_the_user_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
