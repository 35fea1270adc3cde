// SPDX-License-Identifier: GPL-3.0-or-later
//
// Ornstein and Zernike's equation of mixtures: the matrices of the closure against the same beads
// under two names, against a two by two inverse by hand, and against differences.
#include "inversion/hnc_closure.h"

#include "shared/is_close.h"
#include "shared/testing.h"

#include <gsl/gsl_errno.h>
#include <math.h>

enum { BINS = 130, PAIRS = 3 };

static const double pi = 3.14159265358979323846;

static const struct rdf_bins bins = {0, 0.05, BINS};
static const struct box box = {.dimensions = 3, .length = {1e4, 1e4, 1e4}};

/// Densities of 0.3 and 0.7, and of 0.25 and 0.9.
static const struct composition thirds = {
    .types = 2, .count = {300000000000, 700000000000}, .name = {"A", "B"}};
static const struct composition unequal = {
    .types = 2, .count = {250000000000, 900000000000}, .name = {"A", "B"}};

static const struct hnc_liquid of_thirds = {&bins, &box, &thirds, NULL, 0};
static const struct hnc_liquid of_unequal = {&bins, &box, &unequal, NULL, 0};

/// h = −A exp(−(r/w)²) of A-A, A-B and B-B; the eigenvalues of S(0) are 0.43 and 0.92.
static const double amplitude[PAIRS] = {0.12, 0.05, 0.08}, width[PAIRS] = {0.9, 1, 1.1};

static void make_g(double scale, double *g) {
    for (size_t n = 0; n < PAIRS * BINS; n++) {
        const double x = mf_rdf_bins_centre(&bins, n % BINS) / width[n / BINS];
        g[n] = 1 - scale * amplitude[n / BINS] * exp(-x * x);
    }
}

static void test_hnc_closure_of_two_types_that_are_alike_is_that_of_one(void **state) {
    (void)state;
    const struct composition one = mf_composition_of_one(1000000000000);
    double g[PAIRS * BINS], indirect[PAIRS * BINS], alone[BINS], slope[PAIRS * BINS], other[BINS];
    double difference[PAIRS * BINS];
    for (size_t n = 0; n < PAIRS * BINS; n++) {
        const double r = mf_rdf_bins_centre(&bins, n % BINS);
        g[n] = 1 - 0.1 * exp(-r * r) * cos(3 * r);
        difference[n] = 0.01 * exp(-r * r) * sin(r);
    }
    assert_ok(mf_hnc_closure(&(struct hnc_liquid){&bins, &box, &one, NULL, 0}, g, alone));
    assert_ok(mf_hnc_closure(&of_thirds, g, indirect));
    assert_ok(mf_hnc_closure_slope(&(struct hnc_liquid){&bins, &box, &one, NULL, 0}, g, difference,
                                   0.3, other));
    assert_ok(mf_hnc_closure_slope(&of_thirds, g, difference, 0.3, slope));
    assert_true(fabs(alone[0]) > 1e-3);
    for (size_t n = 0; n < PAIRS * BINS; n++) {
        assert_close(indirect[n], alone[n % BINS], 1e-10);
        // The ridge changes what is between the types, S = 1, but the difference has no part there.
        assert_close(slope[n], other[n % BINS], 1e-13);
    }
}

/// h − c = H ρ C at a wave number, with C = (1 + H ρ)⁻¹ H of two types written out.
static double indirect_at(double q, int pair) {
    double h[PAIRS];
    for (int p = 0; p < PAIRS; p++)
        h[p] = -amplitude[p] * pow(pi * width[p] * width[p], 1.5) *
               exp(-0.25 * q * q * width[p] * width[p]);
    const double a = (double)unequal.count[0] / 1e12, b = (double)unequal.count[1] / 1e12;
    const double square = h[0] * h[2] - h[1] * h[1];
    const double determinant = 1 + a * h[0] + b * h[2] + a * b * square;
    const double c[PAIRS] = {(h[0] + b * square) / determinant, h[1] / determinant,
                             (h[2] + a * square) / determinant};
    return h[pair] - c[pair];
}

/// Its transform to r, by Simpson's rule.
static double indirect_of(double r, int pair) {
    enum { STEPS = 2000 };
    static const double end = 20;
    double sum = 0;
    for (int k = 1; k < STEPS; k++) {
        const double q = end * k / STEPS;
        sum += (k % 2 ? 4 : 2) * q * indirect_at(q, pair) * sin(q * r) / r;
    }
    return sum * end / STEPS / 3 / (2 * pi * pi);
}

/// Of h as constant pieces: h'' width²/24. Measured 9e-6 of 0.025.
static const double discretisation = 2e-5;

static void test_hnc_closure_is_the_inverse_by_hand_when_h_are_gaussians(void **state) {
    (void)state;
    double g[PAIRS * BINS], indirect[PAIRS * BINS], largest = 0, size = 0;
    make_g(1, g);
    assert_ok(mf_hnc_closure(&of_unequal, g, indirect));
    for (size_t n = 0; n < PAIRS * BINS; n += 5) {
        const double exact = indirect_of(mf_rdf_bins_centre(&bins, n % BINS), (int)(n / BINS));
        largest = fmax(largest, fabs(indirect[n] - exact));
        size = fmax(size, fabs(exact));
    }
    print_message("largest error %.1e of %.3f\n", largest, size);
    assert_true(largest < discretisation && size > 0.01);
}

/// Change of h of one pair type alone at a time.
static void check_slope(size_t pair) {
    static const double small = 1e-4, cells = 5e-3; // means of cells, not values at their centres
    double g[PAIRS * BINS], above[PAIRS * BINS], below[PAIRS * BINS], more[PAIRS * BINS],
        less[PAIRS * BINS], difference[PAIRS * BINS], slope[PAIRS * BINS], largest = 0;
    make_g(1, g);
    for (size_t n = 0; n < PAIRS * BINS; n++) {
        const double r = mf_rdf_bins_centre(&bins, n % BINS);
        const double change = n / BINS == pair ? small * exp(-r * r) * (1 + r) : 0;
        above[n] = g[n] + change;
        below[n] = g[n] - change;
        difference[n] = 2 * change;
    }
    assert_ok(mf_hnc_closure(&of_unequal, above, more));
    assert_ok(mf_hnc_closure(&of_unequal, below, less));
    assert_ok(mf_hnc_closure_slope(&of_unequal, g, difference, 0, slope));
    for (size_t n = 0; n < PAIRS * BINS; n++) {
        largest = fmax(largest, fabs(slope[n]));
        assert_close(slope[n], more[n] - less[n], small * cells);
    }
    assert_true(largest > 0.1 * small);
}

static void test_hnc_closure_slope_is_that_of_the_closure_in_a_mixture(void **state) {
    (void)state;
    for (size_t pair = 0; pair < PAIRS; pair++)
        check_slope(pair);
}

static void test_hnc_closure_stays_finite_when_a_mixture_has_no_structure_factor(void **state) {
    (void)state;
    double g[PAIRS * BINS], indirect[PAIRS * BINS];
    make_g(4, g);
    assert_ok(mf_hnc_closure(&of_unequal, g, indirect));
    for (size_t n = 0; n < PAIRS * BINS; n++)
        assert_true(isfinite(indirect[n]));
}

int main(void) {
    gsl_set_error_handler_off(); // as the program does: a matrix may have no Cholesky factor
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_hnc_closure_of_two_types_that_are_alike_is_that_of_one),
        cmocka_unit_test(test_hnc_closure_is_the_inverse_by_hand_when_h_are_gaussians),
        cmocka_unit_test(test_hnc_closure_slope_is_that_of_the_closure_in_a_mixture),
        cmocka_unit_test(test_hnc_closure_stays_finite_when_a_mixture_has_no_structure_factor),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
