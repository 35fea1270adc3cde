// SPDX-License-Identifier: GPL-3.0-or-later
//
// Statistical tests have fixed seeds and bounds of 4 standard errors: a right generator fails one
// of them with a chance of 6e-5 for a seed chosen blindly. Estimators and their errors are those of
// independent numbers.
#include "base/rng_lanes.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <Random123/philox.h>

#include <math.h>

enum { SAMPLES = 200000 };

static const double standard_errors = 4;

/// Known answers of Random123 1.14, file tests/kat_vectors, lines "philox4x32 10".
static const struct {
    uint32_t counter[4], key[2], answer[4];
} known[] = {
    {{0, 0, 0, 0}, {0, 0}, {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}},
    {{0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff},
     {0xffffffff, 0xffffffff},
     {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}},
    {{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344},
     {0xa4093822, 0x299f31d0},
     {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}},
};
enum { KNOWN = sizeof known / sizeof *known };

static void test_rng_philox4x32_gives_the_known_answers_when_called_in_the_library(void **state) {
    (void)state;
    for (int k = 0; k < KNOWN; k++) {
        const uint32_t *c = known[k].counter;
        const philox4x32_ctr_t counter = {{c[0], c[1], c[2], c[3]}};
        const philox4x32_key_t key = {{known[k].key[0], known[k].key[1]}};
        const philox4x32_ctr_t answer = philox4x32(counter, key);
        assert_memory_equal(answer.v, known[k].answer, sizeof answer.v);
    }
}

static void test_rng_philox_lane_gives_the_known_answers_when_given_their_counters(void **state) {
    (void)state;
    for (int k = 0; k < KNOWN; k++) {
        const uint32_t *c = known[k].counter, *key = known[k].key;
        assert_int_equal(rng_philox_lane(key[0], key[1], c[0], c[1], c[2], c[3]),
                         known[k].answer[0]);
    }
}

/// The first known answer needs no stream; for others the stream owns the fourth counter word.
static void test_rng_philox_puts_seed_and_counters_in_place_when_they_differ(void **state) {
    (void)state;
    const struct rng_block zero = mf_rng_philox(0, RNG_PAIR_NOISE, 0, 0, 0);
    assert_memory_equal(zero.word, known[0].answer, sizeof zero.word);

    const struct rng_block block = mf_rng_philox(0x0123456789abcdef, RNG_METROPOLIS, 5, 6, 7);
    const philox4x32_ctr_t counter = {{5, 6, 7, (uint32_t)RNG_METROPOLIS << 28}};
    const philox4x32_key_t key = {{0x89abcdef, 0x01234567}};
    const philox4x32_ctr_t answer = philox4x32(counter, key);
    assert_memory_equal(block.word, answer.v, sizeof block.word);
}

static void test_rng_philox_lane_equals_word_0_when_counters_vary(void **state) {
    (void)state;
    for (uint32_t n = 0; n < 20000; n++) {
        const struct rng_block random = mf_rng_philox(3, RNG_SELECTION, n, 0, 0);
        const uint64_t seed = (uint64_t)random.word[0] << 32 | random.word[1];
        const enum rng_stream stream = (enum rng_stream)(n % (RNG_MEAN_VELOCITY + 1));
        const uint32_t a = n, b = random.word[2], c = random.word[3];
        const uint32_t lane = rng_philox_lane((uint32_t)seed, (uint32_t)(seed >> 32), a, b, c,
                                              rng_stream_word(stream, 0));
        assert_int_equal(lane, mf_rng_philox(seed, stream, a, b, c).word[0]);
    }
}

static void test_rng_philox_lanes_words_equal_the_library_in_all_words(void **state) {
    (void)state;
    int32_t b[RNG_LANES], c[RNG_LANES], word[4][RNG_LANES + 3];
    for (int n = 0; n < RNG_LANES; n++) {
        const struct rng_block random = mf_rng_philox(5, RNG_SELECTION, (uint32_t)n, 0, 0);
        b[n] = (int32_t)random.word[0];
        c[n] = (int32_t)random.word[1];
    }
    rng_philox_lanes_words(0x89abcdef, 0x01234567, 17, b, c, rng_stream_word(RNG_PAIR_MEMORY, 0), 4,
                           word[0], RNG_LANES + 3);
    for (int n = 0; n < RNG_LANES; n++) {
        const struct rng_block block =
            mf_rng_philox(0x0123456789abcdef, RNG_PAIR_MEMORY, 17, (uint32_t)b[n], (uint32_t)c[n]);
        for (int w = 0; w < 4; w++)
            assert_int_equal((uint32_t)word[w][n], block.word[w]);
    }
}

static void test_rng_stream_word_keeps_streams_apart_when_extra_is_large(void **state) {
    (void)state;
    assert_int_equal(rng_stream_word(RNG_VERIFICATION, 0), 0x70000000);
    assert_int_equal(rng_stream_word(RNG_PAIR_NOISE, 0xFFFFFFFF), 0x0FFFFFFF);
    assert_int_equal(rng_stream_word(RNG_VELOCITIES, 0x10000001), 0x10000001);
}

/// One normal number for a pair, as the engine keys it: step, smaller id, larger id.
static double pair_normal(uint64_t seed, uint32_t step, uint32_t smaller, uint32_t larger) {
    double normal[4];
    mf_rng_normal4(mf_rng_philox(seed, RNG_PAIR_NOISE, step, smaller, larger), normal);
    return normal[0];
}

/// One uniform number of mean 0 and variance 1 for a pair, from word 0 alone.
static double pair_uniform(uint64_t seed, uint32_t step, uint32_t smaller, uint32_t larger) {
    const uint32_t word = rng_philox_lane((uint32_t)seed, (uint32_t)(seed >> 32), step, smaller,
                                          larger, rng_stream_word(RNG_PAIR_NOISE, 0));
    return sqrt(12) * (((double)word + 0.5) * 0x1p-32 - 0.5);
}

/// Number n of a grid of pairs 0 ≤ i < j < 200 and steps.
static double grid_noise(double (*noise)(uint64_t, uint32_t, uint32_t, uint32_t), uint32_t n,
                         uint64_t seed, uint32_t later, uint32_t other) {
    const uint32_t step = n / 10000, i = n % 100, j = 100 + n / 100 % 100;
    return noise(seed, step + later, i, j + other);
}

/// Mean 0, variance 1; the variance of a squared number is `square_variance`.
static void check_mean_and_variance(double (*noise)(uint64_t, uint32_t, uint32_t, uint32_t),
                                    double square_variance) {
    double sum = 0, squares = 0;
    for (uint32_t n = 0; n < SAMPLES; n++) {
        const double x = grid_noise(noise, n, 1, 0, 0);
        sum += x;
        squares += x * x;
    }
    assert_close(sum / SAMPLES, 0, standard_errors / sqrt(SAMPLES));
    assert_close(squares / SAMPLES, 1, standard_errors * sqrt(square_variance / SAMPLES));
}

static void test_rng_pair_noise_has_mean_0_and_variance_1_when_sampled_over_pairs(void **state) {
    (void)state;
    check_mean_and_variance(pair_normal, 2);
    check_mean_and_variance(pair_uniform, 0.8);
}

/// Correlation of noise with noise of another seed, a later step or another partner.
static double correlation(double (*noise)(uint64_t, uint32_t, uint32_t, uint32_t), uint64_t seed,
                          uint32_t later, uint32_t other) {
    double sum = 0;
    for (uint32_t n = 0; n < SAMPLES; n++)
        sum += grid_noise(noise, n, 1, 0, 0) * grid_noise(noise, n, seed, later, other);
    return sum / SAMPLES;
}

static void test_rng_pair_noise_is_uncorrelated_when_step_partner_or_seed_differ(void **state) {
    (void)state;
    static double (*const noises[])(uint64_t, uint32_t, uint32_t, uint32_t) = {pair_normal,
                                                                               pair_uniform};
    const double bound = standard_errors / sqrt(SAMPLES);
    for (int k = 0; k < 2; k++) {
        assert_close(correlation(noises[k], 1, 1, 0), 0, bound);
        assert_close(correlation(noises[k], 1, 0, 1), 0, bound);
        assert_close(correlation(noises[k], 2, 0, 0), 0, bound);
        assert_close(correlation(noises[k], 2, 1, 0), 0, bound);
    }
}

/// The covariance finder itself: noise is fully correlated with itself.
static void test_rng_pair_noise_is_correlated_when_nothing_differs(void **state) {
    (void)state;
    assert_close(correlation(pair_normal, 1, 0, 0), 1, standard_errors * sqrt(2.0 / SAMPLES));
}

static void test_rng_seeds_do_not_replay_each_other_when_steps_are_shifted(void **state) {
    (void)state;
    for (uint32_t step = 0; step < 100; step++)
        for (uint32_t shift = 0; shift < 100; shift++) {
            const struct rng_block first = mf_rng_philox(42, RNG_PAIR_NOISE, step, 1, 2);
            const struct rng_block second = mf_rng_philox(43, RNG_PAIR_NOISE, shift, 1, 2);
            assert_memory_not_equal(first.word, second.word, sizeof first.word);
        }
}

static void test_rng_streams_differ_when_seed_and_counters_are_the_same(void **state) {
    (void)state;
    for (int a = RNG_PAIR_NOISE; a <= RNG_MEAN_VELOCITY; a++)
        for (int b = RNG_PAIR_NOISE; b < a; b++) {
            const struct rng_block first = mf_rng_philox(7, (enum rng_stream)a, 1, 2, 3);
            const struct rng_block second = mf_rng_philox(7, (enum rng_stream)b, 1, 2, 3);
            assert_memory_not_equal(first.word, second.word, sizeof first.word);
        }
}

static void test_rng_normal4_numbers_are_independent_when_from_one_block(void **state) {
    (void)state;
    double product[4][4] = {{0}}, fourth = 0;
    for (uint32_t n = 0; n < SAMPLES; n++) {
        double x[4];
        mf_rng_normal4(mf_rng_philox(9, RNG_VELOCITIES, n, 0, 0), x);
        for (int a = 0; a < 4; a++)
            for (int b = 0; b <= a; b++)
                product[a][b] += x[a] * x[b];
        fourth += x[0] * x[0] * x[0] * x[0];
    }
    for (int a = 0; a < 4; a++)
        for (int b = 0; b <= a; b++)
            assert_close(product[a][b] / SAMPLES, a == b,
                         standard_errors * sqrt((a == b ? 2.0 : 1.0) / SAMPLES));
    // ⟨x⁴⟩ = 3 and ⟨x⁸⟩ − ⟨x⁴⟩² = 105 − 9: the tails are there.
    assert_close(fourth / SAMPLES, 3, standard_errors * sqrt(96.0 / SAMPLES));
}

static void test_rng_normal4_is_finite_when_words_are_extreme(void **state) {
    (void)state;
    static const uint32_t extremes[] = {0, 1, 0x80000000, 0xFFFFFFFF};
    for (int a = 0; a < 4; a++)
        for (int b = 0; b < 4; b++) {
            double x[4];
            mf_rng_normal4((struct rng_block){{extremes[a], extremes[b], extremes[b], extremes[a]}},
                           x);
            for (int k = 0; k < 4; k++)
                assert_true(isfinite(x[k]));
        }
}

static void test_rng_uniform_is_never_0_or_1_when_words_are_extreme(void **state) {
    (void)state;
    assert_true(mf_rng_uniform(0, 0) > 0);
    assert_true(mf_rng_uniform(0xFFFFFFFF, 0xFFFFFFFF) < 1);
    assert_close(mf_rng_uniform(0x80000000, 0), 0.5, 0x1p-52);
    assert_close(mf_rng_uniform(0xFFFFFFFF, 0xFFFFFFFF), 1, 0x1p-52);
}

static void test_rng_sequence_is_uniform_when_long(void **state) {
    (void)state;
    struct rng_sequence sequence = mf_rng_sequence_begin(5, RNG_SELECTION, 1, 2);
    double sum = 0, squares = 0;
    for (int n = 0; n < SAMPLES; n++) {
        const double u = mf_rng_sequence_uniform(&sequence);
        assert_true(u > 0 && u < 1);
        sum += u;
        squares += (u - 0.5) * (u - 0.5);
    }
    // Variance 1/12, fourth central moment 1/80.
    assert_close(sum / SAMPLES, 0.5, standard_errors * sqrt(1.0 / 12 / SAMPLES));
    assert_close(squares / SAMPLES, 1.0 / 12,
                 standard_errors * sqrt((1.0 / 80 - 1.0 / 144) / SAMPLES));
}

static void test_rng_sequence_repeats_when_begun_again(void **state) {
    (void)state;
    struct rng_sequence first = mf_rng_sequence_begin(5, RNG_SELECTION, 1, 2);
    struct rng_sequence again = mf_rng_sequence_begin(5, RNG_SELECTION, 1, 2);
    struct rng_sequence other = mf_rng_sequence_begin(6, RNG_SELECTION, 1, 2);
    int same = 0;
    for (int n = 0; n < 100; n++) {
        const double u = mf_rng_sequence_uniform(&first);
        assert_identical(u, mf_rng_sequence_uniform(&again));
        same += is_identical(u, mf_rng_sequence_uniform(&other));
    }
    assert_int_equal(same, 0);
}

static void test_rng_sequence_below_is_even_and_in_range_when_count_is_seven(void **state) {
    (void)state;
    struct rng_sequence sequence = mf_rng_sequence_begin(5, RNG_INITIAL, 0, 0);
    int hits[7] = {0};
    for (int n = 0; n < SAMPLES; n++) {
        const uint32_t k = mf_rng_sequence_below(&sequence, 7);
        assert_true(k < 7);
        hits[k]++;
    }
    const double p = 1.0 / 7;
    for (int k = 0; k < 7; k++)
        assert_close(hits[k] / (double)SAMPLES, p, standard_errors * sqrt(p * (1 - p) / SAMPLES));
    assert_int_equal(mf_rng_sequence_below(&sequence, 1), 0);
}

static void test_rng_child_seed_differs_when_any_argument_differs(void **state) {
    (void)state;
    const uint64_t child = mf_rng_child_seed(1, RNG_EVALUATION, 2, 3);
    assert_true(child == mf_rng_child_seed(1, RNG_EVALUATION, 2, 3));
    assert_true(child != mf_rng_child_seed(2, RNG_EVALUATION, 2, 3));
    assert_true(child != mf_rng_child_seed(1, RNG_VERIFICATION, 2, 3));
    assert_true(child != mf_rng_child_seed(1, RNG_EVALUATION, 3, 3));
    assert_true(child != mf_rng_child_seed(1, RNG_EVALUATION, 2, 4));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rng_philox4x32_gives_the_known_answers_when_called_in_the_library),
        cmocka_unit_test(test_rng_philox_lane_gives_the_known_answers_when_given_their_counters),
        cmocka_unit_test(test_rng_philox_puts_seed_and_counters_in_place_when_they_differ),
        cmocka_unit_test(test_rng_philox_lane_equals_word_0_when_counters_vary),
        cmocka_unit_test(test_rng_philox_lanes_words_equal_the_library_in_all_words),
        cmocka_unit_test(test_rng_stream_word_keeps_streams_apart_when_extra_is_large),
        cmocka_unit_test(test_rng_pair_noise_has_mean_0_and_variance_1_when_sampled_over_pairs),
        cmocka_unit_test(test_rng_pair_noise_is_uncorrelated_when_step_partner_or_seed_differ),
        cmocka_unit_test(test_rng_pair_noise_is_correlated_when_nothing_differs),
        cmocka_unit_test(test_rng_seeds_do_not_replay_each_other_when_steps_are_shifted),
        cmocka_unit_test(test_rng_streams_differ_when_seed_and_counters_are_the_same),
        cmocka_unit_test(test_rng_normal4_numbers_are_independent_when_from_one_block),
        cmocka_unit_test(test_rng_normal4_is_finite_when_words_are_extreme),
        cmocka_unit_test(test_rng_uniform_is_never_0_or_1_when_words_are_extreme),
        cmocka_unit_test(test_rng_sequence_is_uniform_when_long),
        cmocka_unit_test(test_rng_sequence_repeats_when_begun_again),
        cmocka_unit_test(test_rng_sequence_below_is_even_and_in_range_when_count_is_seven),
        cmocka_unit_test(test_rng_child_seed_differs_when_any_argument_differs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
