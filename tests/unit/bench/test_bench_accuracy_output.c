// SPDX-License-Identifier: GPL-3.0-or-later
//
// The table for people and its recommendation.
#include "bench/bench_accuracy_output.h"

#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>

static char *print(const struct bench_diagram *diagram) {
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    assert_non_null(stream);
    mf_bench_accuracy_table(stream, diagram);
    assert_int_equal(fclose(stream), 0);
    return text;
}

static void test_cheapest_limit_is_recommended_with_its_gain(void **state) {
    (void)state;
    const char *const names[] = {"dpd-verlet(0.5)", "shardlow", "aboba"};
    const struct bench_row row = {.method = names[0], .value = {[BENCH_TIME_STEP] = 0.01}};
    const struct bench_limit limit[] = {{names[0], 0.03, 0.001, 0.006, 0.0003, true},
                                        {NULL, 0, 0, 0, 0, false},
                                        {names[2], 0.06, 0.002, 0.003, 0.0001, false}};
    struct bench_diagram diagram = {.scene = "small",
                                    .particles = 81,
                                    .wanted = 0.005,
                                    .row = &row,
                                    .rows = 1,
                                    .reference = row,
                                    .limit = limit,
                                    .method = names,
                                    .methods = 3,
                                    .has_omega = true};
    assert_int_equal(mf_bench_cheapest(&diagram), 2);
    char *text = print(&diagram);
    assert_contains(text, "for |dg| <= 0.005 take aboba with a time step of 0.06 tau: 3 ms/tau, "
                          "2.00(12) times less than dpd-verlet(0.5) at 0.03 tau\n");
    assert_contains(text, "shardlow          none\n");
    assert_contains(text, "(the largest that was run and is stable)");
    free(text);
    diagram.methods = 0;
    text = print(&diagram);
    assert_contains(text, "no time step here has |dg| <= 0.005 for certain");
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cheapest_limit_is_recommended_with_its_gain),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
