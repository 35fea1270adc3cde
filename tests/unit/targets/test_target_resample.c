// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/target_resample.h"

#include "base/rng.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

enum { MAX = 400 };
static const double step = 0.03, end = 6;

/// A liquid's g: a steep flank at 1, and oscillations that fade.
static double liquid(double r) {
    return r < 0.5 ? 0
                   : exp(-4 * (pow(r, -12) - pow(r, -6))) *
                         (1 + 1.5 * exp(-r) * cos(2 * acos(-1) * (r - 1.1)));
}

static double normal(uint32_t draw, size_t k) {
    double four[4];
    mf_rng_normal4(mf_rng_philox(5, RNG_PLACEMENT, draw, (uint32_t)k, 0), four);
    return four[0];
}

/// Points at steps that differ by half, with noise.
static void fill(struct target_rows *rows, double noise, uint32_t draw) {
    double r = 0.4;
    *rows = (struct target_rows){.dimensions = 3};
    assert_ok(mf_target_rows_allocate(rows, MAX));
    for (rows->count = 0; r < end && rows->count < MAX; rows->count++) {
        const size_t k = rows->count;
        const double g = liquid(r);
        rows->x[k] = r;
        rows->y[k] = g > 0.01 ? fmax(0, g + noise * normal(2 * draw, k)) : 0;
        rows->line[k] = k + 1;
        r += step * (1 + 0.5 * tanh(normal(2 * draw + 1, k)));
    }
}

static void test_target_resample_is_needed_when_steps_differ(void **state) {
    (void)state;
    struct target_rows rows = {.dimensions = 3};
    assert_ok(mf_target_rows_allocate(&rows, 8));
    for (size_t k = 0; k < rows.count; k++)
        rows.x[k] = 0.1 * (double)k + 0.05;
    assert_false(mf_target_resample_is_needed(&rows));
    rows.x[3] += 0.0005; // rounding
    assert_false(mf_target_resample_is_needed(&rows));
    rows.x[3] += 0.004;
    assert_true(mf_target_resample_is_needed(&rows));
    mf_target_rows_clear(&rows);
}

/// Without noise the liquid's curve comes back, at steps that a person takes.
static void test_target_resample_gives_the_curve_back(void **state) {
    (void)state;
    struct target_rows rows;
    struct target_resampling done;
    fill(&rows, 0, 1);
    const size_t points = rows.count;
    assert_ok(mf_target_resample(&rows, "g.csv", false, 0.002, &done));
    assert_int_equal(done.points, points);
    assert_true(done.shortest < 0.7 * step && done.longest > 1.3 * step);
    assert_in_range(rows.count, points - 2, points + 1);
    for (size_t k = 0; k < rows.count; k++) {
        assert_close(rows.y[k], liquid(rows.x[k]), 0.006 + rows.error[k]);
        if (k > 0)
            assert_close(rows.x[k] - rows.x[k - 1], rows.x[1] - rows.x[0], 1e-9);
    }
    mf_target_rows_clear(&rows);
}

/// Noise that is known is found, and the curve is as far off as the errors say: over twenty draws
/// the mean square over its variance is about 1, or less where points are averaged.
static void test_target_resample_knows_how_noisy_it_is(void **state) {
    (void)state;
    enum { DRAWS = 20 };
    static const double noise = 0.02;
    double found = 0, square = 0, count = 0;
    for (uint32_t draw = 0; draw < DRAWS; draw++) {
        struct target_rows rows;
        struct target_resampling done;
        fill(&rows, noise, draw);
        assert_ok(mf_target_resample(&rows, "g.csv", false, 0.002, &done));
        found += done.error / noise / DRAWS;
        for (size_t k = 0; k < rows.count; k++)
            if (rows.y[k] > 0.3) {
                square += pow((rows.y[k] - liquid(rows.x[k])) / rows.error[k], 2);
                count++;
            }
        mf_target_rows_clear(&rows);
    }
    print_message("error %.3f of the noise, mean square %.3f\n", found, square / count);
    assert_close(found, 1, 0.1);
    assert_true(square / count > 0.5 && square / count < 1.1);
}

/// A hand that is off in r, too, makes more noise where g is steep.
static void test_target_resample_knows_noise_in_r(void **state) {
    (void)state;
    enum { DRAWS = 20 };
    static const double noise = 0.005, noise_in_r = 0.004;
    double found = 0, found_in_r = 0, square = 0, count = 0;
    for (uint32_t draw = 0; draw < DRAWS; draw++) {
        struct target_rows rows;
        struct target_resampling done;
        fill(&rows, noise, draw);
        for (size_t k = 0; k < rows.count; k++)
            rows.x[k] += noise_in_r * normal(100 + draw, k);
        assert_ok(mf_target_resample(&rows, "g.csv", false, 0.002, &done));
        found += done.error / noise / DRAWS;
        found_in_r += done.error_in_r / noise_in_r / DRAWS;
        for (size_t k = 0; k < rows.count; k++)
            if (rows.y[k] > 0.3) {
                square += pow((rows.y[k] - liquid(rows.x[k])) / rows.error[k], 2);
                count++;
            }
        mf_target_rows_clear(&rows);
    }
    print_message("errors %.3f and %.3f of the noise, mean square %.3f\n", found, found_in_r,
                  square / count);
    assert_close(found_in_r, 1, 0.3);
    assert_true(square / count > 0.4 && square / count < 1.2);
}

/// What lies between points is no new information: where they are four times farther apart, rows
/// know four times less, and no fit gains by interpolation.
static void test_target_resample_makes_no_information(void **state) {
    (void)state;
    struct target_rows rows;
    struct target_resampling done;
    fill(&rows, 0.02, 3);
    size_t kept = 0;
    for (size_t k = 0; k < rows.count; k++) // every third point from 3 on
        if (rows.x[k] < 3 || k % 3 == 0) {
            rows.x[kept] = rows.x[k];
            rows.y[kept++] = rows.y[k];
        }
    rows.count = kept;
    size_t points = 0;
    for (size_t k = 0; k < kept; k++)
        points += rows.x[k] > 3.2;
    assert_ok(mf_target_resample(&rows, "g.csv", false, 0.002, &done));
    double information = 0, bins = 0;
    for (size_t k = 0; k < rows.count; k++)
        if (rows.x[k] > 3.2) {
            information += pow(done.error / rows.error[k], 2);
            bins++;
        }
    print_message("%zu points, %.0f rows that know as much as %.1f\n", points, bins, information);
    assert_true(bins > 1.5 * (double)points);
    assert_true(information < 1.1 * (double)points && information > 0.5 * (double)points);
    mf_target_rows_clear(&rows);
}

static void test_target_resample_keeps_errors_that_are_given(void **state) {
    (void)state;
    struct target_rows rows;
    struct target_resampling done;
    fill(&rows, 0, 4);
    for (size_t k = 0; k < rows.count; k++)
        rows.error[k] = 0.05;
    assert_ok(mf_target_resample(&rows, "g.csv", true, 0.002, &done));
    assert_close(done.error, 0, 0);
    for (size_t k = 0; k < rows.count; k++)
        if (rows.y[k] > 0.3)
            assert_true(rows.error[k] >= 0.0499 && rows.error[k] < 0.07);
    mf_target_rows_clear(&rows);
}

static void test_target_resample_names_the_line_behind_a_gap(void **state) {
    (void)state;
    struct target_rows rows;
    struct target_resampling done;
    fill(&rows, 0, 5);
    const size_t line = 60;
    for (size_t k = line - 1; k + 8 < rows.count; k++) {
        rows.x[k] = rows.x[k + 8];
        rows.y[k] = rows.y[k + 8];
    }
    rows.count -= 8;
    assert_fails(mf_target_resample(&rows, "g.csv", false, 0.002, &done), STATUS_BAD_INPUT,
                 "g.csv:60: a gap in r of ");
    assert_contains(mf_status_message(), "or end the target before it by \"cutoff\"");
    mf_target_rows_clear(&rows);
}

/// Points on the same place, as a hand that clicks twice makes them.
static void test_target_resample_takes_points_that_nearly_coincide(void **state) {
    (void)state;
    struct target_rows rows;
    struct target_resampling done;
    fill(&rows, 0, 6);
    for (size_t k = 40; k < 44; k++) {
        rows.x[k] = rows.x[40] + 1e-7 * (double)(k - 40);
        rows.y[k] = rows.y[40] + 0.01 * ((double)(k - 40) - 1.5);
    }
    assert_ok(mf_target_resample(&rows, "g.csv", false, 0.002, &done));
    for (size_t k = 0; k < rows.count; k++)
        assert_close(rows.y[k], liquid(rows.x[k]), 0.03);
    mf_target_rows_clear(&rows);
    fill(&rows, 0, 7);
    rows.count = 6;
    for (size_t k = 0; k < 6; k++)
        rows.x[k] = k < 5 ? 1 + 1e-9 * (double)k : 2;
    assert_fails(mf_target_resample(&rows, "g.csv", false, 0.002, &done), STATUS_BAD_INPUT,
                 "g.csv: only 2 points at different r");
    mf_target_rows_clear(&rows);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_target_resample_is_needed_when_steps_differ),
        cmocka_unit_test(test_target_resample_gives_the_curve_back),
        cmocka_unit_test(test_target_resample_knows_how_noisy_it_is),
        cmocka_unit_test(test_target_resample_knows_noise_in_r),
        cmocka_unit_test(test_target_resample_makes_no_information),
        cmocka_unit_test(test_target_resample_keeps_errors_that_are_given),
        cmocka_unit_test(test_target_resample_names_the_line_behind_a_gap),
        cmocka_unit_test(test_target_resample_takes_points_that_nearly_coincide),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
