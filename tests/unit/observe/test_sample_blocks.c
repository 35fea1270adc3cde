// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/sample_blocks.h"
#include "base/statistics.h"
#include "shared/testing.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>

/// Add the number of each sample to the sum of its block.
static void take(struct sample_blocks *blocks, size_t samples) {
    for (size_t n = 0; n < samples; n++)
        *mf_sample_blocks_next(blocks) += (double)n;
}

/// 100 samples fill 25 blocks of 4: 0 + 1 + 2 + 3, 4 + 5 + 6 + 7, …
static void test_blocks_are_joined_where_nothing_is_planned(void **state) {
    (void)state;
    struct sample_blocks blocks;
    assert_ok(mf_sample_blocks_init(&blocks, 0, 1));
    take(&blocks, 102);
    assert_int_equal(blocks.each, 4);
    assert_int_equal(mf_sample_blocks_whole(&blocks), 25);
    for (size_t b = 0; b < 25; b++)
        assert_true(blocks.sums[b] == 16.0 * (double)b + 6 && blocks.samples[b] == 4);
    assert_true(blocks.sums[25] == 100 + 101 && blocks.samples[25] == 2);
    mf_sample_blocks_clear(&blocks);
}

static void test_planned_samples_make_twenty_blocks(void **state) {
    (void)state;
    struct sample_blocks blocks;
    assert_ok(mf_sample_blocks_init(&blocks, 40, 1));
    assert_int_equal(blocks.count, 20);
    take(&blocks, 39);
    assert_true(blocks.sums[0] == 0 + 1 && blocks.sums[18] == 36 + 37 && blocks.sums[19] == 38);
    assert_int_equal(mf_sample_blocks_whole(&blocks), 20);
    mf_sample_blocks_clear(&blocks);
    assert_ok(mf_sample_blocks_init(&blocks, 3, 1));
    assert_int_equal(blocks.count, 3);
    mf_sample_blocks_clear(&blocks);
}

/// Counts of Poisson's law in 40 numbers, each sample taken `times` times: the variance of a mean
/// is then so many times that of counts that know nothing of each other. 40 others before them,
/// which do not count, are three times as many and are taken ten times.
static bool counts_are_independent(size_t samples, size_t times) {
    enum { NUMBERS = 40, SLOW = 10, ROW = 2 * NUMBERS };
    static const double expected = 30;
    struct sample_blocks blocks;
    double mean[NUMBERS], error[NUMBERS], drawn[ROW];
    gsl_rng *const rng = gsl_rng_alloc(gsl_rng_mt19937);
    assert_ok(mf_sample_blocks_init(&blocks, samples, ROW));
    for (size_t n = 0; n < samples; n++) {
        for (size_t k = 0; k < ROW; k++)
            if (n % (k < NUMBERS ? SLOW : times) == 0)
                drawn[k] = gsl_ran_poisson(rng, k < NUMBERS ? 3 * expected : expected);
        double *const sums = mf_sample_blocks_next(&blocks);
        for (size_t k = 0; k < ROW; k++)
            sums[k] += drawn[k];
    }
    for (size_t k = 0; k < NUMBERS; k++) {
        struct running_mean all = {0};
        for (size_t b = 0; b < blocks.count; b++)
            mf_statistics_add(&all, blocks.sums[b * ROW + NUMBERS + k] / blocks.samples[b]);
        mean[k] = all.mean;
        error[k] = mf_statistics_standard_error(&all);
    }
    const bool found = mf_sample_blocks_are_independent(&blocks, NUMBERS, NUMBERS, mean, error);
    mf_sample_blocks_clear(&blocks);
    gsl_rng_free(rng);
    return found;
}

static void test_errors_are_of_samples_where_counts_scatter_as_poisson_says(void **state) {
    (void)state;
    assert_true(counts_are_independent(400, 1));
    assert_false(counts_are_independent(400, 2));
    assert_false(counts_are_independent(400, 10));
    assert_false(counts_are_independent(1, 1)); // nothing is known of one
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_blocks_are_joined_where_nothing_is_planned),
        cmocka_unit_test(test_planned_samples_make_twenty_blocks),
        cmocka_unit_test(test_errors_are_of_samples_where_counts_scatter_as_poisson_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
