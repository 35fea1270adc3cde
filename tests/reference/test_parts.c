// SPDX-License-Identifier: GPL-3.0-or-later
//
// Parts of the neighbour list that threads build side by side: none writes into another, wherever
// the beads are. stress/test_parts.c does the same with thousands of scenes.
#include "shared/testing.h"
#include "shared/uneven.h"
#include "shared/variants.h"

/// Rooms that are tried at the end of a part, of 16 places each: vectors of owners reach 8.
enum { ROOMS = 24 };

static struct variant variants[VARIANTS_MAX];
static int variant_count;

static int find_variants(void **state) {
    (void)state;
    variant_count = variants_find(variants);
    return 0;
}

static void test_part_ends_before_the_next_when_it_is_nearly_full(void **state) {
    (void)state;
    for (int v = 0; v < variant_count; v++) {
        int seen = 0;
        variants_select(&variants[v]);
        for (uint32_t number = 0; number < 12; number++)
            for (int capacity = 0; capacity < ROOMS; capacity++) {
                struct uneven uneven;
                uneven_init(&uneven, UNEVEN_EMPTY, number);
                uneven_narrow(&uneven, capacity);
                seen += uneven_check_ends(&uneven);
                uneven_clear(&uneven);
            }
        assert_true(seen > 4 * ROOMS); // some of each scene were not widened
    }
    variants_select(&variants[0]);
}

static void test_threads_build_the_same_list_when_beads_are_spread_unevenly(void **state) {
    (void)state;
    static const int threads[] = {2, 3, 7, 40};
    for (int kind = 0; kind < UNEVEN_KINDS; kind++)
        for (int capacity = 0; capacity < ROOMS; capacity++) {
            struct uneven uneven;
            uneven_init(&uneven, (enum uneven_kind)kind, (uint32_t)capacity);
            uneven_narrow(&uneven, capacity);
            uneven_check_threads(&uneven, threads[capacity % 4]);
            uneven_clear(&uneven);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_part_ends_before_the_next_when_it_is_nearly_full),
        cmocka_unit_test(test_threads_build_the_same_list_when_beads_are_spread_unevenly),
    };
    return cmocka_run_group_tests(tests, find_variants, NULL);
}
