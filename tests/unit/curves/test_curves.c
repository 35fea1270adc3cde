// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/names.h"
#include "curves/shape.h"
#include "curves/core.h"
#include "curves/curve.h"
#include "curves/formula.h"
#include "curves/sampled.h"
#include "curves/sum.h"
#include "curves/table.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

/// A curve of the family with its default parameters.
static struct curve make(const struct curve_family *family) {
    struct curve curve;
    assert_ok(mf_curve_create(&curve, family));
    return curve;
}

static void test_curve_find_knows_every_family_when_named(void **state) {
    (void)state;
    assert_ptr_equal(mf_curve_find(mf_curve_potentials, "lennard-jones"),
                     &mf_formula_lennard_jones);
    assert_ptr_equal(mf_curve_find(mf_curve_potentials, "soft-repulsion"),
                     &mf_formula_soft_repulsion);
    assert_ptr_equal(mf_curve_find(mf_curve_potentials, "gaussian"), &mf_formula_gaussian);
    assert_ptr_equal(mf_curve_find(mf_curve_potentials, "table"), &mf_sampled_family);
    assert_ptr_equal(mf_curve_find(mf_curve_potentials, "sum"), &mf_sum_family);
    assert_ptr_equal(mf_curve_find(mf_curve_omegas, "power"), &mf_formula_power_omega);
    assert_null(mf_curve_find(mf_curve_omegas, "lennard-jones"));
    assert_null(mf_curve_find(mf_curve_potentials, ""));
}

static void test_lennard_jones_has_its_textbook_values_when_shifted(void **state) {
    (void)state;
    struct curve curve = make(&mf_formula_lennard_jones);
    const double shift = 4 * (pow(2.5, -12) - pow(2.5, -6));
    assert_close(mf_curve_cutoff(&curve), 2.5, 0);
    assert_close(mf_curve_value(&curve, 1), -shift, 1e-14);
    assert_close(mf_curve_value(&curve, pow(2, 1.0 / 6)), -1 - shift, 1e-14);
    assert_close(mf_curve_value(&curve, 2), 4 * (pow(2, -12) - pow(2, -6)) - shift, 1e-14);
    assert_close(mf_curve_value(&curve, 2.5 * (1 - 1e-9)), 0, 1e-8);
    assert_identical(mf_curve_value(&curve, 2.5), 0);
    assert_identical(mf_curve_value(&curve, 9), 0);
    mf_curve_clear(&curve);
}

/// Below σ/2 it is straight: value and slope continuous, finite at 0.
static void test_lennard_jones_is_straight_when_particles_overlap(void **state) {
    (void)state;
    struct curve curve = make(&mf_formula_lennard_jones);
    const double at = mf_curve_value(&curve, 0.5);
    // Φ'(σ/2) = −24 (2 · 2¹² − 2⁶) · 2
    const double expected = -24 * (2 * 4096.0 - 64) * 2;
    assert_close_relative(mf_curve_value(&curve, 0.5 - 1e-6) - at, -1e-6 * expected, 1e-6);
    assert_close_relative(mf_curve_value(&curve, 0.5 + 1e-6) - at, 1e-6 * expected, 1e-4);
    assert_close_relative(mf_curve_value(&curve, 0) - at, -0.5 * expected, 1e-12);
    mf_curve_clear(&curve);
}

static void test_soft_repulsion_has_the_force_of_groot_and_warren_when_differenced(void **state) {
    (void)state;
    struct curve curve = make(&mf_formula_soft_repulsion);
    *(struct formula_soft_repulsion_parameters *)curve.parameters =
        (struct formula_soft_repulsion_parameters){.a = 18.75, .cutoff = 1.3};
    assert_close(mf_curve_value(&curve, 0), 0.5 * 18.75 * 1.3, 1e-14);
    for (double r = 0.05; r < 1.25; r += 0.1) {
        const double force =
            -(mf_curve_value(&curve, r + 1e-5) - mf_curve_value(&curve, r - 1e-5)) / 2e-5;
        assert_close(force, 18.75 * (1 - r / 1.3), 1e-8);
    }
    assert_identical(mf_curve_value(&curve, 1.3), 0);
    assert_identical(mf_curve_value(&curve, 2), 0);
    mf_curve_clear(&curve);
}

static void test_gaussian_has_its_values_when_shifted(void **state) {
    (void)state;
    struct curve curve = make(&mf_formula_gaussian);
    *(struct formula_gaussian_parameters *)curve.parameters =
        (struct formula_gaussian_parameters){.epsilon = -2, .sigma = 0.5, .cutoff = 1};
    const double shift = -2 * exp(-4);
    assert_close(mf_curve_value(&curve, 0), -2 - shift, 1e-15);
    assert_close(mf_curve_value(&curve, 0.5), -2 / M_E - shift, 1e-15);
    assert_identical(mf_curve_value(&curve, 1), 0);
    mf_curve_clear(&curve);
}

static void test_power_omega_is_zero_outside_its_shell_when_it_has_an_inner_cutoff(void **state) {
    (void)state;
    struct curve curve = make(&mf_formula_power_omega);
    // The default is γ = 4.5, σ = 3 of Groot and Warren.
    assert_close(pow(mf_curve_value(&curve, 0), 2), 4.5, 1e-14);
    assert_close(pow(mf_curve_value(&curve, 0.5), 2), 4.5 / 4, 1e-14);
    *(struct formula_power_omega_parameters *)curve.parameters =
        (struct formula_power_omega_parameters){
            .sigma = 2.589, .exponent = 1, .inner_cutoff = 0.596, .cutoff = 1.72};
    assert_identical(mf_curve_value(&curve, 0), 0);
    assert_identical(mf_curve_value(&curve, 0.596), 0);
    assert_close(mf_curve_value(&curve, 0.6), 2.589 * (1 - 0.6 / 1.72), 1e-14);
    assert_close(mf_curve_value(&curve, 1.29), 2.589 / 4, 1e-14);
    assert_identical(mf_curve_value(&curve, 1.72), 0);
    ((struct formula_power_omega_parameters *)curve.parameters)->exponent = 0.25;
    assert_close(mf_curve_value(&curve, 1.29), 2.589 * sqrt(0.5), 1e-14);
    mf_curve_clear(&curve);
}

static void test_power_omega_is_refused_when_nothing_is_between_its_cutoffs(void **state) {
    (void)state;
    struct curve curve = make(&mf_formula_power_omega);
    struct formula_power_omega_parameters *p = curve.parameters;
    struct table table = {0};
    p->cutoff = 1;
    for (p->inner_cutoff = 1; p->inner_cutoff <= 3; p->inner_cutoff += 2) {
        assert_fails(mf_curve_check(&curve), STATUS_BAD_INPUT, "is not below the cutoff 1");
        assert_fails(mf_table_init_omega(&table, &curve), STATUS_BAD_INPUT, "below the cutoff 1");
        mf_table_clear(&table);
    }
    p->inner_cutoff = 0.99;
    assert_ok(mf_table_init_omega(&table, &curve));
    mf_table_clear(&table);
    mf_curve_clear(&curve);
}

/// The table of a curve of four times the strength, and what kernels read of it.
static void test_table_scale_is_the_table_of_the_stronger_curve(void **state) {
    (void)state;
    struct curve curve = make(&mf_formula_power_omega);
    struct table table, scaled, strong;
    assert_ok(mf_table_init_omega(&table, &curve));
    assert_ok(mf_table_scale(&scaled, &table, 4));
    ((struct formula_power_omega_parameters *)curve.parameters)->sigma *= 4;
    assert_ok(mf_table_init_omega(&strong, &curve));
    for (double r = 0.001; r < 2; r += 0.01) {
        double a, b, slope_a, slope_b;
        mf_table_evaluate(&scaled, r, &a, &slope_a, NULL);
        mf_table_evaluate(&strong, r, &b, &slope_b, NULL);
        assert_close(a, b, 1e-14);
        assert_close(slope_a, slope_b, 1e-10);
    }
    for (int k = 0; k <= TABLE_INTERVALS; k++)
        for (int n = 0; n < 2; n++)
            assert_true(fabs(scaled.single[k][n] - strong.single[k][n]) < 1e-5F);
    assert_identical(scaled.cutoff, strong.cutoff);
    mf_table_clear(&table);
    mf_table_clear(&scaled);
    mf_table_clear(&strong);
    mf_curve_clear(&curve);
}

/// Largest difference of a table and its curve: value and force, from `first` to the cutoff.
struct difference {
    double value, slope;
};

static struct difference compare(const struct curve *curve, const struct table *table,
                                 double first) {
    struct difference largest = {0};
    const double cutoff = mf_curve_cutoff(curve), h = 1e-6;
    for (int k = 0; k < 7919; k++) {
        const double r = first + (cutoff - first - 1e-4) * (k + 0.5) / 7919;
        double value, slope;
        mf_table_evaluate(table, r, &value, &slope, NULL);
        const double expected =
            (mf_curve_value(curve, r + h) - mf_curve_value(curve, r - h)) / (2 * h);
        largest.value = fmax(largest.value, fabs(value - mf_curve_value(curve, r)));
        largest.slope = fmax(largest.slope, fabs(slope - expected) / (1 + fabs(expected)));
    }
    return largest;
}

/// Bounds: twice what was measured when the test was written; table.h quotes the second.
static void test_table_follows_its_potential_when_smooth(void **state) {
    (void)state;
    struct curve curve = make(&mf_formula_soft_repulsion);
    struct table table;
    assert_ok(mf_table_init_potential(&table, &curve));
    struct difference difference = compare(&curve, &table, 0.001);
    assert_true(difference.value < 1e-12); // a parabola is a cubic
    assert_true(difference.slope < 1e-7);
    mf_table_clear(&table);
    mf_curve_clear(&curve);

    curve = make(&mf_formula_lennard_jones);
    assert_ok(mf_table_init_potential(&table, &curve));
    difference = compare(&curve, &table, 0.9);
    assert_true(difference.value < 2e-6);
    assert_true(difference.slope < 1e-5);
    mf_table_clear(&table);
    mf_curve_clear(&curve);

    curve = make(&mf_formula_gaussian);
    assert_ok(mf_table_init_potential(&table, &curve));
    difference = compare(&curve, &table, 0.001);
    assert_true(difference.value < 1e-10);
    assert_true(difference.slope < 1e-7);
    mf_table_clear(&table);
    mf_curve_clear(&curve);
}

static void test_table_is_zero_when_beyond_the_cutoff(void **state) {
    (void)state;
    struct curve curve = make(&mf_formula_gaussian);
    struct table table;
    assert_ok(mf_table_init_potential(&table, &curve));
    double value, slope, curvature;
    const double far[] = {table.cutoff, 2 * table.cutoff, 1e9};
    for (int k = 0; k < 3; k++) {
        mf_table_evaluate(&table, far[k], &value, &slope, &curvature);
        assert_identical(value, 0);
        assert_identical(slope, 0);
        assert_identical(curvature, 0);
    }
    for (int k = 0; k < 4; k++)
        assert_identical(table.single[TABLE_INTERVALS][k], 0);
    mf_table_clear(&table);
    mf_curve_clear(&curve);
}

/// Each curve keeps its own grid, shift and end; a part without one is 0.
static void test_table_stack_holds_each_curve_as_it_was_alone(void **state) {
    (void)state;
    struct curve soft = make(&mf_formula_soft_repulsion), gaussian = make(&mf_formula_gaussian);
    struct table parts[3] = {{0}}, stack;
    assert_ok(mf_table_init_potential(&parts[0], &soft));
    assert_ok(mf_table_init_potential(&parts[2], &gaussian));
    assert_ok(mf_table_stack(&stack, parts, 3));
    assert_int_equal(stack.curves, 3);
    assert_identical(stack.cutoff, fmax(parts[0].cutoff, parts[2].cutoff));
    for (double r = 0; r < 1.2 * stack.cutoff; r += 0.00371)
        for (int pair = 0; pair < 3; pair++) {
            double here[3], alone[3] = {0};
            mf_table_evaluate_pair(&stack, pair, r, &here[0], &here[1], &here[2]);
            if (pair != 1)
                mf_table_evaluate(&parts[pair], r, &alone[0], &alone[1], &alone[2]);
            for (int n = 0; n < 3; n++)
                assert_identical(here[n], alone[n]);
            // A table of one curve is for all pairs.
            mf_table_evaluate_pair(&parts[0], pair, r, &here[0], NULL, NULL);
            mf_table_evaluate(&parts[0], r, &alone[0], NULL, NULL);
            assert_identical(here[0], alone[0]);
        }
    mf_table_clear(&parts[0]);
    mf_table_clear(&parts[2]);
    mf_table_clear(&stack);
    mf_curve_clear(&soft);
    mf_curve_clear(&gaussian);
}

/// Value and slope are continuous at every node, and so is the curvature.
static void test_table_is_twice_continuous_when_a_potential(void **state) {
    (void)state;
    struct curve curve = make(&mf_formula_lennard_jones);
    struct table table;
    assert_ok(mf_table_init_potential(&table, &curve));
    for (int k = 400; k < TABLE_INTERVALS - 1; k++) {
        const double *c = table.coefficient + 4 * k, *next = c + 4;
        const double size = 1e-9 * (1 + fabs(c[0]) + fabs(c[1]) + fabs(c[2]) + fabs(c[3]));
        assert_close(c[0] + c[1] + c[2] + c[3], next[0], size);
        assert_close(c[1] + 2 * c[2] + 3 * c[3], next[1], size);
        assert_close(2 * c[2] + 6 * c[3], 2 * next[2], size);
    }
    mf_table_clear(&table);
    mf_curve_clear(&curve);
}

static void test_table_of_omega_jumps_within_one_interval_when_omega_does(void **state) {
    (void)state;
    struct curve curve = make(&mf_formula_power_omega);
    struct formula_power_omega_parameters *p = curve.parameters;
    p->inner_cutoff = 0.4;
    struct table table;
    assert_ok(mf_table_init_omega(&table, &curve));
    const double spacing = 1.0 / TABLE_INTERVALS;
    for (double r = 0.0003; r < 1; r += 0.0017) {
        double value;
        mf_table_evaluate(&table, r, &value, NULL, NULL);
        if (fabs(r - 0.4) > spacing)
            assert_close(value, mf_curve_value(&curve, r), 1e-11); // the last node is 1e-12 inside
        else
            assert_true(value >= 0 && value <= p->sigma * 0.6 + 1e-3);
    }
    double value;
    mf_table_evaluate(&table, 1, &value, NULL, NULL);
    assert_identical(value, 0);
    mf_table_clear(&table);
    mf_curve_clear(&curve);
}

static void test_sampled_curve_goes_through_its_points_when_evaluated(void **state) {
    (void)state;
    enum { POINTS = 40 };
    double r[POINTS], y[POINTS];
    for (int k = 0; k < POINTS; k++) {
        r[k] = 0.5 + 1.5 * k / (POINTS - 1);
        y[k] = cos(2 * r[k]) * (2 - r[k]);
    }
    struct curve curve;
    assert_ok(mf_sampled_create(&curve, r, y, POINTS));
    assert_close(mf_curve_cutoff(&curve), 2, 0);
    for (int k = 0; k < POINTS - 1; k++)
        assert_close(mf_curve_value(&curve, r[k]), y[k], 1e-14);
    // Between points: the natural spline's error is some 1e-4 near its ends, far less inside.
    assert_close(mf_curve_value(&curve, 1.234), cos(2.468) * (2 - 1.234), 1e-6);
    // Below the first point the straight line with the slope there.
    const double slope = (mf_curve_value(&curve, 0.5 + 1e-6) - mf_curve_value(&curve, 0.5)) / 1e-6;
    assert_close(mf_curve_value(&curve, 0.2), y[0] - 0.3 * slope, 1e-5);
    assert_identical(mf_curve_value(&curve, 2), 0);
    assert_identical(mf_curve_value(&curve, 3), 0);
    mf_curve_clear(&curve);
}

static void test_sampled_create_refuses_when_points_are_bad(void **state) {
    (void)state;
    struct curve curve;
    const double r[] = {0, 1, 1, 2}, y[] = {3, 2, 1, 0};
    assert_fails(mf_sampled_create(&curve, r, y, 4), STATUS_BAD_INPUT,
                 "does not increase at point 3");
    assert_fails(mf_sampled_create(&curve, r, y, 2), STATUS_BAD_INPUT, "at least 3 points");
    const double nan[] = {0, NAN, 2};
    assert_fails(mf_sampled_create(&curve, nan, y, 3), STATUS_BAD_INPUT, "does not increase");
    assert_ok(mf_curve_create(&curve, &mf_sampled_family));
    ((struct sampled_parameters *)curve.parameters)->cutoff = 3;
    const double good[] = {0, 1, 1.5, 2};
    assert_fails(mf_sampled_set_points(&curve, good, y, 4), STATUS_BAD_INPUT, "before the cutoff");
    mf_curve_clear(&curve);
}

static double binomial(int n, int k) {
    double product = 1;
    for (int m = 1; m <= k; m++)
        product *= (double)(n - k + m) / m;
    return product;
}

/// Σ C(n, k) t^k (1 − t)^(n−k) x_k − x_n with n = count − 1, for small n.
static double bernstein(const double *coefficients, int count, double t) {
    double sum = 0;
    for (int k = 0; k < count; k++)
        sum += binomial(count - 1, k) * pow(t, k) * pow(1 - t, count - 1 - k) * coefficients[k];
    return sum - coefficients[count - 1];
}

enum { BEZIER_POINTS = 501 };

/// BEZIER_POINTS places from 0 to 1 in equal steps.
static const double *equal_places(void) {
    static double places[BEZIER_POINTS];
    for (int p = 0; p < BEZIER_POINTS; p++)
        places[p] = p / (BEZIER_POINTS - 1.0);
    return places;
}

static const struct shape *bezier(void) {
    return mf_names_find(mf_shapes, "bezier");
}

static void test_bezier_values_are_bernstein_sums_when_coefficients_are_few(void **state) {
    (void)state;
    const double *t = equal_places();
    const double coefficients[] = {3, -1, 4, 1, -5, 9, 2, -6, 5, 3};
    double values[BEZIER_POINTS];
    for (int count = 1; count <= 10; count++) {
        assert_ok(bezier()->values(coefficients, (size_t)count, t, values, BEZIER_POINTS));
        for (int p = 0; p < BEZIER_POINTS; p++)
            assert_close(values[p], bernstein(coefficients, count, t[p]), 1e-13);
        assert_identical(values[0], coefficients[0] - coefficients[count - 1]);
        assert_identical(values[BEZIER_POINTS - 1], 0);
    }
}

/// A Bézier curve stays in the hull of its control points, and equal ones make a constant.
static void test_bezier_values_stay_in_the_hull_when_coefficients_are_a_hundred(void **state) {
    (void)state;
    enum { COEFFICIENTS = 100 };
    double coefficients[COEFFICIENTS], values[BEZIER_POINTS], largest = 0;
    for (int k = 0; k < COEFFICIENTS; k++)
        coefficients[k] = (k * 7919 % 101) / 100.0 * 6.5;
    const double last = coefficients[COEFFICIENTS - 1];
    assert_ok(bezier()->values(coefficients, COEFFICIENTS, equal_places(), values, BEZIER_POINTS));
    for (int p = 0; p < BEZIER_POINTS; p++) {
        assert_true(values[p] + last >= 0 && values[p] + last <= 6.5);
        if (p > 0)
            largest = fmax(largest, fabs(values[p] - values[p - 1]));
    }
    // The steepest slope is n · 6.5 over 1, at an end.
    assert_true(largest <= 6.5 * (COEFFICIENTS - 1) / (BEZIER_POINTS - 1.0));
    for (int k = 0; k < COEFFICIENTS; k++)
        coefficients[k] = 2;
    assert_ok(bezier()->values(coefficients, COEFFICIENTS, equal_places(), values, BEZIER_POINTS));
    for (int p = 0; p < BEZIER_POINTS; p++)
        assert_close(values[p], 0, 1e-13);
}

/// Coefficients on a line give the line; equal ones before a last 0 give 1 − t^n: every Bernstein
/// weight of degree 99 has its say.
static void test_bezier_values_are_known_when_a_hundred_coefficients_are_simple(void **state) {
    (void)state;
    enum { COEFFICIENTS = 100 };
    const double *t = equal_places();
    double coefficients[COEFFICIENTS], values[BEZIER_POINTS];
    for (int k = 0; k < COEFFICIENTS; k++)
        coefficients[k] = 5 - 0.25 * k;
    assert_ok(bezier()->values(coefficients, COEFFICIENTS, t, values, BEZIER_POINTS));
    for (int p = 0; p < BEZIER_POINTS; p++)
        assert_close(values[p], 0.25 * 99 * (1 - t[p]), 1e-12);
    for (int k = 0; k < COEFFICIENTS - 1; k++)
        coefficients[k] = 2;
    coefficients[COEFFICIENTS - 1] = 0;
    assert_ok(bezier()->values(coefficients, COEFFICIENTS, t, values, BEZIER_POINTS));
    for (int p = 0; p < BEZIER_POINTS; p++)
        assert_close(values[p], 2 * (1 - pow(t[p], 99)), 1e-13);
}

static void test_core_continues_value_and_slope_when_the_potential_repels(void **state) {
    (void)state;
    const double r[] = {0, 0.2, 0.4, 0.6 - 1e-6, 0.6, 0.8};
    double phi[] = {99, 99, 99, 99, 1.5, 1};
    mf_core_fill(r, phi, 4, -3, 2000);
    assert_identical(phi[4], 1.5);
    assert_identical(phi[5], 1);
    assert_close((phi[4] - phi[3]) / 1e-6, -3, 2e-3);
    assert_close(phi[2], 1.5 + 0.2 * 3 + 0.5 * 2000 * 0.04, 1e-12);
    assert_close(phi[0], 1.5 + 0.6 * 3 + 0.5 * 2000 * 0.36, 1e-12);
    for (int k = 1; k < 5; k++)
        assert_true(phi[k] < phi[k - 1]);
}

static void test_core_starts_flat_when_the_potential_attracts_inwards(void **state) {
    (void)state;
    const double r[] = {0, 0.6 - 1e-6, 0.6};
    double phi[] = {99, 99, 1.5};
    mf_core_fill(r, phi, 2, 4, 2000);
    assert_close((phi[2] - phi[1]) / 1e-6, 0, 2e-3);
    assert_close(phi[0], 1.5 + 0.5 * 2000 * 0.36, 1e-12);
    phi[0] = 7;
    mf_core_fill(r, phi, 0, 4, 2000); // nothing is below the first known point
    assert_identical(phi[0], 7);
}

static void
test_sampled_friction_weight_has_straight_pieces_and_none_before_the_first(void **state) {
    (void)state;
    const double r[] = {0.5, 0.6, 0.8, 1}, y[] = {0, 3, 0, 0};
    struct curve curve;
    assert_ok(mf_curve_create(&curve, mf_curve_find(mf_curve_omegas, "table")));
    assert_ok(mf_sampled_set_points(&curve, r, y, 4));
    assert_close(mf_curve_value(&curve, 0.2), 0, 0);
    assert_close(mf_curve_value(&curve, 0.52), 0.6, 1e-12);
    assert_close(mf_curve_value(&curve, 0.7), 1.5, 1e-12);
    assert_close(mf_curve_value(&curve, 0.9), 0, 0);
    assert_close(mf_curve_value(&curve, 1), 0, 0);
    mf_curve_clear(&curve);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(
            test_sampled_friction_weight_has_straight_pieces_and_none_before_the_first),
        cmocka_unit_test(test_curve_find_knows_every_family_when_named),
        cmocka_unit_test(test_lennard_jones_has_its_textbook_values_when_shifted),
        cmocka_unit_test(test_lennard_jones_is_straight_when_particles_overlap),
        cmocka_unit_test(test_soft_repulsion_has_the_force_of_groot_and_warren_when_differenced),
        cmocka_unit_test(test_gaussian_has_its_values_when_shifted),
        cmocka_unit_test(test_power_omega_is_zero_outside_its_shell_when_it_has_an_inner_cutoff),
        cmocka_unit_test(test_power_omega_is_refused_when_nothing_is_between_its_cutoffs),
        cmocka_unit_test(test_table_follows_its_potential_when_smooth),
        cmocka_unit_test(test_table_is_zero_when_beyond_the_cutoff),
        cmocka_unit_test(test_table_stack_holds_each_curve_as_it_was_alone),
        cmocka_unit_test(test_table_scale_is_the_table_of_the_stronger_curve),
        cmocka_unit_test(test_table_is_twice_continuous_when_a_potential),
        cmocka_unit_test(test_table_of_omega_jumps_within_one_interval_when_omega_does),
        cmocka_unit_test(test_sampled_curve_goes_through_its_points_when_evaluated),
        cmocka_unit_test(test_sampled_create_refuses_when_points_are_bad),
        cmocka_unit_test(test_bezier_values_are_bernstein_sums_when_coefficients_are_few),
        cmocka_unit_test(test_bezier_values_stay_in_the_hull_when_coefficients_are_a_hundred),
        cmocka_unit_test(test_bezier_values_are_known_when_a_hundred_coefficients_are_simple),
        cmocka_unit_test(test_core_continues_value_and_slope_when_the_potential_repels),
        cmocka_unit_test(test_core_starts_flat_when_the_potential_attracts_inwards),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
