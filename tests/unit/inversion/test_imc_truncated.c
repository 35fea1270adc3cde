// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/imc_solve.h"

#include "base/rng.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>

enum { SIZE = 12 };

static const double temperature = 1.5;

/// C = Σ λ_k e_k e_kᵀ with cosines e_k, so that its singular values are known.
static double eigenvalue(int k) {
    return 100 * pow(0.4, k);
}

static double direction(int k, int a) {
    return sqrt((k == 0 ? 1.0 : 2.0) / SIZE) * cos(M_PI * k * (a + 0.5) / SIZE);
}

static void make_covariance(double covariance[SIZE][SIZE]) {
    for (int a = 0; a < SIZE; a++)
        for (int b = 0; b < SIZE; b++) {
            covariance[a][b] = 0;
            for (int k = 0; k < SIZE; k++)
                covariance[a][b] += eigenvalue(k) * direction(k, a) * direction(k, b);
        }
}

/// Excess of weight `weight[k]` along each direction, all with the variance 1.
static struct imc_system make_system(double covariance[SIZE][SIZE], const double *omega,
                                     double *excess, double *variance) {
    make_covariance(covariance);
    for (int a = 0; a < SIZE; a++) {
        variance[a] = 1;
        excess[a] = 0;
        for (int k = 0; k < SIZE; k++)
            excess[a] += omega[k] * direction(k, a);
    }
    return (struct imc_system){.size = SIZE,
                               .covariance = &covariance[0][0],
                               .excess = excess,
                               .variance = variance,
                               .temperature = temperature,
                               .spacing = 0.05};
}

static double component(const double *x, int k) {
    double sum = 0;
    for (int a = 0; a < SIZE; a++)
        sum += x[a] * direction(k, a);
    return sum;
}

static void test_imc_truncated_keeps_the_directions_above_the_strength(void **state) {
    (void)state;
    double covariance[SIZE][SIZE], omega[SIZE], excess[SIZE], variance[SIZE], x[SIZE];
    struct imc_solution solution;
    for (int k = 0; k < SIZE; k++)
        omega[k] = 1 + k;
    const struct imc_system system = make_system(covariance, omega, excess, variance);
    // 0.4^3 = 0.064, 0.4^4 = 0.0256.
    assert_ok(mf_imc_truncated(&system, 0.05, x, &solution));
    assert_close(solution.directions, 4, 0);
    for (int k = 0; k < SIZE; k++)
        assert_close(component(x, k), k < 4 ? temperature * omega[k] / eigenvalue(k) : 0, 1e-9);
    double left = 0;
    for (int k = 4; k < SIZE; k++)
        left += omega[k] * omega[k];
    assert_close_relative(solution.misfit, left / SIZE, 1e-9);
}

static void test_imc_truncated_tells_its_singular_values(void **state) {
    (void)state;
    double covariance[SIZE][SIZE], omega[SIZE], excess[SIZE], variance[SIZE], x[SIZE];
    double singular[SIZE], used[SIZE];
    struct imc_solution solution;
    for (int k = 0; k < SIZE; k++)
        omega[k] = 1 + k;
    struct imc_system system = make_system(covariance, omega, excess, variance);
    system.singular = singular;
    system.used = used;
    assert_ok(mf_imc_truncated(&system, 0.05, x, &solution));
    for (int k = 0; k < SIZE; k++) {
        assert_close_relative(singular[k], eigenvalue(k) / temperature, 1e-9);
        assert_identical(used[k], k < 4);
    }
}

static void test_imc_truncated_keeps_no_more_than_the_noise_asks(void **state) {
    (void)state;
    // Excess in three directions, and noise of one standard error in all but one: χ² 11/12.
    double covariance[SIZE][SIZE], omega[SIZE] = {20, -9, 6}, excess[SIZE], variance[SIZE];
    double x[SIZE];
    struct imc_solution solution;
    for (int k = 3; k < SIZE; k++)
        omega[k] = k % 2 ? 1 : -1;
    const struct imc_system system = make_system(covariance, omega, excess, variance);
    assert_ok(mf_imc_truncated(&system, 0, x, &solution));
    assert_close(solution.directions, 3, 0);
    assert_true(solution.misfit <= 1);
    for (int k = 0; k < SIZE; k++)
        assert_close(component(x, k), k < 3 ? temperature * omega[k] / eigenvalue(k) : 0, 1e-9);
}

static void test_imc_truncated_changes_nothing_when_the_excess_is_noise(void **state) {
    (void)state;
    double covariance[SIZE][SIZE], omega[SIZE], excess[SIZE], variance[SIZE], x[SIZE];
    struct imc_solution solution;
    for (int k = 0; k < SIZE; k++)
        omega[k] = 0.9;
    const struct imc_system system = make_system(covariance, omega, excess, variance);
    assert_ok(mf_imc_truncated(&system, 0, x, &solution));
    assert_close(solution.directions, 0, 0);
    for (int k = 0; k < SIZE; k++)
        assert_close(x[k], 0, 0);
}

static void test_imc_truncated_meets_a_constraint_by_the_directions_it_keeps(void **state) {
    (void)state;
    double covariance[SIZE][SIZE], omega[SIZE], excess[SIZE], variance[SIZE], x[SIZE], p[SIZE];
    struct imc_solution solution;
    for (int k = 0; k < SIZE; k++) {
        omega[k] = 1 + k;
        p[k] = 1 - (k + 0.5) / SIZE;
    }
    struct imc_system system = make_system(covariance, omega, excess, variance);
    system.constraint = p;
    system.wanted = 2.5;
    assert_ok(mf_imc_truncated(&system, 0.05, x, &solution));
    double met = 0, response = 0;
    for (int a = 0; a < SIZE; a++)
        met += p[a] * x[a];
    assert_close(met, 2.5, 1e-9);
    // At the least cost, Σ (s_k Δ_k)²: Δ_k ∝ p_k/s_k².
    for (int k = 0; k < SIZE; k++) {
        const double s = eigenvalue(k) / temperature;
        const double change = component(x, k) - (k < 4 ? omega[k] / s : 0);
        if (k == 0)
            response = change * s * s / component(p, k);
        assert_close(change, k < 4 ? response * component(p, k) / (s * s) : 0, 1e-9);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_imc_truncated_keeps_the_directions_above_the_strength),
        cmocka_unit_test(test_imc_truncated_tells_its_singular_values),
        cmocka_unit_test(test_imc_truncated_keeps_no_more_than_the_noise_asks),
        cmocka_unit_test(test_imc_truncated_changes_nothing_when_the_excess_is_noise),
        cmocka_unit_test(test_imc_truncated_meets_a_constraint_by_the_directions_it_keeps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
