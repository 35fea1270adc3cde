// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/sample_blocks.h"
#include "shared/testing.h"

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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_blocks_are_joined_where_nothing_is_planned),
        cmocka_unit_test(test_planned_samples_make_twenty_blocks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
