// SPDX-License-Identifier: GPL-3.0-or-later
//
// What reptation rests on: numbers of a density, the energy of a place against a sum over all
// pairs, and which kinds of molecules do it, and how.
#include "dynamics/metropolis.h"

#include "base/memory.h"
#include "base/rng.h"
#include "curves/formula.h"
#include "shared/is_close.h"
#include "shared/molecules.h"
#include "shared/testing.h"

#include <math.h>

// Numbers -----------------------------------------------------------------------------------------

/// p(q) = q/2 from 0 to 2: q = 2 √u. Bins are 2/256 wide.
static void test_drawn_numbers_follow_their_density(void **state) {
    (void)state;
    struct reptation_draw draw;
    double weight[REPTATION_BINS];
    for (int bin = 0; bin < REPTATION_BINS; bin++)
        weight[bin] = 7 * (bin + 0.5);
    mf_reptation_draw_init(&draw, 0, 2, weight);
    for (double u = 0.01; u < 1; u += 0.01) {
        const double q = mf_reptation_draw_number(&draw, u);
        assert_close(q, 2 * sqrt(u), 2e-3);
        assert_close(mf_reptation_draw_density(&draw, q), q / 2, 2.0 / REPTATION_BINS);
    }
    assert_close(mf_reptation_draw_density(&draw, -1e-9), 0, 0);
    assert_close(mf_reptation_draw_density(&draw, 2.001), 0, 0);
}

/// Nor does a number come from a bin without weight.
static void test_no_number_is_drawn_where_the_density_is_zero(void **state) {
    (void)state;
    struct reptation_draw draw;
    double weight[REPTATION_BINS] = {0};
    weight[100] = weight[200] = 1;
    mf_reptation_draw_init(&draw, 0, REPTATION_BINS, weight);
    for (double u = 0.001; u < 1; u += 0.002) {
        const int bin = (int)mf_reptation_draw_number(&draw, u);
        assert_int_equal(bin, u < 0.5 ? 100 : 200);
    }
}

// Energies ----------------------------------------------------------------------------------------

/// Of one particle with all others, in double precision.
static double sum_of_pairs(const struct pair_law *law, const struct particles *particles, size_t k,
                           const int32_t *excluded, int count) {
    double sum = 0;
    for (size_t j = 0; j < particles->count; j++) {
        double square = 0, energy;
        bool left_out = j == k;
        for (int d = 0; d < 3; d++)
            square += pow(box_nearest(particles->position[d][k] - particles->position[d][j],
                                      particles->box.length[d]),
                          2);
        for (int n = 0; n < count; n++)
            left_out |= excluded[n] == (int32_t)j;
        const int pair =
            mf_composition_pair_of_ids(&law->composition, particles->id[k], particles->id[j]);
        mf_table_evaluate_pair(law->potential, pair, sqrt(square), &energy, NULL, NULL);
        sum += left_out ? 0 : energy;
    }
    return sum;
}

/// Boxes of two, three and five cells along an axis, two types of particles that are taken out,
/// moved and put back: fractions of the box have a resolution of 2⁻³².
static void test_energy_of_a_place_is_the_sum_of_all_pairs_when_particles_have_moved(void **state) {
    (void)state;
    enum { COUNT = 200 };
    const struct box box = {3, {2.5, 3.1, 5.3}};
    const struct composition composition = {.types = 2, .count = {120, 80}};
    struct formula_soft_repulsion_parameters soft[3] = {{25, 1}, {40, 0.8}, {10, 0.6}};
    struct table part[3], table;
    struct particles particles;
    struct reptation_grid grid;
    struct rng_sequence random = mf_rng_sequence_begin(5, RNG_INITIAL, 1, 2);
    for (int pair = 0; pair < 3; pair++)
        assert_ok(mf_table_init_potential(
            &part[pair], &(struct curve){&mf_formula_soft_repulsion, &soft[pair]}));
    assert_ok(mf_table_stack(&table, part, 3));
    const struct pair_law law = {.potential = &table, .composition = composition};
    assert_ok(mf_particles_init(&particles, &box, COUNT));
    assert_ok(mf_reptation_grid_init(&grid, COUNT));
    for (uint32_t k = 0; k < COUNT; k++)
        particles.id[k] = (k * 7) % COUNT;
    mf_particles_label_places(&particles);
    mf_reptation_grid_fill(&grid, &particles, table.cutoff);
    for (int move = 0; move < 1000; move++) {
        const int32_t k = move < COUNT ? move : (int32_t)mf_rng_sequence_below(&random, COUNT);
        const int32_t excluded[2] = {(k + 1) % COUNT, (k + 5) % COUNT};
        mf_reptation_grid_remove(&grid, &particles, k);
        for (int d = 0; d < 3; d++) {
            const double x = box.length[d] * (3 * mf_rng_sequence_uniform(&random) - 1);
            particles.position[d][k] = x;
            particles.kernel_place[k].fraction[d] = box_fraction(x, 1 / box.length[d]);
        }
        for (int count = 0; count <= 2 && move >= COUNT; count += 2) {
            const double exact = sum_of_pairs(&law, &particles, (size_t)k, excluded, count);
            const double found =
                mf_reptation_grid_energy(&grid, &law, &particles, k, excluded, count);
            assert_close(found, exact, 1e-9 * 40 * COUNT);
        }
        mf_reptation_grid_insert(&grid, &particles, k);
    }
    mf_reptation_grid_clear(&grid);
    mf_particles_clear(&particles);
    mf_table_clear(&table);
    for (int pair = 0; pair < 3; pair++)
        mf_table_clear(&part[pair]);
}

// Kinds -------------------------------------------------------------------------------------------

enum { MOST = 6 };

/// Whether a kind reptates.
static bool can(struct topology_kind kind, int dimensions) {
    struct topology topology;
    struct reptation reptation;
    molecules_topology(&topology, kind, (struct topology_kind){0}, 2, NULL);
    assert_ok(mf_reptation_init(&reptation, &topology, dimensions));
    const bool found = reptation.can[0];
    assert_int_equal(reptation.chains, found);
    assert_false(mf_reptation_is_on(&reptation));
    mf_reptation_clear(&reptation);
    mf_topology_clear(&topology);
    return found;
}

static void test_chains_alike_from_end_to_end_reptate_and_no_other_molecules(void **state) {
    (void)state;
    static const int alike[MOST] = {0}, head[MOST] = {1};
    struct topology_kind kind;
    for (int highest = TOPOLOGY_BOND; highest < TOPOLOGY_ORDERS; highest++)
        assert_true(can(molecules_chain(3, alike, 5, highest, 3), 3));
    assert_false(can(molecules_chain(3, alike, 4, TOPOLOGY_BOND, 1), 3));
    assert_false(can(molecules_chain(3, alike, 5, TOPOLOGY_BOND, 1), 2));
    assert_false(can(molecules_chain(3, head, 6, TOPOLOGY_BOND, 1), 3));
    kind = molecules_chain(3, alike, 6, TOPOLOGY_ANGLE, 1);
    kind.term[TOPOLOGY_ANGLE][2].group = 1;
    assert_false(can(kind, 3));
    kind = molecules_chain(3, alike, 6, TOPOLOGY_DIHEDRAL, 1);
    kind.terms[TOPOLOGY_DIHEDRAL]--;
    assert_false(can(kind, 3));
    kind = molecules_chain(3, alike, 6, TOPOLOGY_BOND, 1);
    kind.term[TOPOLOGY_BOND][4].bead[0] = 2; // a branch
    assert_false(can(kind, 3));
    kind = molecules_chain(3, alike, 6, TOPOLOGY_ANGLE, 1);
    kind.term[TOPOLOGY_ANGLE][1] = (struct topology_term){.bead = {3, 2, 1}}; // from the other end
    assert_true(can(kind, 3));
}

// How often ---------------------------------------------------------------------------------------

static void
test_places_are_those_of_most_moves_for_each_place_and_none_below_a_hundredth(void **state) {
    (void)state;
    static const struct {
        uint64_t accepted[REPTATION_CHOICES]; ///< of 1000 tries each
        int choice;
    } examples[] = {
        {{70, 100, 160, 220}, 0}, {{70, 150, 160, 220}, 1}, {{20, 50, 110, 330}, 3},
        {{9, 19, 39, 79}, -1},    {{0, 0, 0, 0}, -1},
    };
    for (size_t n = 0; n < sizeof examples / sizeof *examples; n++) {
        struct reptation reptation = {.chains = true, .can = {true}};
        for (uint32_t sweep = 0; sweep < REPTATION_CHOICES; sweep++) {
            mf_reptation_tune(&reptation, sweep);
            struct reptation_kind *kind = &reptation.kind[0];
            assert_int_equal(kind->choice, sweep);
            kind->tally[kind->choice].tried = 1000;
            kind->tally[kind->choice].accepted = examples[n].accepted[sweep];
        }
        mf_reptation_choose(&reptation);
        assert_int_equal(reptation.kind[0].choice, examples[n].choice);
        assert_int_equal(mf_reptation_is_on(&reptation), examples[n].choice >= 0);
        assert_int_equal(reptation.kind[0].tally[0].tried, 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_drawn_numbers_follow_their_density),
        cmocka_unit_test(test_no_number_is_drawn_where_the_density_is_zero),
        cmocka_unit_test(test_energy_of_a_place_is_the_sum_of_all_pairs_when_particles_have_moved),
        cmocka_unit_test(test_chains_alike_from_end_to_end_reptate_and_no_other_molecules),
        cmocka_unit_test(
            test_places_are_those_of_most_moves_for_each_place_and_none_below_a_hundredth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
