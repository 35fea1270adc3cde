// SPDX-License-Identifier: GPL-3.0-or-later
#include "inverse/inversion_band.h"

#include "base/rng.h"
#include "base/statistics.h"
#include "inverse/imc_solve.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>

enum { SIZE = 16, TRIALS = 2000 };

static const double temperature = 1.5, spacing = 0.1;

static void make_counts(double counts[SIZE][SIZE]) {
    for (int a = 0; a < SIZE; a++)
        for (int b = 0; b < SIZE; b++)
            counts[a][b] = (10 + a) * (10 + b) * exp(-abs(a - b) / 1.5) * 0.1;
}

/// Standard deviations of 2000 trials are known to 1.6 %: five of these for 16 bins are a false
/// alarm in 10^5 seeds.
static const double scatter_tolerance = 0.08;

static void test_inversion_band_is_the_scatter_when_the_data_say_all(void **state) {
    (void)state;
    double counts[SIZE][SIZE], variance[SIZE], covariance[SIZE * SIZE], directions;
    struct running_mean scatter[SIZE] = {{0}};
    make_counts(counts);
    for (int k = 0; k < SIZE; k++)
        variance[k] = 0.02 + 0.005 * k;
    const struct imc_system response = {.size = SIZE,
                                        .covariance = &counts[0][0],
                                        .variance = variance,
                                        .temperature = temperature,
                                        .spacing = spacing};
    assert_ok(inversion_band_covariance(&response, covariance, &directions));
    for (uint32_t trial = 0; trial < TRIALS; trial++) {
        double excess[SIZE], x[SIZE];
        struct imc_solution solution;
        for (int a = 0; a < SIZE; a++) {
            double normal[4];
            rng_normal4(rng_philox(22, RNG_INITIAL, trial, (uint32_t)a, 0), normal);
            excess[a] = sqrt(variance[a]) * normal[0];
        }
        struct imc_system system = response;
        system.excess = excess;
        assert_ok(imc_solve(&system, 1e-9, x, &solution));
        for (int k = 0; k < SIZE; k++)
            statistics_add(&scatter[k], x[k]);
    }
    for (int k = 0; k < SIZE; k++)
        assert_close_relative(sqrt(covariance[k * SIZE + k]),
                              sqrt(scatter[k].squares / (TRIALS - 1)), scatter_tolerance);
    assert_close(directions, SIZE, 0.1);
}

static void test_inversion_band_is_the_prior_when_the_data_say_nothing(void **state) {
    (void)state;
    double counts[SIZE][SIZE] = {{0}}, variance[SIZE], covariance[SIZE * SIZE], directions;
    for (int k = 0; k < SIZE; k++)
        variance[k] = 1;
    const struct imc_system response = {.size = SIZE,
                                        .covariance = &counts[0][0],
                                        .variance = variance,
                                        .temperature = temperature,
                                        .spacing = spacing};
    assert_ok(inversion_band_covariance(&response, covariance, &directions));
    assert_close(directions, 0, 1e-12);
    // One number has the ridge alone: 10 k_B T of it, spread over the whole curve; the last bin,
    // half a spacing from the end, is held by its bend.
    assert_true(sqrt(covariance[0]) > 5 * temperature && sqrt(covariance[0]) < 10 * temperature);
    assert_true(sqrt(covariance[SIZE * SIZE - 1]) < temperature);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_inversion_band_is_the_scatter_when_the_data_say_all),
        cmocka_unit_test(test_inversion_band_is_the_prior_when_the_data_say_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
