// SPDX-License-Identifier: GPL-3.0-or-later
//
// Pairs in a well: their time by hand, and where there is none.
#include "observe/bound_pairs.h"

#include "curves/expression_law.h"
#include "dynamics/integrator.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>

/// Beads of mass 1 and T = 1 in a potential with the cutoff 1.5, which is read where they are in
/// `fluid`.
static struct bound_pairs find(const struct fluid *fluid, const char *formula) {
    struct curve curve;
    struct table table;
    assert_ok(mf_curve_create(&curve, &mf_expression_potential));
    struct expression_parameters *p = curve.parameters;
    snprintf(p->formula, sizeof p->formula, "%s", formula);
    p->cutoff = 1.5;
    assert_ok(mf_curve_check(&curve));
    assert_ok(mf_table_init_potential(&table, &curve));
    struct simulation_setup setup = fluid->setup;
    setup.potential = &table;
    const struct bound_pairs found = mf_bound_pairs_find(&setup, 0);
    mf_table_clear(&table);
    mf_curve_clear(&curve);
    return found;
}

/// The well of 8 k_B T at 0.6 with the curvature 2 · 8/0.15² has the weight 0.6² sqrt(2 π/U'') e^8,
/// but for what is not parabolic in it, and 1.5/16 of a part of its depth; it ends where 2/r is the
/// force, at 0.925 with 0.07 k_B T.
static void test_bound_pairs_stay_as_long_as_their_well_is_deep(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_ideal_gas(&fluid, 3, 100, 0.01);
    const struct bound_pairs found = find(&fluid, "-8*exp(-((r-0.6)/0.15)^2)");
    const double weight = 0.36 * sqrt(2 * M_PI / (16 / 0.0225)) * exp(8) * (1 + 0.75 / 16);
    const double end = 0.925 * 0.925 * exp(0.07);
    assert_close_relative(found.lifetime, weight / end * sqrt(M_PI), 0.06);
    assert_close(found.depth, 7.93, 0.05);
    fluid_clear(&fluid);
}

static void test_bound_pairs_are_none_without_a_well(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_ideal_gas(&fluid, 3, 100, 0.01);
    assert_true(find(&fluid, "12*(1.5-r)^2").depth < 1e-6);
    assert_true(find(&fluid, "exp(30*(0.8-r))-1.5*exp(-((r-1)/0.15)^2)").depth < 1.6);
    fluid_clear(&fluid);
}

static void test_bound_pairs_have_no_time_in_monte_carlo(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_ideal_gas(&fluid, 3, 100, 0.01);
    fluid.setup.integrator = &mf_monte_carlo;
    assert_identical(find(&fluid, "-8*exp(-((r-0.6)/0.15)^2)").lifetime, 0);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bound_pairs_stay_as_long_as_their_well_is_deep),
        cmocka_unit_test(test_bound_pairs_are_none_without_a_well),
        cmocka_unit_test(test_bound_pairs_have_no_time_in_monte_carlo),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
