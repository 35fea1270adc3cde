// SPDX-License-Identifier: GPL-3.0-or-later
//
// Cells: who is sorted where, what touches a cell, and chains that are entered and left; pairs are
// compared with all images in test_frame_pairs.
#include "base/rng.h"
#include "shared/testing.h"
#include "system/cells.h"

enum { COUNT = 100 };

static void test_cells_keep_the_order_within_a_cell_when_sorted(void **state) {
    (void)state;
    struct cells cells = {0};
    struct rng_sequence random = mf_rng_sequence_begin(7, RNG_PLACEMENT, 0, 0);
    assert_ok(mf_cells_shape(&cells, (const int[3]){2, 3, 4}, COUNT));
    assert_int_equal(cells.total, 24);
    for (size_t k = 0; k < COUNT; k++)
        cells.of[k] = mf_rng_sequence_below(&random, 23); // nobody in the last
    mf_cells_sort(&cells);
    assert_int_equal(cells.start[0], 0);
    assert_int_equal(cells.start[23], COUNT);
    assert_int_equal(cells.start[24], COUNT);
    for (size_t cell = 0; cell < cells.total; cell++)
        for (size_t n = cells.start[cell]; n < cells.start[cell + 1]; n++) {
            assert_int_equal(cells.of[cells.order[n]], cell);
            if (n > cells.start[cell])
                assert_true(cells.order[n] > cells.order[n - 1]);
        }
    mf_cells_clear(&cells);
}

static void test_cells_around_go_round_in_two_and_three_dimensions(void **state) {
    (void)state;
    static const size_t expected[9] = {19, 3, 7, 16, 0, 4, 17, 1, 5};
    size_t around[CELLS_AROUND], times[5 * 4 * 3] = {0};
    assert_int_equal(mf_cells_around((const int[3]){5, 4, 1}, (const int[3]){0, 0, 0}, 2, around),
                     9);
    assert_memory_equal(around, expected, sizeof expected);
    assert_int_equal(mf_cells_around((const int[3]){5, 4, 3}, (const int[3]){4, 0, 2}, 3, around),
                     CELLS_AROUND);
    for (int n = 0; n < CELLS_AROUND; n++) {
        assert_in_range(around[n], 0, 5 * 4 * 3 - 1);
        times[around[n]]++;
    }
    for (size_t cell = 0; cell < 5 * 4 * 3; cell++) {
        const size_t x = cell / 12, y = cell / 3 % 4;
        assert_int_equal(times[cell], (x == 3 || x == 4 || x == 0) && y != 2);
    }
}

static void test_cells_take_what_is_outside_into_the_first_and_the_last(void **state) {
    (void)state;
    assert_int_equal(cells_along(-0.1, 4), 0);
    assert_int_equal(cells_along(0.49, 4), 1);
    assert_int_equal(cells_along(1, 4), 3);
    assert_int_equal(cells_along_fraction(0, 5), 0);
    assert_int_equal(cells_along_fraction(-1, 5), 4);
    assert_int_equal(cells_fit(10, 3, 100), 3);
    assert_int_equal(cells_fit(10, 20, 100), 1);
    assert_int_equal(cells_fit(10, 0, 100), 100);
}

static void test_cells_chain_those_that_enter_the_last_one_first(void **state) {
    (void)state;
    int32_t first = -1, next[4];
    for (int32_t k = 0; k < 4; k++)
        cells_enter(&first, next, k);
    for (int32_t k = 3; k >= 0; k--, first = next[first])
        assert_int_equal(first, k);
    assert_int_equal(first, -1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cells_keep_the_order_within_a_cell_when_sorted),
        cmocka_unit_test(test_cells_around_go_round_in_two_and_three_dimensions),
        cmocka_unit_test(test_cells_take_what_is_outside_into_the_first_and_the_last),
        cmocka_unit_test(test_cells_chain_those_that_enter_the_last_one_first),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
