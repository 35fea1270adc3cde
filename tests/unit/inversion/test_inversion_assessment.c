// SPDX-License-Identifier: GPL-3.0-or-later
//
// How far several states are from their targets together, and when a fit of them ends.
#include "inversion/inversion.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <string.h>

enum { STATES = 2 };

/// Two states of pairs with pressures: the first meets its g, the second is off by four noises of g
/// and two of the pressure.
struct fit {
    struct inverse_problem problem[STATES];
    struct inversion_state state[STATES];
    struct inversion inversion;
};

static void make(struct fit *fit) {
    static const double rms[STATES] = {0.01, 0.08}, noise[STATES] = {0.01, 0.02};
    static const double misfit[STATES] = {1, 16}, pressure[STATES] = {0.1, 0.8};
    static double wanted = 1;
    memset(fit, 0, sizeof *fit);
    for (size_t s = 0; s < STATES; s++) {
        struct inversion_assessment *assessment = &fit->state[s].assessment;
        struct targets *targets = &fit->problem[s].targets;
        targets->target[TARGET_RDF] = (struct target){.count = 1, .value = &wanted};
        targets->target[TARGET_PRESSURE] = (struct target){.count = 1, .value = &wanted};
        fit->problem[s].name = s == 0 ? "thin" : "dense";
        fit->state[s].problem = &fit->problem[s];
        assessment->sections = 1;
        assessment->section[0] = (struct inversion_section){.kind = TARGET_RDF,
                                                            .rms = rms[s],
                                                            .noise = noise[s],
                                                            .own_noise = noise[s] / 2,
                                                            .misfit = misfit[s],
                                                            .probable = 2,
                                                            .precision = 0.1};
        assessment->misfit = misfit[s];
        assessment->distance[TARGET_RDF] =
            (struct target_distance){.rms = rms[s], .noise = noise[s], .count = 10};
        assessment->distance[TARGET_PRESSURE] =
            (struct target_distance){.rms = pressure[s], .noise = s == 0 ? 0.1 : 0.4};
        assessment->stretch = s == 0 ? 1 : 4;
    }
    fit->inversion.problem = &fit->problem[0];
    fit->inversion.state = fit->state;
    fit->inversion.states = STATES;
}

static void test_verdict_of_one_state_is_its_own(void **state) {
    (void)state;
    static struct fit fit;
    struct inversion_assessment all;
    make(&fit);
    mf_inversion_states_assess(&fit.state[1], 1, &all);
    assert_memory_equal(&all, &fit.state[1].assessment, sizeof all);
}

/// (0.01² + 0.08²)/2 = 0.00325.
static void test_verdict_of_two_states_is_that_of_the_worse_and_their_mean(void **state) {
    (void)state;
    static struct fit fit;
    struct inversion_assessment all;
    make(&fit);
    mf_inversion_states_assess(fit.state, STATES, &all);
    assert_close(all.distance[TARGET_RDF].rms, 0.057008771254956896, 1e-15);
    assert_int_equal(all.distance[TARGET_RDF].count, 20);
    assert_close(all.section[0].rms / all.section[0].noise, 4, 1e-12);
    assert_close(all.own_noise, 0.01, 1e-15);
    assert_close(all.misfit, 8.5, 1e-12);
    assert_false(inversion_section_agrees(mf_inversion_assessment_worst(&all)));
    // Two noises of the second state, as so many of the first.
    assert_close(all.distance[TARGET_PRESSURE].rms, 0.2, 1e-15);
    assert_int_equal(all.stretch, 4);
    assert_false(all.unequilibrated.found);
    fit.state[1].assessment.unequilibrated =
        (struct inversion_unequilibrated){.found = true, .quantity = "the energy"};
    mf_inversion_states_assess(fit.state, STATES, &all);
    assert_true(all.unequilibrated.found &&
                !all.useless); // they do for a step, and are no agreement
    fit.state[1].assessment.useless = true;
    mf_inversion_states_assess(fit.state, STATES, &all);
    assert_true(all.unequilibrated.found && all.useless);
    assert_string_equal(all.unequilibrated.quantity, "the energy");
}

static void test_states_end_when_no_step_makes_them_better_together(void **state) {
    (void)state;
    static struct fit fit;
    struct inverse_step step;
    make(&fit);
    for (uint32_t k = 0; k <= 5; k++) {
        step = (struct inverse_step){.iteration = k};
        mf_inversion_states_end(&fit.inversion, &step);
        assert_int_equal(step.finished, k == 5);
    }
    assert_contains(step.reason, "no common potential: rdf of \"dense\" is off by 4.0 times");
    // A tenth nearer is better.
    fit.state[1].assessment.section[0].rms *= 0.9;
    fit.state[1].assessment.distance[TARGET_RDF].rms *= 0.9;
    step = (struct inverse_step){.iteration = 6};
    mf_inversion_states_end(&fit.inversion, &step);
    assert_false(step.finished);
    // What converges has no reason.
    step = (struct inverse_step){.iteration = 7, .finished = true, .converged = true};
    mf_inversion_states_end(&fit.inversion, &step);
    assert_string_equal(step.reason, "");
}

/// Within two noises of its target, three where it was so before; or as far as noise may be.
static void test_what_was_near_stays_near_a_little_longer(void **state) {
    (void)state;
    struct inversion_assessment assessment = {.sections = 1, .section[0] = {.probable = 2}};
    static const struct {
        double misfit, probable;
        bool near, stays;
    } of[] = {
        {3.9, 2, true, true}, {4.1, 2, false, true}, {9.1, 2, false, false}, {9.1, 10, true, true}};
    for (size_t k = 0; k < sizeof of / sizeof *of; k++) {
        assessment.section[0].misfit = of[k].misfit;
        assessment.section[0].probable = of[k].probable;
        assert_int_equal(mf_inversion_assessment_is_near(&assessment, false), of[k].near);
        assert_int_equal(mf_inversion_assessment_is_near(&assessment, true), of[k].stays);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_verdict_of_one_state_is_its_own),
        cmocka_unit_test(test_verdict_of_two_states_is_that_of_the_worse_and_their_mean),
        cmocka_unit_test(test_what_was_near_stays_near_a_little_longer),
        cmocka_unit_test(test_states_end_when_no_step_makes_them_better_together),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
