// SPDX-License-Identifier: GPL-3.0-or-later
//
// Against the answers of VOTCA itself: tests/reference_data/README.md says where they come from.
#include "base/memory.h"
#include "inversion/imc_solve.h"
#include "io/data_table.h"
#include "io/votca.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

#define FOLDER "tests/reference_data/votca/"

enum { MOST = 170 };

/// The answers are printed with 10 digits; values up to 1.5 in spce, 0.4 in the mixture.
static const double tolerance = 1e-9;

/// VOTCA's step, in k_B T, from its matrix and its excess.
static void solve(const char *matrix_file, const char *excess_file, double strength, double *x) {
    struct data_table matrix, excess;
    struct imc_solution solution;
    double column[MOST], variance[MOST];
    assert_ok(mf_data_table_read(&matrix, matrix_file, 1));
    assert_ok(mf_data_table_read(&excess, excess_file, 2));
    assert_int_equal(matrix.rows, matrix.columns);
    assert_int_equal(matrix.rows, excess.rows);
    assert_in_range(matrix.rows, 1, MOST);
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
                                      .spacing = 1};
    assert_ok(mf_imc_votca(&system, strength, x, &solution));
    assert_identical(solution.strength, strength);
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

static void test_imc_votca_gives_its_answer_when_nothing_is_regularised(void **state) {
    (void)state;
    double x[MOST];
    solve(FOLDER "spce/CG-CG.gmc", FOLDER "spce/CG-CG.imc", 0, x);
    assert_int_equal(compare(FOLDER "spce/CG-CG.dpot.imc", x), 67);
}

static void test_imc_votca_gives_its_answer_when_three_potentials_are_coupled(void **state) {
    (void)state;
    double x[MOST];
    solve(FOLDER "LJ1-LJ2/group_1.gmc", FOLDER "LJ1-LJ2/group_1.imc", 1000, x);
    size_t begin = compare(FOLDER "LJ1-LJ2/LJ1-LJ1.dpot.imc", x);
    begin += compare(FOLDER "LJ1-LJ2/LJ2-LJ2.dpot.imc", x + begin);
    begin += compare(FOLDER "LJ1-LJ2/LJ1-LJ2.dpot.imc", x + begin);
    assert_int_equal(begin, MOST);
}

static void test_imc_votca_leaves_out_what_is_singular(void **state) {
    (void)state;
    // C sees (1, 1) alone; the step is C's pseudo-inverse, and the misfit what it cannot remove.
    static const double covariance[] = {2, 2, 2, 2}, excess[] = {3, 1}, variance[] = {0.25, 0.25};
    double x[2], singular[2], used[2];
    const struct imc_system system = {.size = 2,
                                      .covariance = covariance,
                                      .excess = excess,
                                      .variance = variance,
                                      .temperature = 1.5,
                                      .spacing = 1,
                                      .singular = singular,
                                      .used = used};
    struct imc_solution solution;
    assert_ok(mf_imc_votca(&system, 0, x, &solution));
    for (int k = 0; k < 2; k++)
        assert_close(x[k], 1.5 * 0.5, 1e-12);
    assert_close(solution.directions, 1, 1e-12);
    assert_close(singular[0], 4, 1e-12);
    assert_close(singular[1], 0, 1e-12);
    assert_close(used[0], 1, 1e-12);
    assert_close(used[1], 0, 1e-12);
    assert_close(solution.misfit, 4, 1e-12);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_imc_votca_gives_its_answer_when_nothing_is_regularised),
        cmocka_unit_test(test_imc_votca_gives_its_answer_when_three_potentials_are_coupled),
        cmocka_unit_test(test_imc_votca_leaves_out_what_is_singular),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
