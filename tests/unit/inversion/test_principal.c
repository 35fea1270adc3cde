// SPDX-License-Identifier: GPL-3.0-or-later
//
// The largest eigenvalues of a covariance matrix beside all of them by GSL.
#include "inversion/principal.h"

#include "shared/is_close.h"
#include "shared/testing.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_rng.h>
#include <math.h>

enum { MOST = 60, WANTED = 2 };

/// Σ_k λ_k v_k v_kᵀ over vectors that are not orthogonal; the rows and columns but for `first` to
/// `end` − 1 are 0.
static gsl_matrix *make(size_t n, size_t first, size_t end, double decay, gsl_rng *rng) {
    gsl_matrix *matrix = gsl_matrix_calloc(n, n);
    gsl_vector *v = gsl_vector_calloc(n);
    for (size_t k = 0; k < n; k++) {
        for (size_t a = first; a < end; a++)
            gsl_vector_set(v, a, gsl_rng_uniform(rng) - 0.5 + (k == 0) * 0.02 * (double)a);
        gsl_blas_dger(pow(decay, (double)k), v, v, matrix);
    }
    gsl_vector_free(v);
    return matrix;
}

static void check(size_t n, size_t first, size_t end, double decay) {
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_matrix *matrix = make(n, first, end, decay, rng), *copy = gsl_matrix_alloc(n, n);
    gsl_matrix *all = gsl_matrix_alloc(n, n), *vectors = gsl_matrix_alloc(n, WANTED);
    gsl_vector *expected = gsl_vector_alloc(n), *values = gsl_vector_alloc(WANTED);
    gsl_eigen_symmv_workspace *work = gsl_eigen_symmv_alloc(n);
    gsl_matrix_memcpy(copy, matrix);
    gsl_eigen_symmv(copy, expected, all, work);
    gsl_eigen_symmv_sort(expected, all, GSL_EIGEN_SORT_VAL_DESC);
    assert_ok(mf_principal_find(matrix, values, vectors));
    for (size_t k = 0; k < WANTED; k++) {
        gsl_vector_const_view found = gsl_matrix_const_column(vectors, k);
        gsl_vector_const_view right = gsl_matrix_const_column(all, k);
        double product;
        gsl_blas_ddot(&found.vector, &right.vector, &product);
        assert_close(gsl_vector_get(values, k), gsl_vector_get(expected, k),
                     1e-8 * gsl_vector_get(expected, 0));
        assert_close(fabs(product), 1, 1e-8);
        assert_close(gsl_blas_dnrm2(&found.vector), 1, 1e-12);
    }
    gsl_matrix_free(matrix);
    gsl_matrix_free(copy);
    gsl_matrix_free(all);
    gsl_matrix_free(vectors);
    gsl_vector_free(expected);
    gsl_vector_free(values);
    gsl_eigen_symmv_free(work);
    gsl_rng_free(rng);
}

static void test_the_largest_are_those_of_gsl(void **state) {
    (void)state;
    check(2, 0, 2, 0.5);
    check(5, 0, 4, 0.5);
    check(MOST, 0, MOST, 0.6);
    check(MOST, 0, MOST, 0.95);
    check(MOST, 0, MOST - 40, 0.9);
    check(MOST, MOST - 3, MOST, 0.5);
    check(MOST, 12, 16, 0.5);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_the_largest_are_those_of_gsl)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
