// SPDX-License-Identifier: GPL-3.0-or-later
//
// Molecules: ids of their beads, what they refuse, and that what they exclude is on no list.
#include "base/memory.h"
#include "base/simd.h"
#include "shared/all_pairs.h"
#include "shared/is_close.h"
#include "shared/molecules.h"
#include "shared/testing.h"
#include "system/neighbours.h"
#include "system/placement.h"

#include <stdlib.h>
#include <string.h>

static const int abba[] = {0, 1, 1, 0}, bc[] = {1, 2};

/// Two A-B-B-A, one B-C, and single beads A and C: A is 0 to 5, B 6 to 10, C 11 to 13.
static struct composition make(struct topology *topology, int exclude) {
    return molecules_topology(topology, molecules_chain(2, abba, 4, BONDED_DIHEDRAL, exclude),
                              molecules_chain(1, bc, 2, BONDED_BOND, exclude), 3,
                              (const int64_t[]){2, 0, 2});
}

static void test_ids_follow_from_types_and_molecules(void **state) {
    (void)state;
    static const uint32_t expected[2][4] = {{0, 6, 7, 1}, {2, 8, 9, 3}};
    static const uint32_t molecule[] = {0, 0, 1, 1, 3, 4, 0, 0, 1, 1, 2, 2, 5, 6};
    struct topology topology;
    const struct composition composition = make(&topology, 1);
    for (int m = 0; m < 2; m++)
        for (int bead = 0; bead < 4; bead++)
            assert_int_equal(topology_id(&topology.kind[0], m, bead), expected[m][bead]);
    assert_int_equal(topology_id(&topology.kind[1], 0, 0), 10);
    assert_int_equal(topology_id(&topology.kind[1], 0, 1), 11);
    assert_int_equal(topology.molecules, 3);
    assert_int_equal(topology.particles, 14);
    for (int id = 0; id < 14; id++)
        assert_int_equal(topology.molecule[id], molecule[id]);
    for (int bead = 0; bead < 4; bead++)
        assert_int_equal(mf_composition_type(&composition, expected[1][bead]), abba[bead]);
    mf_topology_clear(&topology);
}

static void test_pairs_inside_are_those_that_can_be_counted(void **state) {
    (void)state;
    for (int exclude = 0; exclude <= TOPOLOGY_MAX_EXCLUDE; exclude++) {
        struct topology topology;
        const struct composition composition = make(&topology, exclude);
        for (int n = 0; n < 9; n++) {
            const int type[] = {n / 3, n % 3};
            double excluded = 0, all = 0;
            for (uint32_t i = 0; i < 14; i++)
                for (uint32_t j = 0; j < 14; j++) {
                    const bool counts = i != j && mf_composition_type(&composition, i) == type[0] &&
                                        mf_composition_type(&composition, j) == type[1];
                    excluded += counts && all_pairs_excludes(&topology, i, j);
                    all += counts && topology.molecule[i] == topology.molecule[j];
                }
            assert_identical(mf_topology_intramolecular_pairs(&topology, type, true), excluded);
            assert_identical(mf_topology_intramolecular_pairs(&topology, type, false), all);
        }
        mf_topology_clear(&topology);
    }
}

static void test_beads_within_so_many_bonds_exclude_each_other(void **state) {
    (void)state;
    // Of the chain 0-6-7-1, by hand.
    static const uint32_t chain[] = {0, 6, 7, 1};
    for (int exclude = 0; exclude <= TOPOLOGY_MAX_EXCLUDE; exclude++) {
        struct topology topology;
        make(&topology, exclude);
        for (int a = 0; a < 4; a++)
            for (int b = 0; b < 4; b++)
                assert_int_equal(all_pairs_excludes(&topology, chain[a], chain[b]),
                                 a != b && abs(a - b) <= exclude);
        assert_false(all_pairs_excludes(&topology, 0, 2)); // of two molecules
        assert_false(all_pairs_excludes(&topology, 4, 5)); // single
        assert_int_equal(all_pairs_excludes(&topology, 11, 10), exclude > 0);
        assert_int_equal(topology.excludes, exclude > 0);
        mf_topology_clear(&topology);
    }
    assert_false(all_pairs_excludes(NULL, 0, 1));
}

/// In a ring of four, opposite beads are two bonds apart on either way: there once.
static void test_rings_exclude_each_bead_once(void **state) {
    (void)state;
    static const int type[] = {0, 0, 0, 0};
    struct topology_kind ring = molecules_chain(1, type, 4, BONDED_BOND, 3);
    mf_memory_free(ring.term[BONDED_BOND]);
    ring.terms[BONDED_BOND] = 4;
    ring.term[BONDED_BOND] = mf_memory_zeroed(4, sizeof(struct topology_term));
    for (int n = 0; n < 4; n++)
        ring.term[BONDED_BOND][n] = (struct topology_term){.bead = {n, (n + 1) % 4}};
    assert_ok(mf_topology_check(&ring));
    struct topology topology;
    molecules_topology(&topology, ring, (struct topology_kind){0}, 1, NULL);
    assert_int_equal(topology.excluded_start[4], 12);
    static const size_t expected[] = {0, 8, 12, 12};
    for (int exclude = 0; exclude <= 3; exclude++) {
        size_t count;
        assert_ok(mf_topology_count_excluded(&topology.kind[0], exclude, &count));
        assert_int_equal(count, expected[exclude]);
    }
    mf_topology_clear(&topology);
}

/// A-B-B-B-A as snapshots have it, by type; of a star there are no two ends.
static void test_ends_are_those_of_the_bonds(void **state) {
    (void)state;
    static const int type[] = {0, 0, 1, 1, 1};
    static const int bond[2][4][2] = {{{0, 2}, {4, 1}, {2, 3}, {3, 4}},
                                      {{0, 2}, {1, 2}, {3, 2}, {4, 2}}};
    static const int end[2][2] = {{0, 1}, {0, 4}};
    for (int shape = 0; shape < 2; shape++) {
        struct topology_kind kind = molecules_chain(1, type, 5, BONDED_BOND, 1);
        for (int n = 0; n < 4; n++)
            kind.term[BONDED_BOND][n] =
                (struct topology_term){.bead = {bond[shape][n][0], bond[shape][n][1]}};
        struct topology topology;
        molecules_topology(&topology, kind, (struct topology_kind){0}, 2, NULL);
        for (int n = 0; n < 2; n++)
            assert_int_equal(topology.kind[0].end[n], end[shape][n]);
        mf_topology_clear(&topology);
    }
}

static void check_refused(struct topology_kind kind, const char *message) {
    assert_int_equal(mf_topology_check(&kind), STATUS_BAD_INPUT);
    assert_string_equal(mf_status_message(), message);
    mf_topology_kind_clear(&kind);
}

static void test_terms_that_cannot_be_are_refused(void **state) {
    (void)state;
    struct topology_kind kind = molecules_chain(1, abba, 4, BONDED_DIHEDRAL, 1);
    assert_ok(mf_topology_check(&kind));
    kind.term[BONDED_BOND][1].bead[1] = 4;
    check_refused(kind, "the bond 2-5 has a bead 5, which is not there: beads are 1 to 4");
    kind = molecules_chain(1, abba, 4, BONDED_DIHEDRAL, 1);
    kind.term[BONDED_BOND][2] = (struct topology_term){.bead = {1, 0}, .group = 7};
    check_refused(kind, "duplicate bond 2-1");
    kind = molecules_chain(1, abba, 4, BONDED_DIHEDRAL, 1);
    kind.term[BONDED_ANGLE][1] = (struct topology_term){.bead = {2, 1, 0}};
    check_refused(kind, "duplicate angle 3-2-1");
    kind = molecules_chain(1, abba, 4, BONDED_DIHEDRAL, 1);
    kind.term[BONDED_DIHEDRAL][0].bead[3] = 0;
    check_refused(kind, "the dihedral 1-2-3-1 has a bead twice");
}

static void test_a_term_without_its_bonds_is_found(void **state) {
    (void)state;
    int order, pair[2];
    struct topology_kind kind = molecules_chain(1, abba, 4, BONDED_DIHEDRAL, 1);
    assert_null(mf_topology_unbonded(&kind, &order, pair));
    kind.terms[BONDED_BOND] = 2; // without the last
    assert_ptr_equal(mf_topology_unbonded(&kind, &order, pair), &kind.term[BONDED_ANGLE][1]);
    assert_int_equal(order, BONDED_ANGLE);
    assert_memory_equal(pair, ((const int[]){2, 3}), sizeof pair);
    mf_topology_kind_clear(&kind);
}

/// 1-2 and 3-4 are two pieces; 1-2, 2-4 leave bead 3 alone.
static void test_a_kind_in_pieces_is_found(void **state) {
    (void)state;
    int bead;
    struct topology_kind kind = molecules_chain(1, abba, 4, BONDED_BOND, 1);
    assert_ok(mf_topology_find_disconnected(&kind, &bead));
    assert_int_equal(bead, -1);
    kind.terms[BONDED_BOND] = 2;
    kind.term[BONDED_BOND][1].bead[0] = 2;
    kind.term[BONDED_BOND][1].bead[1] = 3;
    assert_ok(mf_topology_find_disconnected(&kind, &bead));
    assert_int_equal(bead, 2);
    kind.term[BONDED_BOND][1].bead[0] = 1;
    assert_ok(mf_topology_find_disconnected(&kind, &bead));
    assert_int_equal(bead, 2);
    mf_topology_kind_clear(&kind);
}

enum { CHAINS = 60, BEADS = 5, SINGLE = 30, COUNT = CHAINS * BEADS + SINGLE };

/// All pairs in range, by the squares of their distances, but those that are excluded.
static void check_list(const struct neighbours *neighbours, const struct particles *particles) {
    static int found[COUNT][COUNT];
    size_t wanted = 0, excluded = 0;
    memset(found, 0, sizeof found);
    for (size_t i = 0; i < COUNT; i++)
        for (size_t k = neighbours->start[i]; k < neighbours->stop[i]; k++)
            if (neighbours->list[k] != (int32_t)i)
                found[i][neighbours->list[k]]++;
    for (size_t i = 0; i < COUNT; i++)
        for (size_t j = i + 1; j < COUNT; j++) {
            const uint32_t a = particles->id[i], b = particles->id[j];
            double square = 0;
            for (int d = 0; d < 3; d++) {
                const double x = box_nearest(particles->position[d][i] - particles->position[d][j],
                                             particles->box.length[d]);
                square += x * x;
            }
            const bool is_near = square < 1, chained = a / BEADS == b / BEADS;
            const bool is_excluded = a < CHAINS * BEADS && chained && abs((int)a - (int)b) <= 2;
            const int entries = found[i][j] + found[j][i];
            if (is_excluded)
                assert_int_equal(entries, 0);
            else if (is_near)
                assert_int_equal(entries, neighbours->kind == NEIGHBOURS_HALF ? 1 : 2);
            wanted += is_near;
            excluded += is_near && is_excluded;
        }
    assert_true(wanted > 1000 && excluded > 20);
}

static void test_excluded_pairs_are_on_no_list(void **state) {
    (void)state;
    static const int type[BEADS] = {0};
    static const char *const sets[] = {"portable", "avx2", "avx512"};
    const char *const used = mf_simd_name();
    const struct box box = {3, {5, 5, 5}};
    struct topology topology;
    molecules_topology(&topology, molecules_chain(CHAINS, type, BEADS, BONDED_BOND, 2),
                       (struct topology_kind){0}, 1, (const int64_t[]){SINGLE});
    for (int set = 0; set < 3; set++)
        for (int kind = NEIGHBOURS_HALF; kind <= NEIGHBOURS_FULL; kind++) {
            struct particles particles;
            struct neighbours neighbours;
            if (!mf_simd_select(sets[set]))
                continue;
            assert_ok(mf_particles_init(&particles, &box, COUNT));
            assert_ok(mf_particles_join(&particles, &topology));
            assert_ok(mf_placement_random(&particles, 0, 3));
            for (size_t k = 1; k < CHAINS * BEADS; k++) // near their neighbours
                for (int d = 0; d < 3 && k % BEADS; d++)
                    particles.position[d][k] = particles.position[d][k - 1] + 0.3;
            assert_ok(
                mf_neighbours_init(&neighbours, (enum neighbours_kind)kind, &box, COUNT, 1, 0.1));
            assert_ok(mf_neighbours_sort_and_build(&neighbours, &particles));
            check_list(&neighbours, &particles);
            for (uint32_t id = 0; id < COUNT; id++)
                assert_int_equal(particles.id[particles.place[id]], id);
            mf_neighbours_clear(&neighbours);
            mf_particles_clear(&particles);
        }
    assert_true(mf_simd_select(used));
    mf_topology_clear(&topology);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ids_follow_from_types_and_molecules),
        cmocka_unit_test(test_pairs_inside_are_those_that_can_be_counted),
        cmocka_unit_test(test_beads_within_so_many_bonds_exclude_each_other),
        cmocka_unit_test(test_rings_exclude_each_bead_once),
        cmocka_unit_test(test_ends_are_those_of_the_bonds),
        cmocka_unit_test(test_terms_that_cannot_be_are_refused),
        cmocka_unit_test(test_a_term_without_its_bonds_is_found),
        cmocka_unit_test(test_a_kind_in_pieces_is_found),
        cmocka_unit_test(test_excluded_pairs_are_on_no_list),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
