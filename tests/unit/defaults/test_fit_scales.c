// SPDX-License-Identifier: GPL-3.0-or-later
#include "defaults/fit_scales.h"

#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

enum { BINS = 100, FINE = 2 * BINS, PAIRS = 3 };
static const double width = 0.03;

/// g of one or of all pair types with errors, in which something is known.
struct known {
    double g[PAIRS * FINE], error[PAIRS * FINE];
    struct composition composition;
    struct fit_scales_rdf rdf;
};

static void fill(struct known *known, double (*g)(double r), double error) {
    *known = (struct known){.composition = mf_composition_of_one(1000)};
    for (size_t k = 0; k < PAIRS * BINS; k++) {
        known->g[k] = g(((double)(k % BINS) + 0.5) * width);
        known->error[k] = error;
    }
    known->rdf = (struct fit_scales_rdf){.bins = {0, width, BINS},
                                         .composition = &known->composition,
                                         .dimensions = 3,
                                         .density = 0.8,
                                         .g = known->g,
                                         .error = known->error};
}

/// −ln g = 150 (r − 1)² up to the neighbours at 1, a minimum of 0.8 at 1.5, and 1 from 2 on.
static double liquid(double r) {
    const double second = 1 - 0.2 * pow(sin(M_PI * (r - 1)), 2);
    return r < 1      ? 3 * exp(-150 * (1 - r) * (1 - r)) + 1e-9
           : r < 1.25 ? 3 + (second - 3) * (r - 1) / 0.25
           : r < 2    ? second
                      : 1;
}

static void test_fit_scales_finds_curvature_neighbours_shell_and_how_far_g_is_seen(void **state) {
    struct known known;
    (void)state;
    fill(&known, liquid, 0.001);
    const struct fit_scales scales = mf_fit_scales_find(&known.rdf, 2, 0.002);
    // A parabola is found as it is, k_B T · 300, but for those that look over the peak.
    assert_close(scales.curvature, 600, 10);
    assert_close(scales.neighbour, 1, width);
    assert_close(scales.shell, 1.5, width);
    assert_close(scales.seen, 2, 3 * width);
    assert_close(scales.noise, 0.001, 2e-4);
    assert_close(scales.range, 3, 1e-9);
    // g = 0.02 where 150 (1 − r)² = ln 150.
    assert_close(scales.core, 1 - sqrt(log(150) / 150), width);
}

/// Bonded neighbours of neighbours fill the gap at 1.4; below 1 is what is behind the second shell.
static double molecules(double r) {
    static const double at[][2] = {{0.9, 0},    {1, 2},      {1.4, 1.05}, {1.6, 1.3},
                                   {1.85, 0.9}, {2.2, 1.02}, {2.5, 1}};
    size_t k = 1;
    while (k + 1 < sizeof at / sizeof *at && r > at[k][0])
        k++;
    const double part = fmin(1, fmax(0, (r - at[k - 1][0]) / (at[k][0] - at[k - 1][0])));
    return at[k - 1][1] + part * (at[k][1] - at[k - 1][1]);
}

static void test_fit_scales_ends_the_first_shell_of_molecules_where_g_stays_above_1(void **state) {
    struct known known;
    (void)state;
    fill(&known, molecules, 0.001);
    const struct fit_scales scales = mf_fit_scales_find(&known.rdf, 1, 0.002);
    assert_close(scales.neighbour, 1, width);
    assert_close(scales.shell, 1.4, width);
}

static double flat(double r) {
    (void)r;
    return 1;
}

static void test_fit_scales_of_a_gas_without_structure_are_those_of_its_density(void **state) {
    struct known known;
    (void)state;
    fill(&known, flat, 0.01);
    const struct fit_scales scales = mf_fit_scales_find(&known.rdf, 1, 0.002);
    assert_close(scales.neighbour, pow(0.8, -1.0 / 3), 1e-9);
    assert_close(scales.curvature, 0, 0);
    assert_close(scales.seen, 0, 0);
}

/// Beads of chains: the others of their neighbours keep it below 1 up to the end of a molecule.
static double chains(double r) {
    return r < 1 ? 0 : r < 2.5 ? 0.8 + 0.2 * (r - 1) / 1.5 + 0.15 * exp(-50 * pow(r - 1.2, 2)) : 1;
}

static void test_fit_scales_finds_neighbours_where_g_has_no_peak_above_its_tail(void **state) {
    struct known known;
    (void)state;
    fill(&known, chains, 0.004);
    assert_close(mf_fit_scales_find(&known.rdf, 1, 0.002).neighbour, 1.2, width);
    fill(&known, chains, 0.1);
    assert_close(mf_fit_scales_find(&known.rdf, 1, 0.002).neighbour, pow(0.8, -1.0 / 3), 1e-9);
}

/// Noise of bins beside one another is no curvature: at five points its standard error is as large
/// as what is to be found, and wider parabolas are taken.
static void test_fit_scales_takes_wider_parabolas_where_g_is_noisy(void **state) {
    struct known known;
    (void)state;
    fill(&known, liquid, 0.1);
    for (size_t k = 0; k < BINS; k++)
        known.g[k] = fmax(1e-6, known.g[k] + 0.1 * M_SQRT2 * sin((double)(7 * k * k)));
    const struct fit_scales scales = mf_fit_scales_find(&known.rdf, 1, 0.002);
    print_message("curvature %.0f\n", scales.curvature);
    assert_in_range((int)scales.curvature, 200, 450);
}

/// (ρ/3) 4π ∫ r² (1 − r/c)² dr = (ρ/3) 4π c³/30 with g = 1; in a plane (ρ/2) 2π c²/12. Of a mixture
/// with g = 1 it is that of one component.
static void test_fit_scales_friction_is_that_of_neighbours_without_order(void **state) {
    struct known known;
    (void)state;
    const double cutoff = 1.5;
    fill(&known, flat, 0.01);
    assert_close(mf_fit_scales_friction(&known.rdf, cutoff),
                 0.8 / 3 * 4 * M_PI * pow(cutoff, 3) / 30, 1e-3);
    known.composition = (struct composition){.types = 2, .name = {"A", "B"}, .count = {900, 100}};
    assert_close(mf_fit_scales_friction(&known.rdf, cutoff),
                 0.8 / 3 * 4 * M_PI * pow(cutoff, 3) / 30, 1e-3);
    known.rdf.dimensions = 2;
    assert_close(mf_fit_scales_friction(&known.rdf, cutoff),
                 0.8 / 2 * 2 * M_PI * pow(cutoff, 2) / 12, 1e-3);
}

/// Bins of half the width.
static void fill_fine(struct known *known, double (*g)(double r), double error) {
    fill(known, g, error);
    known->rdf.bins = (struct rdf_bins){0, width / 2, FINE};
    for (size_t k = 0; k < PAIRS * FINE; k++) {
        known->g[k] = g(((double)(k % FINE) + 0.5) * width / 2);
        known->error[k] = error;
    }
}

/// A peak of height 1 and standard deviation s: its fourth derivative is 3/s⁴ at most, and cubics
/// through bins of width h are off by 9/128 (h/s)⁴. Within 0.004 that is h = 0.488 s, 0.049.
static const double peak_width = 0.1;

static double peak(double r) {
    return 1 + exp(-pow((r - 1.5) / peak_width, 2) / 2);
}

static void test_fit_scales_joined_bins_are_as_wide_as_a_peak_can_bear(void **state) {
    struct known known;
    (void)state;
    fill_fine(&known, peak, 1e-9);
    assert_int_equal(mf_fit_scales_joined(&known.rdf, 0.004, 0.004), 3);
    // A 16th of the error is half of the width.
    assert_int_equal(mf_fit_scales_joined(&known.rdf, 0.004 / 16, 0.004), 1);
    // The noise of joined bins, 0.02/sqrt(4), may be more than a fit resolves, but not by much.
    for (size_t k = 0; k < PAIRS * FINE; k++)
        known.error[k] = 0.02;
    assert_in_range(mf_fit_scales_joined(&known.rdf, 0.001, 1), 4, 5);
    assert_true(mf_fit_scales_joined(&known.rdf, 0.001, 0.001) <
                mf_fit_scales_joined(&known.rdf, 0.001, 1));
    // One type of pairs that is sharp decides for all.
    known.composition = (struct composition){.types = 2, .name = {"A", "B"}, .count = {500, 500}};
    for (size_t k = 0; k < PAIRS * FINE; k++) {
        known.g[k] = k / FINE == 1 ? 1 + (k % FINE == 50) : 1;
        known.error[k] = 1e-9;
    }
    assert_int_equal(mf_fit_scales_joined(&known.rdf, 0.004, 0.004), 1);
}

/// Where g is a hundredth, pairs have a tenth of the noise.
static double low_peak(double r) {
    return 0.01 * peak(r);
}

static void test_fit_scales_joined_minds_the_flank_where_pairs_are_rare(void **state) {
    struct known known;
    (void)state;
    fill_fine(&known, low_peak, 1e-9);
    // 0.0007 (h/s)⁴ within 0.0001 sqrt(0.02): h = 0.38 s. Without the root it were four bins.
    assert_int_equal(mf_fit_scales_joined(&known.rdf, 0.0001, 0.004), 2);
}

/// Noise alone is no structure: bins are joined to the fewest that there may be.
static void test_fit_scales_joined_is_not_held_up_by_noise(void **state) {
    struct known known;
    (void)state;
    fill_fine(&known, flat, 0.03);
    for (size_t k = 0; k < FINE; k++)
        known.g[k] += 0.03 * M_SQRT2 * sin((double)(7 * k * k));
    assert_int_equal(mf_fit_scales_joined(&known.rdf, 0.001, 0.004), 5);
}

/// As many pairs are in joined bins, and their noise is that of independent bins.
static void test_fit_scales_join_keeps_pairs_and_noise(void **state) {
    struct known known;
    double pairs = 0, joined = 0, variance = 0, joined_variance = 0;
    (void)state;
    fill(&known, peak, 0.01);
    for (size_t k = 0; k < BINS; k++) {
        const double shell = pow((double)k + 1, 3) - pow((double)k, 3);
        pairs += shell * known.g[k];
        variance += pow(shell * known.error[k], 2);
    }
    assert_ok(mf_fit_scales_rdf_join(&known.rdf, 4));
    assert_int_equal(known.rdf.bins.count, BINS / 4);
    assert_close(known.rdf.bins.width, 4 * width, 1e-12);
    for (size_t k = 0; k < BINS / 4; k++) {
        const double shell = 64 * (pow((double)k + 1, 3) - pow((double)k, 3));
        joined += shell * known.rdf.g[k];
        joined_variance += pow(shell * known.rdf.error[k], 2);
    }
    assert_close_relative(joined, pairs, 1e-12);
    assert_close_relative(joined_variance, variance, 1e-12);
    mf_fit_scales_rdf_clear(&known.rdf);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fit_scales_finds_curvature_neighbours_shell_and_how_far_g_is_seen),
        cmocka_unit_test(test_fit_scales_ends_the_first_shell_of_molecules_where_g_stays_above_1),
        cmocka_unit_test(test_fit_scales_of_a_gas_without_structure_are_those_of_its_density),
        cmocka_unit_test(test_fit_scales_takes_wider_parabolas_where_g_is_noisy),
        cmocka_unit_test(test_fit_scales_finds_neighbours_where_g_has_no_peak_above_its_tail),
        cmocka_unit_test(test_fit_scales_friction_is_that_of_neighbours_without_order),
        cmocka_unit_test(test_fit_scales_joined_bins_are_as_wide_as_a_peak_can_bear),
        cmocka_unit_test(test_fit_scales_joined_minds_the_flank_where_pairs_are_rare),
        cmocka_unit_test(test_fit_scales_joined_is_not_held_up_by_noise),
        cmocka_unit_test(test_fit_scales_join_keeps_pairs_and_noise),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
