// SPDX-License-Identifier: GPL-3.0-or-later
//
// Against the answers of VOTCA itself: tests/reference_data/README.md says where they come from.
// Bins far apart bend freely, so that what is left of the prior is Tikhonov's α ρ |x|², and VOTCA's
// λ is α ρ.
#include "base/memory.h"
#include "inversion/imc_solve.h"
#include "io/data_table.h"
#include "io/votca.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

#define FOLDER "tests/reference_data/votca/"

enum { MAX = 170 };

/// The answers are printed with 10 digits; values up to 1.5 in spce, 0.4 in the mixture.
static const double tolerance = 1e-9;

/// ρ of mf_imc_solve_prior, and a spacing that makes D as good as 0.
static const double ridge = 0.01, apart = 1e6;

/// VOTCA's step, in k_B T, from its matrix and its excess.
static void solve(const char *matrix_file, const char *excess_file, double lambda, double *x) {
    struct data_table matrix, excess;
    struct imc_solution solution;
    double column[MAX], variance[MAX];
    assert_ok(mf_data_table_read(&matrix, matrix_file, 1));
    assert_ok(mf_data_table_read(&excess, excess_file, 2));
    assert_int_equal(matrix.rows, matrix.columns);
    assert_int_equal(matrix.rows, excess.rows);
    assert_in_range(matrix.rows, 1, MAX);
    for (size_t k = 0; k < matrix.rows * matrix.rows; k++)
        matrix.values[k] = -matrix.values[k];
    for (size_t k = 0; k < excess.rows; k++) {
        column[k] = excess.values[2 * k + 1];
        variance[k] = 1;
    }
    const struct imc_system system = {.size = matrix.rows,
                                      .covariance = matrix.values,
                                      .excess = column,
                                      .variance = variance,
                                      .temperature = 1,
                                      .spacing = apart};
    assert_ok(mf_imc_solve(&system, lambda / ridge, x, &solution));
    mf_data_table_clear(&matrix);
    mf_data_table_clear(&excess);
}

/// Compare with the rows of an answer; returns their number.
static size_t compare(const char *file, const double *x) {
    struct votca_table answer;
    assert_ok(mf_votca_read(&answer, file));
    const size_t rows = answer.rows;
    for (size_t k = 0; k < rows; k++)
        assert_close(x[k], answer.y[k], tolerance);
    mf_votca_clear(&answer);
    return rows;
}

static void test_imc_solve_gives_the_answer_of_votca_when_it_is_weak(void **state) {
    (void)state;
    // 0 would be chosen from the noise.
    double x[MAX];
    solve(FOLDER "spce/CG-CG.gmc", FOLDER "spce/CG-CG.imc", 1e-18, x);
    assert_int_equal(compare(FOLDER "spce/CG-CG.dpot.imc", x), 67);
}

static void
test_imc_solve_gives_the_answer_of_votca_when_three_potentials_are_coupled(void **state) {
    (void)state;
    double x[MAX];
    solve(FOLDER "LJ1-LJ2/group_1.gmc", FOLDER "LJ1-LJ2/group_1.imc", 1000, x);
    size_t begin = compare(FOLDER "LJ1-LJ2/LJ1-LJ1.dpot.imc", x);
    begin += compare(FOLDER "LJ1-LJ2/LJ2-LJ2.dpot.imc", x + begin);
    begin += compare(FOLDER "LJ1-LJ2/LJ1-LJ2.dpot.imc", x + begin);
    assert_int_equal(begin, MAX);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_imc_solve_gives_the_answer_of_votca_when_it_is_weak),
        cmocka_unit_test(
            test_imc_solve_gives_the_answer_of_votca_when_three_potentials_are_coupled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
