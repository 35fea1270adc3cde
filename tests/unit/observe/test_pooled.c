// SPDX-License-Identifier: GPL-3.0-or-later
//
// One mean and error from those of replicas.
#include "observe/pooled.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

static const double rounding = 1e-14;

/// Replicas that found 1, 3 and 5, each with the error 0.6 by `blocks` of time.
static double error_of(size_t count, double blocks, double *mean) {
    static const double found[] = {1, 3, 5}, own = 0.6;
    struct pooled_curve replicas[3];
    double value = 0, error = 0, freedom = NAN;
    const struct observable_values values = {1, NULL, &value, &error, &freedom};
    for (size_t k = 0; k < count; k++)
        replicas[k] = (struct pooled_curve){&found[k], &own, blocks};
    mf_pooled_join(&values, replicas, count);
    assert_close(freedom, (double)count * blocks - 1, rounding * (double)count * blocks);
    *mean = value;
    return error;
}

static void test_pooled_error_is_the_replicas_own_when_it_knows_all(void **state) {
    (void)state;
    double mean;
    assert_close(error_of(1, 20, &mean), 0.6, rounding);
    assert_close(mean, 1, rounding);
    // So many blocks that the scatter of three replicas tells nothing beside them.
    assert_close(error_of(3, 1e18, &mean), 0.6 / sqrt(3), rounding);
    assert_close(mean, 3, rounding);
}

/// The standard error of the mean of 1, 3, 5: their standard deviation is 2.
static void test_pooled_error_is_the_scatter_when_a_replica_knows_none(void **state) {
    (void)state;
    double mean;
    assert_close(error_of(3, 1, &mean), 2 / sqrt(3), rounding);
}

/// Two degrees of freedom between three replicas, and as many inside each of two blocks … of three.
static void test_pooled_error_weighs_both_by_what_they_know(void **state) {
    (void)state;
    double mean;
    assert_close(error_of(3, 2, &mean), sqrt((3 * 0.12 + 2 * 4.0 / 3) / 5), rounding);
}

static void test_pooled_leaves_alone_what_is_not_asked_for(void **state) {
    (void)state;
    const double found = 1, own = 1;
    const struct pooled_curve replicas[2] = {{&found, &own, 3}, {&found, &own, 3}};
    mf_pooled_join(&(struct observable_values){0}, replicas, 2);
    mf_pooled_add(&(struct observable_values){0}, &found, &own, 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pooled_error_is_the_replicas_own_when_it_knows_all),
        cmocka_unit_test(test_pooled_error_is_the_scatter_when_a_replica_knows_none),
        cmocka_unit_test(test_pooled_error_weighs_both_by_what_they_know),
        cmocka_unit_test(test_pooled_leaves_alone_what_is_not_asked_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
