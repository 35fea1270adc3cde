// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimise/coroutine.h"
#include "shared/is_close.h"
#include "shared/testing.h"

struct story {
    int questions;
    double sum;
    bool was_stopped;
};

/// Asks for 1, 2, 3 … and adds up the answers.
static void body(struct coroutine *self, void *context) {
    struct story *story = context;
    for (int k = 1; k <= story->questions; k++) {
        const double question = k;
        double answer = 0;
        if (!mf_coroutine_measure(self, &question, &answer)) {
            story->was_stopped = true;
            return;
        }
        story->sum += answer;
    }
}

static void test_coroutine_asks_until_its_body_returns(void **state) {
    struct story story = {.questions = 100};
    (void)state;
    struct coroutine *coroutine = mf_coroutine_begin(body, &story);
    assert_non_null(coroutine);
    for (int k = 1; k <= 100; k++) {
        assert_close(*mf_coroutine_question(coroutine), k, 0);
        assert_close(*mf_coroutine_question(coroutine), k, 0);
        mf_coroutine_answer(coroutine, 2 * k);
    }
    assert_null(mf_coroutine_question(coroutine));
    mf_coroutine_answer(coroutine, 1); // nobody listens
    assert_null(mf_coroutine_question(coroutine));
    assert_close(story.sum, 10100, 0);
    mf_coroutine_end(coroutine);
    assert_false(story.was_stopped);
}

static void test_coroutine_end_stops_the_body_wherever_it_is(void **state) {
    (void)state;
    for (int answers = 0; answers <= 4; answers++) {
        struct story story = {.questions = 4};
        struct coroutine *coroutine = mf_coroutine_begin(body, &story);
        assert_non_null(coroutine);
        for (int k = 0; k < answers; k++)
            mf_coroutine_answer(coroutine, 1);
        mf_coroutine_end(coroutine);
        assert_int_equal(story.was_stopped, answers < 4);
        assert_close(story.sum, answers, 0);
    }
    mf_coroutine_end(NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_coroutine_asks_until_its_body_returns),
        cmocka_unit_test(test_coroutine_end_stops_the_body_wherever_it_is),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
