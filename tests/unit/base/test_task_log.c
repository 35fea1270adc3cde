// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tasks that stop, and go on from what those before have left.
#include "base/task_log.h"
#include "shared/testing.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { TASKS = 20, CALLS = 3, MAX = 8 };

/// Work of a few calls, each of whose tasks leaves a result and an array of its own length.
struct work {
    int max; ///< tasks that may be done before it stops
    int runs, call;
    size_t length[TASKS];
    double array[TASKS][MAX], result[CALLS][TASKS], sum[CALLS];
};

static enum status run(void *context, size_t task, void *result) {
    struct work *work = context;
    bool may;
#pragma omp critical(count)
    may = work->runs++ < work->max;
    if (!may)
        return mf_status_fail(STATUS_INTERRUPTED, "interrupted");
    work->length[task] = 1 + (task + (size_t)work->call) % MAX;
    for (size_t k = 0; k < work->length[task]; k++)
        work->array[task][k] = sin((double)(task * MAX + k + 100 * (size_t)work->call));
    *(double *)result = cos((double)task) + work->call;
    return STATUS_OK;
}

static void take(void *context, size_t task, const void *result) {
    struct work *work = context;
    work->result[work->call][task] = *(const double *)result;
}

static size_t spans(void *context, size_t task, struct memory_span *span) {
    struct work *work = context;
    span[0] = (struct memory_span){&work->length[task], sizeof work->length[task]};
    span[1] = (struct memory_span){work->array[task], work->length[task] * sizeof(double)};
    return 2;
}

/// Each call has tasks by what the one before has left.
static enum status do_all(struct work *work, int threads) {
    size_t count = TASKS;
    for (work->call = 0; work->call < CALLS; work->call++) {
        TRY(mf_parallel_try(&(struct parallel_tasks){.count = count,
                                                     .threads = threads,
                                                     .run = run,
                                                     .take = take,
                                                     .result_size = sizeof(double),
                                                     .context = work,
                                                     .spans = spans}));
        work->sum[work->call] = 0;
        for (size_t task = 0; task < count; task++)
            for (size_t k = 0; k < work->length[task]; k++)
                work->sum[work->call] += work->array[task][k] * work->result[work->call][task];
        count = TASKS - (work->sum[work->call] > 0);
    }
    return STATUS_OK;
}

/// A checkpoint: the log comes into another process.
static void move(struct task_log *log) {
    struct task_log moved = {.size = log->size};
    struct memory_span from[TASK_LOG_SPANS], to[TASK_LOG_SPANS];
    assert_ok(mf_task_log_reserve(&moved));
    assert_int_equal(mf_task_log_spans(log, from), TASK_LOG_SPANS);
    mf_task_log_spans(&moved, to);
    assert_int_equal(from[1].bytes, to[1].bytes);
    if (from[1].bytes > 0)
        memcpy(to[1].memory, from[1].memory, from[1].bytes);
    mf_task_log_clear(log);
    *log = moved;
}

static void test_finished_tasks_are_not_done_again(void **state) {
    static struct work whole, pieces;
    (void)state;
    memset(&whole, 0, sizeof whole);
    whole.max = 1000;
    assert_ok(do_all(&whole, 1));
    for (int threads = 1; threads <= 3; threads++)
        for (int max = 1; max < 30; max += 7) {
            struct task_log log = {0};
            int done = 0, begun = 0;
            enum status status = STATUS_INTERRUPTED;
            for (; status == STATUS_INTERRUPTED; begun++) {
                assert_true(begun < 100);
                memset(&pieces, 0, sizeof pieces); // the state before
                pieces.max = max;
                mf_task_log_use(&log);
                status = do_all(&pieces, threads);
                mf_task_log_use(NULL);
                done += pieces.runs < max ? pieces.runs : max;
                move(&log);
            }
            assert_ok(status);
            assert_int_equal(done, whole.runs);
            assert_int_equal(begun, (whole.runs + max - 1) / max);
            assert_memory_equal(pieces.sum, whole.sum, sizeof whole.sum);
            assert_memory_equal(pieces.result, whole.result, sizeof whole.result);
            mf_task_log_clear(&log);
        }
}

static void test_records_of_other_tasks_are_refused(void **state) {
    static struct work work;
    struct task_log log = {0};
    (void)state;
    work.max = 1000;
    mf_task_log_use(&log);
    assert_ok(do_all(&work, 1));
    mf_task_log_use(&log);
    const struct parallel_tasks few = {
        .count = 3, .threads = 1, .run = run, .context = &work, .result_size = 8, .spans = spans};
    assert_fails(mf_parallel_try(&few), STATUS_BAD_INPUT, "belongs to another fit");
    mf_task_log_use(NULL);
    mf_task_log_clear(&log);
}

static void test_an_image_stays_as_it_was(void **state) {
    double a[5] = {1, 2, 3, 4, 5};
    char b[3] = "ab";
    const struct memory_span spans_of[] = {{a, sizeof a}, {NULL, 0}, {b, sizeof b}};
    struct memory_image image = {0};
    (void)state;
    for (int k = 0; k < 2; k++) {
        a[4] = k;
        assert_ok(mf_memory_image_take(&image, spans_of, 3));
        a[4] = 9;
        assert_int_equal(image.count, 3);
        assert_true(((const double *)image.span[0].memory)[4] == k);
        assert_int_equal(image.span[1].bytes, 0);
        assert_memory_equal(image.span[2].memory, "ab", 3);
    }
    mf_memory_image_clear(&image);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_finished_tasks_are_not_done_again),
        cmocka_unit_test(test_records_of_other_tasks_are_refused),
        cmocka_unit_test(test_an_image_stays_as_it_was),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
