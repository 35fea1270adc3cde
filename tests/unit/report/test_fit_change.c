// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/fit_report.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

enum { BINS = 40, CORE = 8 };

/// g(r) = 0 in the core, 0.05 in the next bin, of too few pairs to tell, and 1; a potential and an
/// ω of B-splines.
static void begin(struct unknowns *unknowns, struct inverse_problem *problem, double g[BINS]) {
    for (int k = 0; k < BINS; k++)
        g[k] = k < CORE ? 0 : k == CORE ? 0.05 : 1;
    *problem = (struct inverse_problem){
        .targets = {.bins = {0, 0.1, BINS}, .target[TARGET_RDF] = {.count = BINS, .value = g}},
        .unknown = {{.wanted = true,
                     .parameters = {.shape = INVERSE_CURVE_BSPLINE,
                                    .coefficients = 12,
                                    .minimum = -20,
                                    .maximum = 80}},
                    {.wanted = true,
                     .parameters = {.shape = INVERSE_CURVE_BSPLINE,
                                    .coefficients = 10,
                                    .maximum = 5,
                                    .inner_cutoff = 0.1,
                                    .cutoff = 1.5}}},
        .scene = {.temperature = 1},
        .core_threshold = 1e-3,
        .core_stiffness = 2000};
    assert_ok(mf_unknowns_init(unknowns, problem));
}

/// A well that goes from −1 at r = 2.05 to −0.5 at r = 2.55; what changes in the core is not given.
static void test_change_of_a_potential_is_that_beyond_its_core(void **state) {
    (void)state;
    struct unknowns unknowns;
    struct inverse_problem problem;
    double g[BINS], first[BINS + 1] = {0}, last[BINS + 1] = {0}, error[BINS + 1] = {0};
    const struct fit_result result = {
        .step = {.curve[UNKNOWN_POTENTIAL] = last, .curve_error[UNKNOWN_POTENTIAL] = error},
        .first[UNKNOWN_POTENTIAL] = first};
    begin(&unknowns, &problem, g);
    assert_close(mf_unknowns_r(&unknowns, UNKNOWN_POTENTIAL)[20], 2.05, 1e-12);
    first[20] = -1;
    last[25] = -0.5;
    error[20] = 0.3;
    error[25] = 0.1;
    last[CORE] = -50;
    first[CORE - 3] = 1000;
    last[CORE - 3] = -1000;
    const struct fit_change change = mf_fit_change_find(&unknowns, UNKNOWN_POTENTIAL, 0, &result);
    assert_close(change.first_well, -1, 0);
    assert_close(change.first_well_at, 2.05, 1e-12);
    assert_close(change.well, -0.5, 0);
    assert_close(change.well_at, 2.55, 1e-12);
    assert_close(change.well_error, 0.1, 0);
    assert_close(change.rms, sqrt(1.25 / (BINS - CORE - 1)), 1e-12);
    mf_unknowns_clear(&unknowns);
}

static void test_change_of_omega_is_its_rms(void **state) {
    (void)state;
    struct unknowns unknowns;
    struct inverse_problem problem;
    double g[BINS], first[OMEGA_POINTS], last[OMEGA_POINTS];
    const struct fit_result result = {.step.curve[UNKNOWN_OMEGA] = last,
                                      .first[UNKNOWN_OMEGA] = first};
    begin(&unknowns, &problem, g);
    for (int k = 0; k < OMEGA_POINTS; k++) {
        first[k] = 1;
        last[k] = 1.25;
    }
    assert_close(mf_fit_change_find(&unknowns, UNKNOWN_OMEGA, 0, &result).rms, 0.25, 1e-12);
    mf_unknowns_clear(&unknowns);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_change_of_a_potential_is_that_beyond_its_core),
        cmocka_unit_test(test_change_of_omega_is_its_rms),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
