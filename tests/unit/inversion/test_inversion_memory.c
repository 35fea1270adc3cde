// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_memory.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

/// Samples of a series with the correlations ρ^t, h apart, that count as one independent: 1 + 2 Σ
/// ρ^hk.
static double inefficiency(double rho, double h) {
    double sum = 1;
    for (int k = 1; k < 10000; k++)
        sum += 2 * pow(rho, h * k);
    return sum;
}

static void test_a_short_run_counts_by_what_a_longer_one_has_shown(void **state) {
    (void)state;
    static const double rho = 0.98;
    struct inversion_memory memory = {0};
    assert_close(mf_inversion_memory_recall(&memory, 16, 2048, inefficiency(rho, 16)),
                 inefficiency(rho, 16), 1e-12);
    assert_close(mf_inversion_memory_recall(&memory, 2, 128, 1.5), inefficiency(rho, 2), 1e-9);
    assert_close(mf_inversion_memory_recall(&memory, 64, 1024, 1), inefficiency(rho, 64), 1e-9);
}

static void test_a_run_as_long_may_show_less(void **state) {
    (void)state;
    struct inversion_memory memory = {0};
    mf_inversion_memory_recall(&memory, 16, 1024, 10);
    assert_close(mf_inversion_memory_recall(&memory, 2, 1024, 1.5), 1.5, 0);
    assert_close(mf_inversion_memory_recall(&memory, 2, 128, 1.2), 1.5, 1e-12);
}

static void test_any_run_may_show_more(void **state) {
    (void)state;
    struct inversion_memory memory = {0};
    mf_inversion_memory_recall(&memory, 2, 1024, 3);
    assert_close(mf_inversion_memory_recall(&memory, 2, 128, 9), 9, 0);
    assert_close(memory.seen_by, 128, 0);
}

static void test_independent_samples_have_no_memory(void **state) {
    (void)state;
    struct inversion_memory memory = {0};
    assert_close(mf_inversion_memory_recall(&memory, 16, 1024, 1), 1, 0);
    assert_close(mf_inversion_memory_recall(&memory, 2, 128, 1), 1, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_short_run_counts_by_what_a_longer_one_has_shown),
        cmocka_unit_test(test_a_run_as_long_may_show_less),
        cmocka_unit_test(test_any_run_may_show_more),
        cmocka_unit_test(test_independent_samples_have_no_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
