// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/kirkwood_buff.h"

#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

enum { BINS = 4000 };

/// So large that its finite size does not matter, or small.
static const struct box huge = {.dimensions = 3, .length = {1e5, 1e5, 1e5}};

static double hole(double r) {
    return r < 1 ? 0 : 1;
}

static double decay(double r) {
    return 1 - exp(-2 * r);
}

static double g_of[BINS], error_of[BINS];

static struct rdf_bins fill(double (*of)(double), double range, double own_error) {
    const struct rdf_bins bins = {0, range / BINS, BINS};
    for (size_t k = 0; k < BINS; k++) {
        g_of[k] = of(mf_rdf_bins_centre(&bins, k));
        error_of[k] = own_error;
    }
    return bins;
}

static struct kirkwood_buff integrate(double (*of)(double), double range, const struct box *box,
                                      size_t count, double own_error) {
    const struct rdf_bins bins = fill(of, range, own_error);
    return mf_kirkwood_buff_integrate(&bins, g_of, error_of, box, count, 0);
}

static void test_kirkwood_buff_is_the_polynomial_of_a_hole(void **state) {
    (void)state;
    const double range = 4, x = 1 / range;
    const double exact =
        -4 * M_PI * range * range * range *
        (x * x * x / 3 - 23.0 / 8 * pow(x, 6) / 6 + 0.75 * pow(x, 7) / 7 + 9.0 / 8 * pow(x, 8) / 8);
    assert_close_relative(integrate(hole, range, &huge, 100, 0).integral, exact, 1e-9);
}

static void test_kirkwood_buff_converges_as_the_cube_of_the_range(void **state) {
    (void)state;
    double last = 0;
    for (int k = 0; k < 2; k++) {
        // −4π ∫ r² e^{−2r} dr = −π.
        const double off = integrate(decay, 16 * pow(2, k), &huge, 100, 0).integral + M_PI;
        if (k > 0)
            assert_close(last / off, 8, 0.5);
        last = off;
    }
    assert_close(last, 0, 3e-3);
}

static void test_kirkwood_buff_takes_out_the_finite_size(void **state) {
    (void)state;
    // The tail of N particles, −ρG/N, added by hand: the result is the same.
    const struct box box = {.dimensions = 3, .length = {12, 12, 12}};
    const size_t count = 3000;
    static double g[BINS], error[BINS];
    const struct rdf_bins bins = {0, 5.0 / BINS, BINS};
    const double infinite = integrate(hole, 5, &huge, 100, 0).integral;
    for (size_t k = 0; k < BINS; k++)
        g[k] = hole(mf_rdf_bins_centre(&bins, k)) - infinite / (12.0 * 12 * 12);
    const struct kirkwood_buff found = mf_kirkwood_buff_integrate(&bins, g, error, &box, count, 0);
    assert_close_relative(found.integral, infinite, 1e-9);
    assert_close(found.compressibility, 1 + 3000 / 1728.0 * infinite, 1e-9);
}

/// A range that is no part of the box says nothing of it: its tail cannot be taken out.
static void test_kirkwood_buff_is_unknown_beyond_the_box(void **state) {
    (void)state;
    static const double range[] = {5, 8, 12};
    const struct box box = {.dimensions = 3, .length = {12, 12, 12}};
    for (int k = 0; k < 3; k++) {
        const struct kirkwood_buff found = integrate(decay, range[k], &box, 500, 0.01);
        const double all[] = {found.integral, found.integral_error, found.compressibility,
                              found.compressibility_error};
        for (int n = 0; n < 4; n++)
            assert_int_equal(isfinite(all[n]), k == 0);
    }
}

/// Dimers that do not see each other, M of them: 1 + ρG is the two beads of one, whether g has the
/// pairs of a dimer, at a distance, or not.
static void test_kirkwood_buff_counts_pairs_that_g_leaves_out(void **state) {
    (void)state;
    const struct box box = {.dimensions = 3, .length = {12, 12, 12}};
    const double molecules = 500, beads = 2 * molecules;
    const double inside = 12.0 * 12 * 12 / (beads - 1); // M pairs of N (N − 1)/2
    static double g[BINS], error[BINS];
    const struct rdf_bins bins = {0, 5.0 / BINS, BINS};
    for (size_t k = 0; k < BINS; k++)
        g[k] = 1 - 1 / (beads - 1);
    const struct kirkwood_buff found =
        mf_kirkwood_buff_integrate(&bins, g, error, &box, (size_t)beads, inside);
    assert_close(found.compressibility, 2, 2.0 / beads);
}

static void test_kirkwood_buff_error_is_that_of_independent_bins(void **state) {
    (void)state;
    const struct rdf_bins bins = {0, 1, 2};
    const double g[] = {0.5, 1.2}, error[] = {0.1, NAN};
    const struct kirkwood_buff found = mf_kirkwood_buff_integrate(&bins, g, error, &huge, 1000, 0);
    const double first =
        4 * M_PI * 8 *
        (0.125 / 3 - 23.0 / 48 * pow(0.5, 6) + 3.0 / 28 * pow(0.5, 7) + 9.0 / 64 * pow(0.5, 8));
    assert_close_relative(found.integral_error, 0.1 * first, 1e-9);
    assert_close_relative(found.compressibility_error, 1e-12 * found.integral_error, 1e-9);
}

/// A core, a peak and a hole behind it.
static double liquid(double r) {
    return r < 0.9 ? 0 : 1 + exp(-2 * (r - 0.9)) * cos(6 * (r - 1.1));
}

/// That comes to 1 as a system of 1000 with S(0) = 1 lets it.
static double hole_of_1000(double r) {
    return (1 - exp(-3 * r)) * (1 - 1e-3);
}

/// Cut off inside its first peak, G is known as well as its range tells, which the noise of the
/// bins does not; and not at all where g has not come to 1. Without errors of g it has none.
static void test_kirkwood_buff_is_told_as_far_as_its_range_tells_it(void **state) {
    (void)state;
    static const double range[] = {1.05, 1.1, 1.25, 1.5, 2, 3, 4};
    const struct box box = {.dimensions = 3, .length = {100, 100, 100}};
    const size_t count = 800000;
    const double exact = integrate(liquid, 20, &box, count, 0).compressibility;
    for (size_t k = 0; k < sizeof range / sizeof *range; k++) {
        const struct rdf_bins bins = fill(liquid, range[k], 1e-4);
        const struct kirkwood_buff noise =
            mf_kirkwood_buff_integrate(&bins, g_of, error_of, &box, count, 0);
        const struct kirkwood_buff found =
            mf_kirkwood_buff_known(&bins, g_of, error_of, &box, count, 0);
        print_message("to %.2f: %.3f(%.3f), by noise (%.3f), exact %.3f\n", range[k],
                      found.compressibility, found.compressibility_error,
                      noise.compressibility_error, exact);
        assert_close(found.compressibility, exact, 3 * found.compressibility_error);
    }
    struct rdf_bins bins = fill(liquid, 0.85, 1e-4);
    assert_true(isnan(mf_kirkwood_buff_known(&bins, g_of, error_of, &box, count, 0).integral));
    bins = fill(liquid, 4, 0);
    const struct kirkwood_buff one = mf_kirkwood_buff_known(&bins, g_of, error_of, &box, count, 0);
    assert_true(isfinite(one.compressibility) && isnan(one.compressibility_error));
    bins = fill(hole_of_1000, 4, 0);
    assert_true(isfinite(mf_kirkwood_buff_known(&bins, g_of, error_of, &box, 1000, 0).integral));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_kirkwood_buff_is_the_polynomial_of_a_hole),
        cmocka_unit_test(test_kirkwood_buff_converges_as_the_cube_of_the_range),
        cmocka_unit_test(test_kirkwood_buff_takes_out_the_finite_size),
        cmocka_unit_test(test_kirkwood_buff_is_unknown_beyond_the_box),
        cmocka_unit_test(test_kirkwood_buff_is_told_as_far_as_its_range_tells_it),
        cmocka_unit_test(test_kirkwood_buff_counts_pairs_that_g_leaves_out),
        cmocka_unit_test(test_kirkwood_buff_error_is_that_of_independent_bins),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
