// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_noise.h"

#include "inversion/inversion_state.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

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
    // Errors that no file gives are those of a scatter that sees each bin by itself.
    made.problem.targets.target[TARGET_RDF].own_errors = true;
    assert_close(covariance_of(&made, INVERSION_NOISE_OF_SAMPLES, 3, 3), 4, 1e-12);
    assert_close(covariance_of(&made, INVERSION_NOISE_OF_SAMPLES, 3, 2), 0.94 * 0.5, 1e-12);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_inversion_noise_of_samples_correlates_as_what_they_count),
        cmocka_unit_test(test_inversion_noise_of_a_target_is_each_bins_own_but_for_factors),
        cmocka_unit_test(test_inversion_noise_of_a_target_of_samples_correlates_as_theirs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
