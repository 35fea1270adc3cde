// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/imc_solve.h"

#include "base/rng.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 24 };

static const double temperature = 1.5, spacing = 0.05;

/// A covariance such as counts have: positive, with neighbours correlated, bins of very
/// different scatter.
static void make_covariance(double covariance[SIZE][SIZE]) {
    for (int a = 0; a < SIZE; a++)
        for (int b = 0; b < SIZE; b++)
            covariance[a][b] = (10 + a) * (10 + b) * exp(-abs(a - b) / 1.5) * 0.1;
}

/// A smooth potential change that ends at 0.
static double true_change(int k) {
    return 0.8 * cos(0.25 * k) * (1 - (k + 0.5) / SIZE);
}

/// excess = C x / k_B T for x = true_change, plus `noise` standard deviations of a normal number.
static void make_excess(double covariance[SIZE][SIZE], const double *variance, double noise,
                        uint32_t trial, double *excess) {
    for (int a = 0; a < SIZE; a++) {
        double normal[4];
        mf_rng_normal4(mf_rng_philox(21, RNG_INITIAL, trial, (uint32_t)a, 0), normal);
        excess[a] = noise * sqrt(variance[a]) * normal[0];
        for (int b = 0; b < SIZE; b++)
            excess[a] += covariance[a][b] * true_change(b) / temperature;
    }
}

static void fill(double *array, double value) {
    for (int k = 0; k < SIZE; k++)
        array[k] = value;
}

static struct imc_system make_system(double covariance[SIZE][SIZE], const double *excess,
                                     const double *variance) {
    return (struct imc_system){.size = SIZE,
                               .covariance = &covariance[0][0],
                               .excess = excess,
                               .variance = variance,
                               .temperature = temperature,
                               .spacing = spacing};
}

/// χ² by bin of what a change leaves.
static double misfit_of(const struct imc_system *system, const double *x) {
    double sum = 0;
    for (size_t a = 0; a < SIZE; a++) {
        double left = system->excess[a];
        for (size_t b = 0; b < SIZE; b++)
            left -= system->covariance[a * SIZE + b] * x[b] / temperature;
        sum += left * left / system->variance[a];
    }
    return sum / SIZE;
}

/// The condition number of C here is 400 and enters squared: 2^-53 · 2e5, with a factor of 100 for
/// the regularisation that the noise of 1e-8 allows.
static const double exact = 1e-8;

static void test_imc_solve_is_exact_when_there_is_no_noise(void **state) {
    (void)state;
    double covariance[SIZE][SIZE], excess[SIZE], variance[SIZE], x[SIZE];
    struct imc_solution solution;
    make_covariance(covariance);
    fill(variance, 1e-20);
    make_excess(covariance, variance, 0, 0, excess);
    const struct imc_system system = make_system(covariance, excess, variance);
    assert_ok(mf_imc_solve(&system, 0, x, &solution));
    for (int k = 0; k < SIZE; k++) {
        // Too many pairs ask for a higher potential.
        assert_close(x[k], true_change(k), exact);
    }
}

/// What mf_imc_solve minimises, written down again.
static double objective(const struct imc_system *system, double strength, const double *x) {
    const double bend = pow(0.1 / spacing, 2);
    double penalty = 0;
    for (size_t k = 1; k < SIZE; k++) {
        // The last bin ends at the cutoff, half a spacing away.
        const double step = k + 1 < SIZE ? 1 : 0.5, after = k + 1 < SIZE ? x[k + 1] : 0;
        const double second =
            bend * ((after - x[k]) / step - (x[k] - x[k - 1])) / (0.5 * (1 + step));
        penalty += second * second;
    }
    for (size_t k = 0; k < SIZE; k++)
        penalty += 0.01 * x[k] * x[k];
    return SIZE * misfit_of(system, x) + strength * penalty;
}

static void test_imc_solve_is_the_minimum_when_the_strength_is_given(void **state) {
    (void)state;
    static const double strengths[] = {1e-3, 1, 1e4};
    double covariance[SIZE][SIZE], excess[SIZE], variance[SIZE], x[SIZE];
    make_covariance(covariance);
    fill(variance, 4);
    make_excess(covariance, variance, 1, 1, excess);
    const struct imc_system system = make_system(covariance, excess, variance);
    for (int s = 0; s < 3; s++) {
        struct imc_solution solution;
        assert_ok(mf_imc_solve(&system, strengths[s], x, &solution));
        assert_identical(solution.strength, strengths[s]);
        assert_close_relative(solution.misfit, misfit_of(&system, x), 1e-9);
        // A quadratic form is lowest where a step to either side raises it by the same.
        const double lowest = objective(&system, strengths[s], x), step = 1e-3;
        for (int k = 0; k < SIZE; k++) {
            double moved[SIZE], above, below;
            memcpy(moved, x, sizeof x);
            moved[k] = x[k] + step;
            above = objective(&system, strengths[s], moved) - lowest;
            moved[k] = x[k] - step;
            below = objective(&system, strengths[s], moved) - lowest;
            assert_true(above > 0 && below > 0);
            assert_close_relative(above, below, 1e-4);
        }
    }
}

/// Of the bisection: 18 decades in 2^40 parts.
static const double discrepancy = 1e-6;

static void test_imc_solve_leaves_just_the_noise_when_the_excess_is_significant(void **state) {
    (void)state;
    double covariance[SIZE][SIZE], excess[SIZE], variance[SIZE], x[SIZE];
    make_covariance(covariance);
    for (int k = 0; k < SIZE; k++)
        variance[k] = 0.2 + 0.05 * k;
    for (uint32_t trial = 0; trial < 20; trial++) {
        struct imc_solution solution;
        make_excess(covariance, variance, 1, trial, excess);
        const struct imc_system system = make_system(covariance, excess, variance);
        assert_ok(mf_imc_solve(&system, 0, x, &solution));
        assert_close(solution.misfit, 1, discrepancy);
        assert_close(misfit_of(&system, x), 1, 10 * discrepancy);
        assert_true(solution.strength > 0);
    }
}

static void test_imc_solve_changes_nothing_when_the_excess_is_noise(void **state) {
    (void)state;
    double covariance[SIZE][SIZE], excess[SIZE], variance[SIZE], x[SIZE];
    struct imc_solution solution;
    make_covariance(covariance);
    fill(variance, 4);
    for (int k = 0; k < SIZE; k++)
        excess[k] = k % 2 ? 1.9 : -1.9;
    const struct imc_system system = make_system(covariance, excess, variance);
    assert_ok(mf_imc_solve(&system, 0, x, &solution));
    assert_close(solution.misfit, 0.95 * 0.95, 1e-3);
    for (int k = 0; k < SIZE; k++)
        assert_close(x[k], 0, 1e-3);
}

static void assert_bounded(const double *x, double bound) {
    for (int k = 0; k < SIZE; k++) {
        assert_true(isfinite(x[k]));
        assert_true(fabs(x[k]) < bound);
    }
}

/// Make C blind to `direction`, of length 1: C ← (1 − dd) C (1 − dd).
static void project_out(double covariance[SIZE][SIZE], const double *direction) {
    double product[SIZE], twice = 0;
    for (int a = 0; a < SIZE; a++) {
        product[a] = 0;
        for (int b = 0; b < SIZE; b++)
            product[a] += covariance[a][b] * direction[b];
        twice += product[a] * direction[a];
    }
    for (int a = 0; a < SIZE; a++)
        for (int b = 0; b < SIZE; b++)
            covariance[a][b] += direction[a] * direction[b] * twice - direction[a] * product[b] -
                                product[a] * direction[b];
}

/// The ramp 1 − r/r_c, of length 1.
static void make_ramp(double *ramp) {
    double square = 0;
    for (int k = 0; k < SIZE; k++) {
        ramp[k] = 1 - (k + 0.5) / SIZE;
        square += ramp[k] * ramp[k];
    }
    for (int k = 0; k < SIZE; k++)
        ramp[k] /= sqrt(square);
}

static void test_imc_solve_stays_bounded_when_a_direction_is_unseen(void **state) {
    (void)state;
    double covariance[SIZE][SIZE], excess[SIZE], variance[SIZE], x[SIZE], ramp[SIZE];
    struct imc_solution solution;
    make_ramp(ramp);
    make_covariance(covariance);
    project_out(covariance, ramp);
    fill(variance, 0.1);
    make_excess(covariance, variance, 1, 3, excess);
    const struct imc_system system = make_system(covariance, excess, variance);
    assert_ok(mf_imc_solve(&system, 0, x, &solution));
    assert_bounded(x, 3);
    assert_close(solution.misfit, 1, discrepancy);
}

static void test_imc_solve_stays_bounded_when_a_bin_has_no_pairs(void **state) {
    (void)state;
    double covariance[SIZE][SIZE], excess[SIZE], variance[SIZE], x[SIZE];
    struct imc_solution solution;
    make_covariance(covariance);
    for (int k = 0; k < SIZE; k++)
        covariance[5][k] = covariance[k][5] = 0;
    fill(variance, 0.1);
    make_excess(covariance, variance, 1, 4, excess);
    const struct imc_system system = make_system(covariance, excess, variance);
    assert_ok(mf_imc_solve(&system, 0, x, &solution));
    assert_bounded(x, 3);
    // Its value comes from its neighbours.
    assert_close(x[5], 0.5 * (x[4] + x[6]), 0.2);
}

static void test_imc_solve_stays_bounded_when_the_excess_cannot_be_removed(void **state) {
    (void)state;
    // Pairs that the target has and this potential never: no change of Φ is linear in that. The
    // misfit stays above 1 at every strength, down to where C alone would have to be inverted.
    static const double depth[] = {1e2, 1e6};
    for (int d = 0; d < 2; d++) {
        double covariance[SIZE][SIZE], excess[SIZE], variance[SIZE], x[SIZE];
        struct imc_solution solution;
        make_covariance(covariance);
        for (int bin = 3; bin < 9; bin++)
            for (int k = 0; k < SIZE; k++)
                covariance[bin][k] = covariance[k][bin] = 0;
        fill(variance, 0.1);
        make_excess(covariance, variance, 1, 5, excess);
        for (int bin = 3; bin < 9; bin++)
            excess[bin] -= depth[d];
        const struct imc_system system = make_system(covariance, excess, variance);
        assert_ok(mf_imc_solve(&system, 0, x, &solution));
        assert_true(solution.misfit > 1);
        assert_bounded(x, 10);
    }
}

static void test_imc_solve_stays_bounded_when_the_excess_lies_in_an_unseen_direction(void **state) {
    (void)state;
    // As above, but C is singular without a zero in it: rounding decides what its inverse is.
    static const double depth[] = {10, 1e3, 1e6}, spacings[] = {0.05, 0.01};
    for (int d = 0; d < 3; d++)
        for (int h = 0; h < 2; h++) {
            double covariance[SIZE][SIZE], excess[SIZE], variance[SIZE], x[SIZE];
            double ramp[SIZE];
            struct imc_solution solution;
            make_ramp(ramp);
            make_covariance(covariance);
            project_out(covariance, ramp);
            fill(variance, 0.1);
            make_excess(covariance, variance, 1, 6, excess);
            for (int k = 0; k < SIZE; k++)
                excess[k] += depth[d] * ramp[k];
            struct imc_system system = make_system(covariance, excess, variance);
            system.spacing = spacings[h];
            assert_ok(mf_imc_solve(&system, 0, x, &solution));
            assert_true(solution.misfit > 1);
            assert_bounded(x, 3);
        }
}

static void test_imc_solve_leaves_the_ramp_free_when_it_is_smooth(void **state) {
    (void)state;
    gsl_matrix *prior = gsl_matrix_alloc(2 * SIZE - 1, SIZE);
    mf_imc_solve_prior(
        &(struct imc_system){.spacing = spacing, .block = (const size_t[]){SIZE}, .blocks = 1},
        prior);
    for (size_t row = 0; row < SIZE - 1; row++) {
        double sum = 0;
        for (size_t k = 0; k < SIZE; k++)
            sum += gsl_matrix_get(prior, row, k) * (1 - (k + 0.5) / SIZE);
        assert_close(sum, 0, 1e-13);
    }
    gsl_matrix_free(prior);
}

static double product(const double *p, const double *x) {
    double sum = 0;
    for (size_t k = 0; k < SIZE; k++)
        sum += p[k] * x[k];
    return sum;
}

/// No change along the constraint lowers the objective.
static void assert_constrained_minimum(const struct imc_system *system, double strength,
                                       const double *x) {
    const double lowest = objective(system, strength, x);
    assert_close(product(system->constraint, x), system->wanted, 1e-9);
    for (size_t k = 1; k < SIZE; k++)
        for (int sign = -1; sign <= 1; sign += 2) {
            double moved[SIZE];
            memcpy(moved, x, sizeof moved);
            moved[0] += sign * 1e-3 * system->constraint[k];
            moved[k] -= sign * 1e-3 * system->constraint[0];
            assert_true(objective(system, strength, moved) > lowest);
        }
}

/// A potential whose last bin jumps to 0 at the cutoff is made to end there by a step that the data
/// do not ask for, and that changes little else. Steps that know nothing of it keep the jump.
static void test_imc_solve_makes_up_for_a_jump_at_the_cutoff(void **state) {
    (void)state;
    double covariance[SIZE][SIZE] = {{0}}, excess[SIZE] = {0}, variance[SIZE], phi[SIZE], x[SIZE];
    double reference[SIZE];
    struct imc_solution solution;
    for (int a = 0; a < SIZE; a++)
        covariance[a][a] = temperature;
    fill(variance, 0.03);
    fill(phi, 0);
    phi[SIZE - 1] = 0.3;
    struct imc_system system = make_system(covariance, excess, variance);
    assert_ok(mf_imc_solve(&system, 1, x, &solution));
    for (int a = 0; a < SIZE; a++)
        assert_close(x[a], 0, 1e-12);
    // The reference has the jump, too: it counts as little at the end.
    memcpy(reference, phi, sizeof reference);
    system.phi = phi;
    system.reference = reference;
    assert_ok(mf_imc_solve(&system, 1, x, &solution));
    print_message("%.4f and %.4f at the end\n", phi[SIZE - 2] + x[SIZE - 2],
                  phi[SIZE - 1] + x[SIZE - 1]);
    assert_true(fabs(phi[SIZE - 1] + x[SIZE - 1]) < 0.2 * phi[SIZE - 1]);
    assert_true(fabs(x[SIZE - 2]) < 0.3 * phi[SIZE - 1]);
    assert_true(fabs(x[SIZE / 2]) < 0.01);
}

/// With a reference the most probable potential is one, wherever a linear fit begins.
static void test_imc_solve_ends_where_the_reference_says_whatever_the_start(void **state) {
    (void)state;
    double covariance[SIZE][SIZE], excess[SIZE], moved[SIZE], variance[SIZE], reference[SIZE];
    double phi[SIZE], end[SIZE], x[SIZE], steepness[SIZE];
    struct imc_solution solution;
    make_covariance(covariance);
    fill(variance, 4);
    make_excess(covariance, variance, 1, 3, excess);
    for (int k = 0; k < SIZE; k++) {
        reference[k] = 0.3 * sin(0.4 * k) * (1 - (k + 0.5) / SIZE);
        steepness[k] = 20.0 / (1 + k);
    }
    for (int start = 0; start < 3; start++) {
        for (int k = 0; k < SIZE; k++)
            phi[k] = start * (k % 3) + 5 * start / (1.0 + k);
        for (int a = 0; a < SIZE; a++) {
            moved[a] = excess[a]; // that of phi = 0
            for (int b = 0; b < SIZE; b++)
                moved[a] -= covariance[a][b] * phi[b] / temperature;
        }
        struct imc_system system = make_system(covariance, moved, variance);
        system.phi = phi;
        system.reference = reference;
        system.steepness = steepness;
        assert_ok(mf_imc_solve(&system, 0.7, x, &solution));
        for (int k = 0; k < SIZE && start > 0; k++)
            assert_close(phi[k] + x[k], end[k], 1e-8);
        for (int k = 0; k < SIZE; k++)
            end[k] = phi[k] + x[k];
    }
}

static void test_imc_solve_meets_a_constraint_at_the_least_cost(void **state) {
    (void)state;
    double covariance[SIZE][SIZE], excess[SIZE], variance[SIZE], x[SIZE], p[SIZE];
    struct imc_solution solution;
    make_covariance(covariance);
    fill(variance, 4);
    make_excess(covariance, variance, 1, 7, excess);
    for (int k = 0; k < SIZE; k++)
        p[k] = 1 + 0.1 * k + sin(k);
    struct imc_system system = make_system(covariance, excess, variance);
    system.constraint = p;
    system.wanted = 17;
    assert_ok(mf_imc_solve(&system, 1, x, &solution));
    assert_close_relative(solution.misfit, misfit_of(&system, x), 1e-9);
    assert_constrained_minimum(&system, 1, x);
    // Where the noise decides, the constraint counts as much.
    assert_ok(mf_imc_solve(&system, 0, x, &solution));
    assert_close(product(p, x), 17, 1e-9);
}

static void
test_imc_solve_follows_all_directions_when_it_is_weak_and_none_when_strong(void **state) {
    (void)state;
    double covariance[SIZE][SIZE], excess[SIZE], variance[SIZE], x[SIZE];
    struct imc_solution solution;
    make_covariance(covariance);
    fill(variance, 4);
    make_excess(covariance, variance, 1, 8, excess);
    const struct imc_system system = make_system(covariance, excess, variance);
    assert_ok(mf_imc_solve(&system, 1e-12, x, &solution));
    assert_close(solution.directions, SIZE, 1e-3);
    assert_ok(mf_imc_solve(&system, 1e12, x, &solution));
    assert_close(solution.directions, 0, 1e-3);
    // The trace is what the prediction of each bin follows that bin's excess.
    double trace = 0;
    assert_ok(mf_imc_solve(&system, 30, x, &solution));
    for (int a = 0; a < SIZE; a++) {
        double moved[SIZE], other[SIZE];
        struct imc_solution ignored;
        memcpy(moved, excess, sizeof moved);
        moved[a] += 1;
        const struct imc_system beside = make_system(covariance, moved, variance);
        assert_ok(mf_imc_solve(&beside, 30, other, &ignored));
        for (int b = 0; b < SIZE; b++)
            trace += covariance[a][b] * (other[b] - x[b]) / temperature;
    }
    assert_close(solution.directions, trace, 1e-6);
}

/// Bᵀ B and Bᵀ excess are Cᵀ V⁻¹ C and Cᵀ V⁻¹ excess with V itself and its inverse by Cholesky.
static void test_imc_solve_whitens_by_the_covariance_of_the_excess(void **state) {
    (void)state;
    double covariance[SIZE][SIZE], variance[SIZE], excess[SIZE], noise[SIZE * SIZE];
    gsl_matrix_view factor = gsl_matrix_view_array(noise, SIZE, SIZE);
    gsl_matrix *v = gsl_matrix_calloc(SIZE, SIZE), *rows = gsl_matrix_alloc(SIZE, SIZE);
    gsl_vector *right = gsl_vector_alloc(SIZE);
    make_covariance(covariance);
    for (size_t a = 0; a < SIZE; a++)
        variance[a] = 1 + 0.3 * (double)a;
    make_excess(covariance, variance, 1, 9, excess);
    struct imc_system system = make_system(covariance, excess, variance);
    system.noise = noise;
    for (size_t a = 0; a < SIZE; a++)
        for (size_t b = 0; b < SIZE; b++)
            gsl_matrix_set(v, a, b,
                           (a == b ? variance[a] : 0) +
                               (2 + 0.1 * (double)a) * (2 + 0.1 * (double)b));
    gsl_matrix_memcpy(&factor.matrix, v);
    assert_int_equal(gsl_linalg_cholesky_decomp1(&factor.matrix), 0);
    assert_ok(mf_imc_solve_rows(&system, rows, right));
    assert_int_equal(gsl_linalg_cholesky_decomp1(v), 0);
    assert_int_equal(gsl_linalg_cholesky_invert(v), 0);
    for (size_t a = 0; a < SIZE; a++) {
        double whitened = 0, wanted = 0;
        for (size_t b = 0; b < SIZE; b++)
            whitened += gsl_matrix_get(rows, b, a) * gsl_vector_get(right, b);
        for (size_t b = 0; b < SIZE; b++)
            for (size_t c = 0; c < SIZE; c++)
                wanted += covariance[b][a] / temperature * gsl_matrix_get(v, b, c) * excess[c];
        assert_close(whitened, wanted, 1e-9 * fabs(wanted) + 1e-9);
    }
    gsl_matrix_free(v);
    gsl_matrix_free(rows);
    gsl_vector_free(right);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_imc_solve_is_exact_when_there_is_no_noise),
        cmocka_unit_test(test_imc_solve_whitens_by_the_covariance_of_the_excess),
        cmocka_unit_test(test_imc_solve_is_the_minimum_when_the_strength_is_given),
        cmocka_unit_test(test_imc_solve_leaves_just_the_noise_when_the_excess_is_significant),
        cmocka_unit_test(test_imc_solve_changes_nothing_when_the_excess_is_noise),
        cmocka_unit_test(test_imc_solve_stays_bounded_when_a_direction_is_unseen),
        cmocka_unit_test(test_imc_solve_stays_bounded_when_a_bin_has_no_pairs),
        cmocka_unit_test(test_imc_solve_stays_bounded_when_the_excess_cannot_be_removed),
        cmocka_unit_test(test_imc_solve_leaves_the_ramp_free_when_it_is_smooth),
        cmocka_unit_test(test_imc_solve_makes_up_for_a_jump_at_the_cutoff),
        cmocka_unit_test(test_imc_solve_ends_where_the_reference_says_whatever_the_start),
        cmocka_unit_test(test_imc_solve_meets_a_constraint_at_the_least_cost),
        cmocka_unit_test(
            test_imc_solve_follows_all_directions_when_it_is_weak_and_none_when_strong),
        cmocka_unit_test(test_imc_solve_stays_bounded_when_the_excess_lies_in_an_unseen_direction),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
