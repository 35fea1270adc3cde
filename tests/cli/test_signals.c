// SPDX-License-Identifier: GPL-3.0-or-later
//
// Who wants a run to stop, or does not listen to it any more, loses nothing of it; and what could
// not be printed is not called done.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>

enum { INTERRUPTED = 130 };

static struct run_program_result result;

/// A scene that takes years before its first sample: its progress is told all the same.
static void write_long_scene(struct temporary_folder *folder) {
    small_inputs_write(folder, "scene.json", small_inputs_scene, "\"equilibration\": 2",
                       "\"equilibration\": 100000000000");
}

static void test_a_run_that_is_stopped_is_saved(void **state) {
    // What a batch system sends at the end of a job's time is no failure.
    static const struct {
        int number, code;
    } signals[] = {{SIGINT, INTERRUPTED}, {SIGHUP, INTERRUPTED}, {SIGTERM, 0}, {SIGUSR1, 0}};
    write_long_scene(*state);
    for (size_t k = 0; k < sizeof signals / sizeof *signals; k++) {
        const struct run_program_how how = {.interrupt_after = 0.01,
                                            .interrupt_with = signals[k].number};
        run_program(&result, &how,
                    (const char *const[]){"simulate", "scene.json", "--force", NULL});
        run_program_assert_code(&result, signals[k].code);
        assert_contains(result.err, "mesofit: interrupted at step ");
        unsigned long long step = 0;
        sscanf(strstr(result.err, "at step "), "at step %llu", &step);
        assert_true(step > 0);
        run_program(&result, &how,
                    (const char *const[]){"simulate", "scene.json", "--resume", NULL});
        run_program_assert_code(&result, signals[k].code);
        unsigned long long later = 0;
        sscanf(strstr(result.err, "at step "), "at step %llu", &later);
        assert_true(later > step);
    }
}

/// All that it has measured so far, as at its end, and no number of which nothing is known yet: the
/// MSD begins after 10000 samples.
static void test_a_simulation_that_is_stopped_shows_what_it_has(void **state) {
    small_inputs_write(*state, "scene.json", small_inputs_scene, "\"samples\": 4, \"every\": 1}",
                       "\"samples\": 100000000, \"every\": 1}, \"motion\": {\"lags\": 10000}");
    const struct run_program_how how = {.interrupt_after = 0.2, .interrupt_with = SIGINT};
    run_program(&result, &how, (const char *const[]){"simulate", "scene.json", NULL});
    run_program_assert_code(&result, INTERRUPTED);
    assert_contains(result.err, "; what there is, is in out; continue with --resume");
    assert_null(strstr(result.err, "nan"));
    assert_null(strstr(result.err, "no figure"));
    results_assert_text("out/summary.json", "status", "interrupted");
    results_assert_table("out/rdf.tsv", 0, 0);
    results_assert_table("out/thermodynamics.tsv", 0, 0);
    const double steps = results_number("out/summary.json", "engine_steps");
    assert_true(steps >= 4 && steps < 10000);
    run_program(&result, &how, (const char *const[]){"simulate", "scene.json", "--resume", NULL});
    run_program_assert_code(&result, INTERRUPTED);
    assert_true(results_number("out/summary.json", "engine_steps") > steps);
    run_program_assert_no_partial("out");
}

static int shell(const char *line) {
    const int status = system(line);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

/// `head` takes one line of the progress and goes.
static void test_a_run_whose_pipe_is_closed_is_saved(void **state) {
    write_long_scene(*state);
    shell("{ timeout 600 \"$MESOFIT\" simulate scene.json; echo $? > code; } 2>&1 | head -1 > "
          "/dev/null");
    char *code = temporary_folder_read("code");
    assert_int_equal(atoi(code), INTERRUPTED);
    free(code);
    assert_true(temporary_folder_exists("out/checkpoint.bin"));
}

/// nohup and its like: a terminal that goes does not end the run.
static void test_a_hangup_that_is_ignored_stays_ignored(void **state) {
    small_inputs_write(*state, "scene.json", small_inputs_scene, "\"samples\": 4",
                       "\"samples\": 2000");
    assert_int_equal(
        shell("trap '' HUP; \"$MESOFIT\" simulate scene.json --quiet & p=$!; "
              "until [ -e out/used.json ]; do sleep 0.01; done; kill -HUP $p; wait $p"),
        0);
}

/// A simulation can be resumed however early it was killed, since it is saved before its first
/// step.
static void test_a_simulation_is_saved_before_its_first_step(void **state) {
    write_long_scene(*state);
    shell("\"$MESOFIT\" simulate scene.json --quiet & p=$!; "
          "while [ ! -e out/checkpoint.bin ]; do sleep 0.01; done; kill -9 $p; wait $p");
    const struct run_program_how how = {.interrupt_with = SIGINT, .interrupt_after = 0.01};
    run_program(&result, &how, (const char *const[]){"simulate", "scene.json", "--resume", NULL});
    run_program_assert_code(&result, INTERRUPTED);
}

static void test_what_cannot_be_printed_is_an_error(void **state) {
    static const char *const words[] = {"--help",
                                        "--version",
                                        "describe",
                                        "describe scene",
                                        "simulate scene.json --explain",
                                        "fit run.json --explain",
                                        "compare fit -o compared"};
    char line[256];
    small_inputs_write(*state, "scene.json", small_inputs_scene, NULL, NULL);
    small_inputs_write(*state, "run.json", small_inputs_run, NULL, NULL);
    small_inputs_write(*state, "target.tsv", small_inputs_target, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "fit", "--quiet");
    for (size_t k = 0; k < sizeof words / sizeof *words; k++) {
        snprintf(line, sizeof line, "\"$MESOFIT\" %s > out.txt 2> err.txt", words[k]);
        assert_int_equal(shell(line), 0);
        snprintf(line, sizeof line, "\"$MESOFIT\" %s > /dev/full 2> err.txt", words[k]);
        assert_int_equal(shell(line), 2);
        char *said = temporary_folder_read("err.txt");
        assert_contains(said, "mesofit: cannot write to stdout: No space left on device");
        free(said);
        snprintf(line, sizeof line, "\"$MESOFIT\" %s >&- 2> err.txt", words[k]);
        assert_int_equal(shell(line), 2);
    }
}

/// What is said goes into no file, and tables have the bits of a run with all its streams.
static void test_closed_streams_change_no_file(void **state) {
    static const char *const tables[] = {"rdf.tsv", "thermodynamics.tsv", "used.json", NULL};
    small_inputs_write(*state, "scene.json", small_inputs_scene, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "open");
    run_program_assert_code(&result, 0);
    assert_int_equal(shell("\"$MESOFIT\" simulate scene.json -o closed <&- >&- 2>&-"), 0);
    results_assert_same("open", "closed", tables);
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)
#define TEST_WITH_SHELL(name)                                                                      \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_a_run_that_is_stopped_is_saved),
        TEST_WITH_SHELL(test_a_simulation_that_is_stopped_shows_what_it_has),
        TEST_WITH_SHELL(test_a_run_whose_pipe_is_closed_is_saved),
        TEST_WITH_SHELL(test_a_hangup_that_is_ignored_stays_ignored),
        TEST_WITH_SHELL(test_a_simulation_is_saved_before_its_first_step),
        TEST_WITH_SHELL(test_what_cannot_be_printed_is_an_error),
        TEST(test_closed_streams_change_no_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
