// SPDX-License-Identifier: GPL-3.0-or-later
//
// Normal numbers of random words: against the normal law of the GSL, over all words, and of words
// that Philox draws.
#include "base/normal_words.h"

#include "base/rng.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>

/// Standard errors by which a moment of a sample may be off: one false alarm in 16,000.
static const double deviations = 4;

/// Of Kolmogorov and Smirnov's test, once.
static const double false_alarm_rate = 6e-5;

static struct normal_table table;

static int make_table(void **state) {
    (void)state;
    mf_normal_table_init(&table);
    return 0;
}

static void test_normal_is_the_quantile_when_the_word_is_any(void **state) {
    (void)state;
    double worst = 0;
    for (uint32_t n = 0; n < 1U << 31; n += 1 + n / 5000) {
        const double wanted = gsl_cdf_ugaussian_Qinv(((double)n + 0.5) * 0x1p-32);
        worst = fmax(worst, fabs(normal_of_word(&table, n) - wanted));
    }
    print_message("largest error of a quantile: %.1e\n", worst);
    assert_close(worst, 0, 5e-7);
    assert_close(normal_of_word(&table, 0), 6.338, 0.001);
}

static void test_normal_of_many_words_has_the_same_bits(void **state) {
    (void)state;
    uint32_t word[NORMAL_WORDS];
    double zeta[NORMAL_WORDS];
    for (uint32_t n = 0; n < 1000; n++) {
        const size_t count = 4 * (1 + n % (NORMAL_WORDS / 4));
        for (uint32_t k = 0; k < count; k++)
            word[k] = n < 500 ? mf_rng_philox(7, RNG_BROWNIAN, n, k, 0).word[0]
                              : (k % 2 ? ~(n - 500 + k) : n - 500 + k);
        normal_of_words(&table, word, count, zeta);
        for (size_t k = 0; k < count; k++)
            assert_identical(zeta[k], normal_of_word(&table, word[k]));
    }
}

static void test_normal_changes_sign_when_the_word_is_inverted(void **state) {
    (void)state;
    for (uint32_t n = 0; n < 1U << 31; n += 1 + n / 1000)
        assert_identical(normal_of_word(&table, ~n), -normal_of_word(&table, n));
}

static void test_normal_grows_when_the_word_nears_the_tail(void **state) {
    (void)state;
    double before = 0;
    for (uint32_t n = (1U << 31) - 1; n > 4096; n -= 1 + n / 4096) {
        const double here = normal_of_word(&table, n);
        assert_true(here >= before);
        before = here;
    }
}

/// Even moments of all words: every one of the tail's 2²⁰, and the middle ones of 256 each. Odd
/// ones are 0 by symmetry. The law's are 1, 3, 15 and 105.
static void test_normal_has_the_moments_of_the_law_when_all_words_are_drawn(void **state) {
    (void)state;
    const uint32_t tail = 1 << 20, stride = 256;
    double sum[5] = {0};
    for (uint64_t n = 0; n < UINT64_C(1) << 31; n += n < tail ? 1 : stride) {
        const double z = normal_of_word(&table, (uint32_t)(n < tail ? n : n + stride / 2));
        double power = n < tail ? 1 : stride;
        for (int k = 1; k <= 4; k++)
            sum[k] += power *= z * z;
    }
    static const double law[] = {1, 1, 3, 15, 105}, tolerance[] = {0, 1e-6, 1e-5, 1e-4, 1e-3};
    for (int k = 1; k <= 4; k++) {
        print_message("moment %d: %.8f\n", 2 * k, sum[k] * 0x1p-31);
        assert_close(sum[k] * 0x1p-31, law[k], tolerance[k]);
    }
}

enum { DRAWS = 1000000 };

static int compare(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/// Moment m has the variance (E z^2m − (E z^m)²)/n; E z^m = (m − 1)!! of even m.
static void check_moments(const double *z) {
    for (int m = 1; m <= 8; m++) {
        double sum = 0, odds = 1, mean = m % 2 ? 0 : 1;
        for (int k = 2 * m - 1; k > 0; k -= 2)
            odds *= k;
        for (int k = m - 1; m % 2 == 0 && k > 0; k -= 2)
            mean *= k;
        for (int n = 0; n < DRAWS; n++)
            sum += pow(z[n], m);
        assert_close(sum / DRAWS, mean, deviations * sqrt((odds - mean * mean) / DRAWS));
    }
}

/// D = sup |F_n − F| exceeds λ/√n with probability 2 Σ (−1)^(k−1) exp(−2 k² λ²).
static void check_distribution(double *z) {
    double d = 0;
    qsort(z, DRAWS, sizeof *z, compare);
    for (int n = 0; n < DRAWS; n++) {
        const double f = gsl_cdf_ugaussian_P(z[n]);
        d = fmax(d, fmax(f - (double)n / DRAWS, (double)(n + 1) / DRAWS - f));
    }
    const double probability = 2 * exp(-2 * d * d * DRAWS);
    print_message("Kolmogorov and Smirnov: D = %.2e, p = %.2f\n", d, probability);
    assert_true(probability > false_alarm_rate);
}

static void test_normal_passes_for_normal_when_words_are_random(void **state) {
    (void)state;
    static double z[DRAWS];
    for (uint32_t n = 0; n < DRAWS; n++)
        z[n] = normal_of_word(&table, mf_rng_philox(11, RNG_PAIR_NOISE, n, 0, 0).word[0]);
    check_moments(z);
    check_distribution(z);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_normal_is_the_quantile_when_the_word_is_any),
        cmocka_unit_test(test_normal_of_many_words_has_the_same_bits),
        cmocka_unit_test(test_normal_changes_sign_when_the_word_is_inverted),
        cmocka_unit_test(test_normal_grows_when_the_word_nears_the_tail),
        cmocka_unit_test(test_normal_has_the_moments_of_the_law_when_all_words_are_drawn),
        cmocka_unit_test(test_normal_passes_for_normal_when_words_are_random),
    };
    return cmocka_run_group_tests(tests, make_table, NULL);
}
