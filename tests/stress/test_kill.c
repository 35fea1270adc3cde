// SPDX-License-Identifier: GPL-3.0-or-later
//
// A run that is killed (SIGKILL: no handler, no farewell) before or after any of its steps on the
// disk (hooks/kill_at.c), or at a random moment, and resumed, leaves the bits of a run in peace.
#include "shared/kill_hook.h"
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

#define FIT(method)                                                                                \
    "{\"seed\": 3, \"target\": {\"rdf\": {\"file\": \"target.tsv\"}},\n"                           \
    "\"unknowns\": {\"potential\": {\"coefficients\": 5, \"maximum\": 30}},\n"                     \
    "\"scene\": {\"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02,\n"       \
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}},\n"                                      \
    "\"method\": {\"name\": " method "}, \"verification\": {\"replicas\": 2, "                     \
    "\"equilibration\": 20, \"samples\": 10, \"every\": 5}}\n"

/// A run, what it writes, and how it may end.
struct kind {
    const char *verb, *text;
    const char *tables[5];
};

static const struct kind kinds[] = {
    {"fit",
     FIT("\"imc\", \"replicas\": 2, \"equilibration\": 5, \"samples\": 20, \"every\": 1, "
         "\"iterations\": 3, \"precision\": 1e-4"),
     {"rdf.tsv", "potential.tsv", "history.tsv", "used.json"}},
    {"fit",
     FIT("\"genetic\", \"population\": 5, \"generations\": 3, \"equilibration\": 30, "
         "\"samples\": 10, \"every\": 5, \"temperature_tolerance\": 0.5"),
     {"rdf.tsv", "potential.tsv", "history.tsv", "used.json"}},
    {"fit",
     FIT("\"gauss-newton\", \"iterations\": 2, \"equilibration\": 30, \"samples\": 10, "
         "\"every\": 5"),
     {"rdf.tsv", "potential.tsv", "history.tsv", "used.json"}},
    {"simulate",
     "{\"seed\": 5, \"box\": [3, 3, 3], \"particles\": {\"count\": 81}, \"time_step\": 0.02,\n"
     "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
     "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}, \"motion\": {\"every\": 3, \"lags\": "
     "8},\n"
     "\"measure\": {\"equilibration\": 100, \"samples\": 400, \"every\": 10}}\n",
     {"rdf.tsv", "thermodynamics.tsv", "motion.tsv", "used.json"}},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

/// Inputs in a new folder, where the test then works.
static void write_inputs(struct temporary_folder *folder, const struct kind *kind) {
    char place[sizeof folder->path + 32];
    snprintf(place, sizeof place, "%s/%ld", folder->path, (long)(kind - kinds));
    struct temporary_folder inside;
    const int length =
        snprintf(inside.path, sizeof inside.path, "%.480s/%ld", folder->path, (long)(kind - kinds));
    assert_in_range(length, 1, sizeof inside.path - 1);
    assert_true(mkdir(inside.path, 0777) == 0 && chdir(inside.path) == 0);
    small_inputs_write(&inside, "target.tsv", small_inputs_target, NULL, NULL);
    small_inputs_write(&inside, "run.json", kind->text, NULL, NULL);
}

/// Go on in the folder, or where nothing was saved yet, begin.
static int finish(const struct kind *kind, const char *out) {
    RUN_PROGRAM(&result, kind->verb, "run.json", "-o", out, "--quiet", "--resume");
    if (result.code == 2 && strstr(result.err, "there is nothing to resume"))
        RUN_PROGRAM(&result, kind->verb, "run.json", "-o", out, "--quiet");
    return result.code;
}

/// How a run in peace ends.
static int run_whole(const struct kind *kind) {
    RUN_PROGRAM(&result, kind->verb, "run.json", "-o", "whole", "--quiet");
    assert_in_range(result.code, 0, 1);
    return result.code;
}

static void assert_same(const struct kind *kind, const char *out, int code, int expected) {
    if (code != expected)
        fail_msg("%s: exit code %d, not %d: %s", out, code, expected, result.err);
    results_assert_same("whole", out, kind->tables);
    run_program_assert_no_partial(out);
}

/// What says that it is finished will not be resumed: nothing half done may be left beside it.
static void assert_whole_if_finished(const char *out) {
    char path[64];
    snprintf(path, sizeof path, "%s/summary.json", out);
    if (temporary_folder_exists(path))
        run_program_assert_no_partial(out);
}

/// Kill before (sign 1) or after (−1) each step; returns how many there are.
static int check_steps(const struct kind *kind, int sign, int expected) {
    for (int at = 1;; at++) {
        char out[32];
        snprintf(out, sizeof out, "%s-%d", sign > 0 ? "before" : "after", at);
        kill_hook_set(sign * at);
        RUN_PROGRAM(&result, kind->verb, "run.json", "-o", out, "--quiet");
        kill_hook_set(0);
        if (result.code != -SIGKILL) {
            assert_same(kind, out, result.code, expected);
            return at - 1;
        }
        assert_whole_if_finished(out);
        // What is finished needs no more; what is not, goes on.
        assert_same(kind, out, finish(kind, out), expected);
    }
}

static void test_a_run_killed_at_any_step_goes_on_with_the_same_bits(void **state) {
    for (int k = 0; k < KINDS; k++) {
        write_inputs(*state, &kinds[k]);
        const int expected = run_whole(&kinds[k]);
        const int before = check_steps(&kinds[k], 1, expected);
        const int after = check_steps(&kinds[k], -1, expected);
        print_message("%s %d: killed before %d and after %d steps\n", kinds[k].verb, k, before,
                      after);
        assert_int_equal(before, after);
        assert_true(before >= 15);
    }
}

static void test_a_run_killed_at_random_goes_on_with_the_same_bits(void **state) {
    enum { TIMES = 8 };
    int killed = 0;
    for (int k = 0; k < KINDS; k++) {
        write_inputs(*state, &kinds[k]);
        const int expected = run_whole(&kinds[k]);
        const double work = result.worked;
        for (int time = 0; time < TIMES; time++) {
            char out[32];
            snprintf(out, sizeof out, "random-%d", time);
            const struct run_program_how how = {.interrupt_with = SIGKILL,
                                                .interrupt_after = work * (time + 0.5) / TIMES,
                                                .interrupt_from_start = true};
            run_program(
                &result, &how,
                (const char *const[]){kinds[k].verb, "run.json", "-o", out, "--quiet", NULL});
            killed += result.code == -SIGKILL;
            assert_whole_if_finished(out);
            const int code = result.code == -SIGKILL ? finish(&kinds[k], out) : result.code;
            assert_same(&kinds[k], out, code, expected);
        }
    }
    print_message("%d of %d runs were killed in time\n", killed, KINDS * TIMES);
    assert_true(killed > KINDS);
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_a_run_killed_at_any_step_goes_on_with_the_same_bits),
        TEST(test_a_run_killed_at_random_goes_on_with_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
