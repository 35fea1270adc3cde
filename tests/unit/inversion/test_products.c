// SPDX-License-Identifier: GPL-3.0-or-later
//
// Products of matrices: those of GSL, bit by bit.
#include "inversion/products.h"

#include "shared/is_close.h"
#include "shared/testing.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_rng.h>

enum { ROWS = 57, COLUMNS = 75, WIDE = 80 };

static void fill(gsl_matrix *matrix, double empty, gsl_rng *rng) {
    for (size_t i = 0; i < matrix->size1; i++)
        for (size_t j = 0; j < matrix->size2; j++)
            gsl_matrix_set(matrix, i, j,
                           gsl_rng_uniform(rng) < empty ? 0 : gsl_rng_uniform(rng) - 0.5);
}

static void test_squares_have_the_bits_of_gsl(void **state) {
    static const double cases[][3] = {{1, 0, 0}, {0.37, 0, 0.9}, {1, 1, 0.5}, {0.3, 1.7, 0}};
    (void)state;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_matrix *wide = gsl_matrix_alloc(ROWS, WIDE), *c = gsl_matrix_alloc(COLUMNS, COLUMNS),
               *expected = gsl_matrix_alloc(COLUMNS, COLUMNS);
    const gsl_matrix_view a = gsl_matrix_submatrix(wide, 0, 2, ROWS, COLUMNS);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        fill(wide, cases[k][2], rng);
        fill(c, 0, rng);
        gsl_matrix_memcpy(expected, c);
        gsl_blas_dsyrk(CblasLower, CblasTrans, cases[k][0], &a.matrix, cases[k][1], expected);
        assert_ok(mf_products_gram(cases[k][0], &a.matrix, cases[k][1], c));
        for (size_t i = 0; i < COLUMNS; i++)
            for (size_t j = 0; j < COLUMNS; j++) // above the diagonal as it was
                assert_identical(gsl_matrix_get(c, i, j), gsl_matrix_get(expected, i, j));
    }
    gsl_matrix_free(wide);
    gsl_matrix_free(c);
    gsl_matrix_free(expected);
    gsl_rng_free(rng);
}

/// But for the signs of zeros.
static void assert_same(const gsl_matrix *found, const gsl_matrix *expected) {
    for (size_t i = 0; i < found->size1; i++)
        for (size_t j = 0; j < found->size2; j++)
            assert_identical(gsl_matrix_get(found, i, j) + 0.0,
                             gsl_matrix_get(expected, i, j) + 0.0);
}

static void test_products_have_the_bits_of_gsl(void **state) {
    (void)state;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_matrix *wide = gsl_matrix_alloc(ROWS, WIDE), *b = gsl_matrix_alloc(COLUMNS, ROWS + 2),
               *square = gsl_matrix_alloc(COLUMNS, COLUMNS), *c = gsl_matrix_alloc(ROWS, ROWS + 2),
               *expected = gsl_matrix_alloc(ROWS, ROWS + 2),
               *d = gsl_matrix_alloc(COLUMNS, ROWS + 2),
               *wanted = gsl_matrix_alloc(COLUMNS, ROWS + 2);
    const gsl_matrix_view a = gsl_matrix_submatrix(wide, 0, 2, ROWS, COLUMNS);
    for (int k = 0; k < 3; k++) {
        fill(wide, 0.45 * k, rng);
        fill(b, 0.45 * k, rng);
        fill(square, 0.45 * k, rng);
        gsl_blas_dgemm(CblasNoTrans, CblasNoTrans, 1, &a.matrix, b, 0, expected);
        assert_ok(mf_products_find(&a.matrix, b, c));
        assert_same(c, expected);
        gsl_blas_dsymm(CblasLeft, CblasLower, 1, square, b, 0, wanted);
        assert_ok(mf_products_symmetric(square, b, d));
        assert_same(d, wanted);
    }
    gsl_matrix_free(wide);
    gsl_matrix_free(b);
    gsl_matrix_free(square);
    gsl_matrix_free(c);
    gsl_matrix_free(expected);
    gsl_matrix_free(d);
    gsl_matrix_free(wanted);
    gsl_rng_free(rng);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_squares_have_the_bits_of_gsl),
                                       cmocka_unit_test(test_products_have_the_bits_of_gsl)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
