// SPDX-License-Identifier: GPL-3.0-or-later
//
// Weights of local densities and the energies of these: integrals over space, ends, values.
#include "curves/weight.h"

#include "curves/density_energy.h"
#include "curves/expression_law.h"
#include "curves/sampled.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

/// ∫ w over space by the rule of Simpson.
static double integral(const struct curve *curve, int dimensions) {
    enum { STEPS = 2000 };
    const double step = mf_curve_cutoff(curve) / STEPS;
    double sum = 0;
    for (int k = 0; k <= STEPS; k++) {
        const double r = k * step, around = dimensions == 3 ? 4 * M_PI * r * r : 2 * M_PI * r;
        sum += (k == 0 || k == STEPS ? 1 : k % 2 ? 4 : 2) * around * mf_curve_value(curve, r);
    }
    return sum * step / 3;
}

static void test_weights_have_the_integral_one_where_they_are_densities(void **state) {
    (void)state;
    static const struct curve_family *const families[] = {&mf_weight_lucy,
                                                          &mf_weight_many_body_dpd};
    for (int n = 0; n < 2; n++)
        for (int dimensions = 2; dimensions <= 3; dimensions++) {
            struct weight_parameters parameters = {0, 0.8, dimensions};
            const struct curve curve = {families[n], &parameters};
            assert_true(mf_weight_is_normalised(&curve));
            assert_close(integral(&curve, dimensions), 1, 1e-9);
        }
}

/// c_0 … c_6 as LAMMPS's manual has them, pair_style local/density.
static void test_sanyal_and_shells_weight_is_an_even_polynomial(void **state) {
    (void)state;
    struct weight_parameters parameters = {0.7, 1.9, 3};
    struct weight_table table;
    const struct curve curve = {&mf_weight_sanyal_shell, &parameters};
    const double x = pow(0.7 / 1.9, 2), cube = pow(1 - x, 3), c2 = 1.9 * 1.9;
    const double c[] = {(1 - 3 * x) / cube, 6 * x / (c2 * cube), -3 * (1 + x) / (c2 * c2 * cube),
                        2 / (c2 * c2 * c2 * cube)};
    assert_ok(mf_weight_tabulate(&table, &curve));
    for (double r = 0.05; r < 2.2; r += 0.1) {
        const double s = r * r, at = c[0] + s * (c[1] + s * (c[2] + s * c[3]));
        const double slope = 2 * r * (c[1] + s * (2 * c[2] + s * 3 * c[3]));
        double value, change;
        mf_weight_evaluate(&table, r, &value, &change);
        assert_close(mf_curve_value(&curve, r), r < 0.7 ? 1 : r < 1.9 ? at : 0, 1e-13);
        assert_close(value, mf_curve_value(&curve, r), 1e-10);
        assert_close(change, r < 0.7 || r > 1.9 ? 0 : slope, 1e-6);
    }
    mf_weight_clear(&table);
}

static void test_weights_without_range_are_refused(void **state) {
    (void)state;
    struct weight_table table;
    struct weight_parameters parameters = {2, 2, 3};
    assert_fails(mf_weight_tabulate(&table, &(struct curve){&mf_weight_sanyal_shell, &parameters}),
                 STATUS_BAD_INPUT, "the inner_cutoff 2 is not below the cutoff 2");
    struct expression_parameters flat = {.formula = "3", .cutoff = 1};
    assert_fails(mf_weight_tabulate(&table, &(struct curve){&mf_expression_potential, &flat}),
                 STATUS_BAD_INPUT, "the weight is 0 at all distances: it has no range");
}

/// Value and slope by hand.
static void assert_energy(const struct density_energy *energy, double density, double value,
                          double slope, double tolerance) {
    double found;
    assert_close(mf_density_energy_value(energy, density, &found), value, tolerance);
    assert_close(found, slope, tolerance);
}

static void test_energies_go_on_as_straight_lines_beyond_a_table(void **state) {
    (void)state;
    struct density_energy energy;
    struct curve curve;
    double x[60], f[60];
    assert_ok(mf_curve_create(&curve, &mf_density_energy_table));
    for (int k = 0; k < 60; k++) {
        x[k] = 1 + k * 0.1;
        f[k] = exp(-x[k]) + 7;
    }
    assert_ok(mf_density_energy_set_points(&curve, x, f, 60));
    assert_ok(mf_density_energy_init(&energy, &curve));
    mf_curve_clear(&curve);
    assert_energy(&energy, 3.03, exp(-3.03) + 7, -exp(-3.03), 1e-5);
    double slope;
    const double last = 6.9, end = mf_density_energy_value(&energy, last, &slope);
    assert_close(end, exp(-last) + 7, 1e-12);
    assert_energy(&energy, last + 5, end + 5 * slope, slope, 1e-12);
    const double first = mf_density_energy_value(&energy, 1, &slope);
    assert_close(slope, -exp(-1), 0.03); // of a spline whose ends are straight
    assert_energy(&energy, -1.5, first - 2.5 * slope, slope, 1e-9);
    mf_density_energy_clear(&energy);
}

/// Densities are 1000 times and energies 2.5 times as large in the file.
static void test_energies_follow_the_units_of_the_file(void **state) {
    (void)state;
    struct density_energy energy;
    struct curve curve;
    assert_ok(mf_curve_create(&curve, &mf_density_energy_polynomial));
    double *const c = curve.parameters;
    c[1] = 2e-6;
    c[2] = -1e-9;
    mf_curve_scale(&curve, 1000, 2.5);
    assert_ok(mf_density_energy_init(&energy, &curve));
    assert_energy(&energy, 3, (2e-6 * 9e6 - 1e-9 * 27e9) / 2.5, (4e-6 * 3e6 - 3e-9 * 9e9) / 2.5,
                  1e-12);
    mf_curve_clear(&curve);
    assert_ok(mf_curve_create(&curve, &mf_density_energy_expression));
    for (const struct field *field = curve.family->fields; field->name; field++)
        if (strcmp(field->name, "formula") == 0)
            strcpy((char *)curve.parameters + field->offset, "2e-6*rho^2 - 1e-9*rho^3");
        else if (strcmp(field->name, "maximum") == 0)
            memcpy((char *)curve.parameters + field->offset, &(double){9000}, sizeof(double));
    mf_curve_scale(&curve, 1000, 2.5);
    assert_ok(mf_density_energy_init(&energy, &curve));
    assert_close(energy.high, 9, 1e-12);
    assert_energy(&energy, 3, (2e-6 * 9e6 - 1e-9 * 27e9) / 2.5, (4e-6 * 3e6 - 3e-9 * 9e9) / 2.5,
                  1e-6);
    mf_density_energy_clear(&energy);
    mf_curve_clear(&curve);
}

/// The powers about an origin, less the value of a bead alone.
static void test_polynomials_may_have_an_origin(void **state) {
    (void)state;
    static const double c[] = {0.7, -0.2, 0.03, -0.004}, origin = 2.5;
    struct density_energy energy;
    struct curve curve;
    assert_ok(mf_curve_create(&curve, &mf_density_energy_polynomial));
    memcpy(curve.parameters, c, sizeof c);
    for (const struct field *field = curve.family->fields; field->name; field++)
        if (strcmp(field->name, "origin") == 0)
            memcpy((char *)curve.parameters + field->offset, &origin, sizeof origin);
    assert_ok(mf_density_energy_init(&energy, &curve));
    mf_curve_clear(&curve);
    for (double density = 0; density < 8; density += 0.37) {
        double value = 0, slope = 0;
        for (int n = 1; n <= 4; n++) {
            value += c[n - 1] * (pow(density - origin, n) - pow(-origin, n));
            slope += n * c[n - 1] * pow(density - origin, n - 1);
        }
        assert_energy(&energy, density, value, slope, 1e-11);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_weights_have_the_integral_one_where_they_are_densities),
        cmocka_unit_test(test_sanyal_and_shells_weight_is_an_even_polynomial),
        cmocka_unit_test(test_weights_without_range_are_refused),
        cmocka_unit_test(test_energies_go_on_as_straight_lines_beyond_a_table),
        cmocka_unit_test(test_energies_follow_the_units_of_the_file),
        cmocka_unit_test(test_polynomials_may_have_an_origin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
