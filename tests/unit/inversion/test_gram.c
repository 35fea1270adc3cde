// SPDX-License-Identifier: GPL-3.0-or-later
//
// Products of a matrix with its own transpose: those of GSL, bit by bit.
#include "inversion/gram.h"

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

static void test_gram_has_the_bits_of_gsl(void **state) {
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
        assert_ok(mf_gram(cases[k][0], &a.matrix, cases[k][1], c));
        for (size_t i = 0; i < COLUMNS; i++)
            for (size_t j = 0; j < COLUMNS; j++) // above the diagonal as it was
                assert_identical(gsl_matrix_get(c, i, j), gsl_matrix_get(expected, i, j));
    }
    gsl_matrix_free(wide);
    gsl_matrix_free(c);
    gsl_matrix_free(expected);
    gsl_rng_free(rng);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_gram_has_the_bits_of_gsl)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
