// SPDX-License-Identifier: GPL-3.0-or-later
//
// Errors against a reference, its extrapolation, and where they cross what is wanted.
#include "bench/bench_accuracy_output.h"

#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

enum { BINS = 3 };

static const struct bench_method method = {.name = "one"}, other = {.name = "other"};

/// A point whose numbers are exact + slope · Δt², with the same error everywhere.
static void make_point(struct bench_point *point, struct bench_number *g, double time_step,
                       double slope, double error) {
    *point = (struct bench_point){
        .method = &method, .time_step = time_step, .time = 50, .cpu = {2 / time_step, 0}, .g = g};
    for (int k = 0; k < BINS; k++)
        g[k] = (struct bench_number){1 + k + slope * (k + 1) * time_step * time_step, error};
    for (int q = 0; q < BENCH_QUANTITIES; q++)
        point->quantity[q] = (struct bench_number){q - slope * time_step * time_step, error};
}

static void test_extrapolation_removes_the_square_of_the_step(void **state) {
    (void)state;
    struct bench_point reference, points[3];
    struct bench_number g[4][BINS];
    make_point(&reference, g[0], 0.01, 5, 0.1);
    make_point(&points[0], g[1], 0.02, 5, 0.1);
    make_point(&points[1], g[2], 0.04, 5, 0.1);
    make_point(&points[2], g[3], 0.05, 5, 0.1);
    const struct bench_extrapolation done = mf_bench_extrapolate(&reference, points, 3, BINS);
    assert_close(done.partner, 0.04, 0);
    assert_close(done.moved, 5 * 3 * 1e-4, 1e-12);
    for (int k = 0; k < BINS; k++)
        assert_close(reference.g[k].value, 1 + k, 1e-12);
    assert_close(reference.quantity[BENCH_PRESSURE].value, BENCH_PRESSURE, 1e-12);
    assert_close(reference.g[0].error, 0.1 * hypot(16.0 / 15, 1.0 / 15), 1e-12);
}

static void test_extrapolation_needs_a_stable_partner_of_its_method(void **state) {
    (void)state;
    struct bench_point reference, points[3];
    struct bench_number g[4][BINS];
    make_point(&reference, g[0], 0.01, 5, 0.1);
    make_point(&points[0], g[1], 0.02, 5, 0.1);
    make_point(&points[1], g[2], 0.04, 5, 0.1);
    make_point(&points[2], g[3], 0.04, 5, 0.1);
    points[1].method = &other;
    points[2].status = STATUS_UNSTABLE;
    assert_close(mf_bench_extrapolate(&reference, points, 3, BINS).partner, 0, 0);
    assert_close(reference.g[1].value, 2 + 10 * 1e-4, 1e-12);
}

static void test_row_has_largest_change_and_rms_without_noise(void **state) {
    (void)state;
    struct bench_point reference, point;
    struct bench_number g[2][BINS];
    make_point(&reference, g[0], 0.01, 0, 0.03);
    make_point(&point, g[1], 0.1, 20, 0.04);
    const struct bench_row row = mf_bench_row_of(&point, &reference, BINS, 0.01);
    const double *value = row.value;
    assert_close(value[BENCH_G_LARGEST], 0.6, 1e-12);
    assert_close(value[BENCH_G_LARGEST_ERROR], 0.05, 1e-12);
    assert_close(value[BENCH_G_RMS], sqrt((0.04 + 0.16 + 0.36) / 3 - 0.0025), 1e-12);
    assert_close(value[BENCH_CHANGES + 2 * BENCH_ENERGY], -0.2, 1e-12);
    assert_close(value[BENCH_CHANGES + 2 * BENCH_ENERGY + 1], 0.05, 1e-12);
    assert_close(value[BENCH_VALUES + 2 * BENCH_ENERGY], BENCH_ENERGY - 0.2, 1e-12);
    assert_close(value[BENCH_CPU_TO_ERROR], 20 * 50 * 16, 1e-9);
}

static void test_noise_alone_has_an_rms_of_0(void **state) {
    (void)state;
    struct bench_point reference, point;
    struct bench_number g[2][BINS];
    make_point(&reference, g[0], 0.01, 0, 0.03);
    make_point(&point, g[1], 0.1, 0.1, 0.04);
    const struct bench_row row = mf_bench_row_of(&point, &reference, BINS, 0.01);
    assert_close(row.value[BENCH_G_RMS], 0, 0);
    assert_true(row.value[BENCH_G_RMS_ERROR] > 0);
}

static void test_expected_largest_is_that_of_half_normal_numbers(void **state) {
    (void)state;
    const double one[] = {2}, two[] = {1, 1}, none[] = {0, 0};
    assert_close_relative(mf_bench_expected_largest(one, 1), 2 * sqrt(2 / M_PI), 1e-4);
    assert_close_relative(mf_bench_expected_largest(two, 2), 2 / sqrt(M_PI), 1e-4);
    assert_close(mf_bench_expected_largest(none, 2), 0, 0);
}

static struct bench_row make_row(double time_step, double largest) {
    struct bench_row row = {.method = "one"};
    row.value[BENCH_TIME_STEP] = time_step;
    row.value[BENCH_CPU] = 1 / time_step;
    row.value[BENCH_G_LARGEST] = largest;
    row.value[BENCH_G_LARGEST_ERROR] = 0.1 * largest;
    return row;
}

static void test_limit_lies_on_the_power_law_of_the_errors(void **state) {
    (void)state;
    const struct bench_row rows[] = {make_row(0.1, 0.01), make_row(0.2, 0.04), make_row(0.4, 0.16)};
    const struct bench_limit limit = mf_bench_limit_of(rows, 3, 0.0225);
    assert_string_equal(limit.method, "one");
    assert_close(limit.time_step, 0.15, 1e-12);
    assert_close(limit.cpu, 1 / 0.15, 1e-9);
    assert_true(limit.is_bounded);
    // Errors of 7 % or so, halved by the square root.
    assert_in_range(1e4 * limit.time_step_error / limit.time_step, 300, 500);
}

static void test_limit_ends_at_the_first_step_that_is_too_large(void **state) {
    (void)state;
    const struct bench_row rows[] = {make_row(0.1, 0.01), make_row(0.2, 0.04), make_row(0.4, 0.01)};
    assert_close(mf_bench_limit_of(rows, 3, 0.02).time_step, 0.1 * sqrt(2), 1e-12);
    assert_null(mf_bench_limit_of(rows, 3, 0.005).method);
    assert_null(mf_bench_limit_of(rows, 0, 1).method);
    const struct bench_limit all = mf_bench_limit_of(rows, 3, 1);
    assert_close(all.time_step, 0.4, 0);
    assert_false(all.is_bounded);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_extrapolation_removes_the_square_of_the_step),
        cmocka_unit_test(test_extrapolation_needs_a_stable_partner_of_its_method),
        cmocka_unit_test(test_row_has_largest_change_and_rms_without_noise),
        cmocka_unit_test(test_noise_alone_has_an_rms_of_0),
        cmocka_unit_test(test_expected_largest_is_that_of_half_normal_numbers),
        cmocka_unit_test(test_limit_lies_on_the_power_law_of_the_errors),
        cmocka_unit_test(test_limit_ends_at_the_first_step_that_is_too_large),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
