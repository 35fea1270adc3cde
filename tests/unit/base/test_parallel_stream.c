// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tasks that come one by one. One of them waits here until others have ended, so that no order is
// left to the machine.
#include "base/parallel_stream.h"

#include "shared/testing.h"

#include <stdatomic.h>
#include <time.h>

enum { WAITS = 1000, FAILS = 2000 };

struct gate {
    atomic_bool open;
};

static enum status square(void *context, const void *task, void *result) {
    struct gate *gate = context;
    const int number = *(const int *)task;
    assert_int_equal(*(const int *)result, 0);
    while (number == WAITS && !atomic_load(&gate->open))
        nanosleep(&(struct timespec){.tv_nsec = 100000}, NULL);
    if (number == FAILS)
        return mf_status_fail(STATUS_INTERRUPTED, "task %d failed", number);
    *(int *)result = number * number;
    return STATUS_OK;
}

static struct parallel_stream *begin(struct gate *gate, int threads) {
    struct parallel_stream *stream;
    assert_ok(mf_parallel_stream_begin(&stream,
                                       &(struct parallel_stream_tasks){.threads = threads,
                                                                       .task_size = sizeof(int),
                                                                       .result_size = sizeof(int),
                                                                       .run = square,
                                                                       .context = gate}));
    return stream;
}

/// Take the square of a task, and return the task; −1 if there was none.
static int take(struct parallel_stream *stream) {
    struct parallel_stream_result taken;
    assert_ok(mf_parallel_stream_take(stream, &taken));
    if (taken.task == NULL)
        return -1;
    const int number = *(const int *)taken.task;
    assert_int_equal(*(const int *)taken.result, number * number);
    return number;
}

static void give(struct parallel_stream *stream, int number) {
    assert_true(mf_parallel_stream_has_idle(stream));
    mf_parallel_stream_give(stream, &number);
}

static void test_parallel_stream_does_each_task_once_when_threads_are_many(void **state) {
    enum { TASKS = 500 };
    (void)state;
    for (int threads = 1; threads <= 5; threads++) {
        struct gate gate = {false};
        struct parallel_stream *stream = begin(&gate, threads);
        int seen[TASKS] = {0}, given = 0;
        for (int left = TASKS; left > 0; left--) {
            while (given < TASKS && mf_parallel_stream_has_idle(stream))
                give(stream, given++);
            seen[take(stream)]++;
        }
        for (int k = 0; k < TASKS; k++)
            assert_int_equal(seen[k], 1);
        assert_int_equal(take(stream), -1);
        mf_parallel_stream_end(stream);
    }
}

static void test_parallel_stream_keeps_nobody_waiting_when_a_task_is_long(void **state) {
    struct gate gate = {false};
    struct parallel_stream *stream = begin(&gate, 2);
    (void)state;
    give(stream, WAITS);
    for (int k = 0; k < 20; k++) {
        give(stream, k);
        assert_false(mf_parallel_stream_has_idle(stream));
        assert_int_equal(take(stream), k);
    }
    atomic_store(&gate.open, true);
    assert_int_equal(take(stream), WAITS);
    mf_parallel_stream_end(stream);
}

static void test_parallel_stream_tells_a_failure_and_goes_on(void **state) {
    struct gate gate = {false};
    struct parallel_stream *stream = begin(&gate, 1);
    struct parallel_stream_result taken;
    (void)state;
    give(stream, FAILS);
    assert_int_equal(mf_parallel_stream_take(stream, &taken), STATUS_INTERRUPTED);
    assert_string_equal(mf_status_message(), "task 2000 failed");
    give(stream, 3);
    assert_int_equal(take(stream), 3);
    mf_parallel_stream_end(stream);
}

static void test_parallel_stream_ends_when_tasks_are_left(void **state) {
    struct gate gate = {true};
    struct parallel_stream *stream = begin(&gate, 3);
    (void)state;
    give(stream, WAITS);
    give(stream, 5);
    mf_parallel_stream_end(stream);
    mf_parallel_stream_end(NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_parallel_stream_does_each_task_once_when_threads_are_many),
        cmocka_unit_test(test_parallel_stream_keeps_nobody_waiting_when_a_task_is_long),
        cmocka_unit_test(test_parallel_stream_tells_a_failure_and_goes_on),
        cmocka_unit_test(test_parallel_stream_ends_when_tasks_are_left),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
