// SPDX-License-Identifier: GPL-3.0-or-later
//
// When a fit has come to its end.
#include "inversion/inversion.h"

#include "shared/testing.h"

/// A fit of pairs, and perhaps of groups, that agrees with its targets and has settled.
static struct inversion make_end(const struct inverse_problem *problem, size_t groups) {
    return (struct inversion){
        .problem = problem,
        .grid = {.pairs = 1, .groups = groups},
        .sections = 1,
        .section[0] = {.misfit = 1.5, .probable = 2},
        .settling = true,
        .band = {.ramp = {.way = -0.04, .error = 0.1}, .farthest = {.way = 0.4, .open = 1}},
        .progress.best_precise = true};
}

static void test_fit_of_pairs_ends_when_it_agrees_once(void **state) {
    (void)state;
    const struct inverse_problem problem = {0};
    struct inversion inversion = make_end(&problem, 0);
    inversion.section[0].misfit = 2.1;
    assert_false(mf_inversion_has_converged(&inversion, true));
    inversion.section[0].misfit = 1.5;
    assert_false(mf_inversion_has_converged(&inversion, false));
    inversion.band.ramp.way = -0.06;
    assert_false(mf_inversion_has_converged(&inversion, true));
    inversion.band.ramp.way = -0.04;
    inversion.band.farthest.way = 0.9;
    assert_false(mf_inversion_has_converged(&inversion, true));
    inversion.band.farthest.way = 0.4;
    assert_true(mf_inversion_has_converged(&inversion, true));
}

/// A way that is over once may be so by chance; what goes on goes on in one direction.
static void test_fit_with_groups_ends_when_the_ways_of_two_iterations_cancel(void **state) {
    (void)state;
    const struct inverse_problem problem = {0};
    struct inversion inversion = make_end(&problem, 1);
    assert_false(mf_inversion_has_converged(&inversion, true));
    inversion.band.ramp.way = -0.07;
    assert_false(mf_inversion_has_converged(&inversion, true));
    inversion.band.ramp.way = 0.04;
    assert_false(mf_inversion_has_converged(&inversion, false)); // back to the one before
    inversion.section[0].misfit = 2.1;
    assert_false(mf_inversion_has_converged(&inversion, true));
    inversion.section[0].misfit = 1.5;
    inversion.band.ramp.way = -0.2;
    inversion.band.farthest.way = 0.7;
    for (int k = 0; k < 20; k++)
        assert_false(mf_inversion_has_converged(&inversion, true));
    inversion.band.ramp.way = 0.12;
    assert_false(mf_inversion_has_converged(&inversion, true));
    inversion.band.farthest.way = 0.3;
    assert_false(mf_inversion_has_converged(&inversion, true));
    inversion.band.ramp.way = -0.15; // the last two
    assert_true(mf_inversion_has_converged(&inversion, true));
}

/// A pressure among the targets holds what g hardly sees, and groups alone have no ramp.
static void test_fit_with_groups_ends_at_once_where_nothing_must_settle(void **state) {
    (void)state;
    struct inverse_problem problem = {0};
    struct inversion inversion = make_end(&problem, 1);
    inversion.grid.pairs = 0;
    inversion.band.ramp.way = 1;
    assert_true(mf_inversion_has_converged(&inversion, true));
    inversion = make_end(&problem, 1);
    problem.targets.target[TARGET_PRESSURE].count = 1;
    inversion.band.ramp.way = 1;
    assert_true(mf_inversion_has_converged(&inversion, true));
}

/// Each section must agree: a stiff bond with many counts hides nothing of a soft one.
static void test_fit_ends_when_all_sections_agree(void **state) {
    (void)state;
    const struct inverse_problem problem = {0};
    struct inversion inversion = make_end(&problem, 0);
    inversion.sections = 2;
    inversion.section[1] = (struct inversion_section){.misfit = 2.5, .probable = 2.4};
    assert_false(mf_inversion_has_converged(&inversion, true));
    inversion.section[1].misfit = 2.3;
    assert_true(mf_inversion_has_converged(&inversion, true));
}

/// Present samples are off by chance where the mean of three potentials near the target is not.
static void test_fit_that_forgets_ends_when_its_mean_or_its_last_potential_agrees(void **state) {
    (void)state;
    const struct inversion_rule rule = {.forgets = true};
    const struct inverse_method method = {.own = &rule};
    const struct inverse_problem problem = {0};
    size_t known_bin[] = {0};
    bool seen[] = {true};
    double mean[] = {15}, target[] = {10}, pooled[] = {2.8}, variance[] = {4};
    struct inversion inversion = make_end(&problem, 0);
    inversion.method = &method;
    inversion.settling = false;
    inversion.section[0] =
        (struct inversion_section){.misfit = 2.5, .probable = 2, .known_count = 1, .bins = 1};
    inversion.grid.known = 1;
    inversion.grid.known_bin = known_bin;
    inversion.grid.seen = seen;
    inversion.target_counts = target;
    inversion.replicas.counts = (struct comoments){.count = 30, .mean = mean};
    inversion.pooled = pooled;
    inversion.variance = variance;
    inversion.progress.pool = 60;
    assert_false(mf_inversion_has_converged(&inversion, true)); // of two: the present one
    inversion.progress.pool = 90;
    assert_true(mf_inversion_has_converged(&inversion, true));
    pooled[0] = 2.9; // χ² of 2.1
    assert_false(mf_inversion_has_converged(&inversion, true));
    // The mean follows a slow fit at a distance: ibi of soft beads met its target for eight
    // iterations, and its mean, which has less noise, did not.
    inversion.section[0].misfit = 1.5;
    assert_true(mf_inversion_has_converged(&inversion, true));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fit_of_pairs_ends_when_it_agrees_once),
        cmocka_unit_test(test_fit_with_groups_ends_when_the_ways_of_two_iterations_cancel),
        cmocka_unit_test(test_fit_with_groups_ends_at_once_where_nothing_must_settle),
        cmocka_unit_test(test_fit_ends_when_all_sections_agree),
        cmocka_unit_test(test_fit_that_forgets_ends_when_its_mean_or_its_last_potential_agrees),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
