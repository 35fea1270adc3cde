// SPDX-License-Identifier: GPL-3.0-or-later
//
// Systems of other numbers of beads: shares that stay, pairs that there are, and molecules that are
// whole.
#include "shared/is_close.h"
#include "shared/molecules.h"
#include "shared/testing.h"
#include "system/scaled_system.h"

static const int aba[] = {0, 1, 0}, bb[] = {1, 1};

/// A-B-A, B-B, and single beads A, B and C.
static struct composition make(struct topology *topology, int64_t first, int64_t second,
                               const int64_t single[3]) {
    return molecules_topology(topology, molecules_chain(first, aba, 3, BONDED_ANGLE, 1),
                              molecules_chain(second, bb, 2, BONDED_BOND, 1), 3, single);
}

static void test_single_beads_keep_their_shares(void **state) {
    (void)state;
    const struct composition rare = {.types = 2, .count = {990, 10}};
    const struct composition one = {.types = 2, .count = {1, 999}};
    const struct scaled_system small = mf_scaled_system(&rare, NULL, 100);
    assert_int_equal(small.composition.count[0], 99);
    assert_int_equal(small.composition.count[1], 2);
    // 2 of 101 instead of 1 of 100.
    assert_close(small.distortion, 200.0 / 101 - 1, 1e-12);
    assert_close(mf_scaled_system(&rare, NULL, 1000).distortion, 0, 0);
    // 2 of 167 are 1.198 of 1 in 100.
    assert_int_equal(mf_scaled_system_min(&rare, NULL, 100, 0.2), 167);
    assert_int_equal(mf_scaled_system_min(&rare, NULL, 180, 0.2), 180);
    assert_int_equal(mf_scaled_system_min(&rare, NULL, 100, 0), 200);
    // Two of a single bead would have a pair, of whose potential nothing is known.
    assert_true(mf_scaled_system(&one, NULL, 4000).distortion < 2e-3);
    assert_int_equal(mf_scaled_system_min(&one, NULL, 4000, 0.05), 4000);
}

static void test_molecules_are_scaled_as_a_whole(void **state) {
    (void)state;
    struct topology topology;
    const struct composition composition = make(&topology, 300, 40, (const int64_t[]){20, 60, 0});
    const struct scaled_system half = mf_scaled_system(&composition, &topology, 530);
    const int64_t beads[] = {610, 300, 150};
    assert_int_equal(half.molecules[0], 150);
    assert_int_equal(half.molecules[1], 20);
    assert_int_equal(half.composition.count[0], beads[0] / 2 + 5);
    assert_int_equal(half.composition.count[1], 150 + 2 * 20 + 30);
    assert_int_equal(half.composition.count[2], 0);
    assert_true(half.distortion < 1e-12);
    mf_topology_clear(&topology);
}

/// Two kinds of the same beads: their types keep their shares where the kinds do not.
static void test_a_kind_that_changes_its_share_distorts(void **state) {
    (void)state;
    struct topology topology;
    const struct composition composition = make(&topology, 200, 3, (const int64_t[]){0, 194, 0});
    const struct scaled_system small = mf_scaled_system(&composition, &topology, 80);
    assert_int_equal(small.molecules[1], 2); // of 0.3
    assert_true(small.distortion > 3);
    // Alone, a kind keeps its one molecule: its share is 1.05 times as large of 762 beads.
    mf_topology_clear(&topology);
    const struct composition with_one = make(&topology, 200, 1, (const int64_t[]){0, 198, 0});
    assert_int_equal(mf_scaled_system(&with_one, &topology, 400).molecules[1], 1);
    assert_int_equal(mf_scaled_system_min(&with_one, &topology, 100, 0.05), 762);
    mf_topology_clear(&topology);
}

/// Pairs within molecules are no hindrance of one kind alone, or where none of them is counted.
static void test_mixtures_whose_molecules_count_their_own_pairs_are_not_alike(void **state) {
    static const struct {
        int64_t second, single;
        int exclude;
        bool alike;
    } cases[] = {
        {0, 0, 1, true}, {0, 5, 1, false}, {4, 0, 1, false}, {0, 5, 2, true}, {4, 5, 2, true}};
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct topology topology;
        const struct composition composition = molecules_topology(
            &topology, molecules_chain(30, aba, 3, BONDED_ANGLE, cases[k].exclude),
            molecules_chain(cases[k].second, bb, 2, BONDED_BOND, 1), 3,
            (const int64_t[]){0, 0, cases[k].single});
        assert_true(mf_scaled_system_is_alike(&composition, &topology) == cases[k].alike);
        mf_topology_clear(&topology);
    }
    assert_true(
        mf_scaled_system_is_alike(&(struct composition){.types = 2, .count = {3, 4}}, NULL));
}

/// Each bead of the scaled topology has the type, the molecule and the bonds of its kind.
static void test_the_topology_is_whole(void **state) {
    (void)state;
    struct topology topology, small;
    const struct composition composition = make(&topology, 300, 40, (const int64_t[]){20, 60, 0});
    const struct scaled_system system = mf_scaled_system(&composition, &topology, 106);
    assert_ok(mf_scaled_system_topology(&system, &topology, &small));
    assert_int_equal(small.kinds, 2);
    assert_int_equal(small.particles, mf_composition_particles(&system.composition));
    assert_int_equal(small.molecules, system.molecules[0] + system.molecules[1]);
    for (int k = 0; k < 2; k++) {
        const struct topology_kind *kind = &small.kind[k], *from = &topology.kind[k];
        assert_string_equal(kind->name, from->name);
        assert_int_equal(kind->exclude, from->exclude);
        assert_memory_equal(kind->near_start, from->near_start,
                            (size_t)(from->beads + 1) * sizeof *from->near_start);
        for (int order = 0; order < BONDED_KINDS; order++) {
            assert_int_equal(kind->terms[order], from->terms[order]);
            if (kind->terms[order] > 0)
                assert_memory_equal(kind->term[order], from->term[order],
                                    (size_t)kind->terms[order] * sizeof *kind->term[order]);
        }
        for (int64_t m = 0; m < kind->count; m++)
            for (int bead = 0; bead < kind->beads; bead++) {
                const uint32_t id = topology_id(kind, m, bead);
                assert_int_equal(mf_composition_type(&system.composition, id), from->type[bead]);
                assert_int_equal(small.molecule[id], (uint32_t)(kind->first + m));
            }
    }
    mf_topology_clear(&small);
    mf_topology_clear(&topology);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_single_beads_keep_their_shares),
        cmocka_unit_test(test_molecules_are_scaled_as_a_whole),
        cmocka_unit_test(test_a_kind_that_changes_its_share_distorts),
        cmocka_unit_test(test_mixtures_whose_molecules_count_their_own_pairs_are_not_alike),
        cmocka_unit_test(test_the_topology_is_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
