// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/hotelling.h"

#include "shared/testing.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_linalg.h>

/// dᵀ C⁻¹ d, with C the sum of the co-moments of one or two sets of samples.
static double square(const struct comoments *first, const struct comoments *second,
                     const double *difference) {
    const size_t p = first->size;
    gsl_matrix *factor = gsl_matrix_alloc(p, p);
    gsl_vector *d = gsl_vector_alloc(p);
    assert_non_null(factor);
    assert_non_null(d);
    for (size_t a = 0; a < p; a++) {
        gsl_vector_set(d, a, difference[a]);
        for (size_t b = 0; b < p; b++)
            gsl_matrix_set(factor, a, b,
                           first->comoment[a * p + b] + (second ? second->comoment[a * p + b] : 0));
    }
    gsl_linalg_cholesky_decomp1(factor);
    gsl_blas_dtrsv(CblasLower, CblasNoTrans, CblasNonUnit, factor, d);
    double result;
    gsl_blas_ddot(d, d, &result);
    gsl_matrix_free(factor);
    gsl_vector_free(d);
    return result;
}

double hotelling_one_sample(const struct comoments *samples, const double *mean) {
    const size_t p = samples->size;
    const double n = samples->count, freedom = n - (double)p;
    double difference[64];
    assert_true(freedom > 0 && p <= 64);
    for (size_t a = 0; a < p; a++)
        difference[a] = samples->mean[a] - mean[a];
    // T² with S = C / (n − 1).
    const double t2 = n * (n - 1) * square(samples, NULL, difference);
    return gsl_cdf_fdist_Q(t2 * freedom / ((double)p * (n - 1)), (double)p, freedom);
}

double hotelling_two_samples(const struct comoments *first, const struct comoments *second) {
    const size_t p = first->size;
    const double n = first->count, m = second->count, freedom = n + m - (double)p - 1;
    double difference[64];
    assert_true(freedom > 0 && p <= 64 && second->size == p);
    for (size_t a = 0; a < p; a++)
        difference[a] = first->mean[a] - second->mean[a];
    const double t2 = n * m / (n + m) * (n + m - 2) * square(first, second, difference);
    return gsl_cdf_fdist_Q(t2 * freedom / ((double)p * (n + m - 2)), (double)p, freedom);
}
