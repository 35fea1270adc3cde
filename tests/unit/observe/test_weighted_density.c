// SPDX-License-Identifier: GPL-3.0-or-later
//
// Weighted densities around particles: those of a lattice, all alike; those of all pairs, image by
// image; and of an ideal gas the mean and variance of its theory.
#include "base/rng.h"
#include "base/statistics.h"
#include "observe/measure.h"
#include "observe/weighted_density.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"
#include "shared/told.h"

#include <math.h>

/// Sanyal and Shell's polynomial as they wrote it, c_0 + c_2 r² + c_4 r⁴ + c_6 r⁶.
static double weight_of(double inner, double cutoff, double r) {
    const double x = inner * inner / (cutoff * cutoff), below = pow(1 - x, 3);
    if (r <= inner)
        return 1;
    return r >= cutoff ? 0
                       : (1 - 3 * x) / below + 6 * x / (cutoff * cutoff * below) * r * r -
                             3 * (1 + x) / (pow(cutoff, 4) * below) * pow(r, 4) +
                             2 / (pow(cutoff, 6) * below) * pow(r, 6);
}

static void test_weight_is_that_of_sanyal_and_shell(void **state) {
    (void)state;
    const struct weighted_density_settings settings = {.inner_cutoff = 0.8, .cutoff = 2};
    for (double r = 0; r < 2.5; r += 0.01)
        assert_close(weighted_density_weight(&settings, r * r), weight_of(0.8, 2, r), 1e-12);
}

/// Sample one configuration of a simulation that does not move.
static struct weighted_density_summary sample(const struct simulation_setup *setup,
                                              const struct weighted_density_settings *settings) {
    static struct simulation simulation;
    const struct measure_plan plan = {.samples = 1, .every = 1};
    void *const state = mf_memory_zeroed(1, mf_weighted_density.state_size);
    assert_ok(mf_simulation_init(&simulation, setup, NULL));
    assert_ok(told_begin(&mf_weighted_density, state, settings, &simulation, &plan));
    assert_ok(told_sample(&mf_weighted_density, state, &simulation));
    const struct weighted_density_summary found = mf_weighted_density_result(state);
    mf_weighted_density.clear(state);
    mf_memory_free(state);
    mf_simulation_clear(&simulation);
    return found;
}

/// A simple cubic lattice of spacing 1: 6 neighbours at 1, 12 at √2, 8 at √3.
static void test_lattice_has_one_density(void **state) {
    (void)state;
    struct fluid fluid;
    const struct weighted_density_settings settings = {0.9, 1.8, 50, 0};
    const double expected = 6 * weight_of(0.9, 1.8, 1) + 12 * weight_of(0.9, 1.8, sqrt(2)) +
                            8 * weight_of(0.9, 1.8, sqrt(3));
    fluid_ideal_gas(&fluid, 3, 216, 0.01);
    fluid.setup.box = (struct box){3, {6, 6, 6}};
    fluid.setup.placement = (struct placement){.count = 216, .kind = PLACEMENT_LATTICE};
    const struct weighted_density_summary found = sample(&fluid.setup, &settings);
    assert_close(found.mean, expected, 1e-5);
    assert_close(found.variance, 0, 1e-4);
    assert_true(found.beyond == 0);
    fluid_clear(&fluid);
}

/// Of N points at random the numbers of others near one are those of N − 1 throws: n = (N − 1)/V,
/// mean n ∫w dV, variance n ∫w² dV − n (∫w dV)²/V, of which the last is that the box is closed.
static void check_gas(int dimensions, int64_t count) {
    enum { SEEDS = 60 };
    const struct weighted_density_settings settings = {0.4, 1.3, 100, 0};
    struct fluid fluid;
    struct running_mean mean = {0}, variance = {0};
    double first = 0, second = 0;
    fluid_ideal_gas(&fluid, dimensions, count, 0.01);
    const double density = (double)(count - 1) / mf_box_volume(&fluid.setup.box);
    for (int k = 0; k < 2000; k++) {
        const double r = 1.3 * (k + 0.5) / 2000, weight = weight_of(0.4, 1.3, r);
        const double shell =
            (dimensions == 3 ? 4 * M_PI * r * r : 2 * M_PI * r) * density * 1.3 / 2000;
        first += shell * weight;
        second += shell * weight * weight;
    }
    second -= first * first / (double)(count - 1);
    for (uint64_t seed = 1; seed <= SEEDS; seed++) {
        fluid.setup.seed = seed;
        const struct weighted_density_summary found = sample(&fluid.setup, &settings);
        mf_statistics_add(&mean, found.mean);
        mf_statistics_add(&variance, found.variance);
    }
    const double error = mf_statistics_standard_error(&mean);
    const double variance_error = mf_statistics_standard_error(&variance);
    print_message("mean %.4f(%.4f), expected %.4f; variance %.4f(%.4f), expected %.4f\n", mean.mean,
                  error, first, variance.mean, variance_error, second);
    assert_true(error < 0.01 * first && variance_error < 0.08 * second);
    assert_close(mean.mean, first, 4 * error);
    assert_close(variance.mean, second, 4 * variance_error);
    fluid_clear(&fluid);
}

static void test_ideal_gas_has_the_mean_and_variance_of_poisson(void **state) {
    (void)state;
    check_gas(3, 1500);
    check_gas(2, 300);
}

/// Numbers with a memory of four samples, the same for all particles of a sample: the errors of
/// the mean and of the bins are those of the scatter of many such series.
static void test_errors_see_correlation(void **state) {
    (void)state;
    enum { SERIES = 60, SAMPLES = 400, COUNT = 4, BINS = 10 };
    const struct weighted_density_settings settings = {0.5, 1, BINS, 10};
    const struct box box = {3, {5, 5, 5}};
    struct running_mean mean = {0}, told = {0}, bin = {0}, bin_told = {0};
    for (uint32_t n = 0; n < SERIES; n++) {
        struct rng_sequence sequence = mf_rng_sequence_begin(7, RNG_PLACEMENT, n, 0);
        struct weighted_density density;
        double level = 0, error;
        assert_ok(mf_weighted_density_init(&density, &settings, &box, COUNT, SAMPLES));
        for (int k = 0; k < SAMPLES; k++) {
            double values[COUNT];
            if (k % 4 == 0)
                level = 10 * mf_rng_sequence_uniform(&sequence);
            for (int j = 0; j < COUNT; j++)
                values[j] = level;
            assert_ok(mf_weighted_density_add(&density, values, COUNT));
        }
        const struct weighted_density_summary found = mf_weighted_density_result(&density);
        mf_statistics_add(&mean, found.mean);
        mf_statistics_add(&told, found.mean_error * found.mean_error);
        mf_statistics_add(&bin, mf_weighted_density_at(&density, 4.5, &error));
        mf_statistics_add(&bin_told, error * error);
        mf_weighted_density_clear(&density);
    }
    const double variance = mean.squares / (SERIES - 1), bin_variance = bin.squares / (SERIES - 1);
    assert_close(mean.mean, 5, 4 * sqrt(variance / SERIES));
    assert_close(bin.mean, 0.1, 4 * sqrt(bin_variance / SERIES));
    assert_true(told.mean > 0.6 * variance && told.mean < 1.6 * variance);
    assert_true(bin_told.mean > 0.6 * bin_variance && bin_told.mean < 1.6 * bin_variance);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_weight_is_that_of_sanyal_and_shell),
        cmocka_unit_test(test_lattice_has_one_density),
        cmocka_unit_test(test_ideal_gas_has_the_mean_and_variance_of_poisson),
        cmocka_unit_test(test_errors_see_correlation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
