// SPDX-License-Identifier: GPL-3.0-or-later
//
// Profiles that are known: a slab's densities and width come back, and what is no slab is none.
#include "base/rng.h"
#include "observe/slab_fit.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

enum { BINS = 200 };
static const double length = 40, area = 64;

static double place(size_t k) {
    return length * (((double)k + 0.5) / BINS - 0.5);
}

/// An error function, whose value goes from 10 to 90 % within 2.563 of its standard deviations,
/// where a capillary wave's profile has it: thin plateaus are those of the liquid and the vapour,
/// whatever the curve between them is.
static void test_slab_has_its_densities_and_width_when_its_interface_is_no_tanh(void **state) {
    (void)state;
    static const double liquid = 0.75, vapour = 0.012, half = 8, deviation = 1.1;
    double density[BINS];
    for (size_t k = 0; k < BINS; k++)
        density[k] = vapour + 0.5 * (liquid - vapour) *
                                  erfc((fabs(place(k)) - half) / (deviation * sqrt(2)));
    const struct slab_fit fit = mf_slab_fit(density, BINS, length, NULL);
    assert_close(fit.liquid, liquid, 1e-3);
    assert_close(fit.vapour, vapour, 1e-4);
    assert_close(fit.place, half, 5e-3);
    assert_close(fit.width, 2 * 1.2816 * deviation, 0.03 * 2 * 1.2816 * deviation);
    assert_true(mf_slab_fit_is_slab(&fit, length, area * length, 1000));
    for (size_t k = 0; k < BINS; k++)
        assert_close(mf_slab_fit_value(&fit, place(k)), density[k], 0.02);
    // With a bubble in the place of the slab there are plateaus, too, and the step is negative.
    for (size_t k = 0; k < BINS; k++)
        density[k] = liquid + vapour - density[k];
    const struct slab_fit bubble = mf_slab_fit(density, BINS, length, NULL);
    assert_false(mf_slab_fit_is_slab(&bubble, length, area * length, 1000));
}

/// Whatever a fluid without an interface has, each configuration about its own middle: the longest
/// wave.
static void test_wave_is_no_slab(void **state) {
    (void)state;
    double density[BINS];
    for (size_t k = 0; k < BINS; k++)
        density[k] = 0.3 * (1 + 0.9 * cos(2 * M_PI * place(k) / length));
    const struct slab_fit fit = mf_slab_fit(density, BINS, length, NULL);
    assert_false(mf_slab_fit_is_slab(&fit, length, area * length, 1000));
}

/// Particles at random in one configuration, or none at all: the best fit is any step of the noise.
static void test_noise_is_no_slab(void **state) {
    (void)state;
    enum { PARTICLES = 1000, TRIALS = 100 };
    double density[BINS] = {0};
    const struct slab_fit empty = mf_slab_fit(density, BINS, length, NULL);
    assert_false(mf_slab_fit_is_slab(&empty, length, area * length, 0));
    for (uint32_t trial = 0; trial < TRIALS; trial++) {
        struct rng_sequence sequence = mf_rng_sequence_begin(3, RNG_PLACEMENT, trial, 0);
        for (size_t k = 0; k < BINS; k++)
            density[k] = 0;
        for (int n = 0; n < PARTICLES; n++)
            density[(size_t)(mf_rng_sequence_uniform(&sequence) * BINS)] += BINS / (area * length);
        const struct slab_fit fit = mf_slab_fit(density, BINS, length, NULL);
        assert_false(mf_slab_fit_is_slab(&fit, length, area * length, PARTICLES));
    }
}

/// A density for each bead in a layer, smooth at its ends.
static double layer(double z, double from, double to) {
    return 0.5 * (tanh((z - from) / 0.6) - tanh((z - to) / 0.6));
}

enum { BLOCKS = 20 };

/// Whether the blocks of a profile, each of beads at random by it, show a slab.
/// @param[in] count  of blocks, one configuration each
static bool is_slab(const double *density, size_t count, uint32_t trial) {
    enum { LARGEST = 100 };
    double sums[BLOCKS][BINS] = {{0}}, mean[BINS] = {0}, ones[BLOCKS];
    struct rng_sequence sequence = mf_rng_sequence_begin(3, RNG_PLACEMENT, trial, 1);
    for (size_t b = 0; b < count; b++) {
        ones[b] = 1;
        for (size_t k = 0; k < BINS; k++) {
            const double volume = area * length / BINS;
            for (int n = 0; n < LARGEST; n++)
                sums[b][k] += mf_rng_sequence_uniform(&sequence) < density[k] * volume / LARGEST
                                  ? 1 / volume
                                  : 0;
            mean[k] += sums[b][k] / (double)count;
        }
    }
    const struct slab_fit fit = mf_slab_fit(mean, BINS, length, NULL);
    const struct slab_blocks blocks = {sums[0], ones, count, BINS};
    return mf_slab_fit_is_slab(&fit, length, area * length, 1000) &&
           mf_slab_fit_rises_once(&fit, &blocks, BINS, length, area * length);
}

/// One slab is one, of a cold liquid and of one near its critical point, in one configuration and
/// in many; two, beside each other or half a box apart, are not, nor is one with a cavity in its
/// middle or beside it.
static void test_two_slabs_and_one_with_a_hole_are_none(void **state) {
    (void)state;
    enum { TRIALS = 10 };
    double one[BINS], near_critical[BINS], two[BINS], apart[BINS], hole[BINS], aside[BINS];
    for (size_t k = 0; k < BINS; k++) {
        const double z = place(k);
        one[k] = 0.002 + 0.72 * layer(z, -8, 8);
        near_critical[k] = 0.2 + 0.2 * layer(z, -8, 8);
        two[k] = 0.008 + 0.71 * (layer(z, -12, -5) + layer(z, 5, 12));
        apart[k] = 0.008 + 0.71 * (layer(z, -6, 6) + layer(z, 16, 40) + layer(z, -40, -16));
        hole[k] = 0.002 + 0.72 * (layer(z, -10, -2) + layer(z, 2, 10));
        aside[k] = 0.002 + 0.72 * (layer(z, -10, 3) + layer(z, 6, 10));
    }
    for (uint32_t trial = 0; trial < TRIALS; trial++) {
        for (size_t count = 1; count <= BLOCKS; count += BLOCKS - 1) {
            assert_true(is_slab(one, count, trial));
            assert_true(is_slab(near_critical, count, trial));
        }
        assert_false(is_slab(two, BLOCKS, trial));
        assert_false(is_slab(apart, BLOCKS, trial));
        assert_false(is_slab(hole, BLOCKS, trial));
        assert_false(is_slab(aside, BLOCKS, trial));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_slab_has_its_densities_and_width_when_its_interface_is_no_tanh),
        cmocka_unit_test(test_wave_is_no_slab),
        cmocka_unit_test(test_noise_is_no_slab),
        cmocka_unit_test(test_two_slabs_and_one_with_a_hole_are_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
