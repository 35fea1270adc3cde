// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/fit_verification.h"

#include "observe/bonded_distribution.h"
#include "observe/kirkwood_buff.h"

#include "shared/testing.h"

#include <math.h>
#include <string.h>

static const double a_value = 1, an_error = 0.1;
#define ONE                                                                                        \
    { .count = 1, .value = &a_value, .error = &an_error }
static const struct targets only_rdf = {.target[TARGET_RDF] = ONE};
static const struct targets with_pressure = {
    .target = {[TARGET_RDF] = ONE, [TARGET_PRESSURE] = ONE}};

static struct verification make(double rms, double temperature, double pressure) {
    return (struct verification){.distance[TARGET_RDF] = {.rms = rms, .noise = 0.002},
                                 .agreement[TARGET_RDF].distance = {.rms = rms, .noise = 0.002},
                                 .thermodynamics = {.temperature = temperature,
                                                    .temperature_configurational = temperature,
                                                    .temperature_configurational_error = 0.002,
                                                    .pressure = pressure}};
}

/// Of the distances told, by χ² by bin, which noise alone takes to 9 at most.
static bool contradicts(const struct verification *of, const struct targets *fitted,
                        char reason[INVERSE_REASON_SIZE]) {
    struct verification verification = *of;
    for (int kind = 0; kind < TARGETS; kind++) {
        struct verify_agreement *const agreement = &verification.agreement[kind];
        const struct target_distance *const distance = &agreement->distance;
        agreement->misfit = distance->noise > 0 ? pow(distance->rms / distance->noise, 2) : 0;
        agreement->probable = 9;
    }
    return mf_fit_verification_contradicts(&verification, fitted, 1.5, NULL, reason);
}

static void assert_says(const struct verification *verification, const char *words) {
    char reason[INVERSE_REASON_SIZE];
    assert_true(contradicts(verification, &only_rdf, reason));
    assert_contains(reason, words);
    assert_true(strlen(reason) + 1 < INVERSE_REASON_SIZE);
}

static void test_fit_verification_is_silent_when_g_is_off_by_noise(void **state) {
    (void)state;
    char reason[INVERSE_REASON_SIZE];
    const struct verification good = make(0.0059, 1.8, -3);
    assert_false(contradicts(&good, &with_pressure, reason));
}

/// An rms below its error is no reason: it is few bins, whose errors are small, that contradict.
static void test_fit_verification_tells_what_an_rms_hides(void **state) {
    (void)state;
    char reason[INVERSE_REASON_SIZE];
    struct verification found = make(0.0015, 1.5, 3);
    found.agreement[TARGET_RDF].misfit = 4.2;
    found.agreement[TARGET_RDF].probable = 1.6;
    assert_true(mf_fit_verification_contradicts(&found, &only_rdf, 1.5, NULL, reason));
    assert_contains(reason, "off by 0.0015 (statistical error 0.002; in single bins more: chi^2 by "
                            "bin is 4.2, by chance 1.6) at T = 1.5");
}

/// One pair type of three, which the others hide; and a g that was not fitted, but is compared.
static void test_fit_verification_sees_each_pair_type_that_was_fitted(void **state) {
    (void)state;
    static const struct targets of_bonds = {.target[TARGET_RDF] = {.count = 0}};
    char reason[INVERSE_REASON_SIZE];
    struct verification hidden = make(0.005, 1.5, 3);
    hidden.distance[TARGET_RDF].count = 90;
    hidden.agreement[TARGET_RDF].distance =
        (struct target_distance){.rms = 0.008, .noise = 0.002, .count = 30};
    assert_says(&hidden, "agree with g(r) of all pair types, but its verification is off by 0.008");
    assert_false(contradicts(&hidden, &of_bonds, reason));
}

static void test_fit_verification_names_the_cause_when_g_is_off(void **state) {
    (void)state;
    const struct verification heated = make(0.0272, 1.69, -0.3), broken = make(0.157, 1.53, -2.19),
                              other = make(0.157, 1.5, 2.2);
    struct verification coarse = other, smaller = other, rough = heated, blameless = other;
    coarse.step = (struct verify_step){.used = 0.02,
                                       .would_hold = 0.0157,
                                       .off = {true, false, -0.0133, 0.002, 0},
                                       .result = VERIFY_STEP_LONG};
    assert_says(&coarse, "the configurational temperature is 1.3 % too low: the time step, 0.02 "
                         "tau, is too long for this potential; use about 0.015 tau");
    rough.step = (struct verify_step){.used = 0.001,
                                      .shortens = true,
                                      .halvings = 4,
                                      .off = {true, true, 0.127, 0.002, 0},
                                      .result = VERIFY_STEP_LONG};
    assert_says(&rough, "the kinetic temperature is 13 % too high even with 0.001 tau, a "
                        "sixteenth of the time step chosen");
    blameless.step = (struct verify_step){.off = {true, false, 0.05, 0.002, 0},
                                          .result = VERIFY_STEP_NOT_THE_CAUSE};
    assert_says(&blameless, "was so with twice the time step: the cause is not the time step");
    smaller.sampled = 700;
    smaller.particles = 1000;
    assert_says(&smaller, "the fit simulates 700 particles and the verification 1000");
    assert_says(&heated, "too few \"samples\" to tell whether the time step is the cause");
    assert_says(&broken, "off by 0.16 (statistical error 0.002) at T = 1.53, pressure -2.19: the "
                         "liquid is under tension, in which it may cavitate");
    assert_says(&other, "longer \"equilibration\" of both");
    struct verification early = other;
    snprintf(early.unequilibrated, sizeof early.unequilibrated, "g(r) still changes");
    assert_says(&early, "it is not in equilibrium, g(r) still changes: it may need a longer ");
    assert_says(&early, "\"verification.equilibration\", or freeze, cavitate or condense with");
    struct verification still = early; // a pressure of 0 within its errors is no tension
    still.thermodynamics.pressure = -0.3;
    still.thermodynamics.pressure_error = 0.2;
    assert_says(&still, "g(r) still changes: it may need");
}

/// Beads that lose their energy to rounding are cold, and friction would hold them.
static void test_fit_verification_names_friction_when_the_beads_are_cold(void **state) {
    (void)state;
    struct verification cold = make(0.045, 1, 2);
    assert_says(&cold, "friction");
    cold.agreement[TARGET_RDF].distance.rms = 0;
    cold.agreement[mf_bonded_distribution_kind(BONDED_BOND)].distance =
        (struct target_distance){.rms = 3.4, .noise = 0.18};
    assert_says(&cold, "agree with bond_lengths, but its verification is off by 3.4 (statistical "
                       "error 0.18) at T = 1, pressure 2: the friction is too weak");
}

/// Inner steps are chosen with the time step alone: who gives that gives them, too.
static void test_fit_verification_names_inner_steps_beside_a_time_step(void **state) {
    static const char words[] =
        " and \"scene.dynamics\": {\"integrator\": \"aboba\", \"inner_steps\": 4}";
    static struct fit_file fit = {.scene.setup.integrator = &mf_aboba, .inner_steps = 4};
    char reason[INVERSE_REASON_SIZE], said[128];
    (void)state;
    struct verification found = make(0.045, 1, 2);
    mf_fit_step_add_dynamics(&fit, &found);
    snprintf(said, sizeof said, "shorten \"verification.time_step\"%s", words);
    assert_says(&found, said);
    found = make(0.0021, 1.5, 1.9);
    mf_fit_step_add_dynamics(&fit, &found);
    found.agreement[TARGET_PRESSURE].distance = (struct target_distance){.rms = 0.4, .noise = 0.1};
    found.shift = (struct thermodynamics_shift){-0.35, 0.05};
    assert_true(contradicts(&found, &with_pressure, reason));
    snprintf(said, sizeof said, "set a shorter \"verification.time_step\"%s", words);
    assert_contains(reason, said);
    found.step =
        (struct verify_step){.used = 0.01, .would_hold = 0.006, .result = VERIFY_STEP_LONG};
    char text[FIT_STEP_TEXT_SIZE];
    mf_fit_step_text(&found, NULL, text);
    snprintf(said, sizeof said, "use about 0.006 tau%s", words);
    assert_contains(text, said);
    fit.inner_steps = 0;
    mf_fit_step_add_dynamics(&fit, &found);
    assert_string_equal(found.dynamics, "");
}

/// g(r) within its noise, at a temperature that the friction does not hold.
static void test_fit_verification_names_the_temperature_when_it_is_off(void **state) {
    (void)state;
    char reason[INVERSE_REASON_SIZE];
    struct verification hot = make(0.0021, 1.5, 1.9);
    hot.thermodynamics.temperature = 1.5 * 1.06;
    assert_false(contradicts(&hot, &only_rdf, reason)); // held by none
    snprintf(hot.warning, sizeof hot.warning, "the kinetic temperature is off");
    assert_true(contradicts(&hot, &only_rdf, reason));
    assert_contains(reason,
                    "the temperature of the verification is 1.59, not 1.5: the temperature is off");
    hot.thermodynamics.temperature = 1.5 * 1.04;
    assert_false(contradicts(&hot, &only_rdf, reason));
}

static void test_fit_verification_names_the_pressure_when_it_was_fitted_and_is_off(void **state) {
    (void)state;
    char reason[INVERSE_REASON_SIZE];
    struct verification found = make(0.0021, 1.5, 1.9);
    found.agreement[TARGET_PRESSURE].distance = (struct target_distance){.rms = 0.4, .noise = 0.1};
    assert_false(contradicts(&found, &only_rdf, reason));
    assert_true(contradicts(&found, &with_pressure, reason));
    assert_contains(reason,
                    "pressure of the verification, 1.9, is off by 0.4 (statistical error 0.1)");
    found.shift = (struct thermodynamics_shift){-0.35, 0.05};
    assert_true(contradicts(&found, &with_pressure, reason));
    assert_contains(reason, "its time step shifts it by about -0.35");
    found.agreement[TARGET_PRESSURE].distance.rms = 0.29;
    assert_false(contradicts(&found, &with_pressure, reason));
}

static void test_fit_verification_names_an_integral_when_it_was_fitted_and_is_off(void **state) {
    (void)state;
    const int kind = mf_kirkwood_buff_kind();
    char reason[INVERSE_REASON_SIZE];
    struct targets fitted = only_rdf;
    struct verification found = make(0.0021, 1.5, 1.9);
    fitted.target[kind] = (struct target)ONE;
    found.agreement[kind].distance = (struct target_distance){.rms = 0.4, .noise = 0.1};
    assert_false(contradicts(&found, &only_rdf, reason));
    assert_true(contradicts(&found, &fitted, reason));
    assert_contains(reason, "Kirkwood-Buff integral of the verification is off by 0.4");
    assert_true(strlen(reason) + 1 < INVERSE_REASON_SIZE);
    found.agreement[kind].distance.rms = 0.29;
    assert_false(contradicts(&found, &fitted, reason));
}

/// Of one target, and of two that count in units of their errors.
static void test_fit_verification_is_worse_when_the_difference_is_no_chance(void **state) {
    (void)state;
    static const double value[10] = {0}, error[10] = {0};
    const struct targets targets = {
        .target[TARGET_RDF] = {.count = 10, .value = value, .error = error, .weight = 10},
        .target[TARGET_DIFFUSION] = {.count = 1, .value = value, .error = error, .weight = 100}};
    struct targets one = targets;
    char reason[INVERSE_REASON_SIZE];
    struct verification found = {
        .distance = {[TARGET_RDF] = {.rms = 1.12, .variance = 1e-4},
                     [TARGET_DIFFUSION] = {.rms = 0.02, .variance = 1e-6}}};
    one.target[TARGET_DIFFUSION].count = 0;
    assert_true(mf_fit_verification_is_worse(&found, &one, 0.088, 0.0001, reason));
    assert_contains(
        reason, "error measured by the fit is 0.088 +- 0.01, that of its verification 1.1 +- 0.01");
    assert_true(strlen(reason) + 1 < INVERSE_REASON_SIZE);
    // Better, or worse by 4 errors, or by a tenth, are no contradiction.
    assert_false(mf_fit_verification_is_worse(&found, &one, 1.3, 0, reason));
    assert_false(mf_fit_verification_is_worse(&found, &one, 0.8, 0.0063, reason));
    assert_false(mf_fit_verification_is_worse(&found, &one, 1.0, 0, reason));
    // sqrt(((10 1.12)² + (100 0.02)²)/2) = 8.04.
    assert_true(mf_fit_verification_is_worse(&found, &targets, 6, 0, reason));
    assert_contains(reason, "verification 8 +- ");
    assert_false(mf_fit_verification_is_worse(&found, &targets, 7, 0, reason));
}

/// Samples of few coefficients, which need not meet the targets, and a simulation that lost its
/// heat: both with their errors, and the cause.
static void test_fit_verification_tells_why_a_verification_is_worse_than_samples(void **state) {
    (void)state;
    char reason[INVERSE_REASON_SIZE];
    struct verification found = make(0.0413, 0.64, 2);
    found.distance[TARGET_RDF].variance = 1e-6;
    assert_false(mf_fit_verification_is_worse_than_samples(&found, &only_rdf, 0.041, 4e-8, 0.64,
                                                           NULL, reason));
    assert_true(
        mf_fit_verification_is_worse_than_samples(&found, &only_rdf, 0.011, 4e-8, 1, NULL, reason));
    assert_string_equal(reason,
                        "the fit's samples differ from the target by 0.01100(20), its "
                        "verification by 0.0413(10) at T = 0.64, pressure 2: the friction is too "
                        "weak to hold the temperature: increase the \"dissipative\" friction or "
                        "shorten \"verification.time_step\"");
    // No worse, but cold.
    snprintf(found.warning, sizeof found.warning, "the temperature is off");
    assert_true(
        mf_fit_verification_is_worse_than_samples(&found, &only_rdf, 0.041, 4e-8, 1, NULL, reason));
    assert_contains(reason,
                    "the temperature of the verification is 0.64, not 1: the friction is too weak");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fit_verification_is_silent_when_g_is_off_by_noise),
        cmocka_unit_test(test_fit_verification_tells_what_an_rms_hides),
        cmocka_unit_test(test_fit_verification_sees_each_pair_type_that_was_fitted),
        cmocka_unit_test(test_fit_verification_names_the_cause_when_g_is_off),
        cmocka_unit_test(test_fit_verification_names_friction_when_the_beads_are_cold),
        cmocka_unit_test(test_fit_verification_names_inner_steps_beside_a_time_step),
        cmocka_unit_test(test_fit_verification_names_the_temperature_when_it_is_off),
        cmocka_unit_test(test_fit_verification_names_the_pressure_when_it_was_fitted_and_is_off),
        cmocka_unit_test(test_fit_verification_names_an_integral_when_it_was_fitted_and_is_off),
        cmocka_unit_test(test_fit_verification_is_worse_when_the_difference_is_no_chance),
        cmocka_unit_test(test_fit_verification_tells_why_a_verification_is_worse_than_samples),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
