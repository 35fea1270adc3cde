// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/shape.h"

#include "base/memory.h"
#include "base/names.h"

#include <gsl/gsl_bspline.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_multifit.h>
#include <math.h>
#include <string.h>

enum { ORDER = 4 }; ///< of a cubic

/// Σ x_k B_k over all basis functions but that of the last coefficient. (GSL 2.7 and 2.8 share no
/// call for those alone that are not 0 at t.)
static double value(gsl_bspline_workspace *basis, gsl_vector *functions, const double *coefficients,
                    size_t count, double t) {
    double sum = 0;
    gsl_bspline_eval(GSL_MIN(GSL_MAX(t, 0), 1), functions, basis);
    for (size_t k = 0; k < count; k++)
        sum += coefficients[k] * gsl_vector_get(functions, k);
    return sum;
}

/// Values at `t` of a cubic B-spline with these coefficients, and with 0 after the last one:
///   y(t) = Σ_k x_k B_k(t),  k = 0 … count − 1,  0 ≤ t ≤ 1,  x_count = 0,
/// with count + 1 basis functions on equal knot intervals, the end knots fourfold (C. de Boor, A
/// Practical Guide to Splines, 1978, chapter IX). y(0) = x_0, y(1) = 0, and each coefficient acts
/// on four intervals alone. Fewer than three coefficients take a lower degree: a parabola, a
/// straight line.
///
/// The curve ends at 0 since the coefficient after the last is fixed to 0. A shift, with which the
/// Bézier curve ends at 0, would let the last coefficient move the whole curve, while here each
/// acts near its place alone. No coefficient is idle (a Bézier curve with equal coefficients is 0,
/// whatever they are), and the basis functions, which add up to 1 but near the end, stay well
/// conditioned for fits.
static enum status bspline_values(const double *coefficients, size_t count, const double *t,
                                  double *values, size_t points) {
    const size_t order = GSL_MIN(ORDER, count + 1), breaks = count + 1 - order + 2;
    gsl_bspline_workspace *basis = gsl_bspline_alloc(order, breaks);
    gsl_vector *functions = gsl_vector_alloc(count + 1);
    enum status status = STATUS_OK;
    if (basis == NULL || functions == NULL || gsl_bspline_knots_uniform(0, 1, basis) != 0)
        status = mf_status_fail(STATUS_NO_MEMORY, "out of memory for a spline of %zu coefficients",
                                count);
    for (size_t p = 0; status == STATUS_OK && p < points; p++)
        values[p] = value(basis, functions, coefficients, count, t[p]);
    gsl_vector_free(functions);
    gsl_bspline_free(basis);
    return status;
}

/// De Casteljau's recursion: n²/2 mixings a point, stable for any n (Bernstein weights of degree
/// 100 span 30 decades). 500 points of degree 100 take 3 ms.
static double casteljau(double *control, size_t degree, double t) {
    for (size_t level = degree; level > 0; level--)
        for (size_t k = 0; k < level; k++)
            control[k] += t * (control[k + 1] - control[k]);
    return control[0];
}

/// Values at `t` of the Bézier curve whose control points are the coefficients, shifted to end at
/// 0:
///   y(t) = Σ_k C(n, k) t^k (1 − t)^(n−k) x_k − x_n,  k = 0 … n,  0 ≤ t ≤ 1.
/// The curve begins at x_0 − x_n and is smoother than the coefficients by about sqrt(t(1 − t)/n) of
/// the range: neighbouring coefficients act together.
///
/// A. G. Baydin (thesis on DPD coarse-graining by evolutionary optimisation, 2008), whose control
/// points are a random walk that is likewise 0 at the cutoff. Here a shift makes the end 0. To set
/// the last coefficient to 0 instead leaves a cliff of half the range of coefficients at the end of
/// the curve, whose force heats four of five individuals of a first generation too much.
static enum status bezier_values(const double *coefficients, size_t count, const double *t,
                                 double *values, size_t points) {
    double *control = mf_memory_zeroed(count, sizeof *control);
    if (control == NULL)
        return STATUS_NO_MEMORY;
    for (size_t p = 0; p < points; p++) {
        memcpy(control, coefficients, count * sizeof *coefficients);
        values[p] = casteljau(control, count - 1, t[p]) - coefficients[count - 1];
    }
    mf_memory_free(control);
    return STATUS_OK;
}

static const struct shape bezier = {
    .name = "bezier",
    .summary = "Bezier curve whose control points are the coefficients; A. G. Baydin (2008)",
    .values = bezier_values,
};

static const struct shape bspline = {
    .name = "bspline",
    .summary =
        "clamped uniform cubic B-spline, each coefficient acts near its place; C. de Boor (1978)",
    .values = bspline_values,
};

const struct shape *const mf_shapes[] = {&bezier, &bspline, NULL};

NAMED_RECORD(struct shape);

enum status mf_shape_basis(const struct shape *shape, size_t coefficients, const double *t,
                           size_t points, double *basis) {
    OWNED double *unit = NULL, *column = NULL;
    TRY_ARRAY(unit, coefficients);
    TRY_ARRAY(column, points);
    for (size_t k = 0; k < coefficients; k++) {
        unit[k] = 1;
        TRY(shape->values(unit, coefficients, t, column, points));
        unit[k] = 0;
        for (size_t p = 0; p < points; p++)
            basis[p * coefficients + k] = column[p];
    }
    return STATUS_OK;
}

/// Relative to the largest singular value: rounding of a basis is 1e-16 of it, and what a curve
/// changes by the ridge is the square of this.
static const double ridge = 1e-7;

/// What is solved: GSL wants at least as many rows as columns, so rows of zeros may follow.
struct rows {
    gsl_matrix *basis;        ///< sqrt(w) B, shape [rows, count]
    gsl_vector *values;       ///< sqrt(w) y, shape [rows]
    gsl_vector *coefficients; ///< shape [count]
    gsl_multifit_linear_workspace *work;
};

static void rows_clear(struct rows *rows) {
    gsl_matrix_free(rows->basis);
    gsl_vector_free(rows->values);
    gsl_vector_free(rows->coefficients);
    gsl_multifit_linear_free(rows->work);
}

static enum status rows_init(struct rows *rows, size_t points, size_t count) {
    const size_t total = points > count ? points : count;
    *rows = (struct rows){gsl_matrix_calloc(total, count), gsl_vector_calloc(total),
                          gsl_vector_calloc(count), gsl_multifit_linear_alloc(total, count)};
    if (rows->basis && rows->values && rows->coefficients && rows->work)
        return STATUS_OK;
    return mf_status_fail(STATUS_NO_MEMORY, "out of memory for a fit of %zu coefficients", count);
}

/// Rows scaled by the roots of their weights.
static enum status rows_fill(struct rows *rows, const double *basis, const double *values,
                             const double *weights, size_t points) {
    const size_t count = rows->coefficients->size;
    for (size_t p = 0; p < points; p++) {
        const double root = weights ? sqrt(weights[p]) : 1;
        if (!isfinite(root * values[p]))
            return mf_status_fail(STATUS_BAD_INPUT, "point %zu of a curve is %g, its weight %g", p,
                                  values[p], weights ? weights[p] : 1);
        gsl_vector_set(rows->values, p, root * values[p]);
        for (size_t k = 0; k < count; k++)
            gsl_matrix_set(rows->basis, p, k, root * basis[p * count + k]);
    }
    return STATUS_OK;
}

static enum status rows_solve(struct rows *rows) {
    double residual, size;
    if (gsl_multifit_linear_svd(rows->basis, rows->work) != 0)
        return mf_status_fail(STATUS_BAD_INPUT, "a curve cannot be decomposed");
    const double largest = gsl_vector_get(rows->work->S, 0);
    if (!(largest > 0))
        return mf_status_fail(STATUS_BAD_INPUT, "no point of the curve has any weight");
    if (gsl_multifit_linear_solve(ridge * largest, rows->basis, rows->values, rows->coefficients,
                                  &residual, &size, rows->work) != 0)
        return mf_status_fail(STATUS_BAD_INPUT, "a curve cannot be fitted");
    return STATUS_OK;
}

enum status mf_shape_fit(const struct shape *shape, const double *t, const double *values,
                         const double *weights, size_t points, double *coefficients, size_t count) {
    CLEARED_BY(rows_clear) struct rows rows = {0};
    OWNED double *basis = NULL;
    if (points < 1)
        return mf_status_fail(STATUS_BAD_INPUT, "a curve without points has no coefficients");
    TRY_ARRAY(basis, points * count);
    TRY(mf_shape_basis(shape, count, t, points, basis));
    TRY(rows_init(&rows, points, count));
    TRY(rows_fill(&rows, basis, values, weights, points));
    TRY(rows_solve(&rows));
    for (size_t k = 0; k < count; k++)
        coefficients[k] = gsl_vector_get(rows.coefficients, k);
    return STATUS_OK;
}
