// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion.h"

#include "shared/testing.h"

#include <math.h>
#include <string.h>

/// A fit of g(r), perhaps with a pressure, that ended with this error.
static struct inversion make_inversion(struct inverse_problem *problem, double rms, bool pressure) {
    static const double target = 5;
    *problem = (struct inverse_problem){0};
    problem->targets.target[TARGET_RDF].count = 1;
    problem->targets.target[TARGET_PRESSURE] =
        (struct target){.count = pressure, .value = &target, .error = &target};
    return (struct inversion){
        .problem = problem,
        .method = &mf_imc,
        .settings.common = {.iterations = 30, .precision = 0.002},
        .progress = {.damping = 1,
                     .best[TARGET_RDF] = {.rms = rms, .noise = 0.003},
                     .best[TARGET_PRESSURE] = {.rms = 2, .noise = 0.1},
                     .best_own_noise = 0.0025,
                     .best_worst = {.misfit = pow(rms / 0.003, 2), .probable = 2},
                     .first_error = 0.11,
                     .second_error = 0.08}};
}

static void assert_says(const struct inversion *inversion, const char *words) {
    char reason[INVERSE_REASON_SIZE];
    mf_inversion_reason_tell(inversion, reason);
    assert_contains(reason, words);
    assert_true(strlen(reason) + 1 < INVERSE_REASON_SIZE);
}

static void test_inversion_reason_is_the_start_when_no_step_from_it_helped(void **state) {
    (void)state;
    struct inverse_problem problem;
    struct inversion inversion = make_inversion(&problem, 0.11, false);
    inversion.progress.second_error = 0.83;
    inversion.progress.damping = 1.0 / 128;
    assert_says(&inversion, "rose from 0.11 to 0.83 with the first step");
    assert_says(&inversion, "outside the basin of \"imc\"");
}

static void test_inversion_reason_is_not_the_start_when_shorter_steps_helped(void **state) {
    (void)state;
    struct inverse_problem problem;
    struct inversion inversion = make_inversion(&problem, 0.05, false);
    inversion.progress.second_error = 0.83;
    assert_says(&inversion, "after 30 iterations the error of g is 0.05, from 0.11 at first");
    inversion.progress.damping = 1.0 / 128;
    assert_says(&inversion, "shrunk to 1/128 without progress: the error of g is 0.05, its "
                            "statistical error 0.003");
}

static void test_inversion_reason_of_a_stuck_mixture_advises_a_shorter_cutoff(void **state) {
    (void)state;
    struct inverse_problem problem;
    struct inversion inversion = make_inversion(&problem, 0.265, false);
    inversion.progress.damping = 1.0 / 128;
    problem.scene.composition = mf_composition_of_one(100);
    assert_says(&inversion, "without progress");
    problem.scene.composition.types = 2;
    assert_says(&inversion, "a shorter \"cutoff\"");
}

static void test_inversion_reason_is_the_precision_when_the_curves_agree(void **state) {
    (void)state;
    struct inverse_problem problem;
    const struct inversion inversion = make_inversion(&problem, 0.004, false);
    assert_says(&inversion,
                "within a statistical error of 0.0025, but \"precision\" asks for 0.002");
}

static void test_inversion_reason_is_the_pressure_when_only_that_is_off(void **state) {
    (void)state;
    struct inverse_problem problem;
    struct inversion inversion = make_inversion(&problem, 0.004, true);
    assert_says(&inversion, "the pressure is 2 off, with an error of 0.1");
    inversion.progress.best[TARGET_PRESSURE].rms = 0.1;
    assert_says(&inversion, "\"precision\"");
}

/// As long as more samples may be taken, what they are is no reason.
static void test_inversion_reason_is_what_has_not_settled(void **state) {
    (void)state;
    struct inverse_problem problem;
    struct inversion inversion = make_inversion(&problem, 0.3, false);
    inversion.progress.unsettled = (struct inversion_unsettled){
        .found = true,
        .for_long = true,
        .quantity = "R_g^2 of the molecules",
        .sweeps = 52800,
        .is = {.drift = 0.3, .memory = 1e-9, .drift_ratio = 2, .memory_ratio = 25}};
    assert_says(&inversion, "not in equilibrium after 52800 sweeps of each replica: R_g^2 of the "
                            "molecules differs between replicas, 5 times as much");
    inversion.progress.unsettled.is = (struct stationary){1e-9, 0.3, 16, 2};
    assert_says(&inversion, "R_g^2 of the molecules still changes, 4 times as much");
    inversion.progress.unsettled.for_long = false;
    assert_says(&inversion, "after 30 iterations");
}

static void test_inversion_reason_is_a_target_that_is_off_as_a_whole(void **state) {
    (void)state;
    struct inverse_problem problem;
    struct inversion inversion = make_inversion(&problem, 0.0117, false);
    problem.scene.temperature = 1;
    inversion.progress.best_factor = (struct inversion_factor){.missing = 0.004, .prior = 0.001};
    assert_says(&inversion, "too small as a whole by 0.4 %");
    assert_says(&inversion, "\"normalisation\" allow by 0.1 %");
    inversion.progress.best_factor.missing = -0.0029;
    assert_says(&inversion, "after 30 iterations");
}

/// A section that is off is told by its χ², and groups that agree have neither g nor a ramp.
static void test_inversion_reason_of_groups_is_the_one_that_is_off(void **state) {
    (void)state;
    const int bond = mf_bonded_distribution_kind(TOPOLOGY_BOND);
    struct inverse_problem problem;
    struct inversion inversion = make_inversion(&problem, 0, false);
    problem.targets.target[TARGET_RDF].count = 0;
    inversion.progress.best[TARGET_RDF] = (struct target_distance){0};
    inversion.progress.best[bond] = (struct target_distance){.rms = 0.3, .noise = 0.2};
    inversion.progress.best_worst =
        (struct inversion_section){.kind = bond, .misfit = 3.4, .probable = 1.9};
    inversion.grid.groups = inversion.sections = 1;
    assert_says(&inversion, "the error of bond_lengths is 0.3, its statistical error 0.2, and "
                            "chi^2 by bin is 3.4 where noise makes 1.9");
    inversion.progress.best_worst.misfit = 1.8;
    assert_says(&inversion, "the distributions agree within a statistical error of 0.0025 of");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_inversion_reason_is_a_target_that_is_off_as_a_whole),
        cmocka_unit_test(test_inversion_reason_is_the_start_when_no_step_from_it_helped),
        cmocka_unit_test(test_inversion_reason_is_not_the_start_when_shorter_steps_helped),
        cmocka_unit_test(test_inversion_reason_of_a_stuck_mixture_advises_a_shorter_cutoff),
        cmocka_unit_test(test_inversion_reason_is_the_precision_when_the_curves_agree),
        cmocka_unit_test(test_inversion_reason_is_what_has_not_settled),
        cmocka_unit_test(test_inversion_reason_of_groups_is_the_one_that_is_off),
        cmocka_unit_test(test_inversion_reason_is_the_pressure_when_only_that_is_off),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
