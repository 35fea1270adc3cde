// SPDX-License-Identifier: GPL-3.0-or-later
//
// Laws of bonds, angles and dihedrals: values against published formulas, slopes against their
// differences, and that all is finite.
#include "curves/bonded_table.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

static struct bonded_curve make(const struct bonded_law *law) {
    struct bonded_curve curve;
    assert_ok(mf_bonded_create(&curve, law));
    return curve;
}

static void set(struct bonded_curve *curve, const char *name, double value) {
    for (const struct field *field = curve->law->fields; field->name; field++)
        if (strcmp(field->name, name) == 0) {
            const int64_t integer = (int64_t)value;
            memcpy((char *)curve->parameters + field->offset,
                   field->type == FIELD_INTEGER ? (const void *)&integer : (const void *)&value, 8);
            return;
        }
    fail_msg("no field %s", name);
}

static double energy_at(const struct bonded_curve *curve, double q) {
    double energy;
    mf_bonded_value(curve, q, &energy, NULL);
    return energy;
}

static void check_slopes(const struct bonded_curve *curve, double from, double to) {
    static const double h = 1e-5;
    for (int k = 0; k <= 100; k++) {
        const double q = from + (to - from) * k / 100;
        double slope, alone;
        mf_bonded_value(curve, q, NULL, &slope);
        if (curve->law->slopes) {
            curve->law->slopes(curve->parameters, 1, &q, &alone);
            assert_close(alone, slope, 0);
        }
        const double difference = (energy_at(curve, q + h) - energy_at(curve, q - h)) / (2 * h);
        assert_close(slope, difference, 1e-5 * fmax(1, fabs(slope)));
    }
}

static void test_bonds_have_the_energies_of_their_formulas(void **state) {
    (void)state;
    struct bonded_curve harmonic = make(&mf_bond_harmonic), fene = make(&mf_bond_fene);
    set(&harmonic, "k", 100);
    set(&harmonic, "length", 0.8);
    assert_close(energy_at(&harmonic, 1.0), 2, 1e-12);
    assert_close(mf_bonded_rest(&harmonic), 0.8, 0);
    check_slopes(&harmonic, 0.1, 2);
    // Kremer and Grest's k = 30, R = 1.5 is the default: -33.75 ln(1 - 0.97^2/2.25) at 0.97.
    assert_close(energy_at(&fene, 0.97), 18.278674, 1e-6);
    assert_close(energy_at(&fene, 1.5 * sqrt(0.75)), 33.75 * log(4), 1e-10);
    check_slopes(&fene, 0.1, 1.48);
    check_slopes(&fene, 1.51, 1.6);
    assert_close(mf_bonded_longest(&fene), 1.5, 0);
    assert_true(isinf(mf_bonded_longest(&harmonic)));
    mf_bonded_clear(&harmonic);
    mf_bonded_clear(&fene);
}

static void test_angles_have_the_energies_of_their_formulas(void **state) {
    (void)state;
    struct bonded_curve harmonic = make(&mf_angle_harmonic), cosine = make(&mf_angle_cosine);
    struct bonded_curve squared = make(&mf_angle_cosine_squared);
    set(&harmonic, "k", 50);
    set(&harmonic, "angle", 120);
    assert_close(energy_at(&harmonic, M_PI / 2), 25 * M_PI * M_PI / 36, 1e-12); // 30 degrees off
    assert_close(mf_bonded_rest(&harmonic), 2 * M_PI / 3, 1e-15);
    set(&cosine, "k", 3);
    assert_close(energy_at(&cosine, M_PI), 0, 1e-15);
    assert_close(energy_at(&cosine, M_PI / 3), 4.5, 1e-12);
    set(&squared, "k", 8);
    set(&squared, "angle", 120);
    assert_close(energy_at(&squared, M_PI / 2), 1, 1e-12);
    check_slopes(&harmonic, 0, M_PI);
    check_slopes(&cosine, 0, M_PI);
    check_slopes(&squared, 0, M_PI);
    mf_bonded_clear(&harmonic);
    mf_bonded_clear(&cosine);
    mf_bonded_clear(&squared);
}

/// Butane of Ryckaert and Bellemans: C_n in K, trans is the least, cis the most, gauche 351 K x k_B
/// (2.93 kJ/mol of GROMACS's manual) above trans: here the coefficients of the manual in kJ/mol.
static void test_ryckaert_bellemans_is_butane(void **state) {
    (void)state;
    static const double c[] = {9.28, 12.16, -13.12, -3.06, 26.24, -31.5};
    static const char *const names[] = {"c0", "c1", "c2", "c3", "c4", "c5"};
    struct bonded_curve butane = make(&mf_dihedral_ryckaert_bellemans);
    for (int k = 0; k < 6; k++)
        set(&butane, names[k], c[k]);
    assert_close(energy_at(&butane, M_PI), 0, 1e-12);       // the coefficients sum to 0
    assert_close(energy_at(&butane, 0), 44.8, 1e-10);       // c0 - c1 + c2 - c3 + c4 - c5, by hand
    assert_close(energy_at(&butane, M_PI / 3), 2.93, 0.02); // gauche
    assert_close(mf_bonded_rest(&butane), M_PI, 0);
    check_slopes(&butane, -M_PI, M_PI);
    mf_bonded_clear(&butane);
}

static void test_periodic_dihedrals_count_from_cis(void **state) {
    (void)state;
    struct bonded_curve curve = make(&mf_dihedral_periodic);
    set(&curve, "k", 2);
    set(&curve, "multiplicity", 3);
    set(&curve, "phase", 0);
    assert_close(energy_at(&curve, 0), 4, 1e-12);        // cis is a maximum
    assert_close(energy_at(&curve, M_PI), 0, 1e-12);     // trans a minimum
    assert_close(energy_at(&curve, M_PI / 3), 0, 1e-12); // and gauche
    assert_close(energy_at(&curve, mf_bonded_rest(&curve)), 0, 1e-12);
    set(&curve, "phase", 180);
    set(&curve, "multiplicity", 1);
    assert_close(energy_at(&curve, M_PI), 4, 1e-12);
    assert_close(energy_at(&curve, mf_bonded_rest(&curve)), 0, 1e-12);
    check_slopes(&curve, -M_PI, M_PI);
    mf_bonded_clear(&curve);
}

static void test_tables_go_through_functions(void **state) {
    (void)state;
    enum { POINTS = 121 };
    double q[POINTS], energy[POINTS];
    struct bonded_curve bond = make(&mf_bond_table), dihedral = make(&mf_dihedral_table);
    for (int k = 0; k < POINTS; k++) {
        q[k] = 0.5 + 0.01 * k;
        energy[k] = 40 * pow(q[k] - 1, 2) - 10 * pow(q[k] - 1, 3);
    }
    assert_ok(mf_bonded_table_set_points(&bond, q, energy, POINTS));
    for (double r = 0.6; r < 1.6; r += 0.013) // away from the ends, where the spline is natural
        assert_close(energy_at(&bond, r), 40 * pow(r - 1, 2) - 10 * pow(r - 1, 3), 1e-4);
    assert_close(mf_bonded_rest(&bond), 1, 1e-3);
    check_slopes(&bond, 0.51, 1.69);
    double slope, end;
    mf_bonded_value(&bond, 2.5, NULL, &slope); // beyond the table: a straight line
    mf_bonded_value(&bond, 1.7, NULL, &end);
    assert_close(slope, end, 1e-9);
    assert_close(energy_at(&bond, 2.5), energy_at(&bond, 1.7) + 0.8 * end, 1e-9);
    for (int k = 0; k < POINTS; k++) {
        q[k] = -180 + 3 * k;
        energy[k] = 3 * sin(2 * q[k] * M_PI / 180) + cos(q[k] * M_PI / 180);
    }
    assert_ok(mf_bonded_table_set_points(&dihedral, q, energy, POINTS));
    for (double phi = -4; phi < 4; phi += 0.03) // periodic
        assert_close(energy_at(&dihedral, phi), 3 * sin(2 * phi) + cos(phi), 2e-4);
    check_slopes(&dihedral, -M_PI, M_PI);
    mf_bonded_clear(&bond);
    mf_bonded_clear(&dihedral);
}

/// Wells between rows, as of a harmonic bond on a coarse grid, are there; those beside a step are
/// the spline's.
static void test_spline_of_a_step_is_refused(void **state) {
    enum { POINTS = 20 };
    double q[POINTS], energy[POINTS];
    (void)state;
    for (int kind = 0; kind < 4; kind++) {
        struct bonded_curve bond = make(&mf_bond_table);
        for (int k = 0; k < POINTS; k++) {
            q[k] = 0.2 + 0.05 * k;
            energy[k] = kind == 0   ? 2000 * pow(q[k] - 0.625, 2)
                        : kind == 1 ? 20 * pow(exp(-6 * (q[k] - 0.48)) - 1, 2)
                        : kind == 2 ? (k < 10 ? 0 : 500)
                                    : (k < 5 ? 60 : 2);
        }
        assert_ok(mf_bonded_table_set_points(&bond, q, energy, POINTS));
        const enum status status = mf_bonded_table_check_wells(&bond, q, energy, POINTS);
        assert_int_equal(status, kind < 2 ? STATUS_OK : STATUS_BAD_INPUT);
        if (kind == 3)
            assert_contains(mf_status_message(), "between rows 6 and 7 of numbers, of 2 and 2");
        mf_bonded_clear(&bond);
    }
}

static void test_tables_that_make_no_sense_are_refused(void **state) {
    (void)state;
    static const double q[] = {0, 60, 120, 180, 300}, energy[] = {0, 1, 2, 3, 0};
    static const double whole[] = {0, 60, 120, 180, 360}, jump[] = {0, 1, 2, 3, 1};
    struct bonded_curve dihedral = make(&mf_dihedral_table), angle = make(&mf_angle_table);
    assert_int_equal(mf_bonded_table_set_points(&dihedral, q, energy, 5), STATUS_BAD_INPUT);
    assert_string_equal(mf_status_message(), "a dihedral's table spans 360 degrees, not 300");
    assert_int_equal(mf_bonded_table_set_points(&dihedral, whole, jump, 5), STATUS_BAD_INPUT);
    assert_string_equal(mf_status_message(), "the ends of a dihedral's table are the same angle "
                                             "and have the energies 0 and 1");
    assert_int_equal(mf_bonded_table_set_points(&angle, q, energy, 5), STATUS_BAD_INPUT);
    assert_string_equal(mf_status_message(), "angles are 0 to 180 degrees, not 0 to 300");
    mf_bonded_clear(&dihedral);
    mf_bonded_clear(&angle);
}

/// A spring at rest at 0 has Maxwell's distribution: with x = R sqrt(k/2 T) the share beyond R is
/// erfc(x) + 2 x e^(−x²)/sqrt(π) in space, and e^(−x²) in the plane. What tears before is not
/// beyond.
static void test_share_of_long_springs_is_that_of_maxwell(void **state) {
    (void)state;
    static const double length = 1.5, k = 6, temperature = 0.8;
    struct bonded_curve spring = make(&mf_bond_harmonic), fene = make(&mf_bond_fene);
    const double x = length * sqrt(k / (2 * temperature)), gauss = exp(-x * x);
    set(&spring, "k", k);
    set(&spring, "length", 0);
    assert_close(mf_bonded_share_beyond(&spring, length, temperature, 3),
                 erfc(x) + 2 * x * gauss / sqrt(M_PI), 1e-6);
    assert_close(mf_bonded_share_beyond(&spring, length, temperature, 2), gauss, 1e-6);
    assert_true(mf_bonded_share_beyond(&spring, 10 * length, temperature, 3) == 0);
    set(&fene, "longest", length);
    assert_true(mf_bonded_share_beyond(&fene, length, temperature, 3) == 0);
    mf_bonded_clear(&spring);
    mf_bonded_clear(&fene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bonds_have_the_energies_of_their_formulas),
        cmocka_unit_test(test_angles_have_the_energies_of_their_formulas),
        cmocka_unit_test(test_share_of_long_springs_is_that_of_maxwell),
        cmocka_unit_test(test_ryckaert_bellemans_is_butane),
        cmocka_unit_test(test_periodic_dihedrals_count_from_cis),
        cmocka_unit_test(test_tables_go_through_functions),
        cmocka_unit_test(test_spline_of_a_step_is_refused),
        cmocka_unit_test(test_tables_that_make_no_sense_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
