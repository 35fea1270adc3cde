// SPDX-License-Identifier: GPL-3.0-or-later
//
// What is published, and what is wished.
#include "base/clock.h"
#include "base/interrupt.h"
#include "live/live_feed.h"
#include "shared/testing.h"

#include <stdlib.h>

static struct live_feed feed;

static int open_feed(void **state) {
    (void)state;
    return mf_live_feed_init(&feed);
}

static int clear_feed(void **state) {
    (void)state;
    mf_live_feed_clear(&feed);
    return 0;
}

static void test_listener_gets_the_newest_of_each_once(void **state) {
    uint64_t seen = 0;
    (void)state;
    mf_live_feed_push(&feed, LIVE_LOG, "one");
    mf_live_feed_push(&feed, LIVE_LOG, "two\nlines");
    mf_live_feed_push(&feed, LIVE_STATE, "{}");
    char *events = mf_live_feed_wait(&feed, &seen, 1);
    // As section 9.2.6 of the HTML standard reads a stream: a line "data" for each line.
    assert_string_equal(events, "event: state\ndata: {}\n\nevent: log\ndata: two\ndata: lines\n\n");
    free(events);
    events = mf_live_feed_wait(&feed, &seen, 0);
    assert_int_equal(events[0], ':');
    free(events);
    mf_live_feed_push(&feed, LIVE_LOG, "three");
    events = mf_live_feed_wait(&feed, &seen, 1);
    assert_string_equal(events, "event: log\ndata: three\n\n");
    free(events);
}

/// What a listener waits that is not woken [s]; half of it passes on no machine, however busy.
static const double patience = 600;

static void *publish_late(void *context) {
    (void)context;
    nanosleep(&(struct timespec){.tv_nsec = 100000000}, NULL);
    mf_live_feed_push(&feed, LIVE_PROGRESS, "{}");
    return NULL;
}

static void test_listener_is_woken_by_news_and_by_the_end(void **state) {
    uint64_t seen = 0;
    pthread_t thread;
    (void)state;
    const double begun = clock_seconds();
    pthread_create(&thread, NULL, publish_late, NULL);
    char *events = mf_live_feed_wait(&feed, &seen, patience);
    assert_true(clock_seconds() - begun < patience / 2);
    assert_contains(events, "event: progress");
    free(events);
    pthread_join(thread, NULL);
    mf_live_feed_close(&feed);
    assert_null(mf_live_feed_wait(&feed, &seen, patience));
    assert_true(clock_seconds() - begun < patience / 2);
}

static void test_particles_are_wanted_for_a_second_and_given_once(void **state) {
    struct live_bytes bytes = {.bytes = malloc(4), .size = 4, .capacity = 4};
    (void)state;
    assert_false(mf_live_feed_wants_particles(&feed));
    struct live_bytes got = mf_live_feed_get_particles(&feed, 0, false);
    assert_int_equal(got.size, 0);
    assert_true(mf_live_feed_wants_particles(&feed));
    assert_false(mf_live_feed_wants_energies(&feed));
    memcpy(bytes.bytes, "abc", 4);
    mf_live_feed_push_particles(&feed, &bytes);
    assert_null(bytes.bytes);
    got = mf_live_feed_get_particles(&feed, 0, false);
    assert_string_equal((const char *)got.bytes, "abc");
    free(got.bytes);
    assert_int_equal(mf_live_feed_get_particles(&feed, got.serial, true).size, 0);
    assert_true(mf_live_feed_wants_energies(&feed));
}

static void test_pause_steps_and_stop_are_obeyed(void **state) {
    struct live_control control;
    struct live_order order = {.file = "a"};
    (void)state;
    assert_ok(mf_live_control_init(&control));
    assert_false(mf_live_control_wait(&control).paused);
    mf_live_control_pause(&control, true);
    assert_true(mf_live_control_wait(&control).paused);
    mf_live_control_step(&control, 2);
    assert_true(mf_live_control_wait(&control).stepping);
    assert_true(mf_live_control_wait(&control).stepping);
    assert_true(mf_live_control_wait(&control).paused);
    mf_live_control_stop(&control); // there is nothing to be stopped
    assert_false(mf_interrupt_requested());
    mf_live_control_order(&control, &order);
    mf_live_control_stop(&control);
    assert_false(mf_live_control_wait(&control).paused);
    assert_true(mf_interrupt_requested());
    mf_live_control_reset(&control);
    assert_false(mf_interrupt_requested());
    mf_live_control_clear(&control);
}

static void test_order_is_taken_once(void **state) {
    struct live_control control;
    struct live_order order = {.file = "a", .text = strdup("text")}, taken;
    (void)state;
    assert_ok(mf_live_control_init(&control));
    mf_live_control_order(&control, &order);
    assert_null(order.text);
    assert_true(mf_live_control_take(&control, &taken));
    assert_string_equal(taken.text, "text");
    free(taken.text);
    assert_false(mf_live_control_take(&control, &taken));
    mf_live_control_clear(&control);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_listener_gets_the_newest_of_each_once, open_feed,
                                        clear_feed),
        cmocka_unit_test_setup_teardown(test_listener_is_woken_by_news_and_by_the_end, open_feed,
                                        clear_feed),
        cmocka_unit_test_setup_teardown(test_particles_are_wanted_for_a_second_and_given_once,
                                        open_feed, clear_feed),
        cmocka_unit_test(test_pause_steps_and_stop_are_obeyed),
        cmocka_unit_test(test_order_is_taken_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
