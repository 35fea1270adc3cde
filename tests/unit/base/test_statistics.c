// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/comoments.h"
#include "base/statistics.h"
#include "base/rng.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <string.h>

enum { SIZE = 3, SAMPLES = 1000 };

/// Rounding of a thousand additions of numbers of order 1: 1000 · 2^-53, with a factor of ten.
static const double rounding = 1e-12;

/// Numbers about `offset` are stored to 2^-27 of a unit at 1e8, each rounding being independent.
static const double rounding_at_large_offset = 1e-7;

/// Correlated samples of order 1, shape [SAMPLES, SIZE], moved by `offset`.
static void make_samples(double samples[SAMPLES][SIZE], double offset) {
    for (uint32_t n = 0; n < SAMPLES; n++) {
        double normal[4];
        mf_rng_normal4(mf_rng_philox(11, RNG_INITIAL, n, 0, 0), normal);
        samples[n][0] = offset + normal[0];
        samples[n][1] = offset + 0.5 * normal[0] + normal[1];
        samples[n][2] = offset - normal[1] + 0.1 * normal[2];
    }
}

/// Two-pass covariance in long double: the slow twin.
static double covariance_two_pass(double samples[SAMPLES][SIZE], size_t a, size_t b) {
    long double mean_a = 0, mean_b = 0, sum = 0;
    for (int n = 0; n < SAMPLES; n++) {
        mean_a += samples[n][a];
        mean_b += samples[n][b];
    }
    mean_a /= SAMPLES;
    mean_b /= SAMPLES;
    for (int n = 0; n < SAMPLES; n++)
        sum += (samples[n][a] - mean_a) * (samples[n][b] - mean_b);
    return (double)(sum / SAMPLES);
}

static void assert_two_pass(const struct comoments *moments, double samples[SAMPLES][SIZE],
                            double tolerance) {
    assert_identical(moments->count, (double)SAMPLES);
    for (size_t a = 0; a < SIZE; a++)
        for (size_t b = 0; b < SIZE; b++)
            assert_close(mf_comoments_covariance(moments, a, b), covariance_two_pass(samples, a, b),
                         tolerance);
}

static void test_statistics_add_equals_two_passes_when_numbers_are_of_order_one(void **state) {
    (void)state;
    double samples[SAMPLES][SIZE];
    make_samples(samples, 0);
    struct running_mean running = {0};
    long double sum = 0;
    for (int n = 0; n < SAMPLES; n++) {
        mf_statistics_add(&running, samples[n][1]);
        sum += samples[n][1];
    }
    const double variance = covariance_two_pass(samples, 1, 1) * SAMPLES / (SAMPLES - 1);
    assert_close(running.mean, (double)(sum / SAMPLES), rounding);
    assert_close(mf_statistics_standard_error(&running), sqrt(variance / SAMPLES), rounding);
}

static void test_statistics_add_keeps_the_variance_when_the_mean_is_large(void **state) {
    (void)state;
    struct running_mean running = {0};
    for (int n = 0; n < SAMPLES; n++)
        mf_statistics_add(&running, 1e8 + n % 2);
    assert_close(running.mean, 1e8 + 0.5, rounding_at_large_offset);
    assert_close(running.squares / SAMPLES, 0.25, rounding_at_large_offset);
}

static void test_statistics_standard_error_is_zero_when_there_are_fewer_than_two(void **state) {
    (void)state;
    struct running_mean running = {0};
    assert_identical(mf_statistics_standard_error(&running), 0.0);
    mf_statistics_add(&running, 3);
    assert_identical(mf_statistics_standard_error(&running), 0.0);
    assert_identical(running.mean, 3.0);
    mf_statistics_add(&running, 5);
    assert_close(mf_statistics_standard_error(&running), 1, rounding);
}

static void test_statistics_mark_unknown_errors_of_which_none_is_above_zero(void **state) {
    (void)state;
    double single[] = {0, 0, 0}, several[] = {0, 0.1, 0}, other = 1;
    mf_statistics_mark_unknown_errors(single, 3);
    mf_statistics_mark_unknown_errors(several, 3);
    mf_statistics_mark_unknown_errors(&other, 0);
    for (size_t k = 0; k < 3; k++) {
        assert_true(isnan(single[k]));
        assert_true(several[k] == (k == 1 ? 0.1 : 0));
    }
    assert_true(other == 1);
}

static void test_statistics_correlated_error_is_exact_when_series_are_short(void **state) {
    (void)state;
    // Γ = 1, 5/7, 1/3, −1/5: both pairs count, the window is 3, and 8 − 7 values are left.
    static const double step[] = {0, 0, 0, 0, 2, 2, 2, 2};
    assert_close(mf_statistics_correlated_error(step, 8, 1),
                 sqrt(-1 + 2 * (1 + 5.0 / 7) + 2 * (1.0 / 3 - 1.0 / 5)), rounding);
    // Γ(0) + Γ(1) = 0: the error of independent values.
    static const double comb[] = {-1, 1, -1, 1, -1, 1, -1, 1};
    assert_close(mf_statistics_correlated_error(comb, 8, 1), sqrt(1.0 / 7), rounding);
    // Chains do not meet: as eight chains of one value, Γ(0) is all there is.
    assert_close(mf_statistics_correlated_error(step, 1, 8), sqrt(1.0 / 7), rounding);
}

static void test_statistics_correlated_error_is_zero_when_there_is_no_scatter(void **state) {
    (void)state;
    assert_true(isnan(mf_statistics_correlated_error((double[]){3}, 1, 1)));
    assert_true(isnan(mf_statistics_correlated_error((double[]){3}, 0, 1)));
    assert_identical(mf_statistics_correlated_error((double[]){3, 3, 3, 3, 3}, 5, 1), 0.0);
    assert_true(isnan(mf_statistics_correlated_error((double[]){3, NAN, 3}, 3, 1)));
}

enum { LENGTH = 400, TRIALS = 2000 };

/// A stationary series x(t+1) = φ x(t) + sqrt(1 − φ²) normal, mean 0 and variance 1.
static void make_autoregressive(double *series, double phi, uint64_t seed, uint32_t trial) {
    struct rng_sequence numbers = mf_rng_sequence_begin(seed, RNG_INITIAL, trial, 0);
    double x = 0;
    for (int k = 0; k < LENGTH; k++) {
        const double radius = sqrt(-2 * log(mf_rng_sequence_uniform(&numbers)));
        const double normal = radius * cos(2 * acos(-1) * mf_rng_sequence_uniform(&numbers));
        x = k == 0 ? normal : phi * x + sqrt(1 - phi * phi) * normal;
        series[k] = x;
    }
}

/// Share of the trials in which the true mean 0 lies within two errors, over `chains` parts.
static double cover(double phi, size_t chains, uint64_t seed) {
    double covered = 0;
    for (uint32_t trial = 0; trial < TRIALS; trial++) {
        double series[LENGTH], sum = 0;
        make_autoregressive(series, phi, seed, trial);
        for (int k = 0; k < LENGTH; k++)
            sum += series[k];
        covered += fabs(sum / LENGTH) <
                   2 * mf_statistics_correlated_error(series, LENGTH / chains, chains);
    }
    print_message("phi = %.2f: the truth within two errors in %.1f %% of %d series\n", phi,
                  100 * covered / TRIALS, TRIALS);
    return covered / TRIALS;
}

/// The share of 2000 has a standard error of 0.5 %; the expected ones are from 10^5 series
/// each, known to 0.1 %. Five standard errors: one false alarm in 10^6 seeds.
static const double covered_band = 0.025;

static void
test_statistics_correlated_error_covers_the_truth_when_series_are_correlated(void **state) {
    (void)state;
    assert_close(cover(0, 1, 11), 0.963, covered_band);
    assert_close(cover(0.5, 1, 12), 0.953, covered_band);
    assert_close(cover(0.8, 1, 13), 0.944, covered_band);
    assert_close(cover(0.9, 1, 14), 0.930, covered_band);
    // Parts of one series are not independent, but here nearly.
    assert_close(cover(0.5, 4, 15), 0.953, covered_band);
}

/// Numbers that are correlated alike share their correlation: two of which one is twice the other
/// have the errors that each has alone; beside one that is not correlated both come out between.
static void test_statistics_correlated_errors_are_of_one_correlation(void **state) {
    (void)state;
    static const double step[8] = {0, 0, 0, 0, 1, 1, 1, 1}, comb[8] = {0, 1, 0, 1, 0, 1, 0, 1};
    double values[16], error[2];
    const double slow = mf_statistics_correlated_error(step, 8, 1);
    const double quick = mf_statistics_correlated_error(comb, 8, 1);
    for (int k = 0; k < 8; k++) {
        values[k] = step[k];
        values[8 + k] = 2 * step[k];
    }
    mf_statistics_correlated_errors(values, 8, 1, 2, error);
    assert_close(error[0], slow, rounding);
    assert_close(error[1], 2 * slow, rounding);
    memcpy(values + 8, comb, sizeof comb);
    mf_statistics_correlated_errors(values, 8, 1, 2, error);
    assert_true(error[0] < slow && error[1] >= quick);
    mf_statistics_correlated_errors(values, 1, 1, 2, error);
    assert_identical(error[0], 0.0);
}

/// Swings, x_t = a x_{t−1} + b x_{t−2} + noise with roots 0.7 exp(±i w): the mean of n has the
/// variance 1/(n (1 − a − b)²). One swing takes 3 or 6 of 1000 values; by the correlation of the
/// values themselves errors are 2.9 and 1.4 times too large.
static void test_statistics_error_of_what_swings_is_right(void **state) {
    (void)state;
    enum { MANY = 1000, SERIES = 200 };
    static const double angle[] = {2.1, 1};
    for (int w = 0; w < 2; w++) {
        const double a = 2 * 0.7 * cos(angle[w]), b = -0.7 * 0.7;
        double squares = 0;
        for (uint32_t n = 0; n < SERIES; n++) {
            double x[MANY], last[2] = {0}, normal[4];
            for (uint32_t t = 0; t < MANY + 100; t++) {
                mf_rng_normal4(mf_rng_philox(9, RNG_INITIAL, t, n, 0), normal);
                const double now = a * last[0] + b * last[1] + normal[0];
                last[1] = last[0];
                last[0] = now;
                if (t >= 100)
                    x[t - 100] = now;
            }
            squares += pow(mf_statistics_correlated_error(x, MANY, 1), 2) / SERIES;
        }
        const double ratio = sqrt(1 / (MANY * pow(1 - a - b, 2)) / squares);
        print_message("swings by %.1f: truth over error %.3f\n", angle[w], ratio);
        assert_true(ratio > 0.8 && ratio < 1.1);
    }
}

/// Sums of the squares of means, whose truth is 0, and of their errors.
struct scatter {
    double means, errors;
};

enum { BINS = 24, TIMES = 37 };

/// Bins of noise, some of which are those of one slow number but for a tenth of their variance:
/// x_t = r x_{t−1} + noise with a memory of two blocks.
static void make_bins(double *values, size_t slow_bins, uint32_t number) {
    const double r = exp(-0.5);
    double slow = 0;
    for (uint32_t t = 0; t < TIMES; t++)
        for (uint32_t k = 0; k < BINS; k++) {
            double normal[4];
            mf_rng_normal4(mf_rng_philox(5, RNG_INITIAL, t, number, k), normal);
            if (k == 0)
                slow = t == 0 ? normal[1] : r * slow + sqrt(1 - r * r) * normal[1];
            values[k * TIMES + t] =
                k < slow_bins ? sqrt(0.9) * slow + sqrt(0.1) * normal[0] : normal[0];
        }
}

static void add_scatter(struct scatter *scatter, const double *values, const double *error,
                        size_t from, size_t to) {
    for (size_t k = from; k < to; k++) {
        double mean = 0;
        for (size_t t = 0; t < TIMES; t++)
            mean += values[k * TIMES + t] / TIMES;
        scatter->means += mean * mean;
        scatter->errors += error[k] * error[k];
    }
}

/// Over the printed errors bins scatter by 1, be they slow or fast: within what 800 series tell. By
/// one correlation of all the two slow ones have 1.75.
static void test_statistics_correlated_errors_are_those_of_slow_and_of_fast_numbers(void **state) {
    (void)state;
    static double values[BINS * TIMES];
    double error[BINS];
    for (size_t slow_bins = 0; slow_bins <= 3; slow_bins++) {
        struct scatter slow = {0}, fast = {0};
        for (uint32_t n = 0; n < 800; n++) {
            make_bins(values, slow_bins, n);
            mf_statistics_correlated_errors(values, TIMES, 1, BINS, error);
            add_scatter(&slow, values, error, 0, slow_bins);
            add_scatter(&fast, values, error, slow_bins, BINS);
        }
        const double ratio = sqrt(slow.means / slow.errors), rest = sqrt(fast.means / fast.errors);
        print_message("%zu slow bins: %.3f, %.3f\n", slow_bins, ratio, rest);
        assert_true(rest > 0.93 && rest < 1.05);
        assert_true(slow_bins == 0 || (ratio > 0.8 && ratio < 1.15));
    }
}

/// Of two estimates the one that is larger on the whole, and not the larger of each.
static void test_statistics_take_larger_takes_all_or_none(void **state) {
    (void)state;
    double error[3] = {1, 1, 0};
    mf_statistics_take_larger(error, (const double[]){0.5, 1.2, 7}, 3);
    assert_identical(error[1], 1.0);
    mf_statistics_take_larger(error, (const double[]){0.5, 1.5, 7}, 3);
    assert_identical(error[0], 0.5);
    assert_identical(error[2], 7.0);
}

static void test_comoments_equal_two_passes_when_samples_are_added(void **state) {
    (void)state;
    double samples[SAMPLES][SIZE];
    make_samples(samples, 0);
    struct comoments moments;
    assert_ok(mf_comoments_init(&moments, SIZE));
    for (int n = 0; n < SAMPLES; n++)
        mf_comoments_add(&moments, samples[n]);
    assert_two_pass(&moments, samples, rounding);
    mf_comoments_clear(&moments);
}

static void test_comoments_do_not_cancel_when_the_offset_is_large(void **state) {
    (void)state;
    double samples[SAMPLES][SIZE];
    make_samples(samples, 1e8);
    struct comoments moments;
    assert_ok(mf_comoments_init(&moments, SIZE));
    for (int n = 0; n < SAMPLES; n++)
        mf_comoments_add(&moments, samples[n]);
    assert_two_pass(&moments, samples, rounding_at_large_offset);
    mf_comoments_clear(&moments);
}

/// Moments of the samples in three unequal parts, merged in the order of `order`.
static void merge_parts(struct comoments *merged, double samples[SAMPLES][SIZE],
                        const int order[3]) {
    static const int begin[] = {0, 10, 400, SAMPLES};
    assert_ok(mf_comoments_init(merged, SIZE));
    for (int k = 0; k < 3; k++) {
        struct comoments part;
        assert_ok(mf_comoments_init(&part, SIZE));
        for (int n = begin[order[k]]; n < begin[order[k] + 1]; n++)
            mf_comoments_add(&part, samples[n]);
        mf_comoments_merge(merged, &part);
        mf_comoments_clear(&part);
    }
}

static void test_comoments_merge_equals_two_passes_when_parts_come_in_any_order(void **state) {
    (void)state;
    static const int orders[][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                    {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    double samples[SAMPLES][SIZE];
    for (int large = 0; large < 2; large++) {
        make_samples(samples, large ? 1e8 : 0);
        for (size_t k = 0; k < sizeof orders / sizeof *orders; k++) {
            struct comoments merged;
            merge_parts(&merged, samples, orders[k]);
            assert_two_pass(&merged, samples, large ? rounding_at_large_offset : rounding);
            mf_comoments_clear(&merged);
        }
    }
}

static void test_comoments_merge_gives_the_same_bits_when_the_order_is_the_same(void **state) {
    (void)state;
    double samples[SAMPLES][SIZE];
    make_samples(samples, 0);
    struct comoments first, second;
    merge_parts(&first, samples, (int[]){2, 0, 1});
    merge_parts(&second, samples, (int[]){2, 0, 1});
    assert_memory_equal(first.mean, second.mean, SIZE * sizeof(double));
    assert_memory_equal(first.comoment, second.comoment, SIZE * SIZE * sizeof(double));
    mf_comoments_clear(&first);
    mf_comoments_clear(&second);
}

static void test_comoments_merge_changes_nothing_when_the_other_is_empty(void **state) {
    (void)state;
    struct comoments moments, empty;
    assert_ok(mf_comoments_init(&moments, SIZE));
    assert_ok(mf_comoments_init(&empty, SIZE));
    mf_comoments_merge(&moments, &empty);
    assert_identical(mf_comoments_covariance(&moments, 0, 0), 0.0);
    mf_comoments_add(&moments, (double[SIZE]){1, 2, 3});
    mf_comoments_add(&moments, (double[SIZE]){3, 2, 1});
    mf_comoments_merge(&moments, &empty);
    assert_identical(moments.count, 2.0);
    assert_identical(mf_comoments_covariance(&moments, 0, 2), -1.0);
    mf_comoments_clear(&moments);
    mf_comoments_clear(&empty);
}

static void test_comoments_reset_forgets_all_when_used_again(void **state) {
    (void)state;
    double samples[SAMPLES][SIZE];
    make_samples(samples, 0);
    struct comoments moments;
    assert_ok(mf_comoments_init(&moments, SIZE));
    mf_comoments_add(&moments, (double[SIZE]){1e9, -5, 7});
    mf_comoments_add(&moments, (double[SIZE]){-3, 1e9, 7});
    mf_comoments_reset(&moments);
    for (int n = 0; n < SAMPLES; n++)
        mf_comoments_add(&moments, samples[n]);
    assert_two_pass(&moments, samples, rounding);
    mf_comoments_clear(&moments);
}

/// Sums of three neighbours out of white noise: ρ is 2/3, 1/3 and 0, so that Σ ρ² of 60 of them is
/// 60 + 2 (59 · 4/9 + 58 · 1/9). Chance correlations of 80 values would add 3600/79.
static void test_statistics_independence_is_that_of_known_correlations(void **state) {
    enum { NUMBERS = 60, BLOCKS = 20, CHAINS = 4, VALUES = BLOCKS * CHAINS };
    static double values[NUMBERS][VALUES];
    struct statistics_independence found;
    (void)state;
    for (uint32_t m = 0; m < VALUES; m++) {
        double white[NUMBERS + 2];
        for (uint32_t k = 0; k < NUMBERS + 2; k++) {
            double normal[4];
            mf_rng_normal4(mf_rng_philox(12, RNG_INITIAL, m, k, 0), normal);
            white[k] = normal[0];
        }
        for (uint32_t k = 0; k < NUMBERS; k++)
            values[k][m] = white[k] + white[k + 1] + white[k + 2];
    }
    assert_ok(mf_statistics_independence(*values, BLOCKS, CHAINS, NUMBERS, &found));
    assert_close(found.numbers, 3600 / (60 + 2 * (59 * 4 + 58) / 9.0), 2.9);
    assert_close(found.freedom, VALUES - 1, 16);
    // What does not scatter is no number, and one value knows nothing.
    memset(values[NUMBERS - 1], 0, sizeof values[NUMBERS - 1]);
    assert_ok(mf_statistics_independence(values[NUMBERS - 2], BLOCKS, CHAINS, 2, &found));
    assert_close(found.numbers, 1, rounding);
    assert_ok(mf_statistics_independence(*values, 1, 1, NUMBERS, &found));
    assert_close(found.numbers, 1, 0);
    assert_close(found.freedom, 0, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_statistics_independence_is_that_of_known_correlations),
        cmocka_unit_test(test_statistics_add_equals_two_passes_when_numbers_are_of_order_one),
        cmocka_unit_test(test_statistics_add_keeps_the_variance_when_the_mean_is_large),
        cmocka_unit_test(test_statistics_standard_error_is_zero_when_there_are_fewer_than_two),
        cmocka_unit_test(test_statistics_mark_unknown_errors_of_which_none_is_above_zero),
        cmocka_unit_test(test_statistics_correlated_error_is_exact_when_series_are_short),
        cmocka_unit_test(test_statistics_correlated_error_is_zero_when_there_is_no_scatter),
        cmocka_unit_test(
            test_statistics_correlated_error_covers_the_truth_when_series_are_correlated),
        cmocka_unit_test(test_statistics_error_of_what_swings_is_right),
        cmocka_unit_test(test_statistics_correlated_errors_are_of_one_correlation),
        cmocka_unit_test(test_statistics_correlated_errors_are_those_of_slow_and_of_fast_numbers),
        cmocka_unit_test(test_statistics_take_larger_takes_all_or_none),
        cmocka_unit_test(test_comoments_equal_two_passes_when_samples_are_added),
        cmocka_unit_test(test_comoments_do_not_cancel_when_the_offset_is_large),
        cmocka_unit_test(test_comoments_merge_equals_two_passes_when_parts_come_in_any_order),
        cmocka_unit_test(test_comoments_merge_gives_the_same_bits_when_the_order_is_the_same),
        cmocka_unit_test(test_comoments_merge_changes_nothing_when_the_other_is_empty),
        cmocka_unit_test(test_comoments_reset_forgets_all_when_used_again),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
