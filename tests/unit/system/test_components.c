// SPDX-License-Identifier: GPL-3.0-or-later
//
// Components: kinds of molecules and types of single beads, how they are called, and where each has
// its site.
#include "shared/is_close.h"
#include "shared/molecules.h"
#include "shared/testing.h"
#include "system/component_sites.h"

#include <stdio.h>
#include <string.h>

static const int abb[] = {0, 1, 1}, bb[] = {1, 1};

/// Two A-B-B, three B-B, no single A, one single B, four single C.
static struct composition make(struct topology *topology) {
    return molecules_topology(topology, molecules_chain(2, abb, 3, BONDED_BOND, 1),
                              molecules_chain(3, bb, 2, BONDED_BOND, 1), 3,
                              (const int64_t[]){0, 1, 4});
}

static void name(struct topology *topology, const char *first, const char *second) {
    snprintf(topology->kind[0].name, TOPOLOGY_NAME_SIZE, "%s", first);
    snprintf(topology->kind[1].name, TOPOLOGY_NAME_SIZE, "%s", second);
}

static void test_components_are_kinds_and_types_of_single_beads(void **state) {
    (void)state;
    static const char *const names[] = {"three", "two", "B", "C"};
    static const int64_t count[] = {2, 3, 1, 4};
    struct topology topology;
    struct composition components;
    const struct composition beads = make(&topology);
    name(&topology, "three", "two");
    assert_ok(mf_components_find(&components, &beads, 17, &topology));
    assert_int_equal(components.types, 4);
    for (int c = 0; c < 4; c++) {
        assert_string_equal(components.name[c], names[c]);
        assert_int_equal(components.count[c], count[c]);
    }
    assert_ok(mf_components_find(&components, &beads, 17, NULL));
    assert_memory_equal(&components, &beads, sizeof beads);
    mf_topology_clear(&topology);
}

static void test_one_kind_alone_needs_no_name(void **state) {
    (void)state;
    struct topology topology;
    struct composition components;
    const struct composition beads = molecules_topology(
        &topology, molecules_chain(4, bb, 2, BONDED_BOND, 1), (struct topology_kind){0}, 2, NULL);
    snprintf(topology.kind[0].name, TOPOLOGY_NAME_SIZE, "a-name-of-many-characters");
    assert_ok(mf_components_find(&components, &beads, 8, &topology));
    assert_int_equal(components.types, 1);
    assert_int_equal(components.count[0], 4);
    mf_topology_clear(&topology);
}

static void assert_refused(struct topology *topology, const struct composition *beads,
                           const char *first, const char *second, const char *words) {
    struct composition components;
    name(topology, first, second);
    assert_int_equal(mf_components_find(&components, beads, 17, topology), STATUS_BAD_INPUT);
    assert_contains(mf_status_message(), words);
}

static void test_components_refuse_names_that_tell_nothing(void **state) {
    (void)state;
    struct topology topology;
    struct composition components;
    struct composition beads = make(&topology);
    assert_refused(&topology, &beads, "three", "B", "\"three-B\" would name two pairs");
    assert_refused(&topology, &beads, "C-B", "C", "\"C-B-C\" would name two pairs");
    assert_refused(&topology, &beads, "B-C", "C-B", "\"C-B-C\" would name two pairs");
    assert_refused(&topology, &beads, "sixteen-letters-", "two", "up to 15 characters");
    name(&topology, "fifteen-letters", "A");
    assert_ok(mf_components_find(&components, &beads, 17, &topology));
    for (; beads.types < COMPOSITION_MAX_TYPES; beads.types++) {
        beads.count[beads.types] = 1;
        snprintf(beads.name[beads.types], COMPOSITION_NAME_SIZE, "T%d", beads.types);
    }
    assert_refused(&topology, &beads, "three", "two", "more than 8 components");
    mf_topology_clear(&topology);
}

/// Id of each particle: they are in no order.
static const uint32_t order[] = {5, 0, 16, 11, 2, 9, 14, 1, 7, 12, 3, 15, 10, 4, 8, 13, 6};
enum { BEADS = sizeof order / sizeof *order };

/// Where each bead is, by its id, along x; y is the same, z half a unit more.
static double place_of(uint32_t id) {
    static const double x[BEADS] = {
        9.5,  3,                // A of the three
        0.5,  1.1,  2, 2,       // B-B of each
        9.75, 0.25, 4, 5, 8, 6, // of the two
        7,    1,    2, 3, 4     // single
    };
    return x[id];
}

static void test_sites_are_the_middles_of_molecules_across_the_border(void **state) {
    (void)state;
    static const double expected[] = {(9.5 + 10.5 + 11.1) / 3, 7.0 / 3, 10, 4.5, 7, 7, 1, 2, 3, 4};
    static const struct box box = {3, {10, 10, 10}};
    struct topology topology;
    struct particles particles;
    struct component_sites sites;
    const struct composition beads = make(&topology);
    name(&topology, "three", "two");
    assert_ok(mf_particles_init(&particles, &box, BEADS));
    assert_ok(mf_particles_join(&particles, &topology));
    for (size_t k = 0; k < BEADS; k++) {
        particles.id[k] = order[k];
        for (int d = 0; d < 3; d++)
            particles.position[d][k] = place_of(order[k]) + (d == 2 ? 0.5 : 0);
    }
    mf_particles_label_places(&particles);
    assert_ok(mf_component_sites_init(&sites, 3, &beads, BEADS, &topology));
    mf_component_sites_find(&sites, &particles);
    for (int d = 0; d < 3; d++)
        for (size_t k = 0; k < 10; k++) {
            const double off = sites.site[d][k] - expected[k] - (d == 2 ? 0.5 : 0);
            assert_close(box_nearest(off, box.length[d]), 0, 1e-12);
        }
    mf_component_sites_clear(&sites);
    mf_particles_clear(&particles);
    mf_topology_clear(&topology);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_components_are_kinds_and_types_of_single_beads),
        cmocka_unit_test(test_one_kind_alone_needs_no_name),
        cmocka_unit_test(test_components_refuse_names_that_tell_nothing),
        cmocka_unit_test(test_sites_are_the_middles_of_molecules_across_the_border),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
