// SPDX-License-Identifier: GPL-3.0-or-later
//
// Exchanges alone, of beads that hardly move: each of the six ways to share out four places among
// two beads of each type comes as often as Boltzmann's factor says.
#include "dynamics/metropolis.h"

#include "curves/formula.h"
#include "shared/testing.h"

#include <math.h>

enum { BEADS = 4, PAIRS = 3, WAYS = 1 << BEADS, SWEEPS = 40000 };

/// Φ = a (1 − r)²/2 of A-A, A-B and B-B.
static const double repulsion[PAIRS] = {40, 12, 25}, temperature = 1.3;
static const struct box box = {3, {3, 3, 3}};
static const double corner[BEADS][3] = {{1, 1, 1}, {1.5, 1, 1}, {1, 1.6, 1.1}, {1.3, 1.4, 1.7}};

static void make_potential(struct table *potential) {
    struct table table[PAIRS];
    for (int pair = 0; pair < PAIRS; pair++) {
        struct formula_soft_repulsion_parameters soft = {repulsion[pair], 1};
        const struct curve curve = {&mf_formula_soft_repulsion, &soft};
        assert_ok(mf_table_init_potential(&table[pair], &curve));
    }
    assert_ok(mf_table_stack(potential, table, PAIRS));
    for (int pair = 0; pair < PAIRS; pair++)
        mf_table_clear(&table[pair]);
}

/// Energy where the bits of `way` are the places of beads of type B.
static double energy_of(unsigned way) {
    double energy = 0;
    for (int i = 0; i < BEADS; i++)
        for (int j = 0; j < i; j++) {
            double square = 0;
            for (int d = 0; d < 3; d++)
                square += pow(corner[i][d] - corner[j][d], 2);
            const double overlap = fmax(0, 1 - sqrt(square));
            energy += 0.5 * repulsion[(way >> i & 1) + (way >> j & 1)] * overlap * overlap;
        }
    return energy;
}

/// The places of beads of type B, ids 2 and 3.
static unsigned way_of(const struct particles *particles) {
    unsigned way = 0;
    for (size_t k = 0; k < particles->count; k++)
        for (int place = 0; place < BEADS; place++) {
            double square = 0;
            for (int d = 0; d < 3; d++)
                square += pow(particles->position[d][k] - corner[place][d], 2);
            way |= square < 1e-6 && particles->id[k] >= 2 ? 1U << place : 0;
        }
    return way;
}

static void sample_drifts(double count[WAYS]) {
    const struct composition composition = {.types = 2, .count = {2, 2}, .name = {"A", "B"}};
    struct metropolis metropolis;
    struct particles particles;
    struct table potential;
    make_potential(&potential);
    assert_ok(mf_particles_init(&particles, &box, BEADS));
    for (size_t k = 0; k < BEADS; k++)
        for (int d = 0; d < 3; d++)
            particles.position[d][k] = corner[k][d];
    assert_ok(mf_metropolis_init_at(&metropolis, &particles,
                                    &(struct pair_law){.potential = &potential,
                                                       .composition = composition,
                                                       .temperature = temperature,
                                                       .seed = 4},
                                    NULL));
    metropolis.step = 1e-9;
    metropolis.exchanges = 2;
    for (int n = 0; n < SWEEPS; n++) {
        assert_ok(mf_metropolis_run(&metropolis, 1));
        count[way_of(&metropolis.particles)]++;
    }
    mf_metropolis_clear(&metropolis);
    mf_particles_clear(&particles);
    mf_table_clear(&potential);
}

static void test_exchanges_share_out_places_as_boltzmanns_factor_says(void **state) {
    (void)state;
    double count[WAYS] = {0}, sum = 0, largest = 0;
    sample_drifts(count);
    for (unsigned way = 0; way < WAYS; way++)
        sum += __builtin_popcount(way) == 2 ? exp(-energy_of(way) / temperature) : 0;
    for (unsigned way = 0; way < WAYS; way++) {
        const double share =
            __builtin_popcount(way) == 2 ? exp(-energy_of(way) / temperature) / sum : 0;
        // Ten sweeps, of two exchanges each, count as one independent; false alarm below 1e-5.
        const double error = sqrt(10 * share * (1 - share) / SWEEPS);
        print_message("%2u: %.4f, exactly %.4f\n", way, count[way] / SWEEPS, share);
        assert_true(fabs(count[way] / SWEEPS - share) <= 5 * error);
        largest = fmax(largest, share);
    }
    assert_true(largest < 0.6); // several ways matter
}

/// Beads of two types in a box, with Φ of A-A, A-B and B-B.
static void equilibrate(struct metropolis *metropolis, struct table *potential,
                        const double strength[PAIRS], const double range[PAIRS]) {
    const struct composition composition = {.types = 2, .count = {180, 20}, .name = {"A", "B"}};
    struct table table[PAIRS];
    for (int pair = 0; pair < PAIRS; pair++) {
        struct formula_soft_repulsion_parameters soft = {strength[pair], range[pair]};
        const struct curve curve = {&mf_formula_soft_repulsion, &soft};
        assert_ok(mf_table_init_potential(&table[pair], &curve));
    }
    assert_ok(mf_table_stack(potential, table, PAIRS));
    for (int pair = 0; pair < PAIRS; pair++)
        mf_table_clear(&table[pair]);
    assert_ok(mf_metropolis_init(metropolis, &(struct box){3, {5.85, 5.85, 5.85}}, &composition,
                                 potential, 1, 7));
    mf_metropolis_exchange(metropolis);
    // From a lattice, where beads overlap, some are accepted of any kind.
    for (int times = 0; times < 2; times++)
        assert_ok(mf_metropolis_equilibrate(metropolis, 200));
}

/// Beads of one size take each other's place; hard ones in the holes of others half as large never
/// do, and are hardly tried.
static void test_exchanges_are_tried_where_some_are_accepted(void **state) {
    (void)state;
    static const double equal[PAIRS] = {25, 27, 25}, range[PAIRS] = {1, 1, 1};
    static const double hard[PAIRS] = {2000, 2000, 2000}, unlike[PAIRS] = {0.9, 1.4, 1.9};
    struct metropolis metropolis;
    struct table potential;
    equilibrate(&metropolis, &potential, equal, range);
    assert_int_equal(metropolis.exchanges, 51); // one in four of 200 beads
    mf_metropolis_clear(&metropolis);
    mf_table_clear(&potential);
    equilibrate(&metropolis, &potential, hard, unlike);
    assert_int_equal(metropolis.exchanges, 5); // one in fifty
    // The next equilibration asks again.
    assert_ok(mf_metropolis_equilibrate(&metropolis, 1));
    assert_true(metropolis.exchanges_tried == 51);
    mf_metropolis_clear(&metropolis);
    mf_table_clear(&potential);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_exchanges_share_out_places_as_boltzmanns_factor_says),
        cmocka_unit_test(test_exchanges_are_tried_where_some_are_accepted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
