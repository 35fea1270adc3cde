// SPDX-License-Identifier: GPL-3.0-or-later
//
// A process forks while another of its threads works: what the child calls must not wait for a
// thread that it does not have.
#include "base/parallel.h"
#include "base/process_lock.h"

#include "shared/testing.h"

#include <pthread.h>
#include <semaphore.h>
#include <stdbool.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static sem_t inside;

static void stay(void) {
    sem_post(&inside);
    nanosleep(&(const struct timespec){.tv_nsec = 200000000}, NULL);
}

static void *hold(void *context) {
    mf_process_lock();
    stay();
    mf_process_unlock();
    return context;
}

static enum status do_nothing(void *context, size_t task, void *result) {
    (void)context, (void)task, (void)result;
    return STATUS_OK;
}

static void take_long(void *context, size_t task, const void *result) {
    (void)context, (void)task, (void)result;
    stay();
}

static void take_nothing(void *context, size_t task, const void *result) {
    (void)context, (void)task, (void)result;
}

static bool do_one(void (*take)(void *context, size_t task, const void *result)) {
    const struct parallel_tasks tasks = {.count = 1, .threads = 1, .run = do_nothing, .take = take};
    return mf_parallel_try(&tasks) == STATUS_OK;
}

static void *take_its_time(void *context) {
    return do_one(take_long) ? context : NULL;
}

/// Fork while `busy` is at work; whether the child gets through within five seconds.
static void check_child(void *(*busy)(void *)) {
    pthread_t thread;
    int how;
    sem_init(&inside, 0, 0);
    assert_int_equal(pthread_create(&thread, NULL, busy, NULL), 0);
    sem_wait(&inside);
    const pid_t child = fork();
    if (child == 0) {
        alarm(5);
        mf_process_lock();
        mf_process_unlock();
        _exit(do_one(take_nothing) ? 0 : 1);
    }
    assert_int_equal(waitpid(child, &how, 0), child);
    pthread_join(thread, NULL);
    if (WIFSIGNALED(how))
        fail_msg("the child waits for ever");
    assert_int_equal(WEXITSTATUS(how), 0);
}

static void test_child_goes_on_when_a_thread_held_the_lock(void **state) {
    (void)state;
    check_child(hold);
}

static void test_child_goes_on_when_a_thread_took_a_result(void **state) {
    (void)state;
    check_child(take_its_time);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_child_goes_on_when_a_thread_held_the_lock),
        cmocka_unit_test(test_child_goes_on_when_a_thread_took_a_result),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
