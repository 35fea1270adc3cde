// SPDX-License-Identifier: GPL-3.0-or-later
//
// How long work still takes, by clocks that are made up.
#include "report/progress.h"

#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void test_pace_is_unknown_before_the_first_part(void **state) {
    (void)state;
    const struct progress_pace pace = mf_progress_pace_begin(100, 0, 4);
    assert_true(isnan(mf_progress_pace_left(&pace, 105, 0, 10)));
}

/// Ten seconds a part, also where a run before has done 50 of them.
static void test_pace_of_even_parts_is_their_time(void **state) {
    (void)state;
    for (uint64_t before = 0; before <= 50; before += 50) {
        struct progress_pace pace = mf_progress_pace_begin(100, before, 1);
        for (uint64_t k = 1; k <= 20; k++) {
            const double clock = 100 + 10 * (double)k;
            mf_progress_pace_update(&pace, clock, before + k);
            assert_close(mf_progress_pace_left(&pace, clock, before + k, before + 20),
                         200 - 10 * (double)k, 1e-9);
        }
    }
}

/// Eight simulations side by side end together: the time left runs down with the clock, not in
/// jumps as they come in.
static void test_pace_runs_down_inside_a_period(void **state) {
    (void)state;
    struct progress_pace pace = mf_progress_pace_begin(0, 0, 8);
    for (uint64_t period = 1; period <= 2; period++)
        for (uint64_t k = 1; k <= 8; k++)
            mf_progress_pace_update(&pace, 10 * (double)period, 8 * (period - 1) + k);
    assert_close(mf_progress_pace_left(&pace, 20, 16, 40), 30, 1e-9);
    assert_close(mf_progress_pace_left(&pace, 25, 16, 40), 25, 1e-9);
    mf_progress_pace_update(&pace, 29, 17);
    assert_close(mf_progress_pace_left(&pace, 29, 17, 40), 21, 1e-9);
    assert_close(mf_progress_pace_left(&pace, 30, 24, 24), 0, 0);
}

/// A period that takes longer than those before, as one whose samples are doubled, lets the rate
/// age, and the periods after it are taken to be as those before and it together: two of 8 parts in
/// 80 s are 5 s each.
static void test_pace_ages_while_a_period_is_overdue(void **state) {
    (void)state;
    struct progress_pace pace = mf_progress_pace_begin(0, 0, 8);
    for (uint64_t period = 1; period <= 2; period++)
        mf_progress_pace_update(&pace, 10 * (double)period, 8 * period);
    assert_close(mf_progress_pace_rate(&pace, 29.9, 23), 0.8, 1e-9);
    assert_close(mf_progress_pace_rate(&pace, 90, 17), 0.2, 1e-9);
    // Two whole periods, and some of this one, of which 7 parts are to come.
    assert_true(mf_progress_pace_left(&pace, 90, 17, 40) > 2 * 8 * 5);
    assert_true(mf_progress_pace_left(&pace, 90, 17, 40) < 2 * 8 * 5 + 7 * 5);
    assert_true(mf_progress_pace_left(&pace, 90, 23, 24) > 0);
    double before = 1;
    for (double clock = 30; clock < 1000; clock += 10) {
        const double rate = mf_progress_pace_rate(&pace, clock, 23);
        assert_true(rate > 0 && rate < before);
        before = rate;
    }
}

/// Rate and time left are of the same time, so that who multiplies them has what is to be done.
static void test_pace_has_a_rate_that_agrees_with_the_time_left(void **state) {
    (void)state;
    struct progress_pace pace = mf_progress_pace_begin(0, 10, 1);
    assert_close(mf_progress_pace_rate(&pace, 5, 20), 2, 1e-12);
    const double clocks[] = {100, 101, 102, 104, 107};
    for (uint64_t k = 0; k < 5; k++) {
        mf_progress_pace_update(&pace, clocks[k], 11 + k);
        const double rate = mf_progress_pace_rate(&pace, clocks[k], 11 + k);
        assert_close(rate * mf_progress_pace_left(&pace, clocks[k], 11 + k, 40), 29 - (double)k,
                     1e-9);
    }
}

/// The first of ten periods takes ten times as long as the rest.
static void test_pace_forgets_a_slow_beginning(void **state) {
    (void)state;
    struct progress_pace pace = mf_progress_pace_begin(0, 0, 2);
    for (uint64_t period = 1; period <= 4; period++)
        mf_progress_pace_update(&pace, 90 + 10 * (double)period, 2 * period);
    assert_close(mf_progress_pace_left(&pace, 130, 8, 20), 60, 1e-9);
}

static void keep(void *context, const struct watcher_progress *now) {
    *(struct watcher_progress *)context = *now;
}

/// Passes of an iteration, which may be more than one and of other sizes, never take back what is
/// done.
static void test_iterations_go_on_when_their_passes_begin_anew(void **state) {
    (void)state;
    static const struct {
        uint32_t iteration;
        uint64_t done, total, reported;
    } words[] = {{0, 1, 4, 1}, {0, 4, 4, 4}, {0, 1, 4, 4}, {0, 4, 4, 4},
                 {1, 1, 2, 6}, {1, 2, 2, 8}, {2, 1, 8, 8}, {2, 8, 8, 12}};
    struct watcher_progress last = {0};
    const struct watcher watcher = {.context = &last, .report = keep};
    struct progress progress = mf_progress_begin(true, &watcher);
    for (size_t k = 0; k < sizeof words / sizeof *words; k++) {
        const struct inverse_progress now = {.iteration = words[k].iteration,
                                             .iterations = 3,
                                             .done = words[k].done,
                                             .total = words[k].total};
        mf_progress_report_iteration(&progress, &now, "");
        assert_int_equal(last.done, words[k].reported);
        assert_int_equal(last.total, 12);
    }
}

static void test_rates_are_told_as_people_write_them(void **state) {
    (void)state;
    static const struct {
        double rate;
        const char *text;
    } rates[] = {{8.0612, "8.06 steps/s"}, {123456, "123000 steps/s"},   {999.7, "1000 steps/s"},
                 {0.1, "0.1 steps/s"},     {1.0 / 32, "1.88 steps/min"}, {1.0 / 3600, "1 steps/h"},
                 {0, "0 steps/h"}};
    for (size_t k = 0; k < sizeof rates / sizeof *rates; k++) {
        char text[PROGRESS_RATE_SIZE];
        mf_progress_rate_text(rates[k].rate, "steps", text);
        assert_string_equal(text, rates[k].text);
    }
}

/// While samples are doubled nobody is told a time, in the folder neither.
static void test_iteration_that_doubles_its_samples_has_no_time_left(void **state) {
    struct temporary_folder *folder = *state;
    struct watcher_progress last = {0};
    const struct watcher watcher = {.context = &last, .report = keep};
    struct progress progress = mf_progress_begin(true, &watcher);
    struct inverse_progress now = {.iterations = 3, .done = 4, .total = 4};
    progress.folder = folder->path;
    progress.started -= 100;
    for (int number = 0; number <= 1; number++) {
        now.doubling.number = number;
        progress.next = 0;
        mf_progress_report_iteration(&progress, &now, "some");
        char *text = temporary_folder_read(temporary_folder_file(folder, "progress.json"));
        assert_int_equal(strstr(text, "\"left\"") == NULL, number > 0);
        free(text);
        assert_int_equal(last.open, number > 0);
        assert_true(last.rate > 0);
    }
    mf_progress_end(&progress);
}

/// What who looks at the folder reads: numbers that agree with each other, and nothing at the end.
/// What is begun and what has ended say the same where samples are doubled: once in a file.
static void test_line_of_a_file_is_not_repeated(void **state) {
    static const char text[] = "iteration 0  doubling samples, 1 of 9";
    struct progress progress = mf_progress_begin(RUN_SAYS_ALL, NULL);
    const int before = dup(STDERR_FILENO);
    const char *file = temporary_folder_file(*state, "said");
    assert_non_null(freopen(file, "w", stderr));
    progress.terminal = false;
    for (int k = 0; k < 3; k++) {
        mf_progress_report(&progress, 4, 4, "simulations", text);
        progress.last -= 1000; // a long while
    }
    fflush(stderr);
    dup2(before, STDERR_FILENO);
    close(before);
    char *said = temporary_folder_read(file);
    assert_non_null(strstr(said, text));
    assert_null(strstr(strstr(said, text) + 1, text));
    free(said);
}

static void test_progress_is_in_the_folder_until_the_end(void **state) {
    struct temporary_folder *folder = *state;
    struct progress progress = mf_progress_begin(true, NULL);
    mf_progress_end(&progress); // without a folder nothing is removed
    progress.folder = folder->path;
    progress.started -= 100;
    progress.next = 0;
    mf_progress_report(&progress, 25, 100, "steps", "step 25  T \x1b[2J");
    const char *file = temporary_folder_file(folder, "progress.json");
    assert_close(results_number(file, "done"), 25, 0);
    assert_close(results_number(file, "total"), 100, 0);
    assert_close(results_number(file, "rate"), 0.25, 0.05);
    results_assert_text(file, "unit", "steps");
    results_assert_text(file, "text", "step 25  T \x1b[2J");
    mf_progress_end(&progress);
    assert_false(temporary_folder_exists(file));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pace_is_unknown_before_the_first_part),
        cmocka_unit_test(test_pace_of_even_parts_is_their_time),
        cmocka_unit_test(test_pace_runs_down_inside_a_period),
        cmocka_unit_test(test_pace_ages_while_a_period_is_overdue),
        cmocka_unit_test(test_rates_are_told_as_people_write_them),
        cmocka_unit_test(test_pace_has_a_rate_that_agrees_with_the_time_left),
        cmocka_unit_test(test_pace_forgets_a_slow_beginning),
        cmocka_unit_test(test_iterations_go_on_when_their_passes_begin_anew),
        cmocka_unit_test_setup_teardown(test_iteration_that_doubles_its_samples_has_no_time_left,
                                        temporary_folder_create, temporary_folder_remove),
        cmocka_unit_test_setup_teardown(test_line_of_a_file_is_not_repeated,
                                        temporary_folder_create, temporary_folder_remove),
        cmocka_unit_test_setup_teardown(test_progress_is_in_the_folder_until_the_end,
                                        temporary_folder_create, temporary_folder_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
