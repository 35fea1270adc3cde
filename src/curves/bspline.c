// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/bspline.h"

#include <gsl/gsl_bspline.h>
#include <gsl/gsl_math.h>

enum { ORDER = 4 }; ///< of a cubic

/// Σ x_k B_k over those basis functions that are not 0 at t, the one of the last coefficient left
/// out.
static double value(gsl_bspline_workspace *basis, gsl_vector *nonzero, const double *coefficients,
                    size_t count, double t) {
    size_t first, last;
    double sum = 0;
    gsl_bspline_eval_nonzero(GSL_MIN(GSL_MAX(t, 0), 1), nonzero, &first, &last, basis);
    for (size_t k = first; k <= last && k < count; k++)
        sum += coefficients[k] * gsl_vector_get(nonzero, k - first);
    return sum;
}

enum status mf_bspline_values(const double *coefficients, size_t count, const double *t,
                              double *values, size_t points) {
    const size_t order = GSL_MIN(ORDER, count + 1), breaks = count + 1 - order + 2;
    gsl_bspline_workspace *basis = gsl_bspline_alloc(order, breaks);
    gsl_vector *nonzero = gsl_vector_alloc(order);
    enum status status = STATUS_OK;
    if (basis == NULL || nonzero == NULL || gsl_bspline_knots_uniform(0, 1, basis) != 0)
        status = mf_status_fail(STATUS_NO_MEMORY, "out of memory for a spline of %zu coefficients",
                                count);
    for (size_t p = 0; status == STATUS_OK && p < points; p++)
        values[p] = value(basis, nonzero, coefficients, count, t[p]);
    gsl_vector_free(nonzero);
    gsl_bspline_free(basis);
    return status;
}
