// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/testing.h"
#include "trajectory/elements.h"
#include "trajectory/structure.h"

#include <math.h>
#include <stdio.h>

static struct structure make(size_t atoms, const int *residue, const int *molecule) {
    struct structure structure;
    assert_ok(mf_structure_init(&structure, atoms));
    structure.has_residues = residue != NULL;
    structure.has_molecules = molecule != NULL;
    for (size_t k = 0; k < atoms; k++) {
        structure.atom[k].residue_number = residue ? residue[k] : 0;
        structure.atom[k].molecule = molecule ? molecule[k] : 0;
        structure.atom[k].id = (int64_t)(3 * k + 5);
    }
    assert_ok(mf_structure_number_residues(&structure));
    return structure;
}

/// Runs of the same number, which may come again; molecules wherever their atoms are.
static void test_residues_are_runs_and_molecules_are_not(void **state) {
    static const int numbers[] = {1, 1, 2, 2, 1, 1}, residues[] = {0, 0, 1, 1, 2, 2};
    static const int molecules[] = {7, 0, 3, 7, 0, 3}, found[] = {3, 0, 2, 3, 1, 2};
    struct structure runs = make(6, numbers, NULL), scattered = make(6, NULL, molecules);
    (void)state;
    assert_int_equal(runs.residues, 3);
    assert_int_equal(scattered.residues, 4);
    for (int k = 0; k < 6; k++) {
        assert_int_equal(runs.atom[k].residue, residues[k]);
        assert_int_equal(scattered.atom[k].residue, found[k]);
    }
    mf_structure_clear(&runs);
    mf_structure_clear(&scattered);
}

/// A ring of 4 joined to a chain in whatever order, a pair, and one that is alone.
static void test_molecules_are_what_bonds_join(void **state) {
    static const uint32_t bonds[][2] = {{6, 2}, {7, 4}, {1, 2}, {5, 6}, {1, 5}, {0, 5}};
    static const int64_t molecule[] = {1, 1, 1, 0, 5, 1, 1, 5};
    struct structure structure = make(8, NULL, NULL);
    (void)state;
    assert_ok(mf_structure_join(&structure, bonds, 6));
    assert_ok(mf_structure_number_residues(&structure));
    for (int k = 0; k < 8; k++)
        assert_int_equal(structure.atom[k].molecule, molecule[k]);
    assert_int_equal(structure.residues, 3);
    assert_fails(mf_structure_join(&structure, (const uint32_t[][2]){{3, 8}}, 1), STATUS_BAD_INPUT,
                 "bond 1 is of the atoms 4 and 9 of 8");
    mf_structure_clear(&structure);
}

static void test_atoms_are_found_by_ids_with_gaps(void **state) {
    struct structure structure = make(100, NULL, NULL);
    (void)state;
    for (int64_t id = 0; id < 310; id++) {
        const size_t found = mf_structure_find(&structure, id);
        const bool there = id >= 5 && id < 305 && (id - 5) % 3 == 0;
        assert_int_equal(found, there ? (id - 5) / 3 : 100);
    }
    structure.atom[3].id = 5;
    assert_fails(mf_structure_sort(&structure), STATUS_BAD_INPUT, "two atoms have the id 5");
    mf_structure_clear(&structure);
}

static void test_structures_of_other_atoms_are_not_the_same(void **state) {
    struct structure a = make(3, NULL, NULL), b = make(3, NULL, NULL), c = make(2, NULL, NULL);
    (void)state;
    assert_ok(mf_structure_check_same(&a, "a", &b, "b"));
    assert_fails(mf_structure_check_same(&a, "a", &c, "c"), STATUS_BAD_INPUT,
                 "c: has 2 atoms, a has 3");
    a.has_names = b.has_names = true;
    snprintf(b.atom[2].name, STRUCTURE_NAME, "X");
    assert_fails(mf_structure_check_same(&a, "a", &b, "b"), STATUS_BAD_INPUT,
                 "b: atom 3 is called \"X\"");
    b.names = STRUCTURE_TYPES;
    assert_ok(mf_structure_check_same(&a, "a", &b, "b"));
    mf_structure_clear(&a);
    mf_structure_clear(&b);
    mf_structure_clear(&c);
}

static const char *guess_of(const char *name, const char *residue, const char *element,
                            bool alone) {
    static struct structure_atom atom;
    snprintf(atom.name, STRUCTURE_NAME, "%s", name);
    snprintf(atom.residue_name, STRUCTURE_NAME, "%s", residue);
    snprintf(atom.element, STRUCTURE_NAME, "%s", element);
    const char *const symbol = mf_elements_guess(&atom, alone);
    return symbol ? symbol : "none";
}

static const char *guess(const char *name, const char *residue, const char *element) {
    return guess_of(name, residue, element, false);
}

static void test_elements_are_guessed_by_names(void **state) {
    (void)state;
    assert_string_equal(guess("OW", "SOL", ""), "O");
    assert_string_equal(guess("HW1", "SOL", ""), "H");
    assert_string_equal(guess("1HB", "ALA", ""), "H");
    assert_string_equal(guess("CA", "ALA", ""), "C");
    assert_string_equal(guess("CA", "CA", ""), "Ca");
    assert_string_equal(guess("CA", "CA2+", ""), "Ca");
    assert_string_equal(guess("CA", "ALA", "Ca"), "Ca");
    assert_string_equal(guess("CL1", "LIG", ""), "Cl");
    assert_string_equal(guess("BR", "LIG", ""), "Br");
    assert_string_equal(guess("CLA", "LIP", ""), "C");
    assert_string_equal(guess("Ar", "", ""), "Ar");
    assert_string_equal(guess("H3'", "DA", ""), "H");
    assert_string_equal(guess("1", "", ""), "none");
    assert_string_equal(guess("QQ", "", ""), "none");
    assert_true(fabs(mf_elements_mass("O") - 15.999) < 1e-12 && isnan(mf_elements_mass("Xx")));
}

/// What proteins, nucleotides and lipids call their atoms stays as it is.
static void test_elements_in_capitals_are_guessed_where_they_are_no_other_names(void **state) {
    static const char *const capitals[][2] = {{"SI", "Si"},  {"SE", "Se"}, {"FE", "Fe"},
                                              {"CU1", "Cu"}, {"ZN", "Zn"}, {"AU12", "Au"},
                                              {"AL", "Al"},  {"NI", "Ni"}, {"TI", "Ti"}};
    static const char *const organic[][2] = {
        {"CA", "C"}, {"CB", "C"}, {"CD", "C"}, {"CE", "C"},  {"NA", "N"}, {"ND", "N"},
        {"NE", "N"}, {"HG", "H"}, {"HE", "H"}, {"HO", "H"},  {"PB", "P"}, {"SG", "S"},
        {"OS", "O"}, {"CS", "C"}, {"CO", "C"}, {"CR1", "C"}, {"NB", "N"}, {"SD", "S"}};
    (void)state;
    for (size_t k = 0; k < sizeof capitals / sizeof *capitals; k++)
        assert_string_equal(guess(capitals[k][0], "LIG", ""), capitals[k][1]);
    for (size_t k = 0; k < sizeof organic / sizeof *organic; k++)
        assert_string_equal(guess(organic[k][0], "LIG", ""), organic[k][1]);
    assert_string_equal(guess_of("NA", "ION", "", true), "Na");
    assert_string_equal(guess_of("CS", "Ion", "", true), "Cs");
    assert_string_equal(guess_of("CA", "ALA", "", true), "C");
    assert_string_equal(guess_of("CA", "ION", "", true), "Ca");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_residues_are_runs_and_molecules_are_not),
        cmocka_unit_test(test_molecules_are_what_bonds_join),
        cmocka_unit_test(test_atoms_are_found_by_ids_with_gaps),
        cmocka_unit_test(test_structures_of_other_atoms_are_not_the_same),
        cmocka_unit_test(test_elements_are_guessed_by_names),
        cmocka_unit_test(test_elements_in_capitals_are_guessed_where_they_are_no_other_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
