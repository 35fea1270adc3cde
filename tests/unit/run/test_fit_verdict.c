// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/fit_verdict.h"

#include "shared/testing.h"

#include <string.h>

static struct verification make(double rms, double temperature, double pressure) {
    return (struct verification){
        .distance[GOAL_RDF] = {.rms = rms, .noise = 0.002},
        .thermodynamics = {.temperature = temperature, .pressure = pressure}};
}

static void assert_says(const struct verification *verification, const char *words) {
    char reason[INVERSE_REASON_SIZE];
    assert_true(fit_verdict_contradicts(verification, false, 1.5, 3, reason));
    assert_contains(reason, words);
    assert_true(strlen(reason) + 1 < INVERSE_REASON_SIZE);
}

static void test_fit_verdict_is_silent_when_g_is_off_by_noise(void **state) {
    (void)state;
    char reason[INVERSE_REASON_SIZE];
    const struct verification good = make(0.0059, 1.8, -3);
    assert_false(fit_verdict_contradicts(&good, true, 1.5, 3, reason));
}

static void test_fit_verdict_names_the_cause_when_g_is_off(void **state) {
    (void)state;
    const struct verification heated = make(0.0272, 1.69, -0.3), torn = make(0.157, 1.53, -2.19),
                              other = make(0.157, 1.5, 2.2);
    assert_says(&heated, "verification.time_step");
    assert_says(&torn, "off by 0.16 (0.002 by statistics) at T = 1.53, pressure -2.19: a liquid "
                       "under tension tears");
    assert_says(&other, "longer \"equilibration\"");
}

static void test_fit_verdict_names_the_pressure_when_it_was_fitted_and_is_off(void **state) {
    (void)state;
    char reason[INVERSE_REASON_SIZE];
    struct verification found = make(0.0021, 1.5, 1.9);
    found.distance[GOAL_PRESSURE] = (struct goal_distance){.rms = 0.4, .noise = 0.1};
    assert_false(fit_verdict_contradicts(&found, false, 1.5, 3, reason));
    assert_true(fit_verdict_contradicts(&found, true, 1.5, 3, reason));
    assert_contains(reason, "pressure, 1.9, is off by 0.4 (0.1 by statistics)");
    found.distance[GOAL_PRESSURE].rms = 0.29;
    assert_false(fit_verdict_contradicts(&found, true, 1.5, 3, reason));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fit_verdict_is_silent_when_g_is_off_by_noise),
        cmocka_unit_test(test_fit_verdict_names_the_cause_when_g_is_off),
        cmocka_unit_test(test_fit_verdict_names_the_pressure_when_it_was_fitted_and_is_off),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
