// SPDX-License-Identifier: GPL-3.0-or-later
//
// Molecules of a file that lists terms beside its atoms: kinds, their counts and groups of a PSF
// written by hand; what cannot be taken.
#include "shared/temporary_folder.h"
#include "shared/testing.h"
#include "topologies/structure_topology.h"

#include <stdio.h>

static struct molecules molecules;
static struct composition types;

static enum status try(void **state, const char *text) {
    molecules = (struct molecules){.groups = {0}};
    types = (struct composition){0};
    return mf_structure_topology_read(&molecules, &types,
                                      temporary_folder_write(*state, "a.psf", text, strlen(text)));
}

static void assert_refused(void **state, const char *text, const char *part) {
    assert_fails(try(state, text), STATUS_BAD_INPUT, part);
    mf_molecules_clear(&molecules);
}

#define ATOM(n, name) #n " X 1 M " name " t 0 1 0\n"

/// Two chains B-A-A between single beads S, the second of which is listed from its other end.
static void test_molecules_are_what_terms_join(void **state) {
    assert_ok(try(state, "PSF\n\n8 !NATOM\n" ATOM(1, "S") ATOM(2, "B") ATOM(3, "A") ATOM(4, "A")
                             ATOM(5, "S") ATOM(6, "B") ATOM(7, "A")
                                 ATOM(8, "A") "\n4 !NBOND\n2 3 3 4 8 7 7 6\n"
                                              "\n2 !NTHETA\n2 3 4 8 7 6\n"));
    const struct topology_kind *const kind = &molecules.topology.kind[0];
    assert_int_equal(molecules.topology.kinds, 1);
    assert_int_equal(kind->count, 2);
    assert_int_equal(kind->beads, 3);
    assert_string_equal(types.name[kind->type[0]], "B");
    assert_string_equal(types.name[kind->type[2]], "A");
    assert_int_equal(types.types, 3);
    assert_int_equal(molecules.groups[BONDED_BOND], 2);
    assert_string_equal(molecules.group[BONDED_BOND][0].name, "A-B");
    assert_string_equal(molecules.group[BONDED_BOND][1].name, "A-A");
    assert_string_equal(molecules.group[BONDED_ANGLE][0].name, "A-A-B");
    assert_int_equal(kind->terms[BONDED_BOND], 2);
    assert_int_equal(kind->terms[BONDED_ANGLE], 1);
    assert_int_equal(kind->terms[BONDED_DIHEDRAL], 0);
    assert_int_equal(kind->exclude, mf_bonded_kinds[BONDED_ANGLE]->reach);
    mf_molecules_clear(&molecules);
}

static void test_what_cannot_be_taken_is_refused(void **state) {
    assert_refused(state, "PSF\n\n2 !NATOM\n" ATOM(1, "A") ATOM(2, "A") "\n0 !NBOND\n",
                   "a.psf: no bond joins any atoms");
    assert_refused(state, "PSF\n\n2 !NATOM\n" ATOM(1, "A") ATOM(2, "A") "\n2 !NBOND\n1 2 2 1\n",
                   "a.psf: molecule-1: ");
    assert_refused(state, "PSF\n\n2 !NATOM\n" ATOM(1, "A*") ATOM(2, "A+") "\n1 !NBOND\n1 2\n",
                   "\"A*\" and \"A+\" would both be the type \"A_\": give the molecules by a JSON");
    assert_refused(state,
                   "PSF\n\n6 !NATOM\n" ATOM(1, "A") ATOM(2, "A") ATOM(3, "A") ATOM(4, "A")
                       ATOM(5, "A") ATOM(6, "A") "\n5 !NBOND\n1 2 2 3 4 5 5 6 6 4\n",
                   "molecules of the same beads differ");
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_molecules_are_what_terms_join),
        TEST(test_what_cannot_be_taken_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
