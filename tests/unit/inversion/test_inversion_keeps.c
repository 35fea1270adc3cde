// SPDX-License-Identifier: GPL-3.0-or-later
//
// Which potentials an inversion goes on from.
#include "inversion/inversion.h"

#include "shared/testing.h"

#include <math.h>

/// An inversion to g(r), and perhaps a pressure, that has no potential yet.
static void begin(struct inversion *inversion, struct inverse_problem *problem, bool pressure) {
    *problem = (struct inverse_problem){
        .targets.target = {[TARGET_RDF].count = 10, [TARGET_PRESSURE].count = pressure}};
    *inversion = (struct inversion){.problem = problem};
    inversion->progress.best[TARGET_RDF].rms = INFINITY;
}

/// Samples say that g is this far off; what is kept becomes the best, as in an iteration.
static bool keeps(struct inversion *inversion, double rms, double noise) {
    inversion->distance[TARGET_RDF] = (struct target_distance){.rms = rms, .noise = noise};
    const bool kept = mf_inversion_keeps(inversion);
    if (kept)
        memcpy(inversion->progress.best, inversion->distance, sizeof inversion->progress.best);
    return kept;
}

static void test_inversion_keeps_what_is_worse_by_chance(void **state) {
    (void)state;
    struct inversion inversion;
    struct inverse_problem problem;
    begin(&inversion, &problem, false);
    assert_true(keeps(&inversion, 0.2, 0.01));
    assert_true(keeps(&inversion, 0.1, 0.01));
    assert_true(keeps(&inversion, 0.119, 0.01));
    assert_true(keeps(&inversion, 0.119, 0.01));
    assert_false(keeps(&inversion, 0.121, 0.01));
    // An error of noise alone is kept.
    assert_true(keeps(&inversion, 0.001, 0.002));
    assert_true(keeps(&inversion, 0.0049, 0.002));
}

/// Samples end where their noise is a third of the error: each potential 1.6 times as far off as
/// the one before is within two noises of it.
static void test_inversion_keeps_no_slow_divergence(void **state) {
    (void)state;
    struct inversion inversion;
    struct inverse_problem problem;
    begin(&inversion, &problem, false);
    double error = 0.01;
    int kept = 0;
    for (; kept < 20 && keeps(&inversion, error, error / 3); kept++)
        error *= 1.6;
    assert_in_range(kept, 1, 3);
    assert_true(inversion.progress.best[TARGET_RDF].rms <= 3 * 0.01);
    assert_true(inversion.progress.least[TARGET_RDF].rms == 0.01);
}

/// Several targets count in units of their noise; a new start begins anew.
static void test_inversion_keeps_by_all_targets_since_its_start(void **state) {
    (void)state;
    struct inversion inversion;
    struct inverse_problem problem;
    begin(&inversion, &problem, true);
    inversion.distance[TARGET_PRESSURE] = (struct target_distance){.rms = 1, .noise = 1};
    assert_true(keeps(&inversion, 0.01, 0.01));
    inversion.distance[TARGET_PRESSURE].rms = 3.1;
    assert_true(keeps(&inversion, 0.01, 0.01)); // sqrt(1 + 9.6) of sqrt(2) + 2
    inversion.distance[TARGET_PRESSURE].rms = 3.4;
    assert_false(keeps(&inversion, 0.01, 0.01));
    inversion.progress.best[TARGET_RDF].rms = INFINITY;
    assert_true(keeps(&inversion, 0.5, 0.01));
    assert_false(keeps(&inversion, 0.6, 0.01));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_inversion_keeps_what_is_worse_by_chance),
        cmocka_unit_test(test_inversion_keeps_no_slow_divergence),
        cmocka_unit_test(test_inversion_keeps_by_all_targets_since_its_start),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
