// SPDX-License-Identifier: GPL-3.0-or-later
//
// Thousands of lists that threads build of beads spread unevenly: each row has its owner, and the
// forces have the bits of one thread. tests/reference/test_parts.c says why.
#include "shared/testing.h"
#include "shared/uneven.h"

/// A part that is nearly full, as its own room happens to be: one scene in some hundreds.
enum { SCENES = 500, NARROW = 20 };

static void check(uint32_t number, int capacity, int threads) {
    for (int kind = 0; kind < UNEVEN_KINDS; kind++) {
        struct uneven uneven;
        uneven_init(&uneven, (enum uneven_kind)kind, number);
        if (capacity > 0)
            uneven_narrow(&uneven, capacity);
        uneven_check_threads(&uneven, threads);
        uneven_clear(&uneven);
    }
}

static void test_threads_build_the_same_list_when_scenes_are_thousands(void **state) {
    (void)state;
    for (uint32_t number = 100; number < 100 + SCENES; number++)
        check(number, 0, 2);
}

static void test_threads_build_the_same_list_when_every_part_is_narrow(void **state) {
    (void)state;
    static const int threads[] = {2, 4, 5, 64};
    for (uint32_t number = 10; number < 17; number++)
        for (int capacity = 1; capacity <= NARROW; capacity++)
            check(number, capacity, threads[capacity % 4]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_threads_build_the_same_list_when_scenes_are_thousands),
        cmocka_unit_test(test_threads_build_the_same_list_when_every_part_is_narrow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
