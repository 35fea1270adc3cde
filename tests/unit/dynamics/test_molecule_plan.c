// SPDX-License-Identifier: GPL-3.0-or-later
//
// What Monte Carlo moves know of a kind of molecules: arms of chains, stars and rings with tails,
// as one counts them by hand, and the terms of each bead.
#include "dynamics/molecule_moves.h"

#include "base/memory.h"
#include "shared/molecules.h"
#include "shared/testing.h"

#include <stdlib.h>

enum { MAX = 12 };
static const int type[MAX] = {0};

/// A molecule of these bonds, two numbers each.
static struct topology_kind make_graph(int beads, int bonds, const int (*pair)[2], int exclude) {
    struct topology_kind kind = molecules_chain(1, type, beads, -1, exclude);
    kind.terms[BONDED_BOND] = bonds;
    kind.term[BONDED_BOND] = mf_memory_zeroed((size_t)bonds, sizeof(struct topology_term));
    for (int n = 0; n < bonds; n++)
        for (int k = 0; k < 2; k++)
            kind.term[BONDED_BOND][n].bead[k] = pair[n][k];
    return kind;
}

static void plan_graph(struct molecule_plan *plan, struct topology *topology,
                       struct topology_kind kind) {
    molecules_topology(topology, kind, (struct topology_kind){0}, 1, NULL);
    assert_ok(mf_molecule_plan_init(plan, &topology->kind[0]));
}

static int compare(const void *a, const void *b) {
    return *(const int *)a - *(const int *)b;
}

/// An arm as "pivot-first: beads", sorted.
static void describe(const struct molecule_plan *plan, int n, char *text) {
    const struct molecule_arm *arm = &plan->arm[n];
    int bead[MAX] = {0};
    const int beads = molecule_arm_beads(plan, arm);
    for (int k = 0; k < beads; k++)
        bead[k] = molecule_arm_bead(plan, arm, k);
    qsort(bead, (size_t)beads, sizeof *bead, compare);
    text += sprintf(text, "%d-%d:", arm->pivot, arm->first);
    for (int k = 0; k < beads; k++)
        text += sprintf(text, " %d", bead[k]);
}

static void check_arms(const struct molecule_plan *plan, int arms, const char *const *expected) {
    assert_int_equal(plan->arms, arms);
    for (int n = 0; n < arms; n++) {
        char text[100];
        bool found = false;
        describe(plan, n, text);
        for (int m = 0; m < arms; m++)
            found |= strcmp(text, expected[m]) == 0;
        if (!found)
            fail_msg("arm \"%s\"", text);
    }
}

static void test_arms_are_the_smaller_sides_of_bonds_in_no_ring(void **state) {
    (void)state;
    static const struct {
        int beads, bonds, pair[MAX][2], arms;
        const char *arm[MAX];
    } graphs[] = {
        {4, 3, {{0, 1}, {1, 2}, {2, 3}}, 3, {"1-0: 0", "1-2: 2 3", "2-3: 3"}},
        {4, 3, {{3, 1}, {1, 0}, {1, 2}}, 3, {"1-0: 0", "1-2: 2", "1-3: 3"}},
        {3, 3, {{0, 1}, {1, 2}, {2, 0}}, 0, {0}},
        // A ring of four with a tail of two, a fork at its end.
        {8,
         8,
         {{4, 5}, {0, 1}, {1, 2}, {2, 3}, {3, 0}, {2, 4}, {5, 6}, {5, 7}},
         4,
         {"2-4: 4 5 6 7", "4-5: 5 6 7", "5-6: 6", "5-7: 7"}},
        // Two rings, joined by a bond.
        {6, 7, {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {1, 4}}, 1, {"1-4: 3 4 5"}},
    };
    for (size_t n = 0; n < sizeof graphs / sizeof *graphs; n++) {
        struct topology topology;
        struct molecule_plan plan;
        plan_graph(&plan, &topology,
                   make_graph(graphs[n].beads, graphs[n].bonds, graphs[n].pair, 1));
        assert_true(plan.joined);
        check_arms(&plan, graphs[n].arms, graphs[n].arm);
        mf_molecule_plan_clear(&plan);
        mf_topology_clear(&topology);
    }
}

static void test_what_bonds_do_not_join_has_no_arms(void **state) {
    (void)state;
    static const int apart[][2] = {{0, 1}, {2, 3}};
    struct topology topology;
    struct molecule_plan plan;
    plan_graph(&plan, &topology, make_graph(4, 2, apart, 1));
    assert_false(plan.joined);
    assert_int_equal(plan.arms, 0);
    mf_molecule_plan_clear(&plan);
    mf_topology_clear(&topology);
    // An angle between beads that are not bonded.
    static const int chain[][2] = {{0, 1}, {1, 2}, {2, 3}};
    struct topology_kind kind = make_graph(4, 3, chain, 1);
    kind.terms[BONDED_ANGLE] = 1;
    kind.term[BONDED_ANGLE] = mf_memory_zeroed(1, sizeof(struct topology_term));
    *kind.term[BONDED_ANGLE] = (struct topology_term){.bead = {0, 2, 3}};
    plan_graph(&plan, &topology, kind);
    assert_true(plan.joined);
    assert_int_equal(plan.arms, 0);
    mf_molecule_plan_clear(&plan);
    mf_topology_clear(&topology);
}

static void test_terms_of_a_bead_stand_by_law(void **state) {
    (void)state;
    struct topology topology;
    struct molecule_plan plan;
    struct topology_kind kind = molecules_chain(1, type, 5, BONDED_DIHEDRAL, 4);
    kind.term[BONDED_BOND][1].group = 1;
    plan_graph(&plan, &topology, kind);
    // Bead 1: a bond of each group, two angles, two dihedrals.
    static const int expected[][3] = {
        {BONDED_BOND, 0, 1}, {BONDED_BOND, 1, 1}, {BONDED_ANGLE, 0, 2}, {BONDED_DIHEDRAL, 0, 2}};
    assert_int_equal(plan.run_start[2] - plan.run_start[1], 4);
    for (int n = 0; n < 4; n++) {
        const struct molecule_run *run = &plan.run[plan.run_start[1] + n];
        assert_int_equal(run->order, expected[n][0]);
        assert_int_equal(run->group, expected[n][1]);
        assert_int_equal(run->count, expected[n][2]);
        for (int t = 0; t < run->count; t++) {
            bool has = false;
            for (int k = 0; k < mf_bonded_kinds[run->order]->beads; k++)
                has |= plan.term_bead[run->first +
                                      (size_t)(t * mf_bonded_kinds[run->order]->beads + k)] == 1;
            assert_true(has);
        }
    }
    mf_molecule_plan_clear(&plan);
    mf_topology_clear(&topology);
}

static void test_pairs_of_a_molecule_may_all_be_excluded(void **state) {
    (void)state;
    for (int exclude = 1; exclude <= 2; exclude++) {
        struct topology topology;
        struct molecule_plan plan;
        plan_graph(&plan, &topology, molecules_chain(1, type, 3, BONDED_BOND, exclude));
        assert_int_equal(plan.excluded, exclude == 2);
        mf_molecule_plan_clear(&plan);
        mf_topology_clear(&topology);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_arms_are_the_smaller_sides_of_bonds_in_no_ring),
        cmocka_unit_test(test_what_bonds_do_not_join_has_no_arms),
        cmocka_unit_test(test_terms_of_a_bead_stand_by_law),
        cmocka_unit_test(test_pairs_of_a_molecule_may_all_be_excluded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
