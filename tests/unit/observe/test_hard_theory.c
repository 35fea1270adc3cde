// SPDX-License-Identifier: GPL-3.0-or-later
//
// Equations of state of hard discs and spheres against the virial series and the ideal gas; that
// they describe what collides is shown in test_kinetic_gas.
#include "observe/hard_theory.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

static struct hard_theory alike(int dimensions, double eta, double temperature) {
    enum { COUNT = 50 };
    double radius[COUNT], mass[COUNT];
    for (int k = 0; k < COUNT; k++) {
        radius[k] = 0.5;
        mass[k] = 2;
    }
    const double one = dimensions == 2 ? pi / 4 : pi / 6;
    return mf_hard_theory(dimensions, COUNT * one / eta, temperature, radius, mass, COUNT);
}

/// B_2 to B_4 over the powers of the volume; the last one is met nearly.
static void test_hard_theory_has_the_virial_coefficients(void **state) {
    (void)state;
    static const double b[4][3] = {{0}, {0}, {2, 3.1280, 4.2579}, {4, 10, 18.365}};
    for (int dimensions = 2; dimensions <= 3; dimensions++) {
        const double eta = 1e-3, z = alike(dimensions, eta, 1).compressibility_factor;
        const double series = 1 + b[dimensions][0] * eta + b[dimensions][1] * eta * eta +
                              b[dimensions][2] * pow(eta, 3);
        assert_close(z, series, 4e-9 + (dimensions == 2 ? 3e-9 : 0) + 30 * pow(eta, 4));
        assert_close(z, series, 1e-8);
    }
}

/// The virial series with ten coefficients of N. Clisby and B. M. McCoy, J. Stat. Phys. 122, 15
/// (2006), and steps like their last ones for the others: up to η = 0.5 the rest is below 1e-3.
static void test_hard_theory_has_the_sum_of_the_virial_series(void **state) {
    (void)state;
    static const double b[4][10] = {
        [2] = {1, 2, 3.12802, 4.25785, 5.33690, 6.36303, 7.3521, 8.3191, 9.2722, 10.2163},
        [3] = {1, 4, 10, 18.3648, 28.2245, 39.8151, 53.3444, 68.5375, 85.8128, 105.775}};
    static const double last_step[4] = {0, 0, 0.94, 20}, largest[4] = {0, 0, 0.52, 0.42};
    for (int dimensions = 2; dimensions <= 3; dimensions++)
        for (double eta = 0.1; eta < largest[dimensions]; eta += 0.1) {
            double series = 0;
            for (int n = 0; n < 60; n++)
                series += (n < 10 ? b[dimensions][n]
                                  : b[dimensions][9] + last_step[dimensions] * (n - 9)) *
                          pow(eta, n);
            print_message("%dD, eta %.1f: %.5f, series %.5f\n", dimensions, eta,
                          alike(dimensions, eta, 1).compressibility_factor, series);
            assert_close_relative(alike(dimensions, eta, 1).compressibility_factor, series, 0.0015);
        }
}

/// Z = 1 + 2^(d − 1) η χ, and the rate tells χ: 2 sqrt(π) ρ σ χ and 4 sqrt(π) ρ σ² χ times
/// sqrt(k_B T/m).
static void test_hard_theory_has_one_contact_value_for_pressure_and_rate(void **state) {
    (void)state;
    for (int dimensions = 2; dimensions <= 3; dimensions++)
        for (double eta = 0.05; eta < 0.5; eta += 0.1) {
            const struct hard_theory t = alike(dimensions, eta, 3);
            const double density = eta / (dimensions == 2 ? pi / 4 : pi / 6);
            const double chi =
                t.collision_rate / ((dimensions == 2 ? 2 : 4) * sqrt(pi) * density * sqrt(3.0 / 2));
            assert_close(t.eta, eta, 1e-12);
            assert_close(t.compressibility_factor, 1 + pow(2, dimensions - 1) * eta * chi, 1e-12);
            // λ = 1/(2 sqrt(2) ρ σ χ) and 1/(sqrt(2) π ρ σ² χ): half of Maxwell's pairs are slower.
            assert_close(t.mean_free_path,
                         1 / (sqrt(2) * density * chi * (dimensions == 2 ? 2 : pi)), 1e-12);
        }
}

/// Points among large spheres, which see the free volume: Z = 1 + … of the large, and 1/(1 − η) of
/// the points.
static void test_hard_theory_lets_points_feel_the_free_volume(void **state) {
    (void)state;
    enum { COUNT = 1000 };
    double radius[COUNT], mass[COUNT];
    for (int dimensions = 2; dimensions <= 3; dimensions++) {
        for (int k = 0; k < COUNT; k++) {
            radius[k] = k < COUNT / 2 ? 0.5 : 1e-9;
            mass[k] = 1;
        }
        const double eta = 0.3, one = dimensions == 2 ? pi / 4 : pi / 6;
        const double volume = COUNT / 2 * one / eta;
        const double both =
            mf_hard_theory(dimensions, volume, 1, radius, mass, COUNT).compressibility_factor;
        const double large =
            mf_hard_theory(dimensions, volume, 1, radius, mass, COUNT / 2).compressibility_factor;
        assert_close(both, 0.5 * large + 0.5 / (1 - eta), 1e-6);
    }
}

static void test_hard_theory_does_not_know_the_rates_of_too_many_species(void **state) {
    (void)state;
    enum { COUNT = 2 * HARD_THEORY_MAX_SPECIES };
    double radius[COUNT], mass[COUNT];
    for (int k = 0; k < COUNT; k++) {
        radius[k] = 0.5 + 0.01 * k;
        mass[k] = 1;
    }
    const struct hard_theory t = mf_hard_theory(2, 100, 1, radius, mass, COUNT);
    assert_true(isnan(t.collision_rate) && isnan(t.mean_free_path));
    assert_true(t.compressibility_factor > 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_hard_theory_has_the_virial_coefficients),
        cmocka_unit_test(test_hard_theory_has_the_sum_of_the_virial_series),
        cmocka_unit_test(test_hard_theory_has_one_contact_value_for_pressure_and_rate),
        cmocka_unit_test(test_hard_theory_lets_points_feel_the_free_volume),
        cmocka_unit_test(test_hard_theory_does_not_know_the_rates_of_too_many_species),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
