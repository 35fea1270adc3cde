// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/hnc_closure.h"

#include "shared/hard_spheres.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <gsl/gsl_errno.h>
#include <math.h>

enum { BINS = 250 };

static const double pi = 3.14159265358979323846;

static const struct rdf_bins bins = {0, 0.032, BINS};
/// So large that g is that of an infinite system.
static const struct box box = {.dimensions = 3, .length = {1e4, 1e4, 1e4}};
static const struct composition one = {.types = 1, .count = {1000000000000}};
static const struct hnc_liquid liquid = {&bins, &box, &one, NULL, 0};

/// g = 1 − A exp(−r²), with ρ A π^{3/2} = 1/2; the density is 1.
static double amplitude(void) {
    return 0.5 / pow(pi, 1.5);
}

static void make_g(double scale, double *g) {
    for (size_t k = 0; k < BINS; k++) {
        const double r = mf_rdf_bins_centre(&bins, k);
        g[k] = 1 - scale * amplitude() * exp(-r * r);
    }
}

/// Of h as constant pieces: h'' width²/24. Measured 2e-6 of 0.011.
static const double discretisation = 5e-6;

static void test_hnc_closure_is_the_series_when_h_is_a_gaussian(void **state) {
    (void)state;
    double g[BINS], indirect[BINS];
    make_g(1, g);
    assert_ok(mf_hnc_closure(&liquid, g, indirect));
    for (size_t k = 0; k < BINS; k++) {
        // ρ ĥ²/(1 + ρ ĥ) as a geometric series; each term is a Gaussian again.
        const double r = mf_rdf_bins_centre(&bins, k);
        double exact = 0;
        for (int m = 2; m < 60; m++)
            exact += pow(0.5, m) * pow(pi * m, -1.5) * exp(-r * r / m);
        assert_close(indirect[k], exact, discretisation);
    }
}

static void test_hnc_closure_slope_is_that_of_the_closure(void **state) {
    (void)state;
    static const double small = 1e-4, cells = 2e-4; // means of cells, not values at their centres
    double g[BINS], above[BINS], below[BINS], more[BINS], less[BINS], difference[BINS], slope[BINS];
    make_g(1, g);
    make_g(1 + small, above);
    make_g(1 - small, below);
    for (size_t k = 0; k < BINS; k++)
        difference[k] = above[k] - below[k];
    assert_ok(mf_hnc_closure(&liquid, above, more));
    assert_ok(mf_hnc_closure(&liquid, below, less));
    assert_ok(mf_hnc_closure_slope(&liquid, g, difference, 0, slope));
    for (size_t k = 0; k < BINS; k++)
        assert_close(slope[k], more[k] - less[k], small * cells);
    assert_ok(mf_hnc_closure_slope(&liquid, g, difference, 1, slope));
    assert_true(fabs(slope[0] - (more[0] - less[0])) > 1e-7);
}

static void test_hnc_closure_stays_finite_when_the_target_has_no_structure_factor(void **state) {
    (void)state;
    double g[BINS], indirect[BINS];
    make_g(3, g); // S(0) = −1/2
    assert_ok(mf_hnc_closure(&liquid, g, indirect));
    for (size_t k = 0; k < BINS; k++)
        assert_true(isfinite(indirect[k]));
}

/// g of hard spheres up to a range, before their oscillations end; of N of them it is too small by
/// the factor 1 − S(0)/N, over N² pairs (J. L. Lebowitz and J. K. Percus, Phys. Rev. 122, 1675
/// (1961)).
static void check_hard_spheres(double eta, double range, double particles, double bound) {
    enum { CELLS = 120 };
    const struct rdf_bins cells = {0, range / CELLS, CELLS};
    const double edge = cbrt(particles / hard_spheres_density(eta));
    const struct box cube = {.dimensions = 3, .length = {edge, edge, edge}};
    const struct composition spheres = {.types = 1, .count = {(int64_t)particles}};
    const double finite = (1 - hard_spheres_compressibility(eta) / particles) / (1 - 1 / particles);
    double g[CELLS], indirect[CELLS], largest = 0;
    for (size_t k = 0; k < CELLS; k++)
        g[k] = finite * (1 + hard_spheres_h(eta, mf_rdf_bins_centre(&cells, k)));
    assert_ok(mf_hnc_closure(&(struct hnc_liquid){&cells, &cube, &spheres, NULL, 0}, g, indirect));
    for (size_t k = 0; k < CELLS; k++) {
        const double r = mf_rdf_bins_centre(&cells, k);
        const double exact = hard_spheres_h(eta, r) - hard_spheres_c(eta, r);
        if (r > 1 + 2 * cells.width) // the potential of the core is not sought
            largest = fmax(largest, fabs(indirect[k] - exact));
    }
    print_message("eta %g, range %g, %g spheres: largest error %.4f\n", eta, range, particles,
                  largest);
    assert_true(largest < bound);
}

static void test_hnc_closure_knows_what_lies_beyond_the_range(void **state) {
    (void)state;
    check_hard_spheres(0.3, 2, 1e12, 0.02);
    check_hard_spheres(0.45, 1.6, 1e12, 0.15);
}

static void test_hnc_closure_knows_that_particles_are_few(void **state) {
    (void)state;
    check_hard_spheres(0.3, 2, 200, 0.02);
    check_hard_spheres(0.45, 1.6, 500, 0.15);
}

static void test_hnc_closure_refuses_two_dimensions(void **state) {
    (void)state;
    static const struct box plane = {.dimensions = 2, .length = {10, 10, 1}};
    double g[BINS], indirect[BINS];
    make_g(1, g);
    assert_fails(mf_hnc_closure(&(struct hnc_liquid){&bins, &plane, &one, NULL, 0}, g, indirect),
                 STATUS_BAD_INPUT, "three dimensions");
}

int main(void) {
    gsl_set_error_handler_off(); // as the program does: a matrix may have no Cholesky factor
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_hnc_closure_is_the_series_when_h_is_a_gaussian),
        cmocka_unit_test(test_hnc_closure_slope_is_that_of_the_closure),
        cmocka_unit_test(test_hnc_closure_stays_finite_when_the_target_has_no_structure_factor),
        cmocka_unit_test(test_hnc_closure_knows_what_lies_beyond_the_range),
        cmocka_unit_test(test_hnc_closure_knows_that_particles_are_few),
        cmocka_unit_test(test_hnc_closure_refuses_two_dimensions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
