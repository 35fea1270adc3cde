// SPDX-License-Identifier: GPL-3.0-or-later
#include "matching/population.h"
#include "shared/testing.h"

#include <string.h>

static struct evaluate_result failed(enum evaluate_failure failure, double temperature) {
    return (struct evaluate_result){
        .error = OPTIMISER_FAILED, .failure = failure, .temperature = temperature};
}

static void test_failures_are_told_by_their_most_common_cause(void **state) {
    (void)state;
    struct population population = {.totals.evaluations = 10};
    struct population_failures *failures = &population.totals.failures;
    const struct evaluate_result hot = failed(EVALUATE_TEMPERATURE, 1.5),
                                 hotter = failed(EVALUATE_TEMPERATURE, 2.25),
                                 cold = failed(EVALUATE_TEMPERATURE, 0.75),
                                 broken = failed(EVALUATE_BLEW_UP, 0), good = {.error = 3};
    char reason[INVERSE_REASON_SIZE] = "";
    mf_population_add_failure(failures, &broken);
    mf_population_add_failure(failures, &hot);
    mf_population_add_failure(failures, &good);
    mf_population_add_failure(failures, &hotter);
    mf_population_add_failure(failures, &cold);
    mf_population_report_failure(&population, "but why", reason);
    assert_string_equal(reason,
                        "6 of 10 simulations succeeded, but why; 3 of 4 that failed had 0.75 to "
                        "2.25 times their temperature after \"equilibration\": a longer one or a "
                        "shorter \"time_step\" may help");
    for (int k = 0; k < 6; k++)
        mf_population_add_failure(failures, &broken);
    mf_population_report_failure(&population, "but why", reason);
    assert_contains(reason, "not one simulation of the fit succeeded; 7 of 10 blew up: ");
    assert_null(strstr(reason, "but why"));
}

static void test_a_single_cause_is_told_of_all(void **state) {
    (void)state;
    struct population population = {.totals.evaluations = 3};
    const struct evaluate_result drop = failed(EVALUATE_COLLAPSED, 1);
    char reason[INVERSE_REASON_SIZE] = "";
    mf_population_report_failure(&population, "but why", reason);
    assert_string_equal(reason, "all 3 simulations succeeded, but why");
    for (int k = 0; k < 3; k++)
        mf_population_add_failure(&population.totals.failures, &drop);
    mf_population_report_failure(&population, "but why", reason);
    assert_contains(reason, "not one simulation of the fit succeeded; all 3 collapsed into a drop");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_failures_are_told_by_their_most_common_cause),
        cmocka_unit_test(test_a_single_cause_is_told_of_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
