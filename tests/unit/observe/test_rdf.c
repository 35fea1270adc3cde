// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/rng.h"
#include "base/statistics.h"
#include "observe/rdf.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

/// Of a few operations on numbers of order 1 to 100.
static const double rounding = 1e-12;

static const struct box cube = {3, {6, 7, 8}}, square = {2, {6, 7, 1}};

static void test_rdf_bins_are_equal_when_they_begin_above_zero(void **state) {
    (void)state;
    const struct rdf_bins bins = {0.5, 0.25, 6};
    assert_close(mf_rdf_bins_edge(&bins, 0), 0.5, rounding);
    assert_close(mf_rdf_bins_edge(&bins, 2), 1, rounding);
    assert_close(mf_rdf_bins_centre(&bins, 0), 0.625, rounding);
    assert_close(mf_rdf_bins_centre(&bins, 5), 1.875, rounding);
    assert_close(mf_rdf_bins_range(&bins), 2, rounding);
}

static void test_rdf_ideal_pairs_are_exact_when_a_bin_is_wide(void **state) {
    (void)state;
    const double pi = acos(-1);
    const struct rdf_bins bins = {1, 1, 2};
    // 10 particles have 45 pairs; shells 1 to 2 and 2 to 3 of a sphere, and of a disc.
    assert_close(mf_rdf_ideal_pairs(&bins, 0, &cube, 10), 45 * 4 * pi / 3 * 7 / 336, rounding);
    assert_close(mf_rdf_ideal_pairs(&bins, 1, &cube, 10), 45 * 4 * pi / 3 * 19 / 336, rounding);
    assert_close(mf_rdf_ideal_pairs(&bins, 0, &square, 10), 45 * pi * 3 / 42, rounding);
    assert_close(mf_rdf_ideal_pairs(&bins, 1, &square, 10), 45 * pi * 5 / 42, rounding);
}

static void test_rdf_ideal_pairs_fill_the_range_when_added(void **state) {
    (void)state;
    const struct rdf_bins bins = {0, 0.03, 100};
    const struct box *boxes[] = {&cube, &square};
    const double ball = 4 * acos(-1) / 3 * 27 / 336, disc = acos(-1) * 9 / 42;
    for (int b = 0; b < 2; b++) {
        double sum = 0;
        for (size_t k = 0; k < bins.count; k++)
            sum += mf_rdf_ideal_pairs(&bins, k, boxes[b], 2);
        assert_close(sum, b == 0 ? ball : disc, rounding);
    }
}

static void test_rdf_ideal_pairs_are_of_the_kind_when_types_differ(void **state) {
    (void)state;
    const struct rdf_bins bins = {0.5, 0.25, 6};
    const struct composition binary = {.types = 2, .count = {10, 30}};
    const double whole = mf_rdf_ideal_pairs(&bins, 3, &cube, 40);
    double sum = 0;
    for (int pair = 0; pair < 3; pair++)
        sum += mf_rdf_ideal_pairs_of(&bins, 3, &cube, &binary, pair);
    assert_close(sum, whole, rounding);
    assert_close(mf_rdf_ideal_pairs_of(&bins, 3, &cube, &binary, 1), whole * 300 / 780, rounding);
    assert_close(mf_rdf_ideal_pairs_of(&bins, 3, &cube, &binary, 2),
                 mf_rdf_ideal_pairs(&bins, 3, &cube, 30), rounding);
}

/// Particles at given x, the other coordinates 1, with the list of a box of `dimensions`.
static void place(struct particles *particles, const struct box *box, const double *x,
                  size_t count) {
    assert_ok(mf_particles_init(particles, box, count));
    for (int d = 0; d < box->dimensions; d++)
        for (size_t k = 0; k < count; k++)
            particles->position[d][k] = d == 0 ? x[k] : 1;
}

static void test_rdf_result_is_of_the_kind_when_types_differ(void **state) {
    (void)state;
    // A at 0.5 and 2, B at 5.1 and 3.2: A-A 1.5, A-B 1.4, 2.7, 2.9 and 1.2, B-B 1.9.
    static const double x[] = {0.5, 2, 5.1, 3.2}, pairs[] = {1, 0, 2, 2, 1, 0};
    const struct composition composition = {.types = 2, .count = {2, 2}};
    const struct rdf_bins bins = {1, 1, 2};
    struct particles particles;
    struct rdf rdf;
    double g[6], error[6], rmse, spread;
    place(&particles, &cube, x, 4);
    assert_ok(mf_rdf_init_mixture(&rdf, &bins, &cube, &composition, 0, 3));
    for (int sample = 0; sample < 3; sample++)
        assert_ok(mf_rdf_sample(&rdf, &particles, NULL));
    assert_ok(mf_rdf_result(&rdf, 1, g, error));
    for (int k = 0; k < 6; k++) {
        assert_close(g[k],
                     pairs[k] /
                         mf_rdf_ideal_pairs_of(&bins, (size_t)k % 2, &cube, &composition, k / 2),
                     rounding * (1 + g[k]));
        assert_close(error[k], 0, rounding);
        g[k] += k == 5 ? 6 : 0;
    }
    assert_ok(mf_rdf_distance(&rdf, 1, g, &rmse, &spread));
    assert_close(rmse, sqrt(6), rounding * 100);
    assert_close(spread, 0, rounding * 100);
    mf_rdf_clear(&rdf);
    mf_particles_clear(&particles);
}

static void test_rdf_result_is_normalised_when_pairs_are_known(void **state) {
    (void)state;
    // Distances 1.5 and, across the border, 1.4 and 2.9.
    static const double x[] = {0.5, 2, 5.1};
    const struct box *boxes[] = {&cube, &square};
    const struct rdf_bins bins = {1, 1, 2};
    for (int b = 0; b < 2; b++) {
        struct particles particles;
        struct rdf rdf;
        double g[2], error[2];
        place(&particles, boxes[b], x, 3);
        assert_ok(mf_rdf_init(&rdf, &bins, boxes[b], 3, 0, 3));
        for (int sample = 0; sample < 3; sample++)
            assert_ok(mf_rdf_sample(&rdf, &particles, NULL));
        assert_ok(mf_rdf_result(&rdf, 1, g, error));
        for (size_t k = 0; k < 2; k++) {
            const double pairs = k == 0 ? 2 : 1;
            assert_close(g[k], pairs / mf_rdf_ideal_pairs(&bins, k, boxes[b], 3), rounding);
            assert_close(error[k], 0, rounding);
        }
        mf_rdf_clear(&rdf);
        mf_particles_clear(&particles);
    }
}

static void test_rdf_init_refuses_when_the_range_exceeds_half_the_box(void **state) {
    (void)state;
    struct rdf rdf;
    const struct rdf_bins bins = {0, 0.4, 8};
    assert_fails(mf_rdf_init(&rdf, &bins, &cube, 10, 1, 5), STATUS_BAD_INPUT, "RDF");
    // The simulation's list would have been refused already.
    assert_ok(mf_rdf_init(&rdf, &bins, &cube, 10, 3.2, 5));
    assert_false(rdf.needs_own_list);
    mf_rdf_clear(&rdf);
}

// The errors are tested on histograms of independent numbers with a known mean and scatter.
enum { BINS = 32, BLOCKS = 20, EACH = 5, TRIALS = 2000 };
static const struct rdf_bins few_bins = {0.5, 0.08, BINS};
enum { MANY = 50 };

static double true_g(size_t k) {
    static const double values[] = {0.2, 1.6, 0.9, 1};
    return values[k % 4];
}

/// Relative scatter of the pairs of one sample in bin k.
static double scatter(size_t k) {
    return 0.1 + 0.05 * (double)(k % 4);
}

/// An RDF whose samples are normal counts about true_g, each with the share `phi` of the deviation
/// before.
static void make_samples(struct rdf *rdf, uint32_t trial, uint32_t replica, double phi) {
    double deviation[BINS] = {0};
    assert_ok(mf_rdf_init(rdf, &few_bins, &cube, MANY, 5, BLOCKS * EACH));
    assert_int_equal(rdf->blocks.count, BLOCKS);
    for (uint32_t sample = 0; sample < BLOCKS * EACH; sample++) {
        double normal[4] = {0};
        for (uint32_t k = 0; k < BINS; k++) {
            if (k % 4 == 0)
                mf_rng_normal4(mf_rng_philox(9, RNG_INITIAL, trial, replica * BINS + k, sample),
                               normal);
            deviation[k] = sample == 0 ? normal[k % 4]
                                       : phi * deviation[k] + sqrt(1 - phi * phi) * normal[k % 4];
            rdf->blocks.sums[sample / EACH * BINS + k] +=
                mf_rdf_ideal_pairs(&few_bins, k, &cube, MANY) * true_g(k) *
                (1 + scatter(k) * deviation[k]);
        }
        rdf->blocks.samples[sample / EACH] += 1;
        rdf->blocks.taken++;
    }
}

/// |g − true| / error follows Student's t with 19 degrees of freedom: within 2 errors in 94.0 % of
/// the trials. The share of 64,000 has a standard error of 0.1 %; the rest of the band is for the
/// correlation that bins seem to have by chance.
static const double covered_share = 0.940, covered_band = 0.0135;

static void test_rdf_errors_cover_the_truth_when_samples_are_independent(void **state) {
    (void)state;
    double covered = 0;
    for (uint32_t trial = 0; trial < TRIALS; trial++) {
        struct rdf rdf;
        double g[BINS], error[BINS];
        make_samples(&rdf, trial, 0, 0);
        assert_ok(mf_rdf_result(&rdf, 1, g, error));
        for (size_t k = 0; k < BINS; k++)
            covered += fabs(g[k] - true_g(k)) < 2 * error[k];
        mf_rdf_clear(&rdf);
    }
    assert_close(covered / (TRIALS * BINS), covered_share, covered_band);
}

/// Standard errors of a sample variance's root from 2000 trials: 1.6 %; four of these.
static const double spread_tolerance = 0.064;

/// Errors of g over replicas against its scatter from trial to trial, which is `scale` times that
/// of independent samples.
static void check_errors(double phi, double scale) {
    enum { REPLICAS = 3 };
    struct running_mean spread[BINS] = {{0}}, squares[BINS] = {{0}};
    for (uint32_t trial = 0; trial < TRIALS; trial++) {
        struct rdf rdf[REPLICAS];
        double g[BINS], error[BINS];
        for (uint32_t r = 0; r < REPLICAS; r++)
            make_samples(&rdf[r], trial, r, phi);
        assert_ok(mf_rdf_result(rdf, REPLICAS, g, error));
        for (size_t k = 0; k < BINS; k++) {
            mf_statistics_add(&spread[k], g[k]);
            mf_statistics_add(&squares[k], error[k] * error[k]);
        }
        for (uint32_t r = 0; r < REPLICAS; r++)
            mf_rdf_clear(&rdf[r]);
    }
    print_message("phi = %.1f: reported over exact error %.3f\n", phi,
                  sqrt(squares[0].mean / EACH / BLOCKS) * EACH * BLOCKS * sqrt(REPLICAS) /
                      (scale * true_g(0) * scatter(0)));
    for (size_t k = 0; k < BINS; k++) {
        const double truth = scale * true_g(k) * scatter(k) / sqrt(BLOCKS * EACH * REPLICAS);
        assert_close_relative(sqrt(spread[k].squares / (TRIALS - 1)), truth, spread_tolerance);
        // The estimates themselves scatter less.
        assert_close_relative(sqrt(squares[k].mean), truth, spread_tolerance);
    }
}

static void test_rdf_errors_are_the_scatter_when_replicas_are_pooled(void **state) {
    (void)state;
    check_errors(0, 1);
}

/// Of n samples, sqrt(1 + 2 Σ (1 − t/n) φ^t).
static void test_rdf_errors_are_the_scatter_when_samples_are_close(void **state) {
    (void)state;
    static const double shares[] = {0.5, 0.8};
    for (int m = 0; m < 2; m++) {
        double sum = 1;
        for (int t = 1; t < BLOCKS * EACH; t++)
            sum += 2 * (1 - (double)t / (BLOCKS * EACH)) * pow(shares[m], t);
        check_errors(shares[m], sqrt(sum));
    }
}

/// The jackknife is exact to first order in the noise: here the distance is 20 errors.
static const double jackknife_tolerance = 0.1;

static void test_rdf_distance_error_is_the_scatter_when_the_target_is_off(void **state) {
    (void)state;
    double target[BINS];
    struct running_mean spread = {0}, squares = {0};
    for (size_t k = 0; k < BINS; k++)
        target[k] = true_g(k) + 0.3;
    for (uint32_t trial = 0; trial < TRIALS; trial++) {
        struct rdf rdf;
        double rmse, error, without_error;
        make_samples(&rdf, trial, 7, 0);
        assert_ok(mf_rdf_distance(&rdf, 1, target, &rmse, &error));
        assert_ok(mf_rdf_distance(&rdf, 1, target, &without_error, NULL));
        assert_identical(rmse, without_error);
        mf_statistics_add(&spread, rmse);
        mf_statistics_add(&squares, error * error);
        mf_rdf_clear(&rdf);
    }
    assert_close(spread.mean, 0.3, 0.003);
    assert_close_relative(sqrt(squares.mean), sqrt(spread.squares / (TRIALS - 1)),
                          jackknife_tolerance);
}

static void test_rdf_rmse_is_the_root_mean_square_when_bins_differ(void **state) {
    (void)state;
    assert_close(mf_rdf_rmse((double[]){1, 2, 3}, (double[]){1, 0, 4}, 3), sqrt(5.0 / 3), rounding);
    assert_identical(mf_rdf_rmse((double[]){1, 2}, (double[]){1, 2}, 2), 0.0);
}

static void test_rdf_error_is_zero_when_there_is_one_block(void **state) {
    (void)state;
    static const double x[] = {0.5, 2, 5};
    const struct rdf_bins bins = {1, 1, 2};
    struct particles particles;
    struct rdf rdf;
    double g[2], error[2], rmse, rmse_error;
    place(&particles, &cube, x, 3);
    assert_ok(mf_rdf_init(&rdf, &bins, &cube, 3, 0, 1));
    assert_ok(mf_rdf_sample(&rdf, &particles, NULL));
    assert_ok(mf_rdf_result(&rdf, 1, g, error));
    assert_true(g[0] > 0);
    assert_identical(error[0], 0.0);
    assert_ok(mf_rdf_distance(&rdf, 1, (double[]){0, 0}, &rmse, &rmse_error));
    assert_identical(rmse_error, 0.0);
    mf_rdf_clear(&rdf);
    mf_particles_clear(&particles);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rdf_bins_are_equal_when_they_begin_above_zero),
        cmocka_unit_test(test_rdf_ideal_pairs_are_exact_when_a_bin_is_wide),
        cmocka_unit_test(test_rdf_ideal_pairs_fill_the_range_when_added),
        cmocka_unit_test(test_rdf_ideal_pairs_are_of_the_kind_when_types_differ),
        cmocka_unit_test(test_rdf_result_is_of_the_kind_when_types_differ),
        cmocka_unit_test(test_rdf_result_is_normalised_when_pairs_are_known),
        cmocka_unit_test(test_rdf_init_refuses_when_the_range_exceeds_half_the_box),
        cmocka_unit_test(test_rdf_errors_cover_the_truth_when_samples_are_independent),
        cmocka_unit_test(test_rdf_errors_are_the_scatter_when_replicas_are_pooled),
        cmocka_unit_test(test_rdf_errors_are_the_scatter_when_samples_are_close),
        cmocka_unit_test(test_rdf_distance_error_is_the_scatter_when_the_target_is_off),
        cmocka_unit_test(test_rdf_rmse_is_the_root_mean_square_when_bins_differ),
        cmocka_unit_test(test_rdf_error_is_zero_when_there_is_one_block),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
