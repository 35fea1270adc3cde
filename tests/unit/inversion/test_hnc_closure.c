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

enum { CELLS = 120, MANY = 450 };

/// g of so many hard spheres, over N (N − 1)/2 pairs: over N²/2 it is too small by the factor
/// 1 − S(0)/N (J. L. Lebowitz and J. K. Percus, Phys. Rev. 122, 1675 (1961)).
static double finite_g(double eta, double particles, double r) {
    return (1 - hard_spheres_compressibility(eta) / particles) / (1 - 1 / particles) *
           (1 + hard_spheres_h(eta, r));
}

static struct box box_of(double eta, double particles) {
    return mf_box_cube(particles / hard_spheres_density(eta));
}

/// How far h − c of hard spheres is off beyond the core, whose potential is not sought.
static double farthest(const struct rdf_bins *cells, double eta, const double *indirect) {
    double largest = 0;
    for (size_t k = 0; k < cells->count; k++) {
        const double r = mf_rdf_bins_centre(cells, k);
        if (r > 1.04)
            largest = fmax(largest, fabs(indirect[k] - hard_spheres_h(eta, r)));
    }
    return largest; // c is 0 there
}

/// g up to a range, before its oscillations end.
static void check_hard_spheres(const struct rdf_bins *cells, double eta, double particles,
                               double bound) {
    const struct box cube = box_of(eta, particles);
    const struct composition spheres = {.types = 1, .count = {(int64_t)particles}};
    static double g[MANY], indirect[MANY];
    for (size_t k = 0; k < cells->count; k++)
        g[k] = finite_g(eta, particles, mf_rdf_bins_centre(cells, k));
    assert_ok(mf_hnc_closure(&(struct hnc_liquid){cells, &cube, &spheres, NULL, 0}, g, indirect));
    const double off = farthest(cells, eta, indirect);
    print_message("eta %g, range %g, %zu bins, %g spheres: largest error %.4f\n", eta,
                  mf_rdf_bins_range(cells), cells->count, particles, off);
    assert_true(off < bound);
}

static const struct rdf_bins to_2 = {0, 2.0 / CELLS, CELLS};
static const struct rdf_bins to_1_6 = {0, 1.6 / CELLS, CELLS};

static void test_hnc_closure_knows_what_lies_beyond_the_range(void **state) {
    (void)state;
    check_hard_spheres(&to_2, 0.3, 1e12, 0.01);
    check_hard_spheres(&to_1_6, 0.45, 1e12, 0.15);
}

static void test_hnc_closure_knows_that_particles_are_few(void **state) {
    (void)state;
    check_hard_spheres(&to_2, 0.3, 200, 0.01);
    check_hard_spheres(&to_1_6, 0.45, 500, 0.15);
}

/// Also where the first bin is not at 0, and bins are so many that they are joined.
static void test_hnc_closure_fills_the_core(void **state) {
    (void)state;
    check_hard_spheres(&(struct rdf_bins){0.5, 1.5 / CELLS, CELLS}, 0.3, 300, 0.01);
    check_hard_spheres(&(struct rdf_bins){0.5, 1.5 / MANY, MANY}, 0.3, 300, 0.01);
}

/// Hard spheres of which some have another name: pairs of all names have the same g.
static void check_names(int64_t first, int64_t second, double bound) {
    static const double eta = 0.3;
    const double particles = (double)(first + second);
    const struct composition names = {.types = 2, .count = {first, second}, .name = {"A", "B"}};
    const struct box cube = box_of(eta, particles);
    static double g[3 * CELLS], indirect[3 * CELLS];
    for (size_t n = 0; n < 3 * CELLS; n++)
        g[n] = n < CELLS && first < 2
                   ? 0
                   : finite_g(eta, particles, mf_rdf_bins_centre(&to_2, n % CELLS));
    assert_ok(mf_hnc_closure(&(struct hnc_liquid){&to_2, &cube, &names, NULL, 0}, g, indirect));
    for (int pair = first < 2; pair < 3; pair++) {
        const double off = farthest(&to_2, eta, indirect + pair * CELLS);
        print_message("%lld and %lld, pair %d: largest error %.4f\n", (long long)first,
                      (long long)second, pair, off);
        assert_true(off < bound);
    }
}

static void test_hnc_closure_of_few_with_another_name_is_that_of_all(void **state) {
    (void)state;
    check_names(60, 240, 0.01);
    check_names(2, 298, 0.01);
    check_names(1, 299, 0.01);
}

/// A level of g that is off by a per mille makes a ramp, which a softness bounds.
static void test_hnc_closure_bounds_what_the_level_of_g_does(void **state) {
    (void)state;
    static const double eta = 0.45, particles = 1e12, level = 1.004;
    const struct box cube = box_of(eta, particles);
    const struct composition spheres = {.types = 1, .count = {(int64_t)particles}};
    double g[CELLS], indirect[CELLS], off[2];
    for (int soft = 0; soft < 2; soft++) {
        for (size_t k = 0; k < CELLS; k++)
            g[k] = level * finite_g(eta, particles, mf_rdf_bins_centre(&to_2, k));
        assert_ok(mf_hnc_closure(
            &(struct hnc_liquid){&to_2, &cube, &spheres, NULL, soft ? 1e-3 : 0}, g, indirect));
        off[soft] = farthest(&to_2, eta, indirect);
    }
    print_message("off by %.3f, softly %.3f\n", off[0], off[1]);
    assert_true(off[1] < 0.7 * off[0]);
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
        cmocka_unit_test(test_hnc_closure_fills_the_core),
        cmocka_unit_test(test_hnc_closure_of_few_with_another_name_is_that_of_all),
        cmocka_unit_test(test_hnc_closure_bounds_what_the_level_of_g_does),
        cmocka_unit_test(test_hnc_closure_refuses_two_dimensions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
