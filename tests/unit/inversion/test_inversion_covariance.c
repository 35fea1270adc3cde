// SPDX-License-Identifier: GPL-3.0-or-later
//
// What is told of C by samples of a normal S whose C is known: Poisson's diagonal, and beside it
// what pairs have in common, which all but cancels it in one smooth direction, as the
// compressibility of a liquid does in that of the ramp.
#include "inversion/inversion_covariance.h"

#include "base/rng.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <string.h>

enum { BINS = 120, FIRST = 70, SAMPLES = 200 };

/// C = D − s s'ᵀ + w w'ᵀ, D the mean counts: along s little is left of D, along w more.
struct fluid {
    double mean[BINS], flat[BINS], wave[BINS];
};

/// The share of D that is left along `flat`.
static const double left = 0.02;

static void make(struct fluid *fluid) {
    double flat = 0, wave = 0;
    for (size_t a = 0; a < BINS; a++) {
        const double r = (a < FIRST ? (double)a : (double)(a - FIRST)) / FIRST;
        fluid->mean[a] = 1000 * (0.3 + r);
        fluid->flat[a] = 1 - r;
        fluid->wave[a] = sin(7 * r + 1);
    }
    // Orthonormal in the metric of D.
    for (size_t a = 0; a < BINS; a++)
        flat += fluid->mean[a] * fluid->flat[a] * fluid->flat[a];
    for (size_t a = 0; a < BINS; a++)
        wave += fluid->mean[a] * fluid->flat[a] * fluid->wave[a] / flat;
    for (size_t a = 0; a < BINS; a++)
        fluid->wave[a] -= wave * fluid->flat[a];
    wave = 0;
    for (size_t a = 0; a < BINS; a++)
        wave += fluid->mean[a] * fluid->wave[a] * fluid->wave[a];
    for (size_t a = 0; a < BINS; a++) {
        fluid->flat[a] /= sqrt(flat);
        fluid->wave[a] /= sqrt(wave);
    }
}

/// C of so many samples: S = D^{1/2} (n − (1 − sqrt(left)) f f·n + 1.5 w w·n), n normal.
static void sample(const struct fluid *fluid, uint64_t seed, size_t samples, double *c) {
    static double s[BINS], sum[BINS];
    memset(c, 0, BINS * BINS * sizeof *c);
    memset(sum, 0, sizeof sum);
    for (uint32_t k = 0; k < samples; k++) {
        double flat = 0, wave = 0;
        for (uint32_t a = 0; a < BINS; a++) {
            double normal[4];
            mf_rng_normal4(mf_rng_philox(seed, RNG_INITIAL, a, k, 0), normal);
            s[a] = normal[0];
            flat += sqrt(fluid->mean[a]) * fluid->flat[a] * s[a];
            wave += sqrt(fluid->mean[a]) * fluid->wave[a] * s[a];
        }
        for (size_t a = 0; a < BINS; a++) {
            s[a] = sqrt(fluid->mean[a]) *
                   (s[a] + sqrt(fluid->mean[a]) * (1.5 * wave * fluid->wave[a] -
                                                   (1 - sqrt(left)) * flat * fluid->flat[a]));
            sum[a] += s[a];
        }
        for (size_t a = 0; a < BINS; a++)
            for (size_t b = 0; b < BINS; b++)
                c[a * BINS + b] += s[a] * s[b];
    }
    for (size_t a = 0; a < BINS; a++)
        for (size_t b = 0; b < BINS; b++)
            c[a * BINS + b] =
                (c[a * BINS + b] - sum[a] * sum[b] / (double)samples) / ((double)samples - 1);
}

/// What C says of `flat` if the errors of all bins are those of D: fᵀC D⁻¹C f; left² is right.
static double information(const struct fluid *fluid, const double *c) {
    double sum = 0;
    for (size_t a = 0; a < BINS; a++) {
        double row = 0;
        for (size_t b = 0; b < BINS; b++)
            row += c[a * BINS + b] * fluid->flat[b];
        sum += row * row / fluid->mean[a];
    }
    return sum;
}

/// Noise of 120 bins in 200 samples counts as left · 120/200 where left² is right: 30 times as
/// much. Of few functions little of that remains.
static void test_inversion_covariance_takes_no_noise_for_information(void **unused) {
    (void)unused;
    static const size_t size[] = {FIRST, BINS - FIRST};
    static const struct inversion_covariance_blocks blocks = {size, 2, BINS};
    static double sampled[BINS * BINS], covariance[BINS * BINS], shared[BINS];
    struct fluid fluid;
    size_t functions;
    double as_sampled = 0, told = 0;
    make(&fluid);
    for (uint64_t seed = 1; seed <= 4; seed++) {
        sample(&fluid, seed, SAMPLES, sampled);
        assert_ok(mf_inversion_covariance_find(&blocks, sampled, fluid.mean, SAMPLES, covariance,
                                               shared, &functions, NULL));
        as_sampled += information(&fluid, sampled) / (4 * left * left);
        told += information(&fluid, covariance) / (4 * left * left);
    }
    print_message("%zu functions; information over the right one: sampled %.1f, told %.1f\n",
                  functions, as_sampled, told);
    assert_true(as_sampled > 20);
    assert_true(told < as_sampled / 3);
    assert_true(functions >= 2 * 13 && functions < 60);
}

/// By many samples C is found, also where it is not of single pairs.
static void test_inversion_covariance_of_many_samples_is_right(void **unused) {
    (void)unused;
    enum { MANY = 4000 };
    static const size_t size[] = {FIRST, BINS - FIRST};
    static const struct inversion_covariance_blocks blocks = {size, 2, BINS};
    static double sampled[BINS * BINS], covariance[BINS * BINS], shared[BINS];
    struct fluid fluid;
    size_t functions;
    double along = 0;
    make(&fluid);
    sample(&fluid, 9, MANY, sampled);
    assert_ok(mf_inversion_covariance_find(&blocks, sampled, fluid.mean, MANY, covariance, shared,
                                           &functions, NULL));
    for (size_t a = 0; a < BINS; a++)
        for (size_t b = 0; b < BINS; b++)
            along += fluid.wave[a] * covariance[a * BINS + b] * fluid.wave[b];
    assert_close(along, 2.5 * 2.5, 0.06 * 2.5 * 2.5); // 3 sqrt(2/n)
    for (size_t a = 0; a < BINS; a++)
        assert_true(shared[a] >= 0 && shared[a] < 2 * fluid.mean[a]);
}

/// A block of few bins is as sampled, and a bin without counts stays empty.
static void test_inversion_covariance_of_few_bins_is_as_sampled(void **unused) {
    (void)unused;
    static const size_t size[] = {3};
    static const struct inversion_covariance_blocks blocks = {size, 1, 3};
    static const double sampled[] = {4, -1, 0, -1, 9, 0, 0, 0, 0}, mean[] = {5, 8, 0};
    double covariance[9], shared[3];
    size_t functions;
    assert_ok(mf_inversion_covariance_find(&blocks, sampled, mean, 50, covariance, shared,
                                           &functions, NULL));
    for (size_t k = 0; k < 9; k++)
        assert_close(covariance[k], sampled[k], 1e-12);
    assert_int_equal(functions, 3);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_inversion_covariance_takes_no_noise_for_information),
        cmocka_unit_test(test_inversion_covariance_of_many_samples_is_right),
        cmocka_unit_test(test_inversion_covariance_of_few_bins_is_as_sampled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
