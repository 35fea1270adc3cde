// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/rng.h"
#include "observe/maxwell.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

enum { PARTICLES = 200, TRIALS = 1000 };

static const struct box cube = {3, {5, 5, 5}};

/// The table of critical values: N. Smirnov, Ann. Math. Stat. 19, 279 (1948).
static void test_maxwell_probability_is_that_of_tables(void **state) {
    (void)state;
    const double n = 1e12, root = 1e6;
    assert_close(mf_maxwell_probability(0.828 / root, n), 0.4994, 0.0002);
    assert_close(mf_maxwell_probability(1.224 / root, n), 0.1000, 0.0002);
    assert_close(mf_maxwell_probability(1.358 / root, n), 0.0500, 0.0001);
    assert_close(mf_maxwell_probability(1.628 / root, n), 0.0100, 0.0001);
    assert_close(mf_maxwell_probability(0, n), 1, 0);
    assert_close(mf_maxwell_probability(0.1 / root, n), 1, 1e-12);
    // Both series, where they meet.
    assert_close(mf_maxwell_probability(0.999999 / root, n),
                 mf_maxwell_probability(1.000001 / root, n), 1e-5);
    // Ten numbers: the exact critical value at 5 % is 0.409.
    assert_close(mf_maxwell_probability(0.409, 10), 0.05, 0.002);
}

static double test_velocities(double drawn_at, double tested_at, uint64_t seed) {
    struct particles particles;
    struct maxwell maxwell;
    assert_ok(mf_particles_init(&particles, &cube, PARTICLES));
    assert_ok(mf_maxwell_init(&maxwell, 3));
    for (uint64_t step = 0; step < 3; step++) {
        mf_particles_draw_velocities(&particles, PARTICLES_MAXWELL, drawn_at,
                                     mf_rng_child_seed(seed, RNG_INITIAL, 1, (uint32_t)step));
        mf_maxwell_sample(&maxwell, &particles, tested_at, seed, step);
    }
    const struct maxwell_summary s = mf_maxwell_result(&maxwell);
    assert_identical(s.numbers, 3.0 * 3 * PARTICLES);
    mf_maxwell_clear(&maxwell);
    mf_particles_clear(&particles);
    return s.probability;
}

/// The velocities have momentum 0, as those of a simulation: without the drawn mean the shares are
/// 0.149, 0 and 0. Their standard errors for 1000 trials are 0.016, 0.007 and 0.003; five of each
/// are a false alarm in 2 of 10^6 seeds.
static void test_maxwell_p_values_are_uniform_when_velocities_are_of_maxwell(void **state) {
    (void)state;
    double half = 0, twentieth = 0, hundredth = 0;
    for (uint64_t trial = 0; trial < TRIALS; trial++) {
        const double p = test_velocities(2, 2, 100 + trial);
        half += p < 0.5;
        twentieth += p < 0.05;
        hundredth += p < 0.01;
    }
    print_message("p below 0.5, 0.05, 0.01: %.1f, %.1f, %.1f %%\n", 100 * half / TRIALS,
                  100 * twentieth / TRIALS, 100 * hundredth / TRIALS);
    assert_close(half / TRIALS, 0.5, 0.08);
    assert_close(twentieth / TRIALS, 0.05, 0.035);
    assert_close(hundredth / TRIALS, 0.01, 0.016);
    assert_true(hundredth > 0);
}

/// Of velocities v ← a v + sqrt(1 − a²) ξ.
static struct maxwell_summary test_remembering(double a, size_t samples, uint64_t seed) {
    struct particles particles, noise;
    struct maxwell maxwell;
    assert_ok(mf_particles_init(&particles, &cube, PARTICLES));
    assert_ok(mf_particles_init(&noise, &cube, PARTICLES));
    assert_ok(mf_maxwell_init(&maxwell, samples));
    for (uint64_t step = 0; step < samples; step++) {
        const uint64_t own = mf_rng_child_seed(seed, RNG_INITIAL, 1, (uint32_t)step);
        mf_particles_draw_velocities(&noise, PARTICLES_MAXWELL, 1, own);
        for (int d = 0; d < 3; d++)
            for (size_t k = 0; k < PARTICLES; k++)
                particles.velocity[d][k] = step == 0 ? noise.velocity[d][k]
                                                     : a * particles.velocity[d][k] +
                                                           sqrt(1 - a * a) * noise.velocity[d][k];
        mf_maxwell_sample(&maxwell, &particles, 1, seed, step);
    }
    const struct maxwell_summary s = mf_maxwell_result(&maxwell);
    mf_maxwell_clear(&maxwell);
    mf_particles_clear(&particles);
    mf_particles_clear(&noise);
    return s;
}

/// Samples that remember each other, F for three to four of them: counted as independent, 61 % of p
/// would be below 0.05. Standard errors for 100 trials are 0.05 and 0.022.
static void test_maxwell_counts_correlated_velocities_for_fewer(void **state) {
    (void)state;
    enum { RUNS = 100, SAMPLES = 120 };
    double half = 0, twentieth = 0, share = 0;
    for (uint64_t trial = 0; trial < RUNS; trial++) {
        const struct maxwell_summary s = test_remembering(0.95, SAMPLES, 100 + trial);
        half += s.probability < 0.5;
        twentieth += s.probability < 0.05;
        share += s.independent / s.numbers / RUNS;
    }
    print_message("p below 0.5, 0.05: %.0f, %.0f %%; independent %.3f of all\n", 100 * half / RUNS,
                  100 * twentieth / RUNS, share);
    assert_close(half / RUNS, 0.5, 0.2);
    assert_close(twentieth / RUNS, 0.05, 0.08);
}

static void test_maxwell_p_value_is_small_when_the_temperature_is_another(void **state) {
    (void)state;
    assert_true(test_velocities(3, 2, 1) < 1e-4);
    assert_true(test_velocities(1.2, 2, 1) < 1e-4);
}

static void test_maxwell_has_no_p_value_when_nothing_was_sampled(void **state) {
    (void)state;
    struct maxwell maxwell;
    assert_ok(mf_maxwell_init(&maxwell, 3));
    const struct maxwell_summary s = mf_maxwell_result(&maxwell);
    assert_identical(s.numbers, 0.0);
    assert_true(isnan(s.statistic) && isnan(s.probability));
    mf_maxwell_clear(&maxwell);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_maxwell_probability_is_that_of_tables),
        cmocka_unit_test(test_maxwell_p_values_are_uniform_when_velocities_are_of_maxwell),
        cmocka_unit_test(test_maxwell_counts_correlated_velocities_for_fewer),
        cmocka_unit_test(test_maxwell_p_value_is_small_when_the_temperature_is_another),
        cmocka_unit_test(test_maxwell_has_no_p_value_when_nothing_was_sampled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
