// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/fit_closing.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <string.h>

static void begin(struct unknowns *unknowns, struct inverse_problem *problem) {
    *problem = (struct inverse_problem){
        .unknown[UNKNOWN_OMEGA] = {.wanted = true,
                                   .parameters = {.shape = INVERSE_CURVE_BSPLINE,
                                                  .coefficients = 10,
                                                  .maximum = 5,
                                                  .inner_cutoff = 0.1,
                                                  .cutoff = 1.5}},
        .scene = {.temperature = 1}};
    assert_ok(mf_unknowns_init(unknowns, problem));
}

/// An ω of 2 that is known within `error` up to a share of its range, and within 3 beyond.
static void fill(const struct unknowns *unknowns, double share, double *omega, double *error) {
    const double *r = mf_unknowns_r(unknowns, UNKNOWN_OMEGA);
    for (size_t k = 0; k < OMEGA_POINTS; k++) {
        const bool fits = mf_unknowns_fits(unknowns, UNKNOWN_OMEGA, k);
        omega[k] = fits ? 2 : 0;
        error[k] = !fits ? NAN : r[k] < 0.1 + share * 1.4 ? 0.5 : 3;
    }
}

static void test_closing_tells_how_well_a_friction_weight_is_known(void **state) {
    (void)state;
    struct unknowns unknowns;
    struct inverse_problem problem;
    double omega[OMEGA_POINTS], error[OMEGA_POINTS];
    begin(&unknowns, &problem);
    fill(&unknowns, 0.25, omega, error);
    const struct curve_knowledge known =
        mf_fit_closing_knowledge(&unknowns, UNKNOWN_OMEGA, omega, error);
    assert_close(known.rms, 2, 1e-12);
    assert_close(known.seen, 0.25, 0.03);
    assert_close(known.error, sqrt(0.25 * 0.25 + 0.75 * 9), 0.1);
    mf_unknowns_clear(&unknowns);
}

static void test_closing_says_so_where_most_of_a_friction_weight_is_noise(void **state) {
    (void)state;
    struct unknowns unknowns;
    struct inverse_problem problem;
    char reason[INVERSE_REASON_SIZE];
    double omega[OMEGA_POINTS], error[OMEGA_POINTS];
    const double *const curve[UNKNOWNS] = {[UNKNOWN_OMEGA] = omega};
    const double *const errors[UNKNOWNS] = {[UNKNOWN_OMEGA] = error};
    begin(&unknowns, &problem);
    fill(&unknowns, 0.38, omega, error);
    assert_true(mf_fit_closing_is_noise(&unknowns, &problem.targets, curve, errors, NULL, reason));
    assert_contains(reason, "omega is mostly noise: only 3");
    fill(&unknowns, 0.6, omega, error);
    assert_false(mf_fit_closing_is_noise(&unknowns, &problem.targets, curve, errors, NULL, reason));
    for (size_t k = 0; k < OMEGA_POINTS; k++)
        error[k] = NAN; // a method that knows none
    assert_false(mf_fit_closing_is_noise(&unknowns, &problem.targets, curve, errors, NULL, reason));
    mf_unknowns_clear(&unknowns);
}

/// What is given without errors leaves the noise of the fit's own samples alone, which more of them
/// would lessen.
static void test_closing_asks_for_samples_where_the_targets_have_no_errors(void **state) {
    (void)state;
    struct unknowns unknowns;
    struct inverse_problem problem;
    char reason[INVERSE_REASON_SIZE];
    double omega[OMEGA_POINTS], error[OMEGA_POINTS], exact[] = {0, 0};
    const double *const curve[UNKNOWNS] = {[UNKNOWN_OMEGA] = omega};
    const double *const errors[UNKNOWNS] = {[UNKNOWN_OMEGA] = error};
    begin(&unknowns, &problem);
    problem.targets.target[TARGET_VACF] = (struct target){.count = 2, .error = exact};
    fill(&unknowns, 1, omega, error); // 0.5 of 2 everywhere
    assert_true(mf_fit_closing_is_noise(&unknowns, &problem.targets, curve, errors, NULL, reason));
    assert_contains(reason, "omega is known to 25 % of it (rms), by the noise of the fit's own");
    assert_contains(reason, "more \"samples\"");
    exact[1] = 0.01;
    assert_false(mf_fit_closing_is_noise(&unknowns, &problem.targets, curve, errors, NULL, reason));
    exact[1] = 0;
    for (size_t k = 0; k < OMEGA_POINTS; k++)
        error[k] *= 0.3;
    assert_false(mf_fit_closing_is_noise(&unknowns, &problem.targets, curve, errors, NULL, reason));
    mf_unknowns_clear(&unknowns);
}

/// A fit of E(t, r_0) at two times of two r_0, and what its verification was found to be.
struct closed {
    struct fit_file fit;
    struct fit_result result;
    struct verification verification;
};

static struct closed *make_closed(double errors) {
    static struct closed closed;
    static const double value[6] = {1, 1, 0.5, 0.5, 0.2, 0.2};
    closed = (struct closed){.result = {.status = STATUS_OK, .step.converged = true}};
    closed.result.verification = &closed.verification;
    struct targets *const targets = &closed.fit.problem.targets;
    targets->target[TARGET_ETD] = (struct target){.count = 6, .columns = 2, .value = value};
    targets->etd = (struct etd_grid){0.5, 1.5, 2, 3};
    targets->etd_interval = 0.1;
    closed.fit.problem.compared = *targets;
    closed.verification.agreement[TARGET_ETD] = (struct verify_agreement){
        {errors * 0.01, 0.01, .count = 1}, errors * errors, 16, .part = {1, 1, 1, 1}};
    return &closed;
}

/// Success is agreement within the errors, of something that is known.
static void test_closing_calls_success_only_what_agrees_and_is_known(void **state) {
    (void)state;
    static const char noise[] = "omega is mostly noise: only 38 % of it is";
    char text[FIT_VERDICT_SIZE];
    struct closed *closed = make_closed(3.9);
    mf_fit_closing_verdict(&closed->fit, &closed->result, "", text);
    assert_string_equal(text, "success: independent simulations agree with the targets within "
                              "their errors");
    mf_fit_closing_verdict(&closed->fit, &closed->result, noise, text);
    assert_string_equal(text, "undetermined: independent simulations agree with the targets "
                              "within their errors, but omega is mostly noise");
    closed = make_closed(5.2);
    mf_fit_closing_verdict(&closed->fit, &closed->result, "", text);
    assert_string_equal(text, "converged: independent simulations differ from the targets, most "
                              "etd at 0.1 for r_0 from 1 to 1.5 by 5.2 times its statistical error "
                              "(by chance up to 4)");
    closed->result.step.converged = false;
    mf_fit_closing_verdict(&closed->fit, &closed->result, "", text);
    assert_contains(text, "finished: independent simulations differ");
    mf_fit_closing_verdict(&closed->fit, &closed->result, noise, text);
    assert_contains(text, "(by chance up to 4), but omega is mostly noise");
    closed->verification.agreement[TARGET_ETD].probable = 144; // errors that three values tell
    mf_fit_closing_verdict(&closed->fit, &closed->result, "", text);
    assert_contains(text, "unknown: ");
    closed->result.status = STATUS_UNCONVERGED;
    mf_fit_closing_verdict(&closed->fit, &closed->result, noise, text);
    assert_contains(text, "did not succeed");
}

/// What is only compared is no failure of the fit, and "success" does not cover it.
static void test_closing_says_what_success_does_not_cover(void **state) {
    (void)state;
    char text[FIT_VERDICT_SIZE];
    struct closed *closed = make_closed(3.9);
    struct verify_agreement *compared = &closed->verification.compared[TARGET_PRESSURE];
    closed->fit.files.given[TARGET_ETD] = closed->fit.files.given[TARGET_PRESSURE] = 1;
    *compared = (struct verify_agreement){{0.9, 1, .count = 1}, 0.8, 4.4, .part = {0, 1, 0, 1}};
    mf_fit_closing_verdict(&closed->fit, &closed->result, "", text);
    assert_string_equal(text, "success: independent simulations agree with the fitted targets "
                              "within their errors");
    compared->misfit = 5.3;
    mf_fit_closing_verdict(&closed->fit, &closed->result, "", text);
    assert_string_equal(text, "success: independent simulations agree with the fitted targets "
                              "within their errors; those only compared differ, most pressure by "
                              "2.3 times its statistical error (by the noise of target and "
                              "simulations up to 2.1)");
    closed->verification.agreement[TARGET_ETD].misfit = 27;
    mf_fit_closing_verdict(&closed->fit, &closed->result, "", text);
    assert_contains(text, "converged: independent simulations differ from the fitted targets, most "
                          "etd at 0.1");
    assert_contains(text, "; those only compared differ, most pressure by 2.3 times");
}

/// The last lines of a fit of which a target is off by twice what chance allows, as a whole or in a
/// stretch.
static const char *say_farthest(struct closed *closed, int kind, struct verify_part part,
                                struct verify_stretch stretch) {
    static char text[FIT_VERDICT_SIZE];
    closed->verification.agreement[TARGET_ETD] = (struct verify_agreement){0};
    closed->verification.agreement[kind] = (struct verify_agreement){
        {0.1, 0.01, .count = 1}, stretch.count > 0 ? 1 : 64, 16, stretch, part};
    mf_fit_closing_verdict(&closed->fit, &closed->result, "", text);
    closed->verification.agreement[kind] = (struct verify_agreement){0};
    return text;
}

/// Bins of g(r) are counted over all pair types, those of bonds over all groups, and a curve has
/// points of its own.
static void test_closing_names_where_a_target_is_farthest_off(void **state) {
    (void)state;
    static const double q[] = {1, 2, 3, 4};
    static const struct verify_part all = {0, 1, 0, 3};
    static const struct verify_stretch none = {.probable = 0};
    struct closed *closed = make_closed(3.9);
    struct inverse_problem *const problem = &closed->fit.problem;
    int waves = 0;
    while (strcmp(mf_targets_name(waves), "structure_factor") != 0)
        waves++;
    problem->compared.bins = (struct rdf_bins){.low = 0.5, .width = 0.25, .count = 8};
    assert_contains(say_farthest(closed, TARGET_RDF, all, none),
                    "most rdf for r from 0.5 to 1.25 by 8 times");
    closed->fit.scene.setup.composition =
        (struct composition){.types = 2, .name = {"A", "W"}, .count = {5, 5}};
    assert_contains(
        say_farthest(closed, TARGET_RDF, all, (struct verify_stretch){10, 3, 64, 16, false}),
        "most rdf of A-W for r from 1 to 1.75 by 8 times");
    problem->compared.target[waves] = (struct target){.count = 4, .x = q};
    assert_contains(say_farthest(closed, waves, (struct verify_part){0, 1, 1, 2}, none),
                    "most structure_factor for q from 2 to 3 by 8 times");
    assert_contains(say_farthest(closed, TARGET_PRESSURE, (struct verify_part){0, 1, 0, 1}, none),
                    "most pressure by 8 times");
}

/// Numbers that differ look so.
static void test_closing_tells_a_misfit_from_its_bound(void **state) {
    (void)state;
    char text[FIT_VERDICT_SIZE];
    struct closed *closed = make_closed(4.04);
    mf_fit_closing_verdict(&closed->fit, &closed->result, "", text);
    assert_contains(text, "by 4.04 times its statistical error (by chance up to 4)");
    closed = make_closed(4.0004);
    mf_fit_closing_verdict(&closed->fit, &closed->result, "", text);
    assert_contains(text, "by 4.0004 times its statistical error (by chance up to 4)");
}

/// A pressure that is only compared is no less open than one that is not given.
static void test_closing_says_what_g_leaves_open_unless_it_is_fitted(void **state) {
    (void)state;
    static const double value = 23.65;
    char text[FIT_VERDICT_SIZE];
    struct closed *closed = make_closed(3.9);
    struct inverse_problem *const problem = &closed->fit.problem;
    closed->result.step.ramp = (struct inverse_ramp){.error = 0.1, .bulk_open = 6.2};
    closed->verification.thermodynamics.pressure = 20.53;
    problem->targets.bins = (struct rdf_bins){.count = 60, .width = 0.025};
    assert_true(mf_fit_closing_is_open(&closed->fit, &closed->result, text));
    assert_string_equal(text, "undetermined: g(r) alone does not determine the pressure: 20.5 +- "
                              "6.2, if the law ends at 1.5; give \"pressure\" as a second target "
                              "to fix it");
    problem->compared.target[TARGET_PRESSURE] = (struct target){.count = 1, .value = &value};
    assert_true(mf_fit_closing_is_open(&closed->fit, &closed->result, text));
    assert_contains(text, "20.5 +- 6.2, if the law ends at 1.5; fit \"pressure\" as a second");
    problem->targets.target[TARGET_PRESSURE] = problem->compared.target[TARGET_PRESSURE];
    assert_false(mf_fit_closing_is_open(&closed->fit, &closed->result, text));
}

/// A friction weight has not converged to targets that it does not meet.
static void test_closing_says_so_where_a_friction_weight_misses_its_targets(void **state) {
    (void)state;
    char reason[INVERSE_REASON_SIZE];
    struct closed *closed = make_closed(5);
    struct unknown *const omega = &closed->fit.problem.unknown[UNKNOWN_OMEGA];
    assert_false(mf_fit_closing_is_missed(&closed->fit, &closed->verification, 0, reason));
    *omega = (struct unknown){.wanted = true, .parameters = {.cutoff = 1.5}};
    assert_true(mf_fit_closing_is_missed(&closed->fit, &closed->verification, 0, reason));
    assert_contains(reason, "etd at 0.1 for r_0 from 1 to 1.5 by 5 times its statistical error");
    assert_contains(reason, "another cutoff than that given or chosen, 1.5, which no fit changes");
    // Samples that cannot see it are no reason for another form of omega.
    closed->verification.distance[TARGET_ETD] = (struct target_distance){.rms = 0.05};
    assert_true(mf_fit_closing_is_missed(&closed->fit, &closed->verification, 0.08, reason));
    assert_contains(reason, "more \"samples\"");
    assert_true(mf_fit_closing_is_missed(&closed->fit, &closed->verification, 0.03, reason));
    assert_contains(reason, "another cutoff");
    closed = make_closed(3);
    *omega = (struct unknown){.wanted = true, .parameters = {.cutoff = 1.5}};
    assert_false(mf_fit_closing_is_missed(&closed->fit, &closed->verification, 0, reason));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_closing_tells_how_well_a_friction_weight_is_known),
        cmocka_unit_test(test_closing_says_so_where_most_of_a_friction_weight_is_noise),
        cmocka_unit_test(test_closing_asks_for_samples_where_the_targets_have_no_errors),
        cmocka_unit_test(test_closing_says_so_where_a_friction_weight_misses_its_targets),
        cmocka_unit_test(test_closing_calls_success_only_what_agrees_and_is_known),
        cmocka_unit_test(test_closing_says_what_success_does_not_cover),
        cmocka_unit_test(test_closing_names_where_a_target_is_farthest_off),
        cmocka_unit_test(test_closing_tells_a_misfit_from_its_bound),
        cmocka_unit_test(test_closing_says_what_g_leaves_open_unless_it_is_fitted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
