// SPDX-License-Identifier: GPL-3.0-or-later
//
// Equations of triangular matrices: the numbers of GSL, bit by bit.
#include "inversion/triangular.h"

#include "shared/is_close.h"
#include "shared/testing.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_rng.h>

enum { SIZE = 75, OTHERS = 45, WIDE = 80 };

static void fill(gsl_matrix *matrix, double empty, gsl_rng *rng) {
    for (size_t i = 0; i < matrix->size1; i++)
        for (size_t j = 0; j < matrix->size2; j++)
            gsl_matrix_set(matrix, i, j,
                           i == j                         ? 2 + gsl_rng_uniform(rng)
                           : gsl_rng_uniform(rng) < empty ? 0
                                                          : gsl_rng_uniform(rng) - 0.5);
}

/// But for the signs of zeros.
static void assert_same(const gsl_matrix *found, const gsl_matrix *expected) {
    for (size_t i = 0; i < found->size1; i++)
        for (size_t j = 0; j < found->size2; j++)
            assert_identical(gsl_matrix_get(found, i, j) + 0.0,
                             gsl_matrix_get(expected, i, j) + 0.0);
}

static void check(double empty) {
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_matrix *triangle = gsl_matrix_alloc(SIZE, WIDE), *tall = gsl_matrix_alloc(SIZE, WIDE),
               *wide = gsl_matrix_alloc(OTHERS, WIDE), *left = gsl_matrix_alloc(SIZE, OTHERS),
               *right = gsl_matrix_alloc(OTHERS, SIZE);
    const gsl_matrix_view t = gsl_matrix_submatrix(triangle, 0, 2, SIZE, SIZE);
    gsl_matrix_view b = gsl_matrix_submatrix(tall, 0, 3, SIZE, OTHERS),
                    c = gsl_matrix_submatrix(wide, 0, 1, OTHERS, SIZE);
    fill(triangle, empty, rng);
    for (size_t k = 0; k < SIZE; k++)
        gsl_matrix_set(triangle, k, k + 2, 2 + gsl_rng_uniform(rng));
    fill(tall, empty, rng);
    fill(wide, empty, rng);
    gsl_matrix_memcpy(left, &b.matrix);
    gsl_matrix_memcpy(right, &c.matrix);
    gsl_blas_dtrsm(CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, 1, &t.matrix, left);
    for (size_t i = 0; i < OTHERS; i++) {
        gsl_vector_view row = gsl_matrix_row(right, i);
        gsl_blas_dtrsv(CblasUpper, CblasTrans, CblasNonUnit, &t.matrix, &row.vector);
    }
    assert_ok(mf_triangular_left(&t.matrix, &b.matrix));
    assert_same(&b.matrix, left);
    gsl_matrix *other = gsl_matrix_alloc(OTHERS, SIZE);
    gsl_matrix_memcpy(other, &c.matrix);
    gsl_blas_dtrsm(CblasRight, CblasUpper, CblasNoTrans, CblasNonUnit, 1, &t.matrix, other);
    mf_triangular_right(&t.matrix, &c.matrix);
    assert_same(&c.matrix, right);
    assert_same(&c.matrix, other);
    gsl_matrix_free(triangle);
    gsl_matrix_free(tall);
    gsl_matrix_free(wide);
    gsl_matrix_free(left);
    gsl_matrix_free(right);
    gsl_matrix_free(other);
    gsl_rng_free(rng);
}

static void test_triangular_equations_have_the_bits_of_gsl(void **state) {
    (void)state;
    check(0);
    check(0.9);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_triangular_equations_have_the_bits_of_gsl)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
