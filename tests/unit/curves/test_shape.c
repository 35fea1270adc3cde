// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/bspline.h"
#include "curves/shape.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>

enum { POINTS = 201 };

/// 0 to 1 in equal steps.
static void grid(double *t, size_t points) {
    for (size_t p = 0; p < points; p++)
        t[p] = (double)p / (double)(points - 1);
}

/// Some genes without pattern, in (−3, 3).
static void some_genes(double *genes, size_t count) {
    for (size_t k = 0; k < count; k++)
        genes[k] = 3 * sin(17 * (double)(k + 1) * (double)(k + 1));
}

static void test_shape_find_knows_every_shape_when_named(void **state) {
    (void)state;
    for (size_t k = 0; mf_shapes[k]; k++)
        assert_ptr_equal(mf_shape_find(mf_shapes[k]->name), mf_shapes[k]);
    assert_non_null(mf_shape_find("bezier"));
    assert_non_null(mf_shape_find("bspline"));
    assert_null(mf_shape_find("spline"));
}

static void test_shape_values_begin_at_the_first_gene_and_end_at_0(void **state) {
    (void)state;
    for (size_t count = 1; count <= 40; count++) {
        double genes[40], values[2], shift[2];
        some_genes(genes, count);
        assert_ok(mf_shape_find("bspline")->values(genes, count, (double[]){0, 1}, values, 2));
        assert_close(values[0], genes[0], 1e-14);
        assert_identical(values[1], 0);
        assert_ok(mf_shape_find("bezier")->values(genes, count, (double[]){0, 1}, shift, 2));
        assert_close(shift[0], genes[0] - genes[count - 1], 1e-13);
        assert_close(shift[1], 0, 1e-13);
    }
}

/// Equal genes are that number where the last coefficient, which is 0, does not act: on all but the
/// last interval; and less, but above 0, on that.
static void test_bspline_basis_adds_up_to_1_before_the_last_interval(void **state) {
    enum { GENES = 12 };
    double t[POINTS], values[POINTS], ones[GENES];
    const double last = 1 - 1.0 / (GENES + 1 - 3);
    (void)state;
    grid(t, POINTS);
    for (int k = 0; k < GENES; k++)
        ones[k] = 1;
    assert_ok(mf_bspline_values(ones, GENES, t, values, POINTS));
    for (int p = 0; p < POINTS; p++) {
        if (t[p] <= last)
            assert_close(values[p], 1, 1e-14);
        else if (p < POINTS - 1)
            assert_true(values[p] > 0 && values[p] < 1);
    }
}

/// The last of the basis is (1 − (1−u))³ of the last interval, so equal genes fall as 1 − u³.
static void test_bspline_has_its_textbook_values_in_the_last_interval(void **state) {
    static const double ones[4] = {1, 1, 1, 1}; // five coefficients: two intervals
    (void)state;
    for (double u = 0; u <= 1; u += 0.125) {
        double value;
        assert_ok(mf_bspline_values(ones, 4, (double[]){0.5 + 0.5 * u}, &value, 1));
        assert_close(value, 1 - u * u * u, 1e-14);
    }
}

static void test_bspline_gene_acts_on_four_intervals_alone(void **state) {
    enum { GENES = 20, INTERVALS = GENES + 1 - 3 };
    double t[POINTS], basis[POINTS * GENES];
    (void)state;
    grid(t, POINTS);
    assert_ok(mf_shape_basis(mf_shape_find("bspline"), GENES, t, POINTS, basis));
    for (int k = 0; k < GENES; k++)
        for (int p = 0; p < POINTS; p++) {
            const double place = t[p] * INTERVALS - k;
            if (place < -3 - 1e-9 || place > 1 + 1e-9)
                assert_identical(basis[p * GENES + k], 0);
            else
                assert_true(basis[p * GENES + k] >= 0);
        }
}

static void test_bspline_is_a_polynomial_when_genes_are_few(void **state) {
    double value;
    (void)state;
    assert_ok(mf_bspline_values((double[]){3}, 1, (double[]){0.25}, &value, 1));
    assert_close(value, 3 * 0.75, 1e-14);
    assert_ok(mf_bspline_values((double[]){3, 2}, 2, (double[]){0.25}, &value, 1));
    assert_close(value, 3 * 0.75 * 0.75 + 2 * 2 * 0.25 * 0.75, 1e-14);
}

static void test_shape_basis_times_genes_is_the_curve(void **state) {
    enum { GENES = 9 };
    double t[POINTS], basis[POINTS * GENES], values[POINTS], genes[GENES];
    (void)state;
    grid(t, POINTS);
    some_genes(genes, GENES);
    for (size_t s = 0; mf_shapes[s]; s++) {
        assert_ok(mf_shape_basis(mf_shapes[s], GENES, t, POINTS, basis));
        assert_ok(mf_shapes[s]->values(genes, GENES, t, values, POINTS));
        for (int p = 0; p < POINTS; p++) {
            double sum = 0;
            for (int k = 0; k < GENES; k++)
                sum += basis[p * GENES + k] * genes[k];
            assert_close(sum, values[p], 1e-12);
        }
    }
}

static void test_shape_fit_recovers_the_genes_of_a_bspline(void **state) {
    enum { GENES = 30 };
    double t[POINTS], values[POINTS], weights[POINTS], genes[GENES], fitted[GENES];
    (void)state;
    grid(t, POINTS);
    some_genes(genes, GENES);
    assert_ok(mf_bspline_values(genes, GENES, t, values, POINTS));
    for (int p = 0; p < POINTS; p++)
        weights[p] = 1 + (p % 5);
    assert_ok(mf_shape_fit(mf_shape_find("bspline"), t, values, NULL, POINTS, fitted, GENES));
    for (int k = 0; k < GENES; k++)
        assert_close(fitted[k], genes[k], 1e-9);
    assert_ok(mf_shape_fit(mf_shape_find("bspline"), t, values, weights, POINTS, fitted, GENES));
    for (int k = 0; k < GENES; k++)
        assert_close(fitted[k], genes[k], 1e-9);
}

/// Largest distance of the fit of a curve from that curve, and the largest gene.
static void fit_curve(const struct shape *shape, double (*function)(double), size_t points,
                      size_t count, double *distance, double *largest) {
    double t[POINTS], values[POINTS], fitted[POINTS], genes[120];
    grid(t, points);
    for (size_t p = 0; p < points; p++)
        values[p] = function(t[p]);
    assert_ok(mf_shape_fit(shape, t, values, NULL, points, genes, count));
    assert_ok(shape->values(genes, count, t, fitted, points));
    *distance = *largest = 0;
    for (size_t p = 0; p < points; p++)
        *distance = fmax(*distance, fabs(fitted[p] - values[p]));
    for (size_t k = 0; k < count; k++)
        *largest = fmax(*largest, fabs(genes[k]));
}

static double soft_core(double t) {
    return 5 * (1 - t) * (1 - t) * exp(-t) + 0.3 * sin(2 * M_PI * t);
}

/// More genes than can be told apart, or than points: small genes whose curve is right.
static void test_shape_fit_stays_small_when_genes_are_too_many(void **state) {
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
    double gene;
    (void)state;
    assert_ok(mf_shape_fit(mf_shape_find("bspline"), t, values, weights, 3, &gene, 1));
    assert_close(gene, 1.5, 1e-10);
}

static void test_shape_fit_fails_when_points_say_nothing(void **state) {
    static const double t[2] = {0, 0.5}, zero[2] = {0, 0};
    const double nan[2] = {NAN, 1};
    double genes[2];
    (void)state;
    const struct shape *shape = mf_shape_find("bspline");
    assert_fails(mf_shape_fit(shape, t, zero, NULL, 0, genes, 2), STATUS_BAD_INPUT,
                 "without points");
    assert_fails(mf_shape_fit(shape, t, nan, NULL, 2, genes, 2), STATUS_BAD_INPUT, "nan");
    assert_fails(mf_shape_fit(shape, t, zero, zero, 2, genes, 2), STATUS_BAD_INPUT, "weight");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shape_find_knows_every_shape_when_named),
        cmocka_unit_test(test_shape_values_begin_at_the_first_gene_and_end_at_0),
        cmocka_unit_test(test_bspline_basis_adds_up_to_1_before_the_last_interval),
        cmocka_unit_test(test_bspline_has_its_textbook_values_in_the_last_interval),
        cmocka_unit_test(test_bspline_gene_acts_on_four_intervals_alone),
        cmocka_unit_test(test_bspline_is_a_polynomial_when_genes_are_few),
        cmocka_unit_test(test_shape_basis_times_genes_is_the_curve),
        cmocka_unit_test(test_shape_fit_recovers_the_genes_of_a_bspline),
        cmocka_unit_test(test_shape_fit_stays_small_when_genes_are_too_many),
        cmocka_unit_test(test_shape_fit_follows_the_weights),
        cmocka_unit_test(test_shape_fit_fails_when_points_say_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
