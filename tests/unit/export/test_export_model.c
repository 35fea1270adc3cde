// SPDX-License-Identifier: GPL-3.0-or-later
//
// Export: columns of results in any units, the units of engines, power laws, and how far
// interpolations are off.
#include "curves/formula.h"
#include "export/export_columns.h"
#include "export/export_grid.h"
#include "export/export_projection.h"
#include "export/export_units.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <gsl/gsl_spline.h>
#include <math.h>

/// SPC water: λ = 0.465 nm, T_0 = 298 K, μ = 18.0154 u.
static const struct units water = {.length = 0.465, .temperature = 298, .mass = 2.9915e-26};

static void test_columns_are_reduced_whatever_their_heading_says(void **state) {
    static const char text[] = "# r[nm]\tphi[kJ/mol]\tforce\n0.465 2.4777100 1\n0.93 0 2\n";
    static const struct export_column wanted[] = {
        {"r", "lambda", true}, {"phi", "k_B.T_0", true}, {"phi_error", "k_B.T_0", false}, {0}};
    struct export_columns columns;
    const char *file = temporary_folder_write(*state, "t.tsv", text, sizeof text - 1);
    assert_ok(mf_export_columns_read(&columns, file, &water, wanted));
    assert_int_equal(columns.rows, 2);
    assert_true(fabs(columns.values[0] - 1) < 1e-12 && fabs(columns.values[1] - 2) < 1e-12);
    assert_true(fabs(columns.values[2] - 1) < 1e-6); // R T = 8.31446 J/(mol K) 298 K
    assert_true(isnan(columns.values[4]));
    mf_export_columns_clear(&columns);
    const struct units none = {0};
    assert_fails(mf_export_columns_read(&columns, file, &none, wanted), STATUS_BAD_INPUT,
                 "has no units");
    static const struct export_column missing[] = {{"r", "lambda", true}, {"g", "1", true}, {0}};
    assert_fails(mf_export_columns_read(&columns, file, &water, missing), STATUS_BAD_INPUT,
                 "no column called g");
}

static void test_units_of_engines_are_consistent(void **state) {
    (void)state;
    // LAMMPS, update.cpp, units real: boltz, and mvv2e of g/mol (A/fs)² in kcal/mol.
    const struct export_units real = mf_export_units(EXPORT_REAL, &water, false);
    assert_true(fabs(real.energy / real.temperature / 0.0019872067 - 1) < 2e-6);
    const double mvv2e = 48.88821291 * 48.88821291, v = export_units_velocity(&real);
    assert_true(fabs(real.mass * v * v * mvv2e / real.energy - 1) < 2e-6);
    assert_true(fabs(real.pressure / (real.energy / pow(real.length, 3) * 68568.415) - 1) < 2e-6);
    // nm, ps, u, kJ/mol and A, ps, u, 10 J/mol belong together.
    const struct export_units nm = mf_export_units(EXPORT_NANOMETRES, &water, true);
    const double nm_v = export_units_velocity(&nm);
    assert_true(fabs(nm.mass * nm_v * nm_v / nm.energy - 1) < 1e-8);
    const struct export_units internal = mf_export_units(EXPORT_DL_POLY, &water, true);
    const double a_v = export_units_velocity(&internal);
    assert_true(fabs(internal.mass * a_v * a_v / (100 * internal.energy) - 1) < 1e-8);
    // In two dimensions pressure is energy over an area.
    struct units plane = water;
    plane.dimensions = 2;
    const struct export_units flat = mf_export_units(EXPORT_REAL, &plane, false);
    assert_true(fabs(flat.pressure / (flat.energy / pow(flat.length, 2)) - 1) < 1e-12);
    assert_string_equal(flat.pressure_name, "kcal/mol/A^2");
    // An engine without reduced units: 1 nm, 1 kJ/mol, 1 ps.
    const struct units none = {0};
    const struct export_units made_up = mf_export_units(EXPORT_NANOMETRES, &none, true);
    assert_true(fabs(made_up.time - 1) < 1e-9 && fabs(made_up.energy - 1) < 1e-9);
    assert_true(fabs(made_up.temperature - 120.2724) < 1e-4);
    assert_true(mf_export_units(EXPORT_NANOMETRES, &none, false).system == EXPORT_REDUCED);
}

static void make(struct curve *curve, const struct curve_family *family, double *parameters,
                 size_t numbers) {
    assert_ok(mf_curve_create(curve, family));
    memcpy(curve->parameters, parameters, numbers * sizeof *parameters);
}

static void test_power_laws_are_found_and_others_are_not(void **state) {
    (void)state;
    struct curve curve;
    struct table omega = {0}, potential = {0};
    const struct curve_family *power = mf_curve_find(mf_curve_omegas, "power");
    assert_ok(mf_curve_create(&curve, mf_curve_find(mf_curve_potentials, "soft-repulsion")));
    assert_ok(mf_table_init_potential(&potential, &curve));
    mf_curve_clear(&curve);
    static const struct {
        double sigma, exponent, inner;
        bool is_power;
    } cases[] = {{3, 1, 0, true}, {2, 0.37, 0, true}, {5, 2.5, 0, true}, {3, 1, 0.7, false}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        double values[] = {cases[k].sigma, cases[k].exponent, cases[k].inner, 1.3};
        make(&curve, power, values, 4);
        assert_ok(mf_table_init_omega(&omega, &curve));
        const struct export_power found = mf_export_power_fit(
            &omega, &potential, 0, 1, &(struct export_power){.family = EXPORT_POWER});
        assert_true((found.misfit < EXPORT_POWER_BOUND) == cases[k].is_power);
        assert_true(fabs(found.cutoff - 1.3) < 1e-12);
        if (cases[k].is_power) {
            assert_true(fabs(found.amplitude / cases[k].sigma - 1) < 2e-3);
            assert_true(fabs(found.exponent / cases[k].exponent - 1) < 2e-3);
        }
        mf_table_clear(&omega);
        mf_curve_clear(&curve);
    }
    mf_table_clear(&potential);
}

/// The nearest A (1 − r) to 3 (1 − r)² without a potential, by Euler's integrals: A/3 =
/// B(3, 4)/B(3, 3) = 1/2, misfit² = 1 − B(3, 4)²/(B(3, 5) B(3, 3)) = 1/8.
static void test_engines_with_one_exponent_get_the_nearest_of_it(void **state) {
    (void)state;
    struct curve curve;
    struct table omega = {0}, potential = {0};
    make(&curve, mf_curve_find(mf_curve_potentials, "soft-repulsion"), (double[]){0, 1}, 2);
    assert_ok(mf_table_init_potential(&potential, &curve));
    mf_curve_clear(&curve);
    make(&curve, mf_curve_find(mf_curve_omegas, "power"), (double[]){3, 2, 0, 1}, 4);
    assert_ok(mf_table_init_omega(&omega, &curve));
    mf_curve_clear(&curve);
    const struct export_power found = mf_export_power_fit(
        &omega, &potential, 0, 1, &(struct export_power){.family = EXPORT_LINEAR});
    assert_true(found.exponent == 1 && found.cutoff == 1);
    assert_true(fabs(found.amplitude - 1.5) < 1e-4);
    assert_true(fabs(found.misfit - sqrt(0.125)) < 1e-4);
    mf_table_clear(&omega);
    mf_table_clear(&potential);
}

/// Lennard-Jones to 1.5 ends with a force of 1.16: HOOMD's falls to 0 after the last of its rows,
/// however many there are. That interval is no fault of a table, and all before it are.
static void test_jump_of_the_force_at_the_cutoff_needs_no_rows(void **state) {
    (void)state;
    struct curve curve;
    struct table table = {0};
    struct export_error error[2];
    assert_ok(mf_curve_create(&curve, mf_curve_find(mf_curve_potentials, "lennard-jones")));
    ((struct formula_lennard_jones_parameters *)curve.parameters)->cutoff = 1.5;
    assert_ok(mf_table_init_potential(&table, &curve));
    mf_curve_clear(&curve);
    for (int k = 0; k < 2; k++) {
        struct export_grid grid;
        assert_ok(mf_export_grid_make(&grid, &mf_export_grid_open, &table, 0, 0, k ? 1001 : 5001));
        error[k] = mf_export_grid_error(&grid, &mf_export_grid_open, &table, 0, 1);
        mf_export_grid_clear(&grid);
    }
    assert_true(error[0].largest_force * EXPORT_FORCE_BOUND < 1.15);
    assert_true(error[0].force < EXPORT_FORCE_BOUND && error[0].phi < EXPORT_PHI_BOUND);
    assert_true(error[1].force > 20 * error[0].force && error[1].force < 30 * error[0].force);
    mf_table_clear(&table);
}

/// Errors of twice as many rows are a fourth, of straight lines as of LAMMPS, and what is told is
/// what a check at other distances finds.
static void test_errors_of_interpolations_are_measured(void **state) {
    (void)state;
    struct curve curve;
    struct table table = {0};
    assert_ok(mf_curve_create(&curve, mf_curve_find(mf_curve_potentials, "lennard-jones")));
    assert_ok(mf_table_init_potential(&table, &curve));
    mf_curve_clear(&curve);
    const struct export_interpolation *const all[] = {
        &mf_export_grid_square, &mf_export_grid_linear,  &mf_export_grid_open,
        &mf_export_grid_spline, &mf_export_grid_hermite, &mf_export_grid_quadratic};
    for (size_t n = 0; n < sizeof all / sizeof *all; n++) {
        struct export_error error[2];
        for (int k = 0; k < 2; k++) {
            struct export_grid grid;
            assert_ok(mf_export_grid_make(&grid, all[n], &table, 0, 0, k ? 4001 : 2001));
            error[k] = mf_export_grid_error(&grid, all[n], &table, 0, 1);
            for (double r = error[k].from + 1e-4; r < 2.49; r += 0.00317) {
                double phi, slope, read_phi, read_force;
                mf_table_evaluate(&table, r, &phi, &slope, NULL);
                all[n]->value(&grid, r, &read_phi, &read_force);
                assert_true(fabs(read_phi - phi) <= 1.01 * error[k].phi + 1e-12);
            }
            mf_export_grid_clear(&grid);
        }
        // Lennard-Jones is 20 above its minimum of −1 where 4/r¹² − 4/r⁶ = 19.
        assert_true(fabs(error[0].from - 0.84556) < 1e-3);
        assert_true(error[1].phi < 0.27 * error[0].phi);
    }
    mf_table_clear(&table);
}

/// GSL's cspline has natural ends, too.
static void test_spline_is_the_natural_one(void **state) {
    (void)state;
    struct curve curve;
    struct table table = {0};
    struct export_grid grid;
    assert_ok(mf_curve_create(&curve, mf_curve_find(mf_curve_potentials, "soft-repulsion")));
    assert_ok(mf_table_init_potential(&table, &curve));
    assert_ok(mf_export_grid_make(&grid, &mf_export_grid_spline, &table, 0, 0, 21));
    gsl_spline *natural = gsl_spline_alloc(gsl_interp_cspline, grid.rows);
    gsl_spline_init(natural, grid.r, grid.phi, grid.rows);
    for (double r = 0.003; r < 1; r += 0.0171) {
        double phi, force;
        mf_export_grid_spline.value(&grid, r, &phi, &force);
        assert_true(fabs(phi - gsl_spline_eval(natural, r, NULL)) < 1e-10);
        assert_true(fabs(force + gsl_spline_eval_deriv(natural, r, NULL)) < 1e-8);
    }
    gsl_spline_free(natural);
    mf_export_grid_clear(&grid);
    mf_table_clear(&table);
    mf_curve_clear(&curve);
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_columns_are_reduced_whatever_their_heading_says),
        TEST(test_units_of_engines_are_consistent),
        TEST(test_power_laws_are_found_and_others_are_not),
        TEST(test_engines_with_one_exponent_get_the_nearest_of_it),
        TEST(test_jump_of_the_force_at_the_cutoff_needs_no_rows),
        TEST(test_errors_of_interpolations_are_measured),
        TEST(test_spline_is_the_natural_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
