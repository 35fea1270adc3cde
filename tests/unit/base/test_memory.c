// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"
#include "shared/testing.h"

#include <malloc.h>

static int cleared;

static void clear(int *number) {
    cleared += *number;
}

/// Bytes that are not given back.
static size_t in_use(void) {
    const struct mallinfo2 all = mallinfo2();
    return all.uordblks + all.hblkhd;
}

static enum status work(enum status with) {
    OWNED double *first = NULL, *second = NULL, *none = NULL;
    CLEARED_BY(clear) int number = 7;
    TRY_ARRAY(first, 1000);
    TRY_ARRAY(second, 1 << 20);
    TRY(with);
    number = 5;
    return none == NULL ? STATUS_OK : STATUS_IO;
}

static void test_memory_owned_is_freed_however_a_function_is_left(void **state) {
    (void)state;
    const size_t before = in_use();
    cleared = 0;
    assert_ok(work(STATUS_OK));
    assert_int_equal(cleared, 5);
    assert_int_equal(work(STATUS_UNSTABLE), STATUS_UNSTABLE);
    assert_int_equal(cleared, 12);
    assert_true(in_use() < before + 4096); // remnants of alignment
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_memory_owned_is_freed_however_a_function_is_left),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
