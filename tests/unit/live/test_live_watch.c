// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the page is told of a run's progress.
#include "live/live_watch.h"
#include "shared/testing.h"

#include <stdlib.h>

/// The event of a fit that has done 2 of 10 at 4 a second.
static void assert_tells(bool open, const char *words) {
    static struct live_view view;
    struct live_watch watch;
    uint64_t seen = 0;
    assert_ok(mf_live_view_init(&view, "{}", false));
    mf_live_watch_init(&watch, &view);
    watch.watcher.report(&watch, &(struct watcher_progress){.done = 2,
                                                            .total = 10,
                                                            .unit = "simulations",
                                                            .text = "some",
                                                            .rate = 4,
                                                            .open = open});
    char *events = mf_live_feed_wait(&view.feed, &seen, 1);
    assert_contains(events, "event: progress");
    assert_contains(events, words);
    free(events);
    mf_live_watch_clear(&watch);
    mf_live_view_clear(&view);
}

static void test_progress_has_a_time_left_unless_nobody_knows_it(void **state) {
    (void)state;
    assert_tells(false, "\"left\":\t2\n");
    assert_tells(true, "\"left\":\tnull\n");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_progress_has_a_time_left_unless_nobody_knows_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
