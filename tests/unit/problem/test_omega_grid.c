// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/omega_grid.h"

#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

static const double rounding = 1e-12;

static void test_omega_grid_has_its_ends_at_both_cutoffs(void **state) {
    (void)state;
    struct omega_grid grid;
    mf_omega_grid_init(&grid, 0.3, 1.7);
    assert_close(grid.r[0], 0.3, 0);
    assert_close(grid.r[OMEGA_POINTS - 1], 1.7, rounding);
    for (int k = 1; k < OMEGA_POINTS; k++)
        assert_close(grid.r[k] - grid.r[k - 1], 1.4 / 200, rounding);
}

static void test_omega_grid_value_is_straight_between_the_points(void **state) {
    (void)state;
    double omega[OMEGA_POINTS];
    struct omega_grid grid;
    mf_omega_grid_init(&grid, 0.3, 1.7);
    for (int k = 0; k < OMEGA_POINTS; k++)
        omega[k] = k % 2 ? 1 : 4;
    for (int k = 0; k + 1 < OMEGA_POINTS; k++)
        for (int part = 1; part < 4; part++) {
            const double r = grid.r[k] + 0.25 * part * (grid.r[k + 1] - grid.r[k]);
            const double expected = omega[k] + 0.25 * part * (omega[k + 1] - omega[k]);
            assert_close(mf_omega_grid_value(&grid, omega, r), expected, 1e-10);
        }
    assert_close(mf_omega_grid_value(&grid, omega, 0.3), 4, rounding);
    assert_identical(mf_omega_grid_value(&grid, omega, 0.3 - 1e-9), 0.0);
    assert_identical(mf_omega_grid_value(&grid, omega, 0), 0.0);
    assert_identical(mf_omega_grid_value(&grid, omega, 1.7), 0.0);
    assert_identical(mf_omega_grid_value(&grid, omega, 5), 0.0);
}

/// A friction weight of steps, with a wall at the inner cutoff: what a smooth table would swing
/// about.
static void test_omega_grid_table_is_never_negative_when_omega_jumps(void **state) {
    (void)state;
    double omega[OMEGA_POINTS], value;
    struct omega_grid grid;
    struct table table;
    mf_omega_grid_init(&grid, 0.3, 1.7);
    for (int k = 0; k < OMEGA_POINTS; k++)
        omega[k] = k / 20 % 2 ? 0 : 5;
    assert_ok(mf_omega_grid_table(&grid, omega, &table));
    assert_close(table.cutoff, 1.7, 0);
    for (double r = 0; r < 1.7; r += 1e-4) {
        mf_table_evaluate(&table, r, &value, NULL, NULL);
        assert_true(value >= 0 && value <= 5 + rounding);
        if (r < 0.29)
            assert_identical(value, 0.0);
    }
    mf_table_clear(&table);
}

static void test_omega_grid_table_has_the_values_of_the_curve(void **state) {
    (void)state;
    double omega[OMEGA_POINTS], value;
    struct omega_grid grid;
    struct table table;
    mf_omega_grid_init(&grid, 0, 1.2);
    for (int k = 0; k < OMEGA_POINTS; k++)
        omega[k] = 3 * pow(1 - grid.r[k] / 1.2, 1.5);
    assert_ok(mf_omega_grid_table(&grid, omega, &table));
    for (double r = 0.001; r < 1.2; r += 0.00317) {
        mf_table_evaluate(&table, r, &value, NULL, NULL);
        assert_close(value, mf_omega_grid_value(&grid, omega, r), 1e-3);
    }
    mf_table_clear(&table);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_omega_grid_has_its_ends_at_both_cutoffs),
        cmocka_unit_test(test_omega_grid_value_is_straight_between_the_points),
        cmocka_unit_test(test_omega_grid_table_is_never_negative_when_omega_jumps),
        cmocka_unit_test(test_omega_grid_table_has_the_values_of_the_curve),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
