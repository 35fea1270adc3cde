// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel.h"

#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

enum { COUNT = 100003 };
static double values[COUNT];
static int visits[COUNT];

static void visit(void *context, size_t begin, size_t end) {
    (void)context;
    for (size_t k = begin; k < end; k++)
        visits[k]++;
}

static double add_up(const void *context, size_t begin, size_t end) {
    const double *value = context;
    double sum = 0;
    for (size_t k = begin; k < end; k++)
        sum += value[k];
    return sum;
}

static void test_parallel_for_visits_each_element_once_when_threads_are_many(void **state) {
    (void)state;
    for (int threads = 1; threads <= 5; threads++)
        mf_parallel_for(COUNT, threads, visit, NULL);
    for (size_t k = 0; k < COUNT; k++)
        assert_int_equal(visits[k], 5);
}

/// What each place of a ring was touched by: first and second.
enum { RING_PLACES = 64 };
struct touches {
    int parts;
    int count[RING_PLACES], part[RING_PLACES][2];
};

static void touch(struct touches *touches, int place, int part) {
    const int n = touches->count[place]++;
    if (n < 2)
        touches->part[place][n] = part;
}

/// Works longer on the first parts: on those whoever comes after has to wait.
static void touch_both(void *context, int part) {
    struct touches *touches = context;
    volatile double sum = 0;
    touch(touches, part, part);
    for (int k = 0; k < (part < 3 ? 200000 : 2000); k++)
        sum += k;
    touch(touches, (part + 1) % touches->parts, part);
}

static void test_parallel_ring_touches_all_places_in_one_order_for_any_threads(void **state) {
    (void)state;
    for (int threads = 1; threads <= 5; threads++)
        for (int parts = 4; parts <= RING_PLACES; parts += 6) {
            struct touches touches = {.parts = parts};
            mf_parallel_ring(parts, threads, touch_both, &touches);
            for (int place = 0; place < parts; place++) {
                const int before = (place + parts - 1) % parts, even = place % 2 ? before : place;
                assert_int_equal(touches.count[place], 2);
                assert_int_equal(touches.part[place][0], even);
                assert_int_equal(touches.part[place][1], place + before - even);
            }
        }
}

static void count_part(void *context, int part) {
    int *const calls = context;
    calls[part]++;
}

static void test_parallel_parts_are_each_done_once(void **state) {
    enum { PARTS = 9 };
    (void)state;
    for (int threads = 0; threads <= 5; threads++)
        for (int parts = 0; parts <= PARTS; parts++) {
            int calls[PARTS] = {0};
            mf_parallel_parts(parts, threads, count_part, calls);
            for (int part = 0; part < PARTS; part++)
                assert_int_equal(calls[part], part < parts);
        }
}

static void test_parallel_sum_has_the_same_bits_for_any_threads(void **state) {
    (void)state;
    for (size_t k = 0; k < COUNT; k++)
        values[k] = sin((double)k) * exp(10 * cos(3.0 * (double)k));
    for (size_t count = 0; count <= COUNT; count = 3 * count + 1) {
        const double one = mf_parallel_sum(count, 1, add_up, values);
        assert_close(one, add_up(values, 0, count), 1e-6);
        for (int threads = 2; threads <= 5; threads++)
            assert_identical(mf_parallel_sum(count, threads, add_up, values), one);
    }
}

enum { TASKS = 40 };

/// Tasks that fail with what `fails` says, and what was seen of them.
struct trial {
    enum status fails[TASKS];
    int runs[TASKS], taken[TASKS];
    int inside; ///< threads in `take` now
    bool crowded;
    double found[TASKS];
};

static enum status run_task(void *context, size_t task, void *result) {
    struct trial *trial = context;
    double value = sin((double)task);
    for (int k = 0; k < 1000 * (int)(task % 7); k++) // of different lengths
        value = cos(value + (double)k);
    *(double *)result += value;
    trial->runs[task]++;
    return trial->fails[task] ? mf_status_fail(trial->fails[task], "task %zu failed", task)
                              : STATUS_OK;
}

static void take_task(void *context, size_t task, const void *result) {
    struct trial *trial = context;
    int others;
#pragma omp atomic capture
    others = trial->inside++;
    trial->crowded |= others > 0;
    trial->taken[task]++;
    trial->found[task] = *(const double *)result;
#pragma omp atomic
    trial->inside--;
}

static enum status try_tasks(struct trial *trial, int threads) {
    return mf_parallel_try(&(struct parallel_tasks){.count = TASKS,
                                                    .threads = threads,
                                                    .run = run_task,
                                                    .take = take_task,
                                                    .result_size = sizeof(double),
                                                    .context = trial});
}

static void test_parallel_try_takes_each_result_once_and_from_one_thread_at_a_time(void **state) {
    (void)state;
    struct trial one = {0};
    assert_int_equal(try_tasks(&one, 1), STATUS_OK);
    for (int threads = 2; threads <= 4; threads++) {
        struct trial many = {0};
        assert_int_equal(try_tasks(&many, threads), STATUS_OK);
        assert_false(many.crowded);
        for (int k = 0; k < TASKS; k++) {
            assert_int_equal(many.runs[k], 1);
            assert_int_equal(many.taken[k], 1);
            assert_identical(many.found[k], one.found[k]);
        }
    }
}

static void
test_parallel_try_returns_the_failure_of_the_lowest_task_with_its_message(void **state) {
    (void)state;
    bool stopped = false;
    for (int round = 0; round < 50; round++)
        for (int threads = 1; threads <= 3; threads++) {
            struct trial trial = {0};
            // The long task 13 ends after the short one that also fails.
            trial.fails[13] = STATUS_UNSTABLE;
            trial.fails[14] = STATUS_NO_MEMORY;
            trial.fails[30] = STATUS_BAD_INPUT;
            assert_int_equal(try_tasks(&trial, threads), STATUS_UNSTABLE);
            assert_string_equal(mf_status_message(), "task 13 failed");
            for (int k = 0; k < 13; k++)
                assert_int_equal(trial.taken[k], 1);
            assert_int_equal(trial.taken[13], 0);
            // A thread that fails may be kept waiting until the others have done all the rest.
            stopped = stopped || (threads > 1 && trial.runs[TASKS - 1] == 0);
            assert_true(threads > 1 || trial.runs[TASKS - 1] == 0);
        }
    assert_true(stopped);
}

static void test_parallel_try_begins_nothing_more_when_a_task_was_interrupted(void **state) {
    (void)state;
    for (int threads = 1; threads <= 3; threads++) {
        bool stopped = false;
        // A thread that fails may be kept waiting until the others have done all the rest.
        for (int round = 0; round < (threads > 1 ? 50 : 1); round++) {
            struct trial trial = {.fails = {[7] = STATUS_INTERRUPTED}};
            assert_int_equal(try_tasks(&trial, threads), STATUS_INTERRUPTED);
            stopped = stopped || trial.runs[TASKS - 1] == 0;
            for (int k = 0; k < TASKS; k++)
                assert_int_equal(trial.taken[k], trial.runs[k] && k != 7);
        }
        assert_true(stopped);
    }
}

static void test_parallel_try_puts_an_interruption_before_other_failures(void **state) {
    (void)state;
    for (int threads = 1; threads <= 3; threads++) {
        // The short task 7 mostly ends before the long one.
        struct trial trial = {.fails = {[6] = STATUS_UNSTABLE, [7] = STATUS_INTERRUPTED}};
        const enum status status = try_tasks(&trial, threads);
        assert_int_equal(status, trial.runs[7] ? STATUS_INTERRUPTED : STATUS_UNSTABLE);
        assert_string_equal(mf_status_message(), trial.runs[7] ? "task 7 failed" : "task 6 failed");
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_parallel_for_visits_each_element_once_when_threads_are_many),
        cmocka_unit_test(test_parallel_ring_touches_all_places_in_one_order_for_any_threads),
        cmocka_unit_test(test_parallel_parts_are_each_done_once),
        cmocka_unit_test(test_parallel_sum_has_the_same_bits_for_any_threads),
        cmocka_unit_test(test_parallel_try_takes_each_result_once_and_from_one_thread_at_a_time),
        cmocka_unit_test(test_parallel_try_returns_the_failure_of_the_lowest_task_with_its_message),
        cmocka_unit_test(test_parallel_try_begins_nothing_more_when_a_task_was_interrupted),
        cmocka_unit_test(test_parallel_try_puts_an_interruption_before_other_failures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
