// SPDX-License-Identifier: GPL-3.0-or-later
//
// Factors of least squares: those of GSL, bit by bit.
#include "inversion/householder.h"

#include "shared/is_close.h"
#include "shared/testing.h"

#include <gsl/gsl_linalg.h>
#include <gsl/gsl_rng.h>

enum { WIDE = 80 };

static void fill(gsl_matrix *matrix, double empty, gsl_rng *rng) {
    for (size_t i = 0; i < matrix->size1; i++)
        for (size_t j = 0; j < matrix->size2; j++)
            gsl_matrix_set(matrix, i, j,
                           gsl_rng_uniform(rng) < empty ? 0 : gsl_rng_uniform(rng) - 0.5);
}

/// Second differences below what is there, as those of a prior, and the last column of zeros.
static void fill_prior(gsl_matrix *matrix, size_t from) {
    for (size_t k = from; k < matrix->size1; k++)
        for (size_t j = 0; j < matrix->size2; j++) {
            const size_t row = k - from;
            gsl_matrix_set(matrix, k, j, j == row || j == row + 2 ? 1.3 : j == row + 1 ? -2.6 : 0);
        }
    for (size_t k = 0; k < matrix->size1; k++)
        gsl_matrix_set(matrix, k, matrix->size2 - 1, 0);
}

static void check(size_t rows, size_t columns, double empty, size_t prior_from) {
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_matrix *wide = gsl_matrix_alloc(rows, WIDE), *expected = gsl_matrix_alloc(rows, columns);
    gsl_vector *reflect = gsl_vector_alloc(columns), *wanted = gsl_vector_alloc(columns);
    gsl_matrix_view a = gsl_matrix_submatrix(wide, 0, 2, rows, columns);
    fill(wide, empty, rng);
    fill_prior(&a.matrix, prior_from);
    gsl_matrix_memcpy(expected, &a.matrix);
    gsl_linalg_QR_decomp(expected, wanted);
    assert_ok(mf_householder_factor(&a.matrix, reflect));
    for (size_t j = 0; j < columns; j++) {
        assert_identical(gsl_vector_get(reflect, j) + 0.0, gsl_vector_get(wanted, j) + 0.0);
        for (size_t i = 0; i < rows; i++) // zeros may have another sign
            assert_identical(gsl_matrix_get(&a.matrix, i, j) + 0.0,
                             gsl_matrix_get(expected, i, j) + 0.0);
    }
    gsl_matrix_free(wide);
    gsl_matrix_free(expected);
    gsl_vector_free(reflect);
    gsl_vector_free(wanted);
    gsl_rng_free(rng);
}

static void test_factors_have_the_bits_of_gsl(void **state) {
    (void)state;
    for (size_t columns = 1; columns < 70; columns += columns < 20 ? 1 : 7) {
        check(columns, columns, 0, columns);           // square, with a column of zeros
        check(3 * columns, columns, 0, columns);       // over a prior
        check(2 * columns, columns, 0.9, 2 * columns); // nearly empty
        check(2 * columns, columns, 1, 0);             // a prior alone
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_factors_have_the_bits_of_gsl)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
