// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/shape.h"

#include "base/memory.h"
#include "base/names.h"
#include "curves/bezier.h"
#include "curves/bspline.h"

#include <gsl/gsl_multifit.h>

#include <math.h>

static const struct shape bezier = {
    .name = "bezier",
    .summary = "Bezier curve whose control points are the coefficients; A. G. Baydin (2008)",
    .values = mf_bezier_values,
};

static const struct shape bspline = {
    .name = "bspline",
    .summary =
        "clamped uniform cubic B-spline, each coefficient acts near its place; C. de Boor (1978)",
    .values = mf_bspline_values,
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
