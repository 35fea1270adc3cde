// SPDX-License-Identifier: GPL-3.0-or-later
//
// Power and false alarms of mf_equilibration_drift, of series whose truth is known:
// x_t = r x_{t−1} + noise with a variance of 1, and a way or a step of known size. A share p of n
// series has an error of sqrt(p (1 − p)/n); bounds are five of them off what long runs have.
#include "base/rng.h"
#include "observe/equilibration.h"
#include "shared/length.h"

#include <math.h>
#include <stdlib.h>

enum { MAX_SAMPLES = 1000 };

enum shape { NOTHING, LINE, LATE_STEP };

static double value_at(enum shape shape, double share) {
    return shape == LINE ? share : shape == LATE_STEP && share > 0.6 ? 1 : 0;
}

/// With a memory of `memory` samples; the first value is the stationary one.
static void make_series(double *x, uint32_t samples, double memory, enum shape shape, double size,
                        uint32_t number) {
    const double r = memory > 0 ? exp(-1 / memory) : 0;
    double last = 0;
    for (uint32_t t = 0; t < samples; t++) {
        double normal[4];
        mf_rng_normal4(mf_rng_philox(17, RNG_INITIAL, t, number, 0), normal);
        last = t == 0 ? normal[0] : r * last + sqrt(1 - r * r) * normal[0];
        x[t] = last + size * value_at(shape, (double)t / samples);
    }
}

static bool drifts(const double *x, size_t samples) {
    const struct equilibration_drift is = mf_equilibration_drift(x, samples);
    return equilibration_drifts(&is, 1);
}

static double share_found(uint32_t samples, double memory, enum shape shape, double size,
                          uint32_t series) {
    double x[MAX_SAMPLES];
    int found = 0;
    for (uint32_t n = 0; n < series; n++) {
        make_series(x, samples, memory, shape, size, n);
        found += drifts(x, samples);
    }
    return (double)found / series;
}

/// Samples of a series in its short and its long form.
static const uint32_t lengths[] = {400, 1000};

static int count_lengths(void) {
    return length_is_long() ? 2 : 1;
}

/// Of 20000 series 0.0000, 0.0001, 0.0003 and 0.008 are told.
static void test_equilibration_drift_is_quiet_about_stationary_series(void **state) {
    (void)state;
    const uint32_t series = length_is_long() ? 20000 : 1000;
    for (int k = 0; k < count_lengths(); k++) {
        const double n = lengths[k], memory[] = {0, 2, n / 50, n / 20};
        print_message("%.0f samples, false alarms", n);
        for (int m = 0; m < 4; m++) {
            const double share = share_found(lengths[k], memory[m], NOTHING, 0, series);
            const double most = m == 3 ? 0.01 : 0.001;
            print_message("  memory %.0f: %.5f", memory[m], share);
            assert_true(share <= most + 2 * sqrt(most / series));
        }
        print_message("\n");
    }
}

/// At least so many are found of 1, 2, 4, 8, 16 standard deviations.
struct power {
    double memory; ///< of 400 samples
    enum shape shape;
    double least[5];
};

static void test_equilibration_drift_sees_more_the_stronger_it_is(void **state) {
    (void)state;
    static const struct power powers[] = {
        {0, LINE, {0.95, 0.99, 1, 1, 1}},     {0, LATE_STEP, {0.98, 0.99, 1, 1, 1}},
        {8, LINE, {0, 0.02, 0.5, 0.98, 1}},   {8, LATE_STEP, {0, 0.2, 0.93, 1, 1}},
        {20, LINE, {0, 0.05, 0.45, 0.95, 1}}, {20, LATE_STEP, {0, 0.15, 0.85, 0.99, 1}},
    };
    const uint32_t series = length_is_long() ? 2000 : 300;
    for (int k = 0; k < count_lengths(); k++)
        for (size_t p = 0; p < sizeof powers / sizeof *powers; p++) {
            const struct power *is = &powers[p];
            const double memory = is->memory * lengths[k] / 400;
            double before = 0;
            print_message("%u samples, memory %.0f, %s", lengths[k], memory,
                          is->shape == LINE ? "line" : "step at 60 %");
            for (int n = 0; n < 5; n++) {
                const double share = share_found(lengths[k], memory, is->shape, 1 << n, series);
                print_message("  %d: %.3f", 1 << n, share);
                assert_true(share >= is->least[n] && share >= before);
                before = share;
            }
            print_message("\n");
        }
}

/// Eighty frames, as a user may have them: a way of 4 and a step of 3 deviations are drift among
/// thirty series.
static void test_equilibration_drift_sees_ways_of_few_samples(void **state) {
    (void)state;
    enum { SAMPLES = 80, SERIES = 30, TRIALS = 300 };
    int lines = 0, steps = 0;
    for (uint32_t n = 0; n < TRIALS; n++) {
        double x[MAX_SAMPLES];
        make_series(x, SAMPLES, 0, LINE, 4, n);
        const struct equilibration_drift line = mf_equilibration_drift(x, SAMPLES);
        make_series(x, SAMPLES, 0, LATE_STEP, 3, n);
        const struct equilibration_drift step = mf_equilibration_drift(x, SAMPLES);
        lines += equilibration_drifts(&line, SERIES);
        steps += equilibration_drifts(&step, SERIES);
    }
    print_message("of %d: lines %d, steps %d\n", TRIALS, lines, steps);
    assert_true(lines > 0.85 * TRIALS && steps > 0.9 * TRIALS);
}

/// Thirty series together, all with a memory of a twentieth of their length: one in a hundred
/// trajectories is told by mistake, and those of which one goes a way of 16 deviations by its
/// drift.
static void test_equilibration_drift_of_many_series_is_as_quiet(void **state) {
    (void)state;
    enum { SERIES = 30 };
    const int trials = length_is_long() ? 2000 : 100;
    int alarms = 0, found = 0;
    for (int n = 0; n < trials; n++) {
        struct equilibration_drift most = {0}, way;
        double x[MAX_SAMPLES];
        for (int k = 0; k < SERIES; k++) {
            make_series(x, 400, 20, NOTHING, 0, (uint32_t)(n * SERIES + k));
            const struct equilibration_drift is = mf_equilibration_drift(x, 400);
            most = is.evidence > most.evidence ? is : most;
        }
        make_series(x, 400, 20, LINE, 16, (uint32_t)n);
        way = mf_equilibration_drift(x, 400);
        alarms += equilibration_drifts(&most, SERIES);
        found += equilibration_drifts(&way, SERIES);
    }
    print_message("30 series: alarms %g, found %g\n", (double)alarms / trials,
                  (double)found / trials);
    assert_true(alarms <= trials / 100 + 2 * sqrt(trials / 100.0));
    assert_true(found >= 0.9 * trials);
}

/// Where the step is, and what is before and after it; the mean of 240 samples is known to 0.065.
static void test_equilibration_drift_tells_where_and_how_far(void **state) {
    (void)state;
    double x[MAX_SAMPLES];
    make_series(x, 400, 0, LATE_STEP, 10, 1);
    const struct equilibration_drift is = mf_equilibration_drift(x, 400);
    assert_true(equilibration_drifts(&is, 1000));
    assert_true(fabs(is.part - 0.6) < 1e-12);
    assert_true(fabs(is.before) < 0.3 && fabs(is.after - 10) < 0.4);
    assert_true(is.before_error > 0.03 && is.before_error < 0.13);
    assert_true(is.after_error > 0.04 && is.after_error < 0.16);
}

/// Without noise, too; what is constant within the digits of a file does not drift, nor do 19.
static void test_equilibration_drift_of_lines_and_constants(void **state) {
    (void)state;
    double x[MAX_SAMPLES];
    for (int t = 0; t < 400; t++)
        x[t] = 3 + t;
    assert_true(drifts(x, 400));
    assert_false(drifts(x, 19));
    for (int t = 0; t < 400; t++)
        x[t] = t < 240 ? 1 : 2;
    assert_true(drifts(x, 400));
    for (int t = 0; t < 400; t++)
        x[t] = 27 + 1e-8 * t;
    assert_false(drifts(x, 400));
    for (int t = 0; t < 400; t++)
        x[t] = 0;
    assert_false(drifts(x, 400));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_equilibration_drift_is_quiet_about_stationary_series),
        cmocka_unit_test(test_equilibration_drift_sees_more_the_stronger_it_is),
        cmocka_unit_test(test_equilibration_drift_sees_ways_of_few_samples),
        cmocka_unit_test(test_equilibration_drift_of_many_series_is_as_quiet),
        cmocka_unit_test(test_equilibration_drift_tells_where_and_how_far),
        cmocka_unit_test(test_equilibration_drift_of_lines_and_constants),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
