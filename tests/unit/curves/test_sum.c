// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/sum.h"

#include "curves/formula.h"
#include "curves/sampled.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

static const double rounding = 1e-11;

/// Weeks, Chandler and Andersen's repulsion and a Gaussian that reaches farther.
static void make_parts(struct curve part[2]) {
    assert_ok(mf_curve_create(&part[0], &mf_formula_lennard_jones));
    ((struct formula_lennard_jones_parameters *)part[0].parameters)->cutoff = pow(2, 1.0 / 6);
    assert_ok(mf_curve_create(&part[1], &mf_formula_gaussian));
}

static void clear_parts(struct curve part[2]) {
    mf_curve_clear(&part[0]);
    mf_curve_clear(&part[1]);
}

static void test_sum_shifted_ends_at_zero_when_a_curve_does_not(void **state) {
    (void)state;
    const double r[] = {0, 0.5, 1, 1.5, 2}, phi[] = {5, 4, 3, 2, 1};
    struct curve curve;
    assert_ok(mf_sampled_create(&curve, r, phi, 5));
    assert_close(mf_sum_shifted(&curve, 0.75), 2.5, rounding);
    assert_close(mf_sum_shifted(&curve, 2 * (1 - 1e-12)), 0, rounding);
    assert_identical(mf_sum_shifted(&curve, 2), 0);
    mf_curve_clear(&curve);
}

/// 4 (1/r¹² − 1/r⁶) + 1 up to 2^(1/6), and the Gaussian alone beyond.
static void test_sum_has_each_part_up_to_its_own_cutoff(void **state) {
    (void)state;
    struct curve part[2];
    make_parts(part);
    struct sum_parameters sum = {.parts = 2, .part = {part[0], part[1]}};
    const struct curve curve = {&mf_sum_family, &sum};
    assert_close(mf_curve_cutoff(&curve), mf_curve_cutoff(&part[1]), 0);
    assert_close(mf_curve_value(&curve, 1), 1 + mf_curve_value(&part[1], 1), rounding);
    assert_close(mf_curve_value(&curve, 1.2), mf_curve_value(&part[1], 1.2), rounding);
    assert_identical(mf_curve_value(&curve, mf_curve_cutoff(&curve)), 0);
    clear_parts(part);
}

/// Energies and forces are those of both tables.
static void test_sum_tabulate_is_the_sum_of_both_tables(void **state) {
    (void)state;
    struct curve part[2];
    struct table one, other, both;
    make_parts(part);
    assert_ok(mf_table_init_potential(&one, &part[0]));
    assert_ok(mf_table_init_potential(&other, &part[1]));
    assert_ok(mf_sum_tabulate(&both, &part[0], &part[1]));
    assert_close(both.cutoff, other.cutoff, 0);
    for (double r = 0.8; r < other.cutoff; r += 0.013) {
        double value[3], slope[3];
        mf_table_evaluate(&one, r, &value[0], &slope[0], NULL);
        mf_table_evaluate(&other, r, &value[1], &slope[1], NULL);
        mf_table_evaluate(&both, r, &value[2], &slope[2], NULL);
        assert_close(value[2], value[0] + value[1], 1e-5 * (1 + fabs(value[2])));
        // The curvature of the repulsion, 57, ends within an interval of the table.
        assert_close(slope[2], slope[0] + slope[1], 0.02 + 1e-4 * fabs(slope[2]));
    }
    mf_table_clear(&one);
    mf_table_clear(&other);
    mf_table_clear(&both);
    clear_parts(part);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sum_shifted_ends_at_zero_when_a_curve_does_not),
        cmocka_unit_test(test_sum_has_each_part_up_to_its_own_cutoff),
        cmocka_unit_test(test_sum_tabulate_is_the_sum_of_both_tables),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
