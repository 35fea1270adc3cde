// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/replicas.h"

#include "base/rng.h"
#include "shared/fluids.h"
#include "shared/testing.h"

#include <math.h>

enum { COUNT = 8, BINS = 40 };

static void ignore(void *context, const struct inverse_progress *progress) {
    (void)context, (void)progress;
}

/// Blocks of normal numbers with a shift of each replica's own.
static void make(struct replicas *replicas, double *block, double shift) {
    *replicas = (struct replicas){.bins = BINS, .numbers = BINS, .count = COUNT};
    for (size_t k = 0; k < COUNT; k++) {
        replicas->member[k].block = block + k * REPLICAS_BLOCKS * BINS;
        for (size_t n = 0; n < REPLICAS_BLOCKS * BINS; n++) {
            double normal[4];
            mf_rng_normal4(mf_rng_philox(3, RNG_INITIAL, (uint32_t)k, (uint32_t)n, 0), normal);
            replicas->member[k].block[n] = 100 + normal[0] + (k % 2 ? shift : -shift);
        }
    }
}

/// Of 40 bins: 7 and 24 degrees of freedom in each, so that the ratio is good to 0.1; five of that.
static void test_replicas_disagree_as_their_means_do(void **state) {
    (void)state;
    static double block[COUNT * REPLICAS_BLOCKS * BINS];
    double ideal[BINS];
    size_t seen[BINS];
    struct replicas replicas;
    for (size_t a = 0; a < BINS; a++) {
        ideal[a] = 10 + (double)a;
        seen[a] = a;
    }
    make(&replicas, block, 0);
    assert_true(fabs(mf_replicas_disagreement(&replicas, ideal, seen, BINS) - 1) < 0.5);
    make(&replicas, block, 2);
    // A shift by ±2 has a variance of 4 · 8/7, and the mean of four blocks one of 1/4.
    const double expected = 1 + REPLICAS_BLOCKS * 4.0 * COUNT / (COUNT - 1);
    assert_true(fabs(mf_replicas_disagreement(&replicas, ideal, seen, BINS) / expected - 1) < 0.3);
}

/// S(q) of the lattice's planes across x, as in test_placement.
static double order(const struct particles *particles, int edge) {
    double real = 0, imaginary = 0;
    for (size_t k = 0; k < particles->count; k++) {
        const double angle =
            2 * acos(-1.0) * edge / particles->box.length[0] * particles->position[0][k];
        real += cos(angle);
        imaginary += sin(angle);
    }
    return (real * real + imaginary * imaginary) / (double)particles->count;
}

/// A lattice has S = N but for its jitter; without order it is a number of order 1.
static void test_replicas_scatter_their_particles_when_the_plan_says_so(void **state) {
    (void)state;
    enum { EDGE = 8, PARTICLES = EDGE * EDGE * EDGE };
    struct fluid fluid;
    const struct inverse_listener listener = {ignore, NULL};
    const struct inverse_progress progress = {0};
    fluid_lennard_jones(&fluid, PARTICLES, 0.004);
    for (enum sampler_kind kind = SAMPLER_MONTE_CARLO; kind <= SAMPLER_DYNAMICS; kind++)
        for (int scatter = 0; scatter < 2; scatter++) {
            struct replicas replicas;
            struct replicas_plan plan = {.scatter = scatter, .block_samples = 1, .every = 1};
            assert_ok(
                mf_replicas_init(&replicas, 2, kind,
                                 &(struct sampler_system){.box = &fluid.setup.box,
                                                          .composition = &fluid.setup.composition,
                                                          .potential = &fluid.potential,
                                                          .temperature = 1,
                                                          .width = 0.1,
                                                          .bins = 25,
                                                          .seed = 3}));
            assert_ok(mf_replicas_run(&replicas, &plan, 1, &progress, &listener));
            for (size_t k = 0; k < 2; k++) {
                const double found = order(mf_sampler_particles(&replicas.member[k].sampler), EDGE);
                assert_true(scatter ? found < 12 : found > 0.1 * PARTICLES);
            }
            mf_replicas_clear(&replicas);
        }
    fluid_clear(&fluid);
}

/// Equilibration tunes moves to 40 % (mf_metropolis_equilibrate), and trajectories until four of
/// five are taken at their first chance (mf_hybrid_equilibrate), of which 1.4 % are left at their
/// last, and 0.2 % without tuning; a gas without a potential takes all. Of 8 · 4 · 216 moves
/// and 8 · 4 · 100 trajectories, whose tuning scatters by 0.01 and 0.002 from seed to seed.
static void test_replicas_take_as_many_moves_as_their_sampler_is_tuned_to(void **state) {
    (void)state;
    static const double wanted[] = {0.4, 0.986}, tolerance[] = {0.03, 0.008};
    const struct inverse_listener listener = {ignore, NULL};
    const struct inverse_progress progress = {0};
    for (int ideal = 0; ideal < 2; ideal++) {
        struct fluid fluid;
        if (ideal)
            fluid_ideal_gas(&fluid, 3, 216, 0.02);
        else
            fluid_lennard_jones(&fluid, 216, 0.004);
        for (enum sampler_kind kind = SAMPLER_MONTE_CARLO; kind <= SAMPLER_DYNAMICS; kind++) {
            const bool moves = kind == SAMPLER_MONTE_CARLO;
            const struct replicas_plan plan = {
                .equilibration = 200, .block_samples = moves ? 2 : 20, .every = moves ? 1 : 5};
            struct replicas replicas;
            assert_ok(
                mf_replicas_init(&replicas, 8, kind,
                                 &(struct sampler_system){.box = &fluid.setup.box,
                                                          .composition = &fluid.setup.composition,
                                                          .potential = &fluid.potential,
                                                          .temperature = 1,
                                                          .width = 0.02,
                                                          .bins = 50,
                                                          .seed = 3}));
            assert_ok(mf_replicas_run(&replicas, &plan, 1, &progress, &listener));
            const double acceptance = mf_replicas_acceptance(&replicas);
            print_message("%s: %.4f\n", mf_sampler_kinds[kind], acceptance);
            assert_true(fabs(acceptance - (ideal ? 1 : wanted[kind])) <=
                        (ideal ? 0 : tolerance[kind]));
            mf_replicas_clear(&replicas);
        }
        fluid_clear(&fluid);
    }
}

/// Beads without a potential of two types: |ρ|²/N is 1 of each on average, and 2 of both. Of every
/// four replicas two begin with a wave, by whose amplitude, some 80 of 300 beads, it is 20 and
/// more.
static void test_replicas_of_a_mixture_begin_apart(void **state) {
    (void)state;
    enum { BEADS = 600, PAIR_BINS = 4 };
    const struct box box = {3, {12, 12, 12}};
    const struct composition composition = {.types = 2, .count = {BEADS / 2, BEADS / 2}};
    const struct sampler_system system = {.box = &box,
                                          .composition = &composition,
                                          .temperature = 1,
                                          .width = 0.1,
                                          .bins = PAIR_BINS,
                                          .seed = 3};
    struct replicas replicas;
    double mean[2] = {0};
    assert_ok(mf_replicas_init(&replicas, COUNT, SAMPLER_MONTE_CARLO, &system));
    for (size_t k = 0; k < COUNT; k++) {
        struct replica *member = &replicas.member[k];
        assert_ok(mf_sampler_begin(&member->sampler));
        assert_ok(mf_sampler_sample(&member->sampler, 1, member->sample));
        mean[k / 2 % 2] += member->sample[replicas.bins + SAMPLER_WAVES] / (0.5 * COUNT);
    }
    print_message("waves %.1f and %.1f\n", mean[0], mean[1]);
    assert_true(mean[0] < 8 && mean[1] > 20);
    mf_replicas_clear(&replicas);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_replicas_disagree_as_their_means_do),
        cmocka_unit_test(test_replicas_scatter_their_particles_when_the_plan_says_so),
        cmocka_unit_test(test_replicas_take_as_many_moves_as_their_sampler_is_tuned_to),
        cmocka_unit_test(test_replicas_of_a_mixture_begin_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
