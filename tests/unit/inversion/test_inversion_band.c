// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_band.h"

#include "base/comoments.h"
#include "base/rng.h"
#include "base/statistics.h"
#include "inversion/imc_solve.h"
#include "inversion/inversion.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdlib.h>

enum { SIZE = 16, TRIALS = 2000 };

static const double temperature = 1.5, spacing = 0.1;

static void make_counts(double counts[SIZE][SIZE]) {
    for (int a = 0; a < SIZE; a++)
        for (int b = 0; b < SIZE; b++)
            counts[a][b] = (10 + a) * (10 + b) * exp(-abs(a - b) / 1.5) * 0.1;
}

/// Standard deviations of 2000 trials are known to 1.6 %: five of these for 16 bins are a false
/// alarm in 10^5 seeds.
static const double scatter_tolerance = 0.08;

static void test_inversion_band_is_the_scatter_when_the_data_say_all(void **state) {
    (void)state;
    double counts[SIZE][SIZE], variance[SIZE], covariance[SIZE * SIZE], directions;
    struct running_mean scatter[SIZE] = {{0}};
    make_counts(counts);
    for (int k = 0; k < SIZE; k++)
        variance[k] = 0.02 + 0.005 * k;
    const struct imc_system response = {.size = SIZE,
                                        .covariance = &counts[0][0],
                                        .variance = variance,
                                        .temperature = temperature,
                                        .spacing = spacing};
    assert_ok(mf_inversion_band_covariance(&response, 1, covariance, &directions));
    for (uint32_t trial = 0; trial < TRIALS; trial++) {
        double excess[SIZE], x[SIZE];
        struct imc_solution solution;
        for (int a = 0; a < SIZE; a++) {
            double normal[4];
            mf_rng_normal4(mf_rng_philox(22, RNG_INITIAL, trial, (uint32_t)a, 0), normal);
            excess[a] = sqrt(variance[a]) * normal[0];
        }
        struct imc_system system = response;
        system.excess = excess;
        assert_ok(mf_imc_solve(&system, 1e-9, x, &solution));
        for (int k = 0; k < SIZE; k++)
            mf_statistics_add(&scatter[k], x[k]);
    }
    for (int k = 0; k < SIZE; k++)
        assert_close_relative(sqrt(covariance[k * SIZE + k]),
                              sqrt(scatter[k].squares / (TRIALS - 1)), scatter_tolerance);
    assert_close(directions, SIZE, 0.1);
}

/// An excess that is twice as large in all that it may be makes errors twice as large.
static void test_inversion_band_is_wider_by_birges_factor(void **state) {
    (void)state;
    double counts[SIZE][SIZE], noise[SIZE * SIZE] = {0}, directions;
    double narrow[SIZE * SIZE], wide[SIZE * SIZE], doubled[SIZE * SIZE];
    make_counts(counts);
    const struct imc_system system = {.size = SIZE,
                                      .covariance = &counts[0][0],
                                      .noise = noise,
                                      .temperature = temperature,
                                      .spacing = spacing};
    for (int a = 0; a < SIZE; a++)
        for (int b = 0; b <= a; b++)
            noise[a * SIZE + b] = a == b ? 0.2 : 0.02 / (1 + a - b);
    assert_ok(mf_inversion_band_covariance(&system, 1, narrow, &directions));
    assert_ok(mf_inversion_band_covariance(&system, 4, wide, &directions));
    for (int k = 0; k < SIZE * SIZE; k++)
        noise[k] *= 2;
    assert_ok(mf_inversion_band_covariance(&system, 1, doubled, &directions));
    for (int k = 0; k < SIZE * SIZE; k += SIZE + 1) {
        assert_close_relative(wide[k], doubled[k], 1e-9);
        // The prior holds the less known directions.
        assert_true(wide[k] > 3.5 * narrow[k] && wide[k] < 4 * narrow[k]);
    }
}

/// The excess of n independent samples has the covariance C/n, and so the x that removes it has
/// (k_B T)² C⁻¹/n; R. A. Fisher's bound for potentials, whose likelihood is of the exponential
/// family.
static void test_inversion_band_of_samples_alone_is_the_inverse_of_what_they_scatter(void **state) {
    (void)state;
    enum { SAMPLES = 4000 };
    double counts[SIZE][SIZE], noise[SIZE * SIZE], covariance[SIZE * SIZE], directions;
    gsl_matrix *inverse = gsl_matrix_alloc(SIZE, SIZE);
    make_counts(counts);
    for (int k = 0; k < SIZE * SIZE; k++)
        inverse->data[k] = counts[k / SIZE][k % SIZE];
    assert_int_equal(gsl_linalg_cholesky_decomp1(inverse), 0);
    for (int k = 0; k < SIZE * SIZE; k++)
        noise[k] = inverse->data[k] / sqrt(SAMPLES);
    assert_int_equal(gsl_linalg_cholesky_invert(inverse), 0);
    const struct imc_system system = {.size = SIZE,
                                      .covariance = &counts[0][0],
                                      .noise = noise,
                                      .temperature = temperature,
                                      .spacing = spacing};
    assert_ok(mf_inversion_band_covariance(&system, 1, covariance, &directions));
    for (int k = 0; k < SIZE * SIZE; k += SIZE + 1)
        assert_close_relative(covariance[k], pow(temperature, 2) * inverse->data[k] / SAMPLES,
                              0.02);
    gsl_matrix_free(inverse);
}

static void test_inversion_band_is_the_prior_when_the_data_say_nothing(void **state) {
    (void)state;
    double counts[SIZE][SIZE] = {{0}}, variance[SIZE], covariance[SIZE * SIZE], directions;
    for (int k = 0; k < SIZE; k++)
        variance[k] = 1;
    const struct imc_system response = {.size = SIZE,
                                        .covariance = &counts[0][0],
                                        .variance = variance,
                                        .temperature = temperature,
                                        .spacing = spacing};
    assert_ok(mf_inversion_band_covariance(&response, 1, covariance, &directions));
    assert_close(directions, 0, 1e-12);
    // One number has the ridge alone: 10 k_B T of it, spread over the whole curve; the last bin,
    // half a spacing from the end, is held by its bend.
    assert_true(sqrt(covariance[0]) > 5 * temperature && sqrt(covariance[0]) < 10 * temperature);
    assert_true(sqrt(covariance[SIZE * SIZE - 1]) < temperature);
}

/// Counts whose sum hardly varies, as in a liquid that yields little: a hundredth of the variance
/// of the sum is left.
static void make_stiff_counts(double counts[SIZE][SIZE]) {
    double sum[SIZE] = {0}, all = 0;
    make_counts(counts);
    for (int a = 0; a < SIZE; a++)
        for (int b = 0; b < SIZE; b++)
            sum[a] += counts[a][b];
    for (int a = 0; a < SIZE; a++)
        all += sum[a];
    for (int a = 0; a < SIZE; a++)
        for (int b = 0; b < SIZE; b++)
            counts[a][b] -= 0.99 * sum[a] * sum[b] / all;
}

/// The covariance of `samples` normal configurations with the covariance factor·factorᵀ.
static void sample_counts(const gsl_matrix *factor, uint32_t samples, uint32_t trial,
                          double counts[SIZE][SIZE]) {
    struct comoments moments;
    assert_ok(mf_comoments_init(&moments, SIZE));
    for (uint32_t k = 0; k < samples; k++) {
        double value[SIZE] = {0}, normal[4];
        for (uint32_t b = 0; b < SIZE; b++) {
            mf_rng_normal4(mf_rng_philox(31, RNG_INITIAL, trial, k, b), normal);
            for (uint32_t a = b; a < SIZE; a++)
                value[a] += gsl_matrix_get(factor, a, b) * normal[0];
        }
        mf_comoments_add(&moments, value);
    }
    for (size_t a = 0; a < SIZE; a++)
        for (size_t b = 0; b < SIZE; b++)
            counts[a][b] = mf_comoments_covariance(&moments, a, b);
    mf_comoments_clear(&moments);
}

/// Variance of the ramp's amplitude, (1 − r/r_c)·Φ/|1 − r/r_c|².
static double ramp_variance(double counts[SIZE][SIZE], double samples) {
    double variance[SIZE], covariance[SIZE * SIZE], directions, sum = 0, squares = 0;
    for (int a = 0; a < SIZE; a++)
        variance[a] = counts[a][a] / samples;
    const struct imc_system system = {.size = SIZE,
                                      .covariance = &counts[0][0],
                                      .variance = variance,
                                      .temperature = temperature,
                                      .spacing = spacing};
    assert_ok(mf_inversion_band_covariance(&system, 1, covariance, &directions));
    for (int a = 0; a < SIZE; a++) {
        const double ramp = 1 - (a + 0.5) / SIZE;
        squares += ramp * ramp;
        for (int b = 0; b < SIZE; b++)
            sum += ramp * (1 - (b + 0.5) / SIZE) * covariance[a * SIZE + b];
    }
    return sum / (squares * squares);
}

/// The noise of C makes C·C larger, but its smallest eigenvalues smaller, and these decide what is
/// least known: few samples make the ramp's error too large, never too small. The ratios of 200
/// trials are known to 1 or 2 %.
static void test_inversion_band_is_not_narrower_by_the_noise_of_counts(void **state) {
    (void)state;
    static const uint32_t samples[] = {2 * SIZE, 8 * SIZE, 32 * SIZE};
    double counts[SIZE][SIZE], sampled[SIZE][SIZE];
    gsl_matrix *factor = gsl_matrix_alloc(SIZE, SIZE);
    assert_non_null(factor);
    make_stiff_counts(counts);
    for (size_t a = 0; a < SIZE; a++)
        for (size_t b = 0; b < SIZE; b++)
            gsl_matrix_set(factor, a, b, counts[a][b]);
    assert_int_equal(gsl_linalg_cholesky_decomp1(factor), 0);
    for (int k = 0; k < 3; k++) {
        struct running_mean found = {0};
        for (uint32_t trial = 0; trial < 200; trial++) {
            sample_counts(factor, samples[k], trial, sampled);
            mf_statistics_add(&found, ramp_variance(sampled, samples[k]));
        }
        const double ratio = sqrt(found.mean / ramp_variance(counts, samples[k]));
        print_message("%d samples of %d bins: the ramp's error is %.3f of that by the exact C\n",
                      (int)samples[k], SIZE, ratio);
        assert_true(ratio > 0.98 && ratio < 1 + 2.5 * SIZE / samples[k]);
    }
    gsl_matrix_free(factor);
}

/// Of λ that lie anywhere on a wide scale, those of which so many were counted: ln λ by their own
/// frequency, λ^k e^−λ/k! against steps of ln λ.
static double scatter_of_logarithm(int counts) {
    double all = 0, first = 0, second = 0;
    for (double x = -12; x < 8; x += 1e-3) {
        const double weight = exp((counts + 0.5) * x - exp(x)); // Jeffreys's prior λ^−½ dλ
        all += weight;
        first += weight * x;
        second += weight * x * x;
    }
    return sqrt(second / all - pow(first / all, 2));
}

static void test_inversion_band_of_counts_is_that_of_the_logarithm_of_their_mean(void **state) {
    (void)state;
    static const int counts[] = {1, 2, 5, 40};
    for (int k = 0; k < 4; k++)
        assert_close(mf_inversion_poisson_error(counts[k]), scatter_of_logarithm(counts[k]), 1e-4);
    assert_close_relative(mf_inversion_poisson_error(1e8), 1e-4, 1e-6);
}

/// Two states and one bin: by how many pairs were counted in each.
struct counted {
    struct inverse_problem problem, other;
    struct inversion_state state[2];
    struct inversion inversion;
    size_t bin;
    double target[2], error[2], mean[2], variance[2];
};

static double min_error(struct counted *counted, const double target[2], const double sampled[2]) {
    static const double frames = 10;
    *counted = (struct counted){
        .problem.scene.temperature = temperature,
        .other.scene.temperature = temperature,
        .inversion = {.problem = &counted->problem, .state = counted->state, .states = 2}};
    for (int s = 0; s < 2; s++) {
        struct inversion_state *state = &counted->state[s];
        state->problem = s == 0 ? &counted->problem : &counted->other;
        counted->target[s] = target[s] / frames;
        counted->error[s] = sqrt(target[s]) / frames;
        counted->mean[s] = sampled[s] / frames;
        counted->variance[s] = (fmax(sampled[s], 1) +
                                target[s] * (target[s] > 0 ? fmax(1, sampled[s] / target[s]) : 0)) /
                               (frames * frames);
        state->grid = (struct potential_grid){
            .pairs = 1, .pairs_known = 1, .known = 1, .known_bin = &counted->bin};
        state->target.counts = &counted->target[s];
        state->target.error = &counted->error[s];
        state->replicas.counts = (struct comoments){.size = 1, .mean = &counted->mean[s]};
        state->variance = &counted->variance[s];
    }
    return mf_inversion_band_min_error(&counted->inversion, 0);
}

/// A core that the hot state enters and the cold one does not is known by what the hot one counted.
static void test_inversion_band_of_few_counts_is_that_of_the_states_that_have_any(void **state) {
    (void)state;
    struct counted counted;
    const double five = scatter_of_logarithm(5), two = scatter_of_logarithm(2);
    const double none[2] = {0, 0}, one[2] = {0, 5}, both[2] = {3, 2}, few[2] = {2, 0};
    assert_close(min_error(&counted, one, one), temperature * hypot(five, five), 1e-4);
    assert_close(min_error(&counted, both, one), temperature * hypot(five, five), 1e-4);
    assert_close(min_error(&counted, one, few), temperature * hypot(five, two), 1e-4);
    // Nobody has seen it: psi_1(1/2) is pi^2/2.
    assert_close(min_error(&counted, none, none), temperature * M_PI, 1e-9);
    // An exact target says all, and the samples what they have.
    assert_true(min_error(&counted, one, one) > temperature * five);
    counted.error[1] = 0;
    counted.variance[1] = 0.05;
    assert_close(mf_inversion_band_min_error(&counted.inversion, 0), temperature * five, 1e-4);
}

/// Counts tell U/k_B T of the state that they are of: twice as hot, twice the error. Of many in
/// both states the inverse squares of the errors add up.
static void test_inversion_band_of_counts_goes_by_the_temperature_of_their_state(void **state) {
    (void)state;
    struct counted counted;
    const double hot[2] = {0, 5}, both[2] = {1e6, 4e6}, five = scatter_of_logarithm(5);
    min_error(&counted, hot, hot);
    counted.other.scene.temperature = 2 * temperature;
    assert_close(mf_inversion_band_min_error(&counted.inversion, 0),
                 2 * temperature * hypot(five, five), 1e-4);
    min_error(&counted, both, both);
    counted.other.scene.temperature = 2 * temperature;
    assert_close_relative(mf_inversion_band_min_error(&counted.inversion, 0),
                          sqrt(2) * temperature / sqrt(1e6 + 4e6 / 4), 1e-4);
}

/// Bonds whose counts scatter as 100 of each bin do, and whose errors are those of 100 counts and
/// 30 more that all have in common. Counts that alternate by d have fourth differences of 16 d, and
/// those that scatter by 10 have such of 10 sqrt(70).
static void test_inversion_band_of_a_group_has_what_its_bins_err_in_common(void **unused) {
    (void)unused;
    enum { BINS = 20 };
    const double d = 10 * sqrt(70.0) / 16;
    double counts[BINS], error[BINS];
    size_t known_bin[BINS];
    struct inverse_problem problem = {.scene.temperature = temperature};
    struct potential_group group = {.own = {.known = BINS}};
    struct inversion_state state = {
        .problem = &problem,
        .grid = {.groups = 1, .known = BINS, .known_bin = known_bin, .group = &group},
        .target = {.counts = counts, .error = error}};
    const struct inversion inversion = {.problem = &problem, .state = &state, .states = 1};
    for (size_t k = 0; k < BINS; k++) {
        known_bin[k] = k;
        counts[k] = k % 2 ? 100 + d : 100 - d;
        error[k] = hypot(10, 30);
    }
    assert_close(mf_inversion_band_min_error(&inversion, 8) * counts[8], temperature * 30, 0.2);
    for (size_t k = 0; k < BINS; k++)
        error[k] = 9;
    assert_close(mf_inversion_band_min_error(&inversion, 8), 0, 1e-12);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_inversion_band_is_the_scatter_when_the_data_say_all),
        cmocka_unit_test(test_inversion_band_is_wider_by_birges_factor),
        cmocka_unit_test(test_inversion_band_of_samples_alone_is_the_inverse_of_what_they_scatter),
        cmocka_unit_test(test_inversion_band_is_the_prior_when_the_data_say_nothing),
        cmocka_unit_test(test_inversion_band_is_not_narrower_by_the_noise_of_counts),
        cmocka_unit_test(test_inversion_band_of_counts_is_that_of_the_logarithm_of_their_mean),
        cmocka_unit_test(test_inversion_band_of_few_counts_is_that_of_the_states_that_have_any),
        cmocka_unit_test(test_inversion_band_of_counts_goes_by_the_temperature_of_their_state),
        cmocka_unit_test(test_inversion_band_of_a_group_has_what_its_bins_err_in_common),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
