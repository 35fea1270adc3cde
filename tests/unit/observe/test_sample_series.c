// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/sample_series.h"
#include "shared/testing.h"

#include <string.h>

enum { COLUMNS = 3, SAMPLES = 1000 };

static void add(struct sample_series *series, size_t samples) {
    for (size_t k = series->count; samples > 0; k++, samples--) {
        const double numbers[COLUMNS] = {(double)k, 2.0 * (double)k, -(double)k};
        assert_ok(mf_sample_series_add(series, numbers));
    }
}

static void assert_numbers(const struct sample_series *series, size_t samples) {
    assert_int_equal(series->count, samples);
    for (size_t k = 0; k < samples; k++) {
        assert_true(sample_series_column(series, 0)[k] == (double)k);
        assert_true(sample_series_column(series, 1)[k] == 2.0 * (double)k);
        assert_true(sample_series_column(series, 2)[k] == -(double)k);
    }
}

static void test_series_keep_their_numbers_when_they_grow(void **state) {
    (void)state;
    struct sample_series series = {.columns = COLUMNS};
    assert_null(sample_series_column(&series, 1));
    add(&series, SAMPLES);
    assert_numbers(&series, SAMPLES);
    assert_true(series.capacity < 2 * SAMPLES + 256);
    mf_sample_series_clear(&series);
}

/// The number of samples first, then as many numbers of each column, and of no more.
static void test_series_are_restored_from_their_spans(void **state) {
    (void)state;
    struct sample_series saved = {.columns = COLUMNS}, restored = {.columns = COLUMNS};
    struct memory_span from[1 + COLUMNS], to[1 + COLUMNS];
    assert_int_equal(mf_sample_series_spans(&saved, from), 1 + COLUMNS);
    assert_int_equal(from[1].bytes, 0);
    add(&saved, SAMPLES);
    mf_sample_series_spans(&saved, from);
    restored.count = saved.count;
    assert_ok(mf_sample_series_reserve(&restored));
    mf_sample_series_spans(&restored, to);
    for (int c = 1; c <= COLUMNS; c++) {
        assert_int_equal(from[c].bytes, SAMPLES * sizeof(double));
        assert_int_equal(to[c].bytes, from[c].bytes);
        memcpy(to[c].memory, from[c].memory, from[c].bytes);
    }
    add(&restored, SAMPLES);
    assert_numbers(&restored, 2 * SAMPLES);
    mf_sample_series_clear(&saved);
    mf_sample_series_clear(&restored);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_series_keep_their_numbers_when_they_grow),
        cmocka_unit_test(test_series_are_restored_from_their_spans),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
