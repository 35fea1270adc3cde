// SPDX-License-Identifier: GPL-3.0-or-later
//
// U of groups made of coefficients: what the functions can make, what stays in the base of the
// target's noise, and groups beside pairs in one vector of variables.

#include "base/memory.h"
#include "base/rng.h"
#include "problem/parametrisation.h"
#include "shared/is_close.h"
#include "shared/molecules.h"
#include "shared/testing.h"

#include <math.h>

enum { BINS = 60, PAIR_BINS = 20, MAX = 8 * BINS };

static const double temperature = 1.5;
static const int types[4] = {0};

/// Chains of four beads whose U of all orders are looked for, and Φ.
struct twin {
    struct molecules molecules;
    struct inverse_problem problem;
    double g[PAIR_BINS], target[BONDED_KINDS][BINS], error[BONDED_KINDS][BINS];
    struct unknowns unknowns;
};

static const struct bonded_bins bins[BONDED_KINDS] = {
    {0.5, 0.6 / BINS, BINS}, {60, 120.0 / BINS, BINS}, {-180, 360.0 / BINS, BINS}};

static double true_energy(int order, double q) {
    return order == BONDED_BOND    ? 300 * pow(q - 0.8, 2) / 2
           : order == BONDED_ANGLE ? 20 * pow((q - 115) * M_PI / 180, 2) / 2
                                   : 1 + cos(3 * q * M_PI / 180);
}

/// p by the mean Jacobian of each bin, with errors as of so many counts.
static void make_target(struct twin *twin, int order) {
    double *p = twin->target[order], sum = 0;
    for (size_t k = 0; k < BINS; k++) {
        const double energy = true_energy(order, bonded_bins_centre(&bins[order], k));
        p[k] =
            mf_bonded_distribution_jacobian(order, 3, &bins[order], k) * exp(-energy / temperature);
        sum += p[k] * bins[order].width;
    }
    for (size_t k = 0; k < BINS; k++) {
        p[k] /= sum;
        twin->error[order][k] = sqrt(p[k] / bins[order].width / 20000);
    }
}

static void make_twin(struct twin *twin) {
    *twin = (struct twin){.problem = {.scene = {.temperature = temperature,
                                                .box = {.dimensions = 3, .length = {9, 9, 9}}},
                                      .core_threshold = 1e-3,
                                      .core_stiffness = 2000}};
    struct inverse_problem *problem = &twin->problem;
    const struct composition composition =
        molecules_topology(&twin->molecules.topology, molecules_chain(20, types, 4, 2, 3),
                           (struct topology_kind){0}, 1, NULL);
    molecules_add_group(&twin->molecules, BONDED_BOND, &mf_bond_harmonic, NULL);
    molecules_add_group(&twin->molecules, BONDED_ANGLE, &mf_angle_harmonic, NULL);
    molecules_add_group(&twin->molecules, BONDED_DIHEDRAL, &mf_dihedral_periodic, NULL);
    molecules_enter(&problem->scene, &twin->molecules, &composition);
    for (size_t k = 0; k < PAIR_BINS; k++)
        twin->g[k] = k < 5 ? 0 : 1;
    problem->targets.bins = (struct rdf_bins){0, 0.1, PAIR_BINS};
    problem->targets.target[TARGET_RDF] = (struct target){.count = PAIR_BINS, .value = twin->g};
    problem->unknown[UNKNOWN_POTENTIAL] =
        (struct unknown){true, {INVERSE_CURVE_BSPLINE, 7, -3, 3, 0, 0, {0}, 0}, {NULL}, NULL};
    problem->unknown[UNKNOWN_BONDED].wanted = true;
    for (int order = 0; order < BONDED_KINDS; order++) {
        make_target(twin, order);
        problem->group[problem->bonded++] =
            (struct bonded_unknown){order, 0, bins[order], 0, {4 + (int)order, 2 + (int)order}};
        problem->targets.target[mf_bonded_distribution_kind(order)] = (struct target){
            .count = BINS, .value = twin->target[order], .error = twin->error[order]};
    }
    assert_ok(mf_unknowns_init(&twin->unknowns, problem));
}

static void clear_twin(struct twin *twin) {
    mf_unknowns_clear(&twin->unknowns);
    mf_molecules_clear(&twin->molecules);
}

static const struct bonded_grid *grid_of(const struct twin *twin, size_t g) {
    return &twin->unknowns.potential.group[g].own;
}

/// Solve a small system by Gauss's elimination; the right sides follow in the rows.
static void solve(double *rows, size_t count, size_t width) {
    for (size_t i = 0; i < count; i++)
        for (size_t j = 0; j < count; j++)
            for (size_t n = width; n-- > i && j != i;)
                rows[j * width + n] -=
                    rows[j * width + i] / rows[i * width + i] * rows[i * width + n];
}

/// What is left of `values` beside the basis and a constant, by least squares with weights.
static void take_off(const double *basis, size_t own, const double *weight, size_t points,
                     double *values) {
    enum { MAX_TERMS = 12 };
    double rows[MAX_TERMS * (MAX_TERMS + 1)] = {0}, row[MAX_TERMS + 1];
    const size_t count = own + 1, width = count + 1;
    for (size_t k = 0; k < points; k++) {
        for (size_t a = 0; a < count; a++)
            row[a] = a < own ? basis[k * own + a] : 1;
        row[count] = values[k];
        for (size_t a = 0; a < count; a++)
            for (size_t b = 0; b < width; b++)
                rows[a * width + b] += weight[k] * row[a] * row[b];
    }
    solve(rows, count, width);
    for (size_t k = 0; k < points; k++)
        for (size_t a = 0; a < count; a++)
            values[k] -=
                rows[a * width + count] / rows[a * width + a] * (a < own ? basis[k * own + a] : 1);
}

/// Cubic polynomials of a length and an angle, sines and cosines of a dihedral; and no constant.
static void test_bonded_basis_makes_smooth_curves_without_a_constant(void **state) {
    (void)state;
    static struct twin twin;
    double basis[MAX], weight[BINS], values[BINS];
    make_twin(&twin);
    for (size_t g = 0; g < BONDED_KINDS; g++) {
        const struct bonded_grid *grid = grid_of(&twin, g);
        const size_t own = (size_t)grid->unknown->shape.coefficients;
        const double middle = mf_bonded_grid_place(grid, grid->below + grid->known / 2);
        assert_ok(mf_parametrisation_bonded_basis(grid, own, basis));
        for (size_t n = 0; n < own; n++) {
            double mean = 0;
            for (size_t k = 0; k < grid->known; k++)
                mean += basis[k * own + n] * grid->target[grid->first + k];
            assert_close(mean * grid->unknown->bins.width, 0, 1e-12);
        }
        for (size_t k = 0; k < grid->known; k++) {
            const double q = mf_bonded_grid_place(grid, grid->below + k);
            const double x = (q - middle) / middle;
            weight[k] = 1;
            values[k] = g < BONDED_DIHEDRAL ? 3 + 7 * x - 20 * x * x + 40 * x * x * x
                                            : 2 + sin(q * M_PI / 180) - 3 * cos(3 * q * M_PI / 180);
        }
        take_off(basis, own, weight, grid->known, values);
        for (size_t k = 0; k < grid->known; k++)
            assert_close(values[k], 0, 1e-8);
    }
    clear_twin(&twin);
}

/// The scatter of −k_B T ln p/J of targets with noise, less what coefficients make up for: 4000
/// draws know it within 1.1 %, and 5 of that is the margin of each of 150 bins.
static void test_bonded_rough_is_the_noise_that_no_coefficients_make_up_for(void **state) {
    (void)state;
    enum { DRAWS = 4000 };
    static struct twin twin;
    double basis[MAX], weight[BINS], rough[BINS];
    make_twin(&twin);
    for (size_t g = 0; g < BONDED_KINDS; g++) {
        const struct bonded_grid *grid = grid_of(&twin, g);
        const size_t own = (size_t)grid->unknown->shape.coefficients;
        double squares[BINS] = {0};
        assert_ok(mf_parametrisation_bonded_basis(grid, own, basis));
        assert_ok(mf_parametrisation_bonded_rough(grid, twin.error[g], basis, rough));
        for (uint32_t draw = 0; draw < DRAWS; draw++) {
            double values[BINS];
            for (size_t k = 0; k < grid->known; k++) {
                const double p = grid->target[grid->first + k],
                             deviation = temperature * twin.error[g][grid->first + k] / p;
                double normal[4];
                mf_rng_normal4(mf_rng_philox(9, RNG_SELECTION, draw, (uint32_t)k, (uint32_t)g),
                               normal);
                values[k] = deviation * normal[0];
                weight[k] = 1 / (deviation * deviation);
            }
            take_off(basis, own, weight, grid->known, values);
            for (size_t k = 0; k < grid->known; k++)
                squares[k] += values[k] * values[k];
        }
        for (size_t k = 0; k < grid->known; k++) {
            const double found = sqrt(squares[k] / DRAWS);
            assert_close(rough[k] / found, 1, 5 * 0.0112);
        }
    }
    clear_twin(&twin);
}

/// Groups begin with the Boltzmann inversion of their target; each coefficient moves its group
/// alone, in its own range, and none the pairs.
static void test_parametrisation_has_groups_behind_the_pairs(void **state) {
    (void)state;
    static struct twin twin;
    struct parametrisation p;
    double x[7 + 4 + 5 + 6], first[3 * MAX], moved[3 * MAX], wanted[3 * MAX];
    size_t block[32];
    make_twin(&twin);
    assert_ok(mf_parametrisation_init(&p, &twin.problem));
    assert_int_equal(p.variables, 7 + 4 + 5 + 6);
    assert_int_equal(mf_parametrisation_count(&twin.problem), p.variables);
    assert_int_equal(p.first[UNKNOWN_BONDED], 7);
    assert_int_equal(mf_parametrisation_blocks(&p, block), 4);
    assert_int_equal(block[2], 5);
    assert_ok(mf_parametrisation_start(&p, x));
    mf_unknowns_start(&p.unknowns, UNKNOWN_BONDED, wanted);
    mf_parametrisation_curve(&p, UNKNOWN_BONDED, x, first);
    const size_t points = mf_unknowns_points(&p.unknowns, UNKNOWN_BONDED);
    assert_true(points <= 3 * MAX);
    for (size_t k = 0; k < points; k++)
        assert_close(first[k], wanted[k], 1e-12);
    // The second coefficient of the angle, a quarter of its range of ±3 up.
    x[7 + 4 + 1] += 0.25;
    mf_parametrisation_curve(&p, UNKNOWN_BONDED, x, moved);
    const struct bonded_grid *angle = &p.unknowns.potential.group[1].own;
    const struct unknowns_part part = mf_unknowns_part(&p.unknowns, UNKNOWN_BONDED, 1);
    double basis[MAX];
    assert_ok(mf_parametrisation_bonded_basis(angle, 5, basis));
    for (size_t k = 0; k < points; k++) {
        const size_t known = k - part.first - angle->below;
        if (k < part.first || k >= part.first + part.points)
            assert_identical(moved[k], first[k]);
        else if (k >= part.first + angle->below && known < angle->known)
            assert_close(moved[k] - first[k], 0.25 * 2 * 3 * basis[known * 5 + 1], 1e-12);
    }
    // Beyond what is known the bond goes on without a step, which its first coefficient would make.
    x[7] += 0.25;
    mf_parametrisation_curve(&p, UNKNOWN_BONDED, x, moved);
    const size_t end = p.unknowns.potential.group[0].own.below;
    assert_true(fabs(moved[end] - first[end]) > 0.7);
    assert_close(moved[end] - moved[end - 1], moved[end + 1] - moved[end], 0.3);
    mf_parametrisation_clear(&p);
    clear_twin(&twin);
}

/// What simulations of some variables read has these U.
static void test_parametrisation_laws_have_the_groups(void **state) {
    (void)state;
    static struct twin twin;
    struct parametrisation p;
    struct unknowns_laws laws;
    double x[7 + 4 + 5 + 6], curve[3 * MAX], energy;
    make_twin(&twin);
    assert_ok(mf_parametrisation_init(&p, &twin.problem));
    assert_ok(mf_parametrisation_start(&p, x));
    x[7] = 0.8;
    mf_parametrisation_curve(&p, UNKNOWN_BONDED, x, curve);
    assert_ok(mf_parametrisation_laws(&p, x, &laws));
    const struct molecules *found =
        mf_molecules_find(laws.problem.scene.interaction, laws.problem.scene.interactions);
    const struct bonded_grid *bond = &p.unknowns.potential.group[0].own;
    for (size_t k = 0; k < bond->points; k++) {
        mf_bonded_value(&found->group[BONDED_BOND][0].curve, mf_bonded_grid_place(bond, k), &energy,
                        NULL);
        assert_close(energy, curve[k], 1e-3 * (1 + fabs(curve[k])));
    }
    mf_unknowns_laws_clear(&laws);
    mf_parametrisation_clear(&p);
    clear_twin(&twin);
}

/// Errors of U are known where the target is, and hold the noise of the base and that of the
/// coefficients.
static void test_parametrisation_band_of_groups_holds_both_noises(void **state) {
    (void)state;
    static struct twin twin;
    struct parametrisation p;
    double x[22], covariance[22 * 22] = {0}, error[3 * MAX], flat[INVERSE_FLAT * 3 * MAX];
    double basis[MAX], rough[BINS];
    make_twin(&twin);
    assert_ok(mf_parametrisation_init(&p, &twin.problem));
    assert_ok(mf_parametrisation_start(&p, x));
    covariance[8 * 23] = 0.01 * 0.01; // the second coefficient of the bond, in a range of ±2
    assert_ok(mf_parametrisation_band(&p, UNKNOWN_BONDED, x, covariance, error, flat));
    const struct bonded_grid *bond = &p.unknowns.potential.group[0].own;
    assert_ok(mf_parametrisation_bonded_basis(bond, 4, basis));
    assert_ok(mf_parametrisation_bonded_rough(bond, twin.error[0], basis, rough));
    assert_true(isnan(error[0]));
    assert_true(isnan(error[bond->points - 1]));
    for (size_t k = 0; k < bond->known; k++)
        assert_close(error[bond->below + k], hypot(0.01 * 4 * basis[4 * k + 1], rough[k]), 1e-12);
    mf_parametrisation_clear(&p);
    clear_twin(&twin);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bonded_basis_makes_smooth_curves_without_a_constant),
        cmocka_unit_test(test_bonded_rough_is_the_noise_that_no_coefficients_make_up_for),
        cmocka_unit_test(test_parametrisation_has_groups_behind_the_pairs),
        cmocka_unit_test(test_parametrisation_laws_have_the_groups),
        cmocka_unit_test(test_parametrisation_band_of_groups_holds_both_noises),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
