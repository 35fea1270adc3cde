// SPDX-License-Identifier: GPL-3.0-or-later
//
// Chains of known correlation in time and between numbers, in equilibrium and not.
#include "observe/stationary.h"
#include "shared/testing.h"

#include <gsl/gsl_randist.h>
#include <math.h>
#include <stdbool.h>

enum { MAX_CHAINS = 8, MAX_NUMBERS = 60 };

/// x_t = r x_{t−1} + noise in time, of unit variance, and alike from number to number.
struct kind {
    int chains, numbers;
    int each;            ///< samples of a part
    double memory;       ///< r in time
    double beside;       ///< r between neighbours
    bool begun;          ///< all chains begin at `start`, and not with their scatter
    double start, drift; ///< drift along all samples
    bool one;            ///< the drift is that of the last number alone
    bool alone;          ///< numbers are tested by themselves, too
};

static double part[MAX_CHAINS][STATIONARY_PARTS * MAX_NUMBERS];

static void make_chain(const struct kind *kind, gsl_rng *rng, double *means) {
    const double fresh = sqrt(1 - kind->memory * kind->memory);
    const double own = sqrt(1 - kind->beside * kind->beside);
    double x[MAX_NUMBERS];
    for (int n = 0; n < STATIONARY_PARTS * kind->numbers; n++)
        means[n] = 0;
    for (int t = 0; t < STATIONARY_PARTS * kind->each; t++)
        for (int n = 0, first = 1; n < kind->numbers; n++, first = 0) {
            static double last;
            last = first ? gsl_ran_gaussian(rng, 1)
                         : kind->beside * last + own * gsl_ran_gaussian(rng, 1);
            x[n] = t > 0 ? kind->memory * x[n] + fresh * last : kind->begun ? kind->start : last;
            means[t / kind->each * kind->numbers + n] +=
                (x[n] + (kind->one && n + 1 < kind->numbers ? 0 : kind->drift) * t /
                            (STATIONARY_PARTS * kind->each)) /
                kind->each;
        }
}

static struct stationary test(const struct kind *kind) {
    const double *chain[MAX_CHAINS];
    size_t number[MAX_NUMBERS];
    double weight[MAX_NUMBERS];
    bool alone[MAX_NUMBERS];
    struct stationary result;
    for (int c = 0; c < kind->chains; c++)
        chain[c] = part[c];
    for (int n = 0; n < kind->numbers; n++) {
        number[n] = (size_t)n;
        weight[n] = 1;
        alone[n] = true;
    }
    assert_ok(mf_stationary_test(&(struct stationary_numbers){.chains = (size_t)kind->chains,
                                                              .chain = chain,
                                                              .row = (size_t)kind->numbers,
                                                              .count = (size_t)kind->numbers,
                                                              .number = number,
                                                              .weight = weight,
                                                              .alone = kind->alone ? alone : NULL},
                                 &result));
    return result;
}

/// Shares that are rejected at a level.
struct rejected {
    double drift, memory;
};

static struct rejected count(const char *name, struct kind kind, int trials, double level) {
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    struct rejected share = {0, 0};
    for (int k = 0; k < trials; k++) {
        for (int c = 0; c < kind.chains; c++)
            make_chain(&kind, rng, part[c]);
        const struct stationary found = test(&kind);
        share.drift += (double)(found.drift < level) / trials;
        share.memory += (double)(found.memory < level) / trials;
    }
    print_message("%s: %.4f, %.4f\n", name, share.drift, share.memory);
    gsl_rng_free(rng);
    return share;
}

/// One number whose parts are independent: F has its own distribution. Four standard errors of the
/// counts; a false alarm in 1000 seeds.
static void test_stationary_rejects_as_many_as_the_level_says(void **state) {
    (void)state;
    static const int chains[] = {2, 4, 8};
    static const double level[] = {0.5, 0.01};
    enum { TRIALS = 10000 };
    for (int k = 0; k < 3; k++)
        for (int n = 0; n < 2; n++) {
            const double error = 4 * sqrt(level[n] * (1 - level[n]) / TRIALS);
            const struct rejected share =
                count("one number", (struct kind){chains[k], 1, .each = 1}, TRIALS, level[n]);
            assert_true(fabs(share.drift - level[n]) < error);
            assert_true(fabs(share.memory - level[n]) < error);
        }
}

/// Many numbers, independent or hardly so, as bins of g(r) are: rather fewer, and where a few count
/// as independent up to twice as many.
static void test_stationary_rejects_about_as_many_of_correlated_numbers(void **state) {
    (void)state;
    static const double beside[] = {0, 0.8, 0.97};
    enum { TRIALS = 1000 };
    for (int chains = 2; chains <= 8; chains += 6)
        for (int k = 0; k < 3; k++) {
            const struct rejected share =
                count("60 numbers", (struct kind){chains, 60, .each = 1, .beside = beside[k]},
                      TRIALS, 0.01);
            assert_true(share.drift < 0.03 && share.memory < 0.03);
        }
}

/// Samples that are 40 times as long as their correlation are in order, and those that are as long
/// as that, or shorter, are not: chains from equilibrium differ.
static void test_stationary_finds_what_remembers_its_begin(void **state) {
    (void)state;
    enum { TRIALS = 500, EACH = 20 };
    struct kind kind = {8, 1, .each = EACH};
    kind.memory = exp(-40.0 / (STATIONARY_PARTS * EACH));
    struct rejected share = count("40 times as long", kind, TRIALS, 1e-3);
    assert_true(share.drift < 0.01 && share.memory < 0.01);
    kind.memory = exp(-1.0 / (STATIONARY_PARTS * EACH));
    assert_true(count("as long", kind, TRIALS, 1e-3).memory > 0.8);
    kind.memory = exp(-0.2 / (STATIONARY_PARTS * EACH));
    assert_true(count("a fifth as long", kind, TRIALS, 1e-3).memory > 0.99);
}

/// What all chains have in common: a straight way, or a begin from the same place, which all forget
/// too slowly to differ.
static void test_stationary_finds_a_common_drift(void **state) {
    (void)state;
    enum { TRIALS = 300, EACH = 10 };
    struct kind kind = {8, 1, .each = EACH, .memory = 0.5, .drift = 2.5};
    assert_true(count("a way of 2.5 deviations", kind, TRIALS, 1e-3).drift > 0.99);
    kind = (struct kind){8, 1, .each = EACH, .memory = exp(-0.1), .begun = true, .start = 5};
    assert_true(count("a begin that decays", kind, TRIALS, 1e-3).drift > 0.99);
    kind = (struct kind){8, 60, .each = 1, .beside = 0.8, .drift = 2};
    assert_true(count("60 numbers", kind, TRIALS, 1e-3).drift > 0.99);
}

/// One of 60 numbers is slow: in the sum it drowns, by itself it is found. 60 that are not, as
/// correlated or not, are rejected no more often than the level says: of 3000 trials 30 at 0.01, of
/// which more than 46 are one case in 400.
static void test_stationary_finds_the_slowest_of_many(void **state) {
    (void)state;
    struct kind kind = {8, 60, .each = 4, .one = true, .drift = 2.7};
    assert_true(count("one of 60, in the sum", kind, 300, 1e-3).drift < 0.3);
    kind.alone = true;
    assert_true(count("one of 60, by itself", kind, 300, 1e-3).drift > 0.95);
    for (int n = 0; n < 2; n++) {
        kind = (struct kind){8, 60, .each = 1, .beside = 0.8 * n, .alone = true};
        const struct rejected share = count("none of 60", kind, 3000, 0.01);
        assert_true(share.drift < 46.5 / 3000 && share.memory < 46.5 / 3000);
    }
}

/// Numbers of counts, five in each part: of 5000 trials 10 at 0.002 expected of both; more than 20
/// once in 500.
static void test_stationary_takes_counts_as_they_are(void **state) {
    (void)state;
    enum { TRIALS = 5000 };
    const struct kind kind = {8, 60, .each = 1, .alone = true};
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    int rejected = 0;
    for (int k = 0; k < TRIALS; k++) {
        for (int c = 0; c < kind.chains; c++)
            for (int n = 0; n < STATIONARY_PARTS * kind.numbers; n++)
                part[c][n] = gsl_ran_poisson(rng, 5);
        const struct stationary found = test(&kind);
        rejected += stationary_p_value(&found) < 0.001;
    }
    print_message("counts: %d of %d\n", rejected, TRIALS);
    assert_in_range(rejected, 0, 20);
    gsl_rng_free(rng);
}

static void test_stationary_leaves_alone_what_never_changes(void **state) {
    (void)state;
    const struct kind kind = {4, 2, .each = 1};
    for (int c = 0; c < 4; c++)
        for (int n = 0; n < 2 * STATIONARY_PARTS; n++)
            part[c][n] = 7;
    struct stationary found = test(&kind);
    assert_true(found.drift == 1 && found.memory == 1);
    part[2][0] = part[2][2] = part[2][4] = part[2][6] = 8; // one is frozen elsewhere
    found = test(&kind);
    assert_true(found.memory == 0 && isinf(found.memory_ratio));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stationary_rejects_as_many_as_the_level_says),
        cmocka_unit_test(test_stationary_rejects_about_as_many_of_correlated_numbers),
        cmocka_unit_test(test_stationary_finds_what_remembers_its_begin),
        cmocka_unit_test(test_stationary_finds_a_common_drift),
        cmocka_unit_test(test_stationary_finds_the_slowest_of_many),
        cmocka_unit_test(test_stationary_takes_counts_as_they_are),
        cmocka_unit_test(test_stationary_leaves_alone_what_never_changes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
