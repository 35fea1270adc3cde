// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion.h"

#include "inversion/inversions.h"
#include "shared/testing.h"

#include <math.h>
#include <string.h>

/// A fit of g(r), perhaps with a pressure, that ended with this error.
struct fit {
    struct inverse_problem problem;
    struct inversion_state state;
    struct inversion inversion;
};

static struct inversion *make_fit(struct fit *fit, double rms, bool pressure) {
    static const double target = 5;
    *fit = (struct fit){
        .state.problem = &fit->problem,
        .inversion = {
            .problem = &fit->problem,
            .state = &fit->state,
            .states = 1,
            .method = &mf_imc,
            .parameters = {.iterations = 30, .precision = 0.002},
            .course.progress = {.damping = 1,
                                .best = {.distance[TARGET_RDF] = {.rms = rms, .noise = 0.003},
                                         .distance[TARGET_PRESSURE] = {.rms = 2, .noise = 0.1},
                                         .own_noise = 0.0025,
                                         .worst = {.misfit = pow(rms / 0.003, 2), .probable = 2}},
                                .first_error = 0.11,
                                .second_error = 0.08}}};
    fit->problem.targets.target[TARGET_RDF].count = 1;
    fit->problem.targets.target[TARGET_PRESSURE] =
        (struct target){.count = pressure, .value = &target, .error = &target};
    return &fit->inversion;
}

static void assert_says(const struct inversion *inversion, const char *words) {
    char reason[INVERSE_REASON_SIZE];
    mf_inversion_reason_write(inversion, reason);
    mf_status_strip(reason);
    assert_contains(reason, words);
    assert_true(strlen(reason) + 1 < INVERSE_REASON_SIZE);
}

static void test_inversion_reason_is_the_start_when_no_step_from_it_helped(void **state) {
    (void)state;
    struct fit fit;
    struct inversion *inversion = make_fit(&fit, 0.11, false);
    inversion->course.progress.second_error = 0.83;
    inversion->course.progress.damping = 1.0 / 128;
    assert_says(inversion, "rose from 0.11 to 0.83 with the first step");
    assert_says(inversion, "outside the basin of convergence of \"imc\"");
}

static void test_inversion_reason_is_not_the_start_when_shorter_steps_helped(void **state) {
    (void)state;
    struct fit fit;
    struct inversion *inversion = make_fit(&fit, 0.05, false);
    inversion->course.progress.second_error = 0.83;
    assert_says(inversion, "after 30 iterations the error of g(r) is 0.05 (0.11 at first)");
    inversion->course.progress.damping = 1.0 / 128;
    assert_says(inversion, "reduced to 1/128 without progress: the error of g(r) is 0.05, its "
                           "statistical error 0.003");
}

static void test_inversion_reason_of_a_stuck_mixture_advises_a_shorter_cutoff(void **state) {
    (void)state;
    struct fit fit;
    struct inversion *inversion = make_fit(&fit, 0.265, false);
    inversion->course.progress.damping = 1.0 / 128;
    fit.problem.scene.composition = mf_composition_of_one(100);
    assert_says(inversion, "without progress");
    fit.problem.scene.composition.types = 2;
    assert_says(inversion, "a shorter \"cutoff\"");
}

static void test_inversion_reason_is_the_precision_when_the_curves_agree(void **state) {
    (void)state;
    struct fit fit;
    const struct inversion *inversion = make_fit(&fit, 0.004, false);
    assert_says(inversion, "within a statistical error of 0.0025, but \"precision\" is 0.002");
}

static void test_inversion_reason_is_the_pressure_when_only_that_is_off(void **state) {
    (void)state;
    struct fit fit;
    struct inversion *inversion = make_fit(&fit, 0.004, true);
    assert_says(inversion, "the pressure is off by 2 (statistical error 0.1)");
    inversion->course.progress.best.distance[TARGET_PRESSURE].rms = 0.1;
    assert_says(inversion, "\"precision\"");
}

/// As long as more samples may be taken, what they are is no reason.
static void test_inversion_reason_is_what_has_not_settled(void **state) {
    (void)state;
    struct fit fit;
    struct inversion *inversion = make_fit(&fit, 0.3, false);
    inversion->assessment.unequilibrated = (struct inversion_unequilibrated){
        .found = true,
        .for_long = true,
        .quantity = "R_g^2 of the molecules",
        .sweeps = 52800,
        .is = {.drift = 0.3, .memory = 1e-9, .drift_ratio = 2, .memory_ratio = 25}};
    assert_says(inversion, "not in equilibrium after 52800 sweeps of each replica: R_g^2 of the "
                           "molecules differs between replicas, 5 times as much");
    inversion->assessment.unequilibrated.is = (struct stationary){1e-9, 0.3, 16, 2};
    assert_says(inversion, "R_g^2 of the molecules still changes, 4 times as much");
    inversion->assessment.unequilibrated.for_long = false;
    assert_says(inversion, "after 30 iterations");
}

/// Where all targets are met, what else must settle is named.
static void test_inversion_reason_is_what_has_not_settled_though_targets_are_met(void **state) {
    (void)state;
    struct fit fit;
    struct inversion *inversion = make_fit(&fit, 0.004, false);
    struct inversion_course *course = &inversion->course;
    course->progress.best.precise = true;
    course->band.drifts.ramp = (struct inversion_band_drift){.drift = 0.3, .open = 0.1};
    course->band.drifts.bulk[0] = (struct inversion_band_drift){.drift = 2, .open = 1};
    assert_says(inversion,
                "still drifts by 0.3 (error 0.1), and the pressure by 2 (error 1); give");
    course->progress.on_its_way = true;
    assert_says(inversion, "by 2 (error 1), in one direction for two iterations; give");
    course->progress.drifts.met = 2;
    fit.state.grid.pairs = fit.state.grid.groups = 1;
    fit.state.grid.known_of = (size_t[]){0};
    assert_says(inversion, "met in 2 of the last iterations, and 3 must meet them");
    inversion->assessment.unequilibrated = (struct inversion_unequilibrated){
        .found = true, .quantity = "R_g^2 of the molecules", .is = {1e-9, 0.3, 16, 2}};
    assert_says(inversion, "the targets are met, but the last samples have not settled: R_g^2 of "
                           "the molecules still changes, 4 times as much");
    course->progress.from_disorder = true;
    assert_says(inversion, "the last step led away from them and was taken back");
}

static void test_inversion_reason_is_a_target_that_is_off_as_a_whole(void **state) {
    (void)state;
    struct fit fit;
    struct inversion *inversion = make_fit(&fit, 0.0117, false);
    fit.problem.scene.temperature = 1;
    inversion->course.progress.best.factor =
        (struct inversion_factor){.missing = 0.004, .prior = 0.001};
    struct inversion_section *worst = &inversion->course.progress.best.worst;
    worst->rms = 0.009; // what the factor leaves
    worst->noise = 0.003;
    assert_says(inversion, "after 30 iterations");
    worst->rms = 0.004;
    assert_says(inversion, "too small at all distances by 0.4 %");
    assert_says(inversion, "\"normalisation\" is 0.1 %");
    double excess[] = {9, 9, 5, 2, 1};
    inversion->history = (struct inversion_history){.bins = 1, .iterations = 5, .excess = excess};
    assert_says(inversion, "after 30 iterations"); // it still improves
    excess[4] = 4.9;
    assert_says(inversion, "too small at all distances by 0.4 %");
    inversion->course.progress.best.factor.missing = -0.0029;
    assert_says(inversion, "after 30 iterations");
}

/// A section that is off is told by its χ², and groups that agree have neither g nor a ramp.
static void test_inversion_reason_of_groups_is_the_one_that_is_off(void **state) {
    (void)state;
    const int bond = mf_bonded_distribution_kind(BONDED_BOND);
    struct fit fit;
    struct inversion *inversion = make_fit(&fit, 0, false);
    fit.problem.targets.target[TARGET_RDF].count = 0;
    inversion->course.progress.best.distance[TARGET_RDF] = (struct target_distance){0};
    inversion->course.progress.best.distance[bond] =
        (struct target_distance){.rms = 0.3, .noise = 0.2};
    inversion->course.progress.best.worst =
        (struct inversion_section){.kind = bond, .misfit = 3.4, .probable = 1.9};
    fit.state.grid.groups = 1;
    fit.state.assessment.sections = 1;
    assert_says(inversion, "the error of bond_lengths is 0.3, its statistical error 0.2, and "
                           "chi^2 per bin is 3.4 (at most 1.9 by noise)");
    inversion->course.progress.best.worst.misfit = 1.8;
    assert_says(inversion, "the distributions agree within a statistical error of 0.0025 of");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_inversion_reason_is_a_target_that_is_off_as_a_whole),
        cmocka_unit_test(test_inversion_reason_is_the_start_when_no_step_from_it_helped),
        cmocka_unit_test(test_inversion_reason_is_not_the_start_when_shorter_steps_helped),
        cmocka_unit_test(test_inversion_reason_of_a_stuck_mixture_advises_a_shorter_cutoff),
        cmocka_unit_test(test_inversion_reason_is_the_precision_when_the_curves_agree),
        cmocka_unit_test(test_inversion_reason_is_what_has_not_settled),
        cmocka_unit_test(test_inversion_reason_is_what_has_not_settled_though_targets_are_met),
        cmocka_unit_test(test_inversion_reason_of_groups_is_the_one_that_is_off),
        cmocka_unit_test(test_inversion_reason_is_the_pressure_when_only_that_is_off),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
