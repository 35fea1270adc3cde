// SPDX-License-Identifier: GPL-3.0-or-later
//
// Which state's verification contradicts a fit.
#include "work/fit_verify.h"

#include "shared/testing.h"

enum { BINS = 100 };

/// Two states of one inversion, whose g is 1 by their targets.
struct made {
    struct inverse_method method;
    struct fit_file fit, other;
    double wanted[BINS], target_error[BINS], value[2][BINS], error[BINS];
    struct verification verification[2];
};

static void make_state(struct made *made, int s, struct fit_file *state) {
    struct verification *verification = &made->verification[s];
    state->problem.targets.target[TARGET_RDF] =
        (struct target){.count = BINS, .value = made->wanted, .error = made->target_error};
    state->problem.scene.temperature = 1;
    verification->observed.value[TARGET_RDF] = made->value[s];
    verification->observed.error[TARGET_RDF] = made->error;
    verification->sections.count = 1;
    verification->sections.section[0] = (struct verify_section){
        .kind = TARGET_RDF, .count = BINS, .known = {.numbers = 50, .freedom = 76}};
}

/// Off by 0.001 in the first state and by 0.003 in the second, where neither the targets nor the
/// verifications have as much noise.
static void make(struct made *made) {
    *made = (struct made){.method.kind = INVERSE_INVERSION};
    made->fit.method = &made->method;
    made->fit.others = 1;
    made->fit.other = &made->other;
    snprintf(made->other.name, sizeof made->other.name, "hot");
    for (int k = 0; k < BINS; k++) {
        const double sign = k % 2 ? 1 : -1;
        made->wanted[k] = 1;
        made->target_error[k] = 1e-6;
        made->error[k] = 3e-6;
        made->value[0][k] = 1 + 0.001 * sign;
        made->value[1][k] = 1 + 0.003 * sign;
    }
    make_state(made, 0, &made->fit);
    make_state(made, 1, &made->other);
}

/// A potential misses each state's target by the noise of that state's samples.
static void test_verification_judges_each_state_by_the_noise_of_its_samples(void **state) {
    (void)state;
    static struct made made;
    char reason[INVERSE_REASON_SIZE] = "";
    make(&made);
    const struct inverse_step own = {.noise_of_state = {0.001, 0.003}},
                              mean = {.noise_of_state = {0.002, 0.002}},
                              swapped = {.noise_of_state = {0.003, 0.001}};
    assert_false(mf_fit_verify_any_contradicts(&made.fit, made.verification, &own, reason));
    assert_true(mf_fit_verify_any_contradicts(&made.fit, made.verification, &mean, reason));
    assert_contains(reason, "hot");
    assert_true(mf_fit_verify_any_contradicts(&made.fit, made.verification, &swapped, reason));
}

/// A fit of g, with a pressure and an MSD that are only compared and off by ten of their errors.
static void test_verification_compares_what_the_fitted_targets_fix(void **state) {
    (void)state;
    static struct made made;
    static const int kind[] = {TARGET_PRESSURE, TARGET_MSD};
    double wanted = 20, target_error = 0.3, value = 25, error = 0.4;
    char reason[INVERSE_REASON_SIZE] = "";
    struct inverse_step step = {0};
    make(&made);
    made.fit.others = 0;
    struct inverse_problem *const problem = &made.fit.problem;
    const struct verify_agreement *const found = made.verification[0].compared;
    problem->compared = problem->targets;
    for (int k = 0; k < 2; k++) {
        problem->compared.target[kind[k]] =
            (struct target){.count = 1, .value = &wanted, .error = &target_error};
        made.verification[0].observed.value[kind[k]] = &value;
        made.verification[0].observed.error[kind[k]] = &error;
        made.verification[0].sections.curve[kind[k]] =
            (struct statistics_independence){1, INFINITY};
    }
    mf_fit_verify_any_contradicts(&made.fit, made.verification, &step, reason);
    assert_false(verify_agreement_holds(&found[TARGET_PRESSURE])); // of a potential that is given
    assert_false(verify_agreement_holds(&found[TARGET_MSD]));
    problem->unknown[UNKNOWN_POTENTIAL].wanted = made.fit.choices.thermostat = true;
    mf_fit_verify_any_contradicts(&made.fit, made.verification, &step, reason);
    assert_true(found[TARGET_PRESSURE].probable == 0 && found[TARGET_MSD].probable == 0);
    step.ramp.bulk_open = 0.5; // which g leaves open, and is not all of it
    mf_fit_verify_any_contradicts(&made.fit, made.verification, &step, reason);
    assert_false(verify_agreement_holds(&found[TARGET_PRESSURE]));
    step.ramp.bulk_open = 6;
    mf_fit_verify_any_contradicts(&made.fit, made.verification, &step, reason);
    assert_true(found[TARGET_PRESSURE].probable > 0);
    assert_true(verify_agreement_holds(&found[TARGET_PRESSURE]));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_verification_judges_each_state_by_the_noise_of_its_samples),
        cmocka_unit_test(test_verification_compares_what_the_fitted_targets_fix),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
