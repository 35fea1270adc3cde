// SPDX-License-Identifier: GPL-3.0-or-later
//
// A fit that is interrupted again and again, after a task or two each time, comes to its end with
// the same bits: no task that was finished is done again, of whatever method and verification.
#include "base/interrupt.h"
#include "base/parallel_times.h"
#include "report/watcher.h"
#include "shared/results.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"
#include "work/fit.h"

#include <stdio.h>
#include <stdlib.h>

#define METHOD                                                                                     \
    "\"method\": {\"name\": \"imc\", \"replicas\": 2, \"equilibration\": 1, \"samples\": 8,\n"     \
    "             \"every\": 1, \"iterations\": 1}"
#define VERIFICATION "\"verification\": {\"replicas\": 1,"
#define SIMULATED                                                                                  \
    "\"equilibration\": 20, \"samples\": 4, \"every\": 1, \"temperature_tolerance\": 1"

static const char *const methods[] = {
    "\"method\": {\"name\": \"ibi\", \"replicas\": 4, \"equilibration\": 1, \"samples\": 8,\n"
    "             \"every\": 1, \"iterations\": 2}",
    "\"method\": {\"name\": \"genetic\", \"population\": 6, \"generations\": 3, " SIMULATED "}",
    "\"method\": {\"name\": \"gauss-newton\", \"iterations\": 1, " SIMULATED "},\n"
    "\"unknowns\": {\"potential\": {\"coefficients\": 4}}",
};
enum { METHODS = sizeof methods / sizeof *methods };

static const char *const tables[] = {"history.tsv", "potential.tsv", "potential_history.tsv",
                                     "rdf.tsv",     "used.json",     NULL};

/// Someone who wants to stop after so many words.
struct impatient {
    int words, patience; ///< 0: never
};

static void report(void *context, const struct watcher_progress *progress) {
    struct impatient *impatient = context;
    (void)progress;
    if (++impatient->words == impatient->patience)
        mf_interrupt_request(true);
}

static void begin(void *context, const struct watcher_run *run) {
    (void)context, (void)run;
}

static void print(void *context, const char *line) {
    (void)context, (void)line;
}

static void write(void *context) {
    (void)context;
}

/// A person who wants the same before each iteration.
static bool damp(void *context, double *damping) {
    (void)context;
    *damping = 0.5;
    return true;
}

static enum status run(const char *folder, bool resume, int patience) {
    struct impatient impatient = {.patience = patience};
    const struct watcher watcher = {.context = &impatient,
                                    .begin = begin,
                                    .report = report,
                                    .print = print,
                                    .write = write,
                                    .damp = damp};
    const struct run_options options = {
        .folder = folder, .threads = 1, .quiet = true, .resume = resume, .watcher = &watcher};
    const enum status status = mf_fit_run("run.json", &options);
    mf_interrupt_request(false);
    return status;
}

/// Tasks that this process has begun.
static double count_tasks(void) {
    const struct parallel_times times = mf_parallel_times();
    double tasks = 0;
    for (size_t k = 0; k < times.sizes; k++)
        tasks += times.size[k].done;
    return tasks;
}

/// run.json in one piece, and in pieces.
/// @param[in] again  tasks that fail are done once more in each piece: so many
static void run_in_pieces(const char *name, int again) {
    char whole[32], pieces[32];
    snprintf(whole, sizeof whole, "whole-%s", name);
    snprintf(pieces, sizeof pieces, "pieces-%s", name);
    const double before = count_tasks();
    const enum status status = run(whole, false, 0);
    if (status != STATUS_OK && status != STATUS_UNCONVERGED)
        fail_msg("%s", mf_status_message());
    const double all = count_tasks() - before;
    // Words of what was done before are told, too: patience grows until there is something new.
    int runs = 1;
    enum status now = run(pieces, false, 1);
    for (; now == STATUS_INTERRUPTED; runs++)
        now = run(pieces, true, runs + 1);
    assert_int_equal(now, status);
    const double done = count_tasks() - before - all;
    print_message("%s: %.0f tasks, in %d pieces %.0f\n", whole, all, runs, done);
    assert_true(runs > 3);
    assert_true(done <= all + (1 + again) * runs); // one is begun, and stopped, as the wish comes
    results_assert_same(whole, pieces, tables);
}

static void test_no_task_is_done_twice(void **state) {
    for (int k = 0; k < METHODS; k++) {
        char name[16];
        snprintf(name, sizeof name, "%d", k);
        small_inputs_write(*state, "target.tsv", small_inputs_target, NULL, NULL);
        small_inputs_write(*state, "run.json", small_inputs_run, METHOD, methods[k]);
        small_inputs_change(*state, "run.json", VERIFICATION,
                            "\"verification\": {\"replicas\": 4,");
        run_in_pieces(name, 0);
    }
}

/// A step that is far too long, of dynamics without velocities, whose curvature tells no step.
static void test_verification_with_shorter_and_shorter_steps_comes_to_the_same(void **state) {
    small_inputs_write(*state, "target.tsv", small_inputs_target, NULL, NULL);
    small_inputs_write(*state, "run.json", small_inputs_run, VERIFICATION,
                       "\"verification\": {\"replicas\": 4, \"shorten_time_step\": \"yes\",");
    small_inputs_change(*state, "run.json", "\"equilibration\": 1, \"samples\": 2, ",
                        "\"equilibration\": 20, \"samples\": 40, ");
    small_inputs_change(*state, "run.json", "\"time_step\": 0.02,\n", "\"time_step\": 1,\n");
    small_inputs_change(*state, "run.json", "\"dissipative\": {\"law\": \"power\", \"sigma\": 2}",
                        "\"dynamics\": {\"integrator\": \"brownian\", \"friction\": 1}");
    run_in_pieces("steps", 1);
    const double step = results_number("whole-steps/summary.json", "verification_time_step");
    print_message("time step %g\n", step);
    assert_true(step < 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_no_task_is_done_twice,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(
            test_verification_with_shorter_and_shorter_steps_comes_to_the_same,
            small_inputs_enter_without_gnuplot, small_inputs_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
