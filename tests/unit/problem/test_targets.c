// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/targets.h"

#include "base/rng.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

static const double rounding = 1e-14;

enum { TIMES = 21, BINS = 30, CELLS = TIMES * BINS, BLOCKS = 100, BLOCK_CELLS = 6 };

/// The kinds that are named are those that the list of observables supplies first.
static void test_targets_kinds_are_named_as_the_observables_supply_them(void **state) {
    (void)state;
    static const char *const names[] = {[TARGET_RDF] = "rdf",
                                        [TARGET_ETD] = "etd",
                                        [TARGET_VACF] = "vacf",
                                        [TARGET_MSD] = "msd",
                                        [TARGET_DIFFUSION] = "diffusion",
                                        [TARGET_PRESSURE] = "pressure"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        assert_string_equal(mf_targets_name((int)k), names[k]);
}

static void test_targets_distance_is_the_rms_of_what_both_know(void **state) {
    (void)state;
    const double wanted[] = {1, 2, NAN, 4, 5}, wanted_error[] = {0.3, NAN, 1, 0, 9};
    const double value[] = {2, 0, 7, 5, NAN}, error[] = {0.4, 2, 1, NAN, 9};
    const struct target target = {.count = 5, .value = wanted, .error = wanted_error};
    const struct target_distance distance = mf_targets_distance(&target, value, error);
    assert_int_equal(distance.count, 3);
    assert_close(distance.rms, sqrt((1 + 4 + 1) / 3.0), rounding);
    assert_close(distance.noise, sqrt((0.25 + 4 + 0) / 3.0), rounding);
}

static void test_targets_distance_is_infinite_when_nothing_is_common(void **state) {
    (void)state;
    const double wanted[] = {1, NAN}, value[] = {NAN, 1}, error[] = {0, 0};
    const struct target target = {.count = 2, .value = wanted, .error = error};
    const struct target_distance distance = mf_targets_distance(&target, value, error);
    assert_int_equal(distance.count, 0);
    assert_true(distance.rms > 1e300);
    assert_close(distance.noise, 0, 0);
}

static void test_targets_weight_is_one_over_the_errors_when_none_is_given(void **state) {
    (void)state;
    const double value[] = {1, 2, 3, 4}, error[] = {0.3, 0, NAN, 0.4}, none[4] = {0};
    assert_close(mf_targets_weight(&(struct target){.count = 4, .value = value, .error = error}),
                 1 / sqrt(0.125), rounding);
    assert_close(mf_targets_weight(
                     &(struct target){.count = 4, .value = value, .error = error, .weight = 7}),
                 7, 0);
    // Without any error it is a number all the same.
    assert_close(mf_targets_weight(&(struct target){.count = 4, .value = value, .error = none}),
                 100, 1e-10);
}

static void test_targets_error_is_that_of_a_single_target_as_it_is(void **state) {
    (void)state;
    const double value[] = {1}, error[] = {0.5};
    struct target_distance distance[TARGETS] = {
        [TARGET_MSD] = {3, 0.25, 1, 0}, [TARGET_VACF] = {99, 99, 1, 0}};
    const struct targets targets = {
        .target[TARGET_MSD] = {.count = 1, .value = value, .error = error, .weight = 8}};
    assert_int_equal(mf_targets_count(&targets), 1);
    assert_close(mf_targets_error(&targets, distance), 3, 0);
    assert_close(mf_targets_noise(&targets, distance), 0.25, 0);
}

static void test_targets_error_is_1_at_the_errors_of_several_targets(void **state) {
    (void)state;
    const double value[] = {1, 1}, small[] = {0.01, 0.01}, large[] = {5, 5};
    const struct targets targets = {
        .target[TARGET_RDF] = {.count = 2, .value = value, .error = small, .weight = 0},
        .target[TARGET_DIFFUSION] = {.count = 1, .value = value, .error = large, .weight = 0}};
    struct target_distance distance[TARGETS] = {
        [TARGET_RDF] = {0.01, 0.02, 2, 0}, [TARGET_DIFFUSION] = {5, 10, 1, 0}};
    assert_int_equal(mf_targets_count(&targets), 2);
    assert_close(mf_targets_error(&targets, distance), 1, rounding);
    assert_close(mf_targets_noise(&targets, distance), 2, rounding);
    distance[TARGET_DIFFUSION].rms = INFINITY;
    assert_true(mf_targets_error(&targets, distance) > 1e300);
    struct targets weighted = targets;
    weighted.target[TARGET_RDF].weight = 300;
    weighted.target[TARGET_DIFFUSION].weight = 0.8;
    distance[TARGET_DIFFUSION].rms = 5;
    assert_close(mf_targets_error(&weighted, distance), sqrt(0.5 * (9 + 16)), 1e-12);
}

static void test_targets_own_noise_is_that_which_an_exact_measurement_leaves(void **state) {
    (void)state;
    const double value[] = {1, 2}, small[] = {0.003, 0.004}, large[] = {5, 5}, exact[] = {0, 0};
    struct targets targets = {.target[TARGET_RDF] = {.count = 2, .value = value, .error = small}};
    struct target_distance distance[TARGETS] = {0};
    distance[TARGET_RDF] = mf_targets_distance(&targets.target[TARGET_RDF], value, exact);
    assert_close(mf_targets_own_noise(&targets), mf_targets_noise(&targets, distance), 1e-15);
    assert_close(mf_targets_own_noise(&targets), 0.0025 * sqrt(2), 1e-15);
    targets.target[TARGET_RDF].weight = 300;
    targets.target[TARGET_DIFFUSION] =
        (struct target){.count = 1, .value = value, .error = large, .weight = 0.8};
    distance[TARGET_DIFFUSION] =
        mf_targets_distance(&targets.target[TARGET_DIFFUSION], value, exact);
    assert_close(mf_targets_own_noise(&targets), mf_targets_noise(&targets, distance), 1e-12);
    // Without errors it is a number that simulations can reach.
    const struct targets bare = {
        .target[TARGET_RDF] = {.count = 2, .value = value, .error = exact}};
    assert_close(mf_targets_own_noise(&bare), 0.01, 1e-12);
}

/// E of time and bin; the first time, which is no measurement, would spoil every mean.
static void make_cells(double *value, double *error) {
    for (int t = 0; t < TIMES; t++)
        for (int b = 0; b < BINS; b++) {
            value[t * BINS + b] = t == 0 ? 1e6 : 1.0 / t + 0.01 * b;
            error[t * BINS + b] = 0.1;
        }
}

static struct targets escape_targets(const double *value, const double *error) {
    return (struct targets){
        .etd = {0.5, 1, BINS, TIMES},
        .target[TARGET_ETD] = {.count = CELLS, .value = value, .error = error, .columns = BINS}};
}

static void test_targets_features_are_means_over_ten_by_ten_blocks_of_escape_times(void **state) {
    (void)state;
    double cell[CELLS], cell_error[CELLS], value[BLOCKS], error[BLOCKS];
    make_cells(cell, cell_error);
    const struct targets targets = escape_targets(cell, cell_error);
    assert_int_equal(mf_targets_features(&targets), BLOCKS);
    mf_targets_take_features(&targets, NULL, value, error);
    for (int row = 0; row < 10; row++)
        for (int column = 0; column < 10; column++) {
            // Two times and three bins in each block.
            const double early = 1.0 / (2 * row + 1), late = 1.0 / (2 * row + 2);
            const double expected = 0.5 * (early + late) + 0.01 * (3 * column + 1);
            assert_close(value[row * 10 + column], expected, rounding);
            assert_close(error[row * 10 + column], 0.1, rounding);
        }
}

static void test_targets_features_use_every_cell_once_when_ten_does_not_divide_them(void **state) {
    (void)state;
    enum { FEW_TIMES = 18, FEW_BINS = 7 };
    double cell[FEW_TIMES * FEW_BINS] = {0}, value[BLOCKS];
    const double error[FEW_TIMES * FEW_BINS] = {0};
    const struct targets targets = {
        .etd = {0.5, 1, FEW_BINS, FEW_TIMES},
        .target[TARGET_ETD] = {
            .count = FEW_TIMES * FEW_BINS, .value = cell, .error = error, .columns = FEW_BINS}};
    for (int k = FEW_BINS; k < FEW_TIMES * FEW_BINS; k++) {
        int seen = 0;
        cell[k] = 1;
        mf_targets_take_features(&targets, NULL, value, NULL);
        for (int n = 0; n < BLOCKS; n++)
            seen += value[n] > 0;
        assert_int_equal(seen, 1);
        cell[k] = 0;
    }
}

static void test_targets_features_of_the_target_stand_in_for_what_was_not_measured(void **state) {
    (void)state;
    double cell[CELLS], cell_error[CELLS], seen[CELLS], wanted[BLOCKS], value[BLOCKS];
    make_cells(cell, cell_error);
    cell[BINS] = NAN; // of the first block
    memcpy(seen, cell, sizeof seen);
    seen[BINS] = 1e9;        // the target does not know it
    seen[BINS + 1] = NAN;    // the simulation does not
    seen[2 * BINS + 1] += 5; // a difference
    for (int b = 27; b < BINS; b++)
        seen[BINS + b] = seen[2 * BINS + b] = NAN; // a whole block
    const struct targets targets = escape_targets(cell, cell_error);
    double *observed[TARGETS] = {[TARGET_ETD] = seen};
    mf_targets_take_features(&targets, NULL, wanted, NULL);
    mf_targets_take_features(&targets, observed, value, NULL);
    assert_close(value[0] - wanted[0], 1, 1e-12); // 5 over five cells
    for (int n = 1; n < BLOCKS; n++)
        assert_close(value[n], wanted[n], 0);
}

/// Two groups of one target: blocks hold a 50th of their group, end with it and leave nothing out.
static void test_targets_blocks_hold_a_fiftieth_of_their_group(void **state) {
    (void)state;
    enum { FIRST = 200, SECOND = 30 };
    double value[FIRST + SECOND];
    size_t block[2 * TARGETS_MAX_BLOCKS + 1];
    for (size_t k = 0; k < FIRST + SECOND; k++)
        value[k] = k < FIRST ? exp(-0.5 * pow(((double)k - 80) / 25, 2)) : 1;
    const size_t first = mf_targets_blocks(value, FIRST, 0, block);
    const size_t all = first + mf_targets_blocks(value + FIRST, SECOND, FIRST, block + first);
    block[all] = FIRST + SECOND;
    assert_in_range(first, 30, TARGETS_MAX_BLOCKS);
    assert_int_equal(block[0], 0);
    assert_int_equal(block[first], FIRST);
    // Bins that hold more than a 50th are blocks of one.
    assert_int_equal(all - first, SECOND);
    for (size_t n = 0; n < first; n++) {
        double sum = 0;
        for (size_t k = block[n]; k < block[n + 1]; k++)
            sum += value[k];
        assert_true(sum > 0.0199 * 25 * sqrt(2 * M_PI)); // a tail is cut off
        assert_true(n == 0 || block[n] > block[n - 1]);
    }
}

/// A mean over the target's, whose error is that of independent counts; and what a miss of each bin
/// by the same amount makes of it.
static void test_targets_features_of_distributions_are_shares_of_the_target(void **state) {
    (void)state;
    static const double wanted[] = {0, 1, 3, 4}, error[] = {0, 0.3, 0.4, 1};
    static const size_t block[] = {0, 3, 4};
    double observed[] = {1, 1, 4, 2}, value[2], own[2], variance[2];
    double *const all[TARGETS] = {observed};
    const struct targets targets = {
        .target[0] = {.count = 4, .value = wanted, .error = error, .block = block, .blocks = 2}};
    assert_int_equal(mf_targets_features(&targets), 2);
    mf_targets_take_features(&targets, all, value, NULL);
    assert_close(value[0], 6.0 / 4, rounding);
    assert_close(value[1], 2.0 / 4, rounding);
    mf_targets_take_features(&targets, NULL, value, own);
    assert_close(value[0], 1, rounding);
    assert_close(value[1], 1, rounding);
    assert_close(own[0], 0.5 / 4, rounding);
    assert_close(own[1], 1.0 / 4, rounding);
    mf_targets_spread_error(&targets, 0.2, variance);
    assert_close(variance[0], pow(0.2 * 3 / 4, 2), rounding);
    assert_close(variance[1], pow(0.2 / 4, 2), rounding);
}

static void test_targets_features_are_0_when_the_target_does_not_know(void **state) {
    (void)state;
    const double g[] = {1, NAN, 3}, g_error[] = {0.1, 0.2, NAN}, d[] = {NAN}, d_error[] = {NAN};
    double seen_g[] = {2, 5, NAN}, seen_d[] = {4}, value[4], error[4];
    const struct targets targets = {
        .target[TARGET_RDF] = {.count = 3, .value = g, .error = g_error, .weight = 0},
        .target[TARGET_DIFFUSION] = {.count = 1, .value = d, .error = d_error, .weight = 0}};
    double *observed[TARGETS] = {[TARGET_RDF] = seen_g, [TARGET_DIFFUSION] = seen_d};
    assert_int_equal(mf_targets_features(&targets), 4);
    mf_targets_take_features(&targets, NULL, value, error);
    const double wanted[] = {1, 0, 3, 0}, wanted_error[] = {0.1, 0, 0, 0};
    const double measured[] = {2, 0, 3, 0};
    for (int k = 0; k < 4; k++) {
        assert_close(value[k], wanted[k], 0);
        assert_close(error[k], wanted_error[k], rounding);
    }
    mf_targets_take_features(&targets, observed, value, NULL);
    for (int k = 0; k < 4; k++)
        assert_close(value[k], measured[k], 0);
}

/// A number measured again and again: its distance from the target scatters as the variance says,
/// whatever error the target has.
static void test_targets_variance_is_that_of_repeated_measurements(void **state) {
    (void)state;
    enum { MEASUREMENTS = 4000 };
    static const double wanted = 1, target_error = 7, truth = 1.5, error = 0.1;
    const struct targets targets = {
        .target[TARGET_DIFFUSION] = {
            .count = 1, .value = &wanted, .error = &target_error, .weight = 0}};
    struct rng_sequence random = mf_rng_sequence_begin(3, RNG_INITIAL, 0, 0);
    double mean = 0, square = 0, variance = 0;
    for (int k = 0; k < MEASUREMENTS; k++) {
        // Twelve uniform numbers make a normal one.
        double value = -6;
        for (int n = 0; n < 12; n++)
            value += mf_rng_sequence_uniform(&random);
        value = truth + error * value;
        struct target_distance distance[TARGETS] = {0};
        distance[TARGET_DIFFUSION] =
            mf_targets_distance(&targets.target[TARGET_DIFFUSION], &value, &error);
        const double e = mf_targets_error(&targets, distance);
        mean += e / MEASUREMENTS;
        square += e * e / MEASUREMENTS;
        variance += mf_targets_variance(&targets, distance) / MEASUREMENTS;
    }
    assert_close(variance / (square - mean * mean), 1, 0.1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_targets_kinds_are_named_as_the_observables_supply_them),
        cmocka_unit_test(test_targets_variance_is_that_of_repeated_measurements),
        cmocka_unit_test(test_targets_distance_is_the_rms_of_what_both_know),
        cmocka_unit_test(test_targets_distance_is_infinite_when_nothing_is_common),
        cmocka_unit_test(test_targets_weight_is_one_over_the_errors_when_none_is_given),
        cmocka_unit_test(test_targets_error_is_that_of_a_single_target_as_it_is),
        cmocka_unit_test(test_targets_error_is_1_at_the_errors_of_several_targets),
        cmocka_unit_test(test_targets_own_noise_is_that_which_an_exact_measurement_leaves),
        cmocka_unit_test(test_targets_features_are_means_over_ten_by_ten_blocks_of_escape_times),
        cmocka_unit_test(test_targets_features_use_every_cell_once_when_ten_does_not_divide_them),
        cmocka_unit_test(test_targets_features_of_the_target_stand_in_for_what_was_not_measured),
        cmocka_unit_test(test_targets_blocks_hold_a_fiftieth_of_their_group),
        cmocka_unit_test(test_targets_features_of_distributions_are_shares_of_the_target),
        cmocka_unit_test(test_targets_features_are_0_when_the_target_does_not_know),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
