// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/verify_step.h"

#include "dynamics/monte_carlo.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

/// Beads that repel each other by Φ = a (1 − r)²/2, of which Φ'' is a = 25 at all r: two of them
/// oscillate with Ω² = 2 a, and Verlet's steps make the temperature of the positions
/// T/(1 − (Ω Δt)²/4).
static struct inverse_problem make(struct fluid *fluid) {
    fluid_groot_warren(fluid, 81, 0.02);
    return (struct inverse_problem){.scene = fluid->setup};
}

static void test_verify_step_of_a_potential_is_that_of_its_oscillation(void **state) {
    (void)state;
    struct fluid fluid;
    const struct inverse_problem problem = make(&fluid);
    const double step = mf_verify_step_of_potential(&problem, &fluid.potential);
    assert_close(1 / (1 - 2 * 25 * step * step / 4), 1.01, 0.002);
    fluid_clear(&fluid);
}

/// Lennard-Jones bends without bound towards r = 0, where no pair comes.
static void test_verify_step_looks_where_pairs_come(void **state) {
    (void)state;
    enum { BINS = 50 };
    struct fluid fluid;
    double g[BINS], error[BINS];
    fluid_lennard_jones(&fluid, 100, 0.005);
    struct inverse_problem problem = {.scene = fluid.setup};
    const double gas = mf_verify_step_of_potential(&problem, &fluid.potential);
    // Pairs from r = 1.1 on: Φ'' = 4 (156/r¹⁴ − 42/r⁸).
    for (int k = 0; k < BINS; k++) {
        g[k] = (k + 0.5) * 0.05 > 1.1;
        error[k] = 0.01;
    }
    problem.compared = (struct targets){
        .bins = {0, 0.05, BINS}, .target[TARGET_RDF] = {.count = BINS, .value = g, .error = error}};
    const double far = mf_verify_step_of_potential(&problem, &fluid.potential);
    const double curvature = 4 * (156 / pow(1.1, 14) - 42 / pow(1.1, 8));
    // The table's spacing of 0.0025 is 3 % of the curvature.
    assert_close(far, sqrt(0.04 / (2 * curvature)), 0.03 * far);
    assert_true(gas < 0.6 * far);
    fluid_clear(&fluid);
}

static void test_verify_step_begins_near_what_the_potential_bears(void **state) {
    (void)state;
    struct fluid fluid;
    struct inverse_problem problem = make(&fluid);
    const double holds = mf_verify_step_of_potential(&problem, &fluid.potential);
    struct verify_step step = mf_verify_step_begin(&problem, &fluid.potential, 1.3 * holds, true);
    assert_identical(step.used, 1.3 * holds);
    step = mf_verify_step_begin(&problem, &fluid.potential, 5 * holds, true);
    assert_identical(step.used, 1.25 * holds);
    assert_int_equal(step.halvings, 2);
    assert_identical(step.first, 5 * holds);
    step = mf_verify_step_begin(&problem, &fluid.potential, 500 * holds, true);
    assert_int_equal(step.halvings, VERIFY_STEP_HALVINGS);
    // What the file gives is never changed, and sweeps have no length.
    step = mf_verify_step_begin(&problem, &fluid.potential, 5 * holds, false);
    assert_identical(step.used, 5 * holds);
    problem.scene.integrator = &mf_monte_carlo;
    step = mf_verify_step_begin(&problem, &fluid.potential, 5 * holds, true);
    assert_identical(step.used, 5 * holds);
    fluid_clear(&fluid);
}

static struct thermodynamics_off off(double share, double error) {
    return (struct thermodynamics_off){true, false, share, error, 0};
}

static struct verify_step begin(bool shortens) {
    return (struct verify_step){
        .used = 0.02, .first = 0.02, .tried = 0.02, .would_hold = 0.004, .shortens = shortens};
}

static void test_verify_step_is_halved_until_the_temperatures_hold(void **state) {
    (void)state;
    struct verify_step step = begin(true);
    const struct thermodynamics_off far = off(0.12, 0.003), near = off(-0.03, 0.003),
                                    good = off(-0.009, 0.003), none = {.known = false};
    assert_true(mf_verify_step_again(&step, &none, true)); // it blew up
    assert_true(mf_verify_step_again(&step, &far, false));
    assert_true(mf_verify_step_again(&step, &near, false));
    assert_false(mf_verify_step_again(&step, &good, false));
    assert_int_equal(step.result, VERIFY_STEP_HOLDS);
    assert_identical(step.used, 0.0025);
    assert_true(step.first_blew_up);
}

/// 1.7 % off is more than 1 %, but may be chance if the error is 0.6 %.
static void test_verify_step_is_tested_by_the_errors(void **state) {
    (void)state;
    struct verify_step step = begin(true);
    const struct thermodynamics_off chance = off(0.017, 0.006), sure = off(0.017, 0.005),
                                    vague = off(0.05, 0.04), none = {.known = false};
    assert_true(mf_verify_step_again(&step, &sure, false));
    step = begin(true);
    assert_false(mf_verify_step_again(&step, &chance, false));
    assert_int_equal(step.result, VERIFY_STEP_HOLDS);
    assert_false(mf_verify_step_again(&step, &none, false));
    assert_int_equal(step.result, VERIFY_STEP_UNKNOWN);
    assert_false(mf_verify_step_again(&step, &vague, false));
    assert_int_equal(step.result, VERIFY_STEP_UNKNOWN);
}

/// What half a step leaves as it was is no error of the step; a quarter is what Δt² leaves.
static void test_verify_step_is_blamed_for_what_a_shorter_one_changes(void **state) {
    (void)state;
    struct verify_step step = begin(true);
    const struct thermodynamics_off before = off(-0.08, 0.002), same = off(-0.079, 0.002),
                                    quarter = off(-0.02, 0.002), wild = off(48, 0);
    assert_true(mf_verify_step_again(&step, &before, false));
    assert_true(mf_verify_step_again(&step, &quarter, false));
    step = begin(true);
    assert_true(mf_verify_step_again(&step, &before, false));
    assert_false(mf_verify_step_again(&step, &same, false));
    assert_int_equal(step.result, VERIFY_STEP_NOT_THE_CAUSE);
    // Steps that are much too long are wrong in any way.
    step = begin(true);
    assert_true(mf_verify_step_again(&step, &wild, false));
    assert_true(mf_verify_step_again(&step, &wild, false));
}

static void test_verify_step_ends_at_a_sixteenth(void **state) {
    (void)state;
    struct verify_step step = begin(true);
    const struct thermodynamics_off none = {.known = false};
    int steps = 1;
    while (mf_verify_step_again(&step, &none, true))
        steps++;
    assert_int_equal(steps, 5);
    assert_identical(step.used, 0.02 / 16);
    assert_int_equal(step.result, VERIFY_STEP_LONG);
}

/// Of an error of 4 % as Δt² half the step leaves 1 %; of one that is too large for that, what the
/// potential's curvature says.
static void test_verify_step_tells_what_would_hold_if_it_is_given(void **state) {
    (void)state;
    struct verify_step step = begin(false);
    const struct thermodynamics_off some = off(-0.09, 0.003), none = {.known = false};
    assert_false(mf_verify_step_again(&step, &some, false));
    assert_int_equal(step.result, VERIFY_STEP_LONG);
    assert_identical(step.used, 0.02);
    assert_close(step.would_hold, 0.02 / 3, 1e-9);
    step = begin(false);
    assert_false(mf_verify_step_again(&step, &none, true));
    assert_close(step.would_hold, 0.004, 1e-12);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_verify_step_of_a_potential_is_that_of_its_oscillation),
        cmocka_unit_test(test_verify_step_looks_where_pairs_come),
        cmocka_unit_test(test_verify_step_begins_near_what_the_potential_bears),
        cmocka_unit_test(test_verify_step_is_halved_until_the_temperatures_hold),
        cmocka_unit_test(test_verify_step_is_tested_by_the_errors),
        cmocka_unit_test(test_verify_step_is_blamed_for_what_a_shorter_one_changes),
        cmocka_unit_test(test_verify_step_ends_at_a_sixteenth),
        cmocka_unit_test(test_verify_step_tells_what_would_hold_if_it_is_given),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
