// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/own_words.h"
#include "shared/testing.h"

static void test_names_that_tables_have_are_found(void **state) {
    static const char *const own[] = {"now_A",   "error_ring", "B_history",
                                      "B_flat",  "x_error",    "A_boltzmann",
                                      "B_lower", "B_upper",    "_history"};
    static const char *const plain[] = {"A",      "now",      "history",  "error", "B_historyA",
                                        "Anow_B", "A_lower1", "flat_cat", ""};
    (void)state;
    for (size_t k = 0; k < sizeof own / sizeof *own; k++)
        assert_true(mf_own_words_has(own[k]));
    for (size_t k = 0; k < sizeof plain / sizeof *plain; k++)
        assert_false(mf_own_words_has(plain[k]));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_names_that_tables_have_are_found)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
