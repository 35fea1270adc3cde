// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/growing.h"
#include "shared/testing.h"

#include <stdint.h>

static void test_growing_keeps_elements_and_seldom_moves_them(void **state) {
    (void)state;
    enum { ELEMENTS = 100000 };
    uint32_t *numbers = NULL;
    size_t capacity = 0, moves = 0;
    for (uint32_t n = 0; n < ELEMENTS; n++) {
        const uint32_t *before = numbers;
        assert_ok(mf_growing_reserve(&numbers, &capacity, n, n + 1, sizeof *numbers, 10));
        moves += numbers != before;
        assert_true(capacity > n);
        numbers[n] = 3 * n;
    }
    assert_in_range(moves, 2, 15); // 10 doubled 14 times are more
    for (uint32_t n = 0; n < ELEMENTS; n++)
        assert_int_equal(numbers[n], 3 * n);
    assert_ok(mf_growing_reserve(&numbers, &capacity, 5, 10 * capacity, sizeof *numbers, 10));
    assert_true(capacity >= 10 * ELEMENTS);
    assert_int_equal(numbers[4], 12);
    mf_memory_free(numbers);
}

static void test_growing_leaves_all_as_it_was_without_memory(void **state) {
    (void)state;
    uint32_t *numbers = NULL;
    size_t capacity = 0;
    assert_ok(mf_growing_reserve(&numbers, &capacity, 0, 3, sizeof *numbers, 1));
    assert_int_equal(capacity, 3);
    numbers[2] = 7;
    assert_fails(mf_growing_reserve(&numbers, &capacity, 3, SIZE_MAX / 2, sizeof *numbers, 1),
                 STATUS_NO_MEMORY, "too large");
    assert_int_equal(capacity, 3);
    assert_int_equal(numbers[2], 7);
    mf_memory_free(numbers);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_growing_keeps_elements_and_seldom_moves_them),
        cmocka_unit_test(test_growing_leaves_all_as_it_was_without_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
