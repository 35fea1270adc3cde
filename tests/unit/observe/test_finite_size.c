// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/finite_size.h"

#include "base/rng.h"
#include "shared/is_close.h"
#include "shared/molecules.h"
#include "shared/testing.h"

#include <math.h>

enum { BINS = 200 };

static const struct box cube = {3, {10, 10, 10}};
static const struct rdf_bins bins = {0, 4.0 / BINS, BINS};
static const struct composition one = {.types = 1, .count = {1000}};

/// g of N hard rods of length 1 on a ring of length N/ρ, normalised by N (N − 1): the chances that
/// the m-th neighbour is there, each gap being one of N parts of N/ρ − N (L. Tonks, Phys. Rev. 50,
/// 955 (1936)).
static double rods(int particles, double density, double r) {
    const double ring = particles / density, room = ring - particles;
    double chance = 0;
    for (int m = 1; m < particles && r > m; m++) {
        const double ahead = r - m, behind = room - ahead;
        if (behind > 0)
            chance += exp(lgamma(particles) - lgamma(m) - lgamma(particles - m) +
                          (m - 1) * log(ahead / room) + (particles - m - 1) * log(behind / room)) /
                      room;
    }
    return chance * ring / (particles - 1);
}

/// Where their oscillations are over: S(0) = (1 − ρ)². Terms of the next order in 1/N are left out.
static void test_finite_size_factor_is_that_of_hard_rods(void **state) {
    (void)state;
    static const double densities[] = {0.05, 0.2, 0.4};
    for (int k = 0; k < 3; k++) {
        const double density = densities[k], s = pow(1 - density, 2);
        const double r = 12.4, exact = rods(400, density, r) / rods(40, density, r);
        const double factor = mf_finite_size_factor(s, 40, 400);
        print_message("density %.2f: g(400)/g(40) exact %.6f, by S(0) %.6f, by S = 0 %.6f\n",
                      density, exact, factor, mf_finite_size_factor(0, 40, 400));
        assert_close(factor, exact, 0.02 * (1 - mf_finite_size_factor(0, 40, 400)));
    }
}

static void test_finite_size_factor_is_one_for_an_ideal_gas(void **state) {
    (void)state;
    assert_identical(mf_finite_size_factor(1, 20, 1000), 1.0);
    assert_close(mf_finite_size_factor(0, 2, 4), 0.5 / 0.75, 1e-12);
    assert_close(mf_finite_size_factor(0.3, 70, 900) * mf_finite_size_factor(0.3, 900, 70), 1,
                 1e-12);
}

/// A hole of radius 1 whose outside is `outside`, with noise, and the factor to ten times as many.
static double factor_in(double hole, double outside, double noise,
                        const struct finite_size_fluid *of, int pair, uint32_t seed) {
    double g[BINS], error[BINS];
    for (uint32_t k = 0; k < BINS; k++) {
        double normal[4];
        mf_rng_normal4(mf_rng_philox(seed, RNG_INITIAL, k, 0, 0), normal);
        g[k] = (mf_rdf_bins_centre(&bins, k) < 1 ? hole : 1) * outside + noise * normal[0];
        error[k] = noise;
    }
    const double all = (double)mf_composition_particles(of->composition);
    return mf_finite_size_factor_of(&bins, g, error, of, pair, all, 10 * all);
}

static double factor_of(double hole, double outside, double noise, const struct composition *of,
                        int pair, uint32_t seed) {
    return factor_in(hole, outside, noise,
                     &(struct finite_size_fluid){.box = &cube, .composition = of}, pair, seed);
}

/// s = 1 − 4π/3 · ρ (1 − hole) of a g that is flat outside of the hole. The integral ends at 4
/// times its radius and is 2 % off (as the cube of the range): 0.05 of s at most here.
static const double integral = 0.05 * 9e-4;

static void test_finite_size_factor_of_finds_s_in_g(void **state) {
    (void)state;
    const double densities = 1000 / 1e3, depth = 0.15;
    const double s = 1 - 4 * M_PI / 3 * densities * depth;
    // In a closed system the outside lies by −G/V above 1.
    const double outside = 1 + 4 * M_PI / 3 * depth / 1e3;
    assert_close(factor_of(1 - depth, outside, 1e-6, &one, 0, 1),
                 mf_finite_size_factor(s, 1e3, 1e4), integral);
    assert_close(factor_of(1, 1, 1e-6, &one, 0, 1), 1, 1e-6);
}

/// A hole that makes the liquid incompressible: s comes out as 0 within 3 errors, of 0.1 each.
static void test_finite_size_factor_of_believes_no_noise(void **state) {
    (void)state;
    const double depth = 3 / (4 * M_PI);
    for (uint32_t seed = 1; seed <= 10; seed++)
        assert_close(factor_of(1 - depth, 1 + 1e-3, 0.03, &one, 0, seed),
                     mf_finite_size_factor(0, 1e3, 1e4), 0.3 * 9e-4);
    // Types that have parted: A-A inside a domain, as large as the box.
    const struct composition binary = {.types = 2, .count = {500, 500}};
    assert_identical(factor_of(2, 2, 0, &binary, 0, 1), mf_finite_size_factor(0, 1e3, 1e4));
}

/// Two gases that do not see each other: A-A as if alone, A-B ideal.
static void test_finite_size_factor_of_tells_kinds_of_pairs_apart(void **state) {
    (void)state;
    const struct composition binary = {.types = 2, .count = {200, 800}};
    const double depth = 0.5, own = 1 - 4 * M_PI / 3 * 0.2 * depth;
    const double outside = 1 + 4 * M_PI / 3 * depth / 1e3;
    assert_close(factor_of(1 - depth, outside, 1e-6, &binary, 0, 1),
                 mf_finite_size_factor(own, 200, 2000), integral);
    assert_close(factor_of(1, 1, 1e-6, &binary, 1, 1), 1, 1e-6);
    // No number fluctuates less than not at all: 1 + ρ_A G_AA is bounded by 0.
    assert_true(factor_of(0, 0.9, 1e-6, &binary, 0, 1) >= mf_finite_size_factor(0, 200, 2000));
}

static void test_finite_size_factor_of_is_of_a_liquid_in_the_plane(void **state) {
    (void)state;
    const struct box square = {2, {30, 30, 1}};
    const double g[] = {1, 1, 1}, error[] = {0, 0, 0};
    const struct rdf_bins few = {0, 1, 3};
    const struct finite_size_fluid of = {.box = &square, .composition = &one};
    assert_close(mf_finite_size_factor_of(&few, g, error, &of, 0, 100, 50),
                 mf_finite_size_factor(0, 100, 50), 0);
    assert_identical(mf_finite_size_factor_of(&few, g, error, &of, 0, 100, 100), 1.0);
}

enum { TRIMERS = 1000, TRIMER_PAIRS = 3 };

/// Trimers A-B-A, and single beads C if there are any.
static void make_trimers(struct topology *topology, struct composition *composition,
                         int64_t single) {
    static const int aba[] = {0, 1, 0};
    *composition =
        (struct composition){.types = single > 0 ? 3 : 2, .count = {2 * TRIMERS, TRIMERS, single}};
    *topology =
        (struct topology){.kinds = 1, .kind = {molecules_chain(TRIMERS, aba, 3, BONDED_BOND, 2)}};
    assert_ok(mf_topology_complete(topology, composition));
}

/// g of a pair type that leaves out the pairs of a molecule, of M trimers that do not see each
/// other: pairs of different molecules over all.
static double ideal_trimers(int pair, double molecules) {
    const double of_type[] = {2 * molecules, molecules};
    static const int type[TRIMER_PAIRS][2] = {{0, 0}, {0, 1}, {1, 1}};
    const double a = of_type[type[pair][0]], b = of_type[type[pair][1]];
    const double possible = a * (type[pair][0] == type[pair][1] ? b - 1 : b);
    return a * b * (1 - 1 / molecules) / possible;
}

/// With pairs of a molecule in g or not, however few of them are known.
static void test_finite_size_factor_of_knows_which_pairs_g_leaves_out(void **state) {
    (void)state;
    struct topology topology;
    struct composition composition;
    make_trimers(&topology, &composition, 0);
    const struct finite_size_fluid of = {.box = &cube,
                                         .composition = &composition,
                                         .topology = &topology},
                                   intermolecular = {.box = &cube,
                                                     .composition = &composition,
                                                     .topology = &topology,
                                                     .intermolecular = true};
    for (int pair = 0; pair < TRIMER_PAIRS; pair++) {
        const double here = ideal_trimers(pair, TRIMERS);
        const double exact = ideal_trimers(pair, 10 * TRIMERS) / here;
        print_message("pairs %d of ideal trimers: %.6f, exact %.6f\n", pair,
                      factor_in(1, here, 1e-7, &of, pair, 1), exact);
        assert_close(factor_in(1, here, 1e-7, &of, pair, 1), exact, 3e-6);
        assert_close(factor_in(1, here, 1e-7, &intermolecular, pair, 1), exact, 3e-6);
    }
    mf_topology_clear(&topology);
}

/// Where g tells nothing, as in two dimensions: of one kind of molecule that leaves no room
/// A-B lie as in the infinite system, A-A and B-B by one over their number too high.
static void test_finite_size_rigid_molecules_have_numbers_that_do_not_fluctuate(void **state) {
    (void)state;
    struct topology topology;
    struct composition composition;
    make_trimers(&topology, &composition, 0);
    static const struct box square = {2, {30, 30, 1}};
    struct finite_size_fluid of = {
        .box = &square, .composition = &composition, .topology = &topology};
    static const double own[TRIMER_PAIRS] = {2 * TRIMERS, INFINITY, TRIMERS};
    for (int pair = 0; pair < TRIMER_PAIRS; pair++) {
        const double s = mf_finite_size_rigid(&of, pair);
        assert_close(s, 1 - 3 * TRIMERS / own[pair], 1e-12);
        const double factor = factor_in(1, 1, 0, &of, pair, 1);
        assert_close(factor, (1 - 1 / own[pair]) / (1 - 0.1 / own[pair]), 1e-12);
    }
    mf_topology_clear(&topology);
    // Beside single beads molecules and beads change places: S(0) of all of them stays 0.
    make_trimers(&topology, &composition, 500);
    const double all = 3 * TRIMERS + 500;
    double sum = 0;
    for (int pair = 0; pair < mf_composition_pairs(&composition); pair++) {
        int type[2];
        mf_composition_pair_types(&composition, pair, type);
        const double share =
            (double)composition.count[type[0]] / all * (double)composition.count[type[1]] / all;
        sum += (type[0] == type[1] ? 1 : 2) * share * mf_finite_size_rigid(&of, pair);
    }
    assert_close(sum, 0, 1e-12);
    mf_topology_clear(&topology);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_finite_size_factor_is_that_of_hard_rods),
        cmocka_unit_test(test_finite_size_factor_is_one_for_an_ideal_gas),
        cmocka_unit_test(test_finite_size_factor_of_finds_s_in_g),
        cmocka_unit_test(test_finite_size_factor_of_believes_no_noise),
        cmocka_unit_test(test_finite_size_factor_of_tells_kinds_of_pairs_apart),
        cmocka_unit_test(test_finite_size_factor_of_is_of_a_liquid_in_the_plane),
        cmocka_unit_test(test_finite_size_factor_of_knows_which_pairs_g_leaves_out),
        cmocka_unit_test(test_finite_size_rigid_molecules_have_numbers_that_do_not_fluctuate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
