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

static void test_a_memory_is_the_same_of_any_spacing(void **state) {
    (void)state;
    static const double rho = 0.98;
    struct inversion_memory memory = {0};
    assert_close(mf_inversion_memory_find(&memory, 16, 2048, inefficiency(rho, 16)),
                 inefficiency(rho, 16), 1e-12);
    for (int h = 2; h <= 64; h *= 2) {
        mf_inversion_memory_begin_run(&memory, false);
        assert_close(mf_inversion_memory_find(&memory, h, 128, inefficiency(rho, h)),
                     inefficiency(rho, h), 1e-9);
    }
}

static void test_runs_count_by_their_lengths_and_half_of_the_next(void **state) {
    (void)state;
    static const double every = 2, run[] = {4096, 512, 1024}, rho[] = {0.9, 0.7, 0.95};
    struct inversion_memory memory = {0};
    double sum = 0, length = 0;
    for (int k = 0; k < 3; k++) {
        sum = sum / 2 + run[k] * -2 / log(rho[k]); // twice the correlation time
        length = length / 2 + run[k];
        const double found =
            mf_inversion_memory_find(&memory, every, run[k], inefficiency(rho[k], every));
        assert_close(found, inefficiency(exp(-2 / (sum / length)), every), 1e-9);
        mf_inversion_memory_begin_run(&memory, false);
    }
}

static void test_a_run_that_was_lengthened_counts_once(void **state) {
    (void)state;
    struct inversion_memory memory = {0};
    mf_inversion_memory_find(&memory, 2, 128, 1.2);
    assert_close(mf_inversion_memory_find(&memory, 2, 256, 3), 3, 1e-12);
}

/// A potential may be slow where those before were quick.
static void test_a_run_counts_half_of_what_it_shows_at_least(void **state) {
    (void)state;
    struct inversion_memory memory = {0};
    mf_inversion_memory_find(&memory, 2, 4096, 1);
    mf_inversion_memory_begin_run(&memory, false);
    assert_close(mf_inversion_memory_find(&memory, 2, 256, 10), 5, 1e-12);
}

static void test_what_was_given_up_is_forgotten(void **state) {
    (void)state;
    struct inversion_memory memory = {0};
    mf_inversion_memory_find(&memory, 2, 128, 3);
    mf_inversion_memory_begin_run(&memory, false);
    mf_inversion_memory_find(&memory, 2, 4096, 50);
    mf_inversion_memory_begin_run(&memory, true);
    assert_close(mf_inversion_memory_find(&memory, 2, 128, 3), 3, 1e-12);
}

static void test_independent_samples_have_no_memory(void **state) {
    (void)state;
    struct inversion_memory memory = {0};
    assert_close(mf_inversion_memory_find(&memory, 16, 1024, 1), 1, 0);
    mf_inversion_memory_begin_run(&memory, false);
    assert_close(mf_inversion_memory_find(&memory, 2, 128, 1), 1, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_memory_is_the_same_of_any_spacing),
        cmocka_unit_test(test_runs_count_by_their_lengths_and_half_of_the_next),
        cmocka_unit_test(test_a_run_that_was_lengthened_counts_once),
        cmocka_unit_test(test_a_run_counts_half_of_what_it_shows_at_least),
        cmocka_unit_test(test_what_was_given_up_is_forgotten),
        cmocka_unit_test(test_independent_samples_have_no_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
