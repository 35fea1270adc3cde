// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_noise.h"

#include "inversion/inversion_state.h"
#include "shared/is_close.h"
#include "base/rng.h"
#include "shared/testing.h"

#include <math.h>
#include <string.h>

enum { KNOWN = 6, FIRST = 2, UNSEEN = 5, SAMPLES = 94 };

struct made {
    struct inverse_problem problem;
    struct inversion_state state;
    size_t known_bin[KNOWN], known_of[2];
    bool seen[KNOWN];
    double covariance[KNOWN * KNOWN], variance[KNOWN], counts[KNOWN], error[KNOWN], common[KNOWN];
};

/// Two pair types whose target is exact; the samples scatter by 2 in each bin.
static void make(struct made *made) {
    *made = (struct made){.known_of = {FIRST, KNOWN - FIRST}};
    made->state = (struct inversion_state){
        .problem = &made->problem,
        .grid = {.known = KNOWN,
                 .known_bin = made->known_bin,
                 .known_of = made->known_of,
                 .blocks = 2,
                 .pairs = 2,
                 .seen = made->seen},
        .response = {.covariance = made->covariance, .independent = SAMPLES, .functions = KNOWN},
        .replicas.counts = {.size = KNOWN, .mean = made->counts},
        .inefficiency = 1,
        .variance = made->variance,
        .target = {.counts = made->counts, .error = made->error}};
    for (size_t a = 0; a < KNOWN; a++) {
        made->known_bin[a] = a;
        made->seen[a] = a != UNSEEN;
        made->variance[a] = 4;
        made->counts[a] = 10;
        for (size_t b = 0; b < KNOWN; b++)
            made->covariance[a * KNOWN + b] = 9 * pow(0.5, fabs((double)a - (double)b));
    }
}

/// (L Lᵀ)_ab
static double covariance_of(const struct made *made, enum inversion_noise_kind kind, size_t a,
                            size_t b) {
    double factor[KNOWN * KNOWN], sum = 0;
    mf_inversion_noise_find(&made->state, kind, NULL, factor);
    for (size_t k = 0; k <= a && k <= b; k++)
        sum += factor[a * KNOWN + k] * factor[b * KNOWN + k];
    return sum;
}

/// 94 samples and 6 more that do not correlate: 0.94 of their correlations.
static void test_inversion_noise_of_samples_correlates_as_what_they_count(void **state) {
    (void)state;
    static struct made made;
    make(&made);
    assert_close(covariance_of(&made, INVERSION_NOISE_OF_BINS, 3, 3), 4, 1e-12);
    assert_close(covariance_of(&made, INVERSION_NOISE_OF_BINS, 3, 2), 0.94 * 4 * 0.5, 1e-12);
    assert_close(covariance_of(&made, INVERSION_NOISE_OF_BINS, 0, 3), 0.94 * 4 * 0.125, 1e-12);
    assert_close(covariance_of(&made, INVERSION_NOISE_OF_BINS, UNSEEN, UNSEEN), 4, 1e-12);
    assert_close(covariance_of(&made, INVERSION_NOISE_OF_BINS, UNSEEN, 4), 0, 1e-12);
}

static void test_inversion_noise_of_a_target_is_each_bins_own_but_for_factors(void **state) {
    (void)state;
    static struct made made;
    make(&made);
    for (size_t a = 0; a < KNOWN; a++) {
        made.error[a] = sqrt(3);
        made.common[a] = 0.1 * (double)(a + 1);
    }
    // 1 of 4 is of the samples.
    assert_close(covariance_of(&made, INVERSION_NOISE_OF_BINS, 3, 2), 0.94 * 0.5, 1e-12);
    made.state.target.common = made.common;
    assert_close(covariance_of(&made, INVERSION_NOISE_OF_BINS, 3, 3), 4 + 0.4 * 0.4, 1e-12);
    assert_close(covariance_of(&made, INVERSION_NOISE_OF_BINS, 3, 2), 0.94 * 0.5 + 0.4 * 0.3,
                 1e-12);
    assert_close(covariance_of(&made, INVERSION_NOISE_OF_BINS, 2, 1), 0.94 * 0.5,
                 1e-12); // of two pair types
    assert_close(covariance_of(&made, INVERSION_NOISE_OF_BINS, UNSEEN, UNSEEN), 4, 1e-12);
}

/// The errors of a target correlate as those of samples: all variances count.
static void test_inversion_noise_of_a_target_of_samples_correlates_as_theirs(void **state) {
    (void)state;
    static struct made made;
    make(&made);
    for (size_t a = 0; a < KNOWN; a++)
        made.error[a] = sqrt(3);
    assert_close(covariance_of(&made, INVERSION_NOISE_OF_SAMPLES, 3, 3), 4, 1e-12);
    assert_close(covariance_of(&made, INVERSION_NOISE_OF_SAMPLES, 3, 2), 0.94 * 4 * 0.5, 1e-12);
    assert_close(covariance_of(&made, INVERSION_NOISE_OF_SAMPLES, UNSEEN, 4), 0, 1e-12);
    // A target that says that its errors are of samples has them also where bands ask.
    made.problem.targets.target[TARGET_RDF].errors_of = TARGET_ERRORS_OF_SAMPLES;
    assert_int_equal(mf_inversion_noise_of_band(&made.state, INVERSION_NOISE_OF_SAMPLES),
                     INVERSION_NOISE_OF_SAMPLES);
    assert_int_equal(mf_inversion_noise_of_band(&made.state, INVERSION_NOISE_OF_BINS),
                     INVERSION_NOISE_OF_BINS);
    made.problem.targets.target[TARGET_RDF].errors_of = TARGET_ERRORS_UNKNOWN;
    assert_int_equal(mf_inversion_noise_of_band(&made.state, INVERSION_NOISE_OF_SAMPLES),
                     INVERSION_NOISE_OF_BINS);
    // Errors that no file gives are those of a scatter that sees each bin by itself.
    made.problem.targets.target[TARGET_RDF].errors_of = TARGET_ERRORS_OF_BINS;
    assert_close(covariance_of(&made, INVERSION_NOISE_OF_SAMPLES, 3, 3), 4, 1e-12);
    assert_close(covariance_of(&made, INVERSION_NOISE_OF_SAMPLES, 3, 2), 0.94 * 0.5, 1e-12);
}

/// A liquid of 40 bins whose counts cancel along what is smooth: C = D − 0.98 s sᵀ along three
/// functions s, as those of a compressibility, and a target with errors as large as D.
enum { LIQUID = 40, FLAT = 3 };
struct liquid {
    struct inverse_problem problem;
    struct inversion_state state;
    size_t known_bin[LIQUID], known_of;
    bool seen[LIQUID];
    double flat[FLAT][LIQUID], covariance[LIQUID * LIQUID], variance[LIQUID], counts[LIQUID],
        error[LIQUID], excess[LIQUID];
};

static void make_liquid(struct liquid *liquid) {
    *liquid = (struct liquid){.known_of = LIQUID};
    liquid->problem.scene.temperature = 1;
    liquid->problem.targets.bins.width = 0.03;
    liquid->state = (struct inversion_state){
        .problem = &liquid->problem,
        .grid = {.known = LIQUID,
                 .known_bin = liquid->known_bin,
                 .known_of = &liquid->known_of,
                 .blocks = 1,
                 .pairs = 1,
                 .seen = liquid->seen},
        .response = {.covariance = liquid->covariance, .independent = 1e6, .functions = LIQUID},
        .excess = liquid->excess,
        .replicas.counts = {.size = LIQUID, .mean = liquid->counts},
        .variance = liquid->variance,
        .target = {.counts = liquid->counts, .error = liquid->error}};
    for (size_t a = 0; a < LIQUID; a++) {
        liquid->known_bin[a] = a;
        liquid->seen[a] = true;
        liquid->variance[a] = 1;
        liquid->error[a] = 1 - 1e-6;
        liquid->counts[a] = 100;
        for (size_t f = 0; f < FLAT; f++)
            liquid->flat[f][a] =
                sqrt(2.0 / LIQUID) * cos(M_PI * (double)(f + 1) * ((double)a + 0.5) / LIQUID);
    }
    for (size_t a = 0; a < LIQUID; a++)
        for (size_t b = 0; b < LIQUID; b++)
            for (size_t f = 0; f <= FLAT; f++)
                liquid->covariance[a * LIQUID + b] +=
                    100 * (f == FLAT ? (double)(a == b)
                                     : -0.98 * liquid->flat[f][a] * liquid->flat[f][b]);
}

/// An excess of errors of each bin's own, or of samples, without what cancels.
static void draw(struct liquid *liquid, bool own, uint32_t trial) {
    for (size_t a = 0; a < LIQUID; a++) {
        double normal[4];
        mf_rng_normal4(mf_rng_philox(11, RNG_INITIAL, trial, (uint32_t)a, 0), normal);
        liquid->excess[a] = normal[0];
    }
    for (size_t f = 0; f < FLAT && !own; f++) {
        double along = 0;
        for (size_t a = 0; a < LIQUID; a++)
            along += liquid->flat[f][a] * liquid->excess[a];
        for (size_t a = 0; a < LIQUID; a++)
            liquid->excess[a] -= (1 - sqrt(0.02)) * along * liquid->flat[f][a];
    }
}

/// Errors of samples are told in 199 of 200 excesses, those of each bin's own in 134: what these
/// make along what cancels a potential may have made as well.
static void test_inversion_noise_is_told_by_the_excess(void **state) {
    (void)state;
    enum { TRIALS = 200 };
    static struct liquid liquid;
    int right[2] = {0};
    make_liquid(&liquid);
    for (int own = 0; own < 2; own++)
        for (uint32_t trial = 0; trial < TRIALS; trial++) {
            enum inversion_noise_kind kind;
            draw(&liquid, own, trial);
            assert_ok(mf_inversion_noise_choose(&liquid.state, &kind));
            right[own] += (kind == INVERSION_NOISE_OF_BINS) == own;
        }
    print_message("right of %d: of samples %d, of bins %d\n", TRIALS, right[0], right[1]);
    assert_true(right[0] > 0.95 * TRIALS);
    assert_true(right[1] > 0.55 * TRIALS);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_inversion_noise_of_samples_correlates_as_what_they_count),
        cmocka_unit_test(test_inversion_noise_of_a_target_is_each_bins_own_but_for_factors),
        cmocka_unit_test(test_inversion_noise_of_a_target_of_samples_correlates_as_theirs),
        cmocka_unit_test(test_inversion_noise_is_told_by_the_excess),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
