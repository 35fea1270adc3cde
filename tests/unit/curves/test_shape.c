// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/names.h"
#include "curves/shape.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>

enum { POINTS = 201 };

static const struct shape *find(const char *name) {
    return mf_names_find(mf_shapes, name);
}

/// 0 to 1 in equal steps.
static void grid(double *t, size_t points) {
    for (size_t p = 0; p < points; p++)
        t[p] = (double)p / (double)(points - 1);
}

/// Some coefficients without pattern, in (−3, 3).
static void some_coefficients(double *coefficients, size_t count) {
    for (size_t k = 0; k < count; k++)
        coefficients[k] = 3 * sin(17 * (double)(k + 1) * (double)(k + 1));
}

static void test_names_find_knows_every_shape(void **state) {
    (void)state;
    for (size_t k = 0; mf_shapes[k]; k++)
        assert_ptr_equal(find(mf_shapes[k]->name), mf_shapes[k]);
    assert_non_null(find("bezier"));
    assert_non_null(find("bspline"));
    assert_null(find("spline"));
}

static void test_shape_values_begin_at_the_first_coefficient_and_end_at_0(void **state) {
    (void)state;
    for (size_t count = 1; count <= 40; count++) {
        double coefficients[40], values[2], shift[2];
        some_coefficients(coefficients, count);
        assert_ok(find("bspline")->values(coefficients, count, (double[]){0, 1}, values, 2));
        assert_close(values[0], coefficients[0], 1e-14);
        assert_identical(values[1], 0);
        assert_ok(find("bezier")->values(coefficients, count, (double[]){0, 1}, shift, 2));
        assert_close(shift[0], coefficients[0] - coefficients[count - 1], 1e-13);
        assert_close(shift[1], 0, 1e-13);
    }
}

/// Equal coefficients are that number where the last coefficient, which is 0, does not act: on all
/// but the last interval; and less, but above 0, on that.
static void test_bspline_basis_adds_up_to_1_before_the_last_interval(void **state) {
    enum { COEFFICIENTS = 12 };
    double t[POINTS], values[POINTS], ones[COEFFICIENTS];
    const double last = 1 - 1.0 / (COEFFICIENTS + 1 - 3);
    (void)state;
    grid(t, POINTS);
    for (int k = 0; k < COEFFICIENTS; k++)
        ones[k] = 1;
    assert_ok(find("bspline")->values(ones, COEFFICIENTS, t, values, POINTS));
    for (int p = 0; p < POINTS; p++) {
        if (t[p] <= last)
            assert_close(values[p], 1, 1e-14);
        else if (p < POINTS - 1)
            assert_true(values[p] > 0 && values[p] < 1);
    }
}

/// The last of the basis is (1 − (1−u))³ of the last interval, so equal coefficients fall as 1 −
/// u³.
static void test_bspline_has_its_textbook_values_in_the_last_interval(void **state) {
    static const double ones[4] = {1, 1, 1, 1}; // five coefficients: two intervals
    (void)state;
    for (double u = 0; u <= 1; u += 0.125) {
        double value;
        assert_ok(find("bspline")->values(ones, 4, (double[]){0.5 + 0.5 * u}, &value, 1));
        assert_close(value, 1 - u * u * u, 1e-14);
    }
}

static void test_bspline_coefficient_acts_on_four_intervals_alone(void **state) {
    enum { COEFFICIENTS = 20, INTERVALS = COEFFICIENTS + 1 - 3 };
    double t[POINTS], basis[POINTS * COEFFICIENTS];
    (void)state;
    grid(t, POINTS);
    assert_ok(mf_shape_basis(find("bspline"), COEFFICIENTS, t, POINTS, basis));
    for (int k = 0; k < COEFFICIENTS; k++)
        for (int p = 0; p < POINTS; p++) {
            const double place = t[p] * INTERVALS - k;
            if (place < -3 - 1e-9 || place > 1 + 1e-9)
                assert_identical(basis[p * COEFFICIENTS + k], 0);
            else
                assert_true(basis[p * COEFFICIENTS + k] >= 0);
        }
}

static void test_bspline_is_a_polynomial_when_coefficients_are_few(void **state) {
    double value;
    (void)state;
    assert_ok(find("bspline")->values((double[]){3}, 1, (double[]){0.25}, &value, 1));
    assert_close(value, 3 * 0.75, 1e-14);
    assert_ok(find("bspline")->values((double[]){3, 2}, 2, (double[]){0.25}, &value, 1));
    assert_close(value, 3 * 0.75 * 0.75 + 2 * 2 * 0.25 * 0.75, 1e-14);
}

static void test_shape_basis_times_coefficients_is_the_curve(void **state) {
    enum { COEFFICIENTS = 9 };
    double t[POINTS], basis[POINTS * COEFFICIENTS], values[POINTS], coefficients[COEFFICIENTS];
    (void)state;
    grid(t, POINTS);
    some_coefficients(coefficients, COEFFICIENTS);
    for (size_t s = 0; mf_shapes[s]; s++) {
        assert_ok(mf_shape_basis(mf_shapes[s], COEFFICIENTS, t, POINTS, basis));
        assert_ok(mf_shapes[s]->values(coefficients, COEFFICIENTS, t, values, POINTS));
        for (int p = 0; p < POINTS; p++) {
            double sum = 0;
            for (int k = 0; k < COEFFICIENTS; k++)
                sum += basis[p * COEFFICIENTS + k] * coefficients[k];
            assert_close(sum, values[p], 1e-12);
        }
    }
}

static void test_shape_fit_recovers_the_coefficients_of_a_bspline(void **state) {
    enum { COEFFICIENTS = 30 };
    double t[POINTS], values[POINTS], weights[POINTS], coefficients[COEFFICIENTS],
        fitted[COEFFICIENTS];
    (void)state;
    grid(t, POINTS);
    some_coefficients(coefficients, COEFFICIENTS);
    assert_ok(find("bspline")->values(coefficients, COEFFICIENTS, t, values, POINTS));
    for (int p = 0; p < POINTS; p++)
        weights[p] = 1 + (p % 5);
    assert_ok(mf_shape_fit(find("bspline"), t, values, NULL, POINTS, fitted, COEFFICIENTS));
    for (int k = 0; k < COEFFICIENTS; k++)
        assert_close(fitted[k], coefficients[k], 1e-9);
    assert_ok(mf_shape_fit(find("bspline"), t, values, weights, POINTS, fitted, COEFFICIENTS));
    for (int k = 0; k < COEFFICIENTS; k++)
        assert_close(fitted[k], coefficients[k], 1e-9);
}

/// Largest distance of the fit of a curve from that curve, and the largest coefficient.
static void fit_curve(const struct shape *shape, double (*function)(double), size_t points,
                      size_t count, double *distance, double *largest) {
    double t[POINTS], values[POINTS], fitted[POINTS], coefficients[120];
    grid(t, points);
    for (size_t p = 0; p < points; p++)
        values[p] = function(t[p]);
    assert_ok(mf_shape_fit(shape, t, values, NULL, points, coefficients, count));
    assert_ok(shape->values(coefficients, count, t, fitted, points));
    *distance = *largest = 0;
    for (size_t p = 0; p < points; p++)
        *distance = fmax(*distance, fabs(fitted[p] - values[p]));
    for (size_t k = 0; k < count; k++)
        *largest = fmax(*largest, fabs(coefficients[k]));
}

static double soft_core(double t) {
    return 5 * (1 - t) * (1 - t) * exp(-t) + 0.3 * sin(2 * M_PI * t);
}

/// More coefficients than can be distinguished, or than points: small coefficients whose curve is
/// right.
static void test_shape_fit_stays_small_when_coefficients_are_too_many(void **state) {
    double distance, largest;
    (void)state;
    for (size_t s = 0; mf_shapes[s]; s++) {
        fit_curve(mf_shapes[s], soft_core, POINTS, 100, &distance, &largest);
        assert_close(distance, 0, 1e-5);
        assert_true(largest < 10);
        fit_curve(mf_shapes[s], soft_core, 20, 100, &distance, &largest);
        assert_close(distance, 0, 1e-5);
        assert_true(largest < 10);
    }
}

static void test_shape_fit_follows_the_weights(void **state) {
    static const double t[3] = {0, 0, 0.5}, values[3] = {1, 3, 1}, weights[3] = {3, 1, 0};
    double coefficient;
    (void)state;
    assert_ok(mf_shape_fit(find("bspline"), t, values, weights, 3, &coefficient, 1));
    assert_close(coefficient, 1.5, 1e-10);
}

static void test_shape_fit_fails_when_points_say_nothing(void **state) {
    static const double t[2] = {0, 0.5}, zero[2] = {0, 0};
    const double nan[2] = {NAN, 1};
    double coefficients[2];
    (void)state;
    const struct shape *shape = find("bspline");
    assert_fails(mf_shape_fit(shape, t, zero, NULL, 0, coefficients, 2), STATUS_BAD_INPUT,
                 "without points");
    assert_fails(mf_shape_fit(shape, t, nan, NULL, 2, coefficients, 2), STATUS_BAD_INPUT, "nan");
    assert_fails(mf_shape_fit(shape, t, zero, zero, 2, coefficients, 2), STATUS_BAD_INPUT,
                 "weight");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_names_find_knows_every_shape),
        cmocka_unit_test(test_shape_values_begin_at_the_first_coefficient_and_end_at_0),
        cmocka_unit_test(test_bspline_basis_adds_up_to_1_before_the_last_interval),
        cmocka_unit_test(test_bspline_has_its_textbook_values_in_the_last_interval),
        cmocka_unit_test(test_bspline_coefficient_acts_on_four_intervals_alone),
        cmocka_unit_test(test_bspline_is_a_polynomial_when_coefficients_are_few),
        cmocka_unit_test(test_shape_basis_times_coefficients_is_the_curve),
        cmocka_unit_test(test_shape_fit_recovers_the_coefficients_of_a_bspline),
        cmocka_unit_test(test_shape_fit_stays_small_when_coefficients_are_too_many),
        cmocka_unit_test(test_shape_fit_follows_the_weights),
        cmocka_unit_test(test_shape_fit_fails_when_points_say_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
