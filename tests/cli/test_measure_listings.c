// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit measure --molecules` with files that list atoms and what joins them, whatever laws they
// have: data files and templates of LAMMPS, topologies of GROMACS. Molecules of three beads in a
// line, 0.3 and 0.4 nm apart, have R_e² = 0.49 nm², and R_g² by their masses.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CHAINS = 8, ATOMS = 3 * CHAINS, SIZE = 1 << 13 };
static struct run_program_result result;

#define MEASURE(...)                                                                               \
    do {                                                                                           \
        RUN_PROGRAM(&result, "measure", "--static", "--temperature", "300", __VA_ARGS__);          \
        run_program_assert_code(&result, 0);                                                       \
    } while (0)

/// Beads of a chain lie along x, those of the third kind of place behind all others of the first
/// two: atom of bead b of chain c, from 0, if they do not follow each other.
static int atom_of(int chain, int bead) {
    return bead * CHAINS + chain;
}

static double x_of(int bead) {
    return bead == 0 ? 0 : bead == 1 ? 0.3 : 0.7;
}

#define ADD(...) length += snprintf(text + length, SIZE - (size_t)length, __VA_ARGS__)

/// A dump, whose atoms have ids and types 1 and 2, "1 2 1".
static void write_dump(struct temporary_folder *folder) {
    char text[SIZE];
    int length = 0;
    ADD("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n%d\nITEM: BOX BOUNDS pp pp pp\n0 4\n0 4\n0 4\n"
        "ITEM: ATOMS id type x y z\n",
        ATOMS);
    for (int chain = CHAINS; chain-- > 0;)
        for (int bead = 0; bead < 3; bead++)
            ADD("%d %d %g %g %g\n", atom_of(chain, bead) + 1, bead == 1 ? 2 : 1,
                0.4 * chain + x_of(bead), 0.5 * chain, 0.3 * (chain % 3));
    small_inputs_write(folder, "chains.dump", text, NULL, NULL);
}

/// The data file, with numbers or labels of types, the second of which is given; all atoms are of
/// molecule 1, as some write it.
static void write_data(struct temporary_folder *folder, const char *name, const char *label) {
    const char *const type[] = {label ? "A" : "1", label ? label : "2"};
    char text[SIZE], labels[128] = "", bond[64] = "1";
    int length = 0;
    if (label) {
        snprintf(bond, sizeof bond, "A-%s", label);
        snprintf(labels, sizeof labels,
                 "\nAtom Type Labels\n\n1 A\n2 %s\n\nBond Type Labels\n\n1 %s\n", label, bond);
    }
    ADD("by hand\n\n%d atoms\n2 atom types\n%d bonds\n1 bond types\n0 4 xlo xhi\n0 4 ylo yhi\n"
        "0 4 zlo zhi\n%s\nMasses\n\n%s 12\n%s 14 # one\n\nAtoms # bond\n\n",
        ATOMS, 2 * CHAINS, labels, type[0], type[1]);
    for (int n = 0; n < ATOMS; n++)
        ADD("%d 1 %s 0 0 %g\n", n + 1, type[n / CHAINS == 1], 0.1 * n);
    ADD("\nBonds\n\n");
    for (int n = 0; n < 2 * CHAINS; n++)
        ADD("%d %s %d %d\n", n + 1, bond, atom_of(n / 2, n % 2) + 1, atom_of(n / 2, n % 2 + 1) + 1);
    small_inputs_write(folder, name, text, NULL, NULL);
}

static void assert_holds(const char *file, const char *words) {
    char *const text = temporary_folder_read(file);
    assert_contains(text, words);
    free(text);
}

/// R_g^2 is Σ m_i m_j r_ij²/M² over pairs.
static void assert_chains(const char *name, const char *gyration) {
    assert_contains(result.err, name);
    assert_contains(result.err, ": R_e^2 0.49");
    assert_contains(result.err, gyration);
}

/// Bonds are between ids, wherever these stand.
static void test_molecules_are_those_of_a_data_file_of_lammps(void **state) {
    write_dump(*state);
    write_data(*state, "chains.data", NULL);
    write_data(*state, "data.labels", "Bb");
    write_data(*state, "data.signs", "[C*+]");
    MEASURE("chains.dump", "--file-units", "nano", "--molecules", "chains.data", "-o", "numbers");
    assert_chains("molecule-1", "R_g^2 0.07795 "); // of 12, 14 and 12 u
    assert_contains(result.err, "1: 16 beads of 1 atom");
    MEASURE("chains.dump", "--file-units", "nano", "--molecules", "data.labels", "-o", "labels");
    assert_chains("molecule-1", "R_g^2 0.07795 ");
    assert_contains(result.err, "Bb: 8 beads of 1 atom");
    assert_true(temporary_folder_exists("labels/rdf_A-Bb.tsv"));
    // What no name of a table may have becomes "_".
    MEASURE("chains.dump", "--file-units", "nano", "--molecules", "data.signs", "-o", "signs");
    assert_chains("molecule-1", "R_g^2 0.07795 ");
    assert_contains(result.err, "_C___: 8 beads of 1 atom");
    assert_holds("signs/bond_lengths.tsv", "\tA-_C___[1/nm]");
    // As a structure, all of whose atoms are of molecule 1, bonds tell molecules apart.
    MEASURE("chains.dump", "--file-units", "nano", "-s", "chains.data", "-o", "beads");
    assert_contains(result.err, "8 beads of 3 atoms");
}

/// Atoms of the same ids are the same atoms: a file of other types is of another system.
static void test_a_data_file_of_other_types_is_refused(void **state) {
    static const char *const files[] = {"chains.data", "data.labels"};
    write_dump(*state);
    write_data(*state, "chains.data", NULL);
    write_data(*state, "data.labels", "Bb");
    char *const dump = temporary_folder_read("chains.dump"), *const second = strstr(dump, "\n9 2 ");
    second[3] = '1';
    small_inputs_write(*state, "other.dump", dump, NULL, NULL);
    free(dump);
    for (int k = 0; k < 2; k++) {
        char message[64];
        snprintf(message, sizeof message, "%s: atom 9 is of type 2, in the trajectory of 1",
                 files[k]);
        RUN_PROGRAM(&result, "measure", "other.dump", "--static", "--file-units", "nano",
                    "--molecules", files[k], "-o", "other");
        run_program_assert_code(&result, 2);
        assert_contains(result.err, message);
    }
}

/// Three atoms of a template stand for all, one after the other.
static void test_molecules_are_those_of_a_template_of_lammps(void **state) {
    static const char template[] =
        "# one\n\n3 atoms\n2 bonds\n\nCoords\n\n1 0 0 0\n2 3 0 0\n3 7 0 0\n\n"
        "Types\n\n1 1\n2 2\n3 1\n\nBonds\n\n1 4 1 2\n2 7 3 2\n";
    char text[SIZE];
    int length = 0;
    ADD("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n%d\nITEM: BOX BOUNDS pp pp pp\n0 4\n0 4\n0 4\n"
        "ITEM: ATOMS id type x y z\n",
        ATOMS);
    for (int n = 0; n < ATOMS; n++)
        ADD("%d %d %g %g %g\n", n + 1, n % 3 == 1 ? 2 : 1, 0.4 * (n / 3) + x_of(n % 3),
            0.5 * (n / 3), 0.3 * (n / 3 % 3));
    small_inputs_write(*state, "chains.dump", text, NULL, NULL);
    small_inputs_write(*state, "chain.mol", template, NULL, NULL);
    MEASURE("chains.dump", "--file-units", "nano", "--molecules", "chain.mol", "-o", "out");
    assert_chains("molecule-1", "R_g^2 0.08222 "); // of equal masses
    assert_holds("out/bond_lengths.tsv", "\t4[1/nm]");
    assert_holds("out/bond_lengths.tsv", "\t7[1/nm]");
    // Beside a file that has names for the numbers of types.
    length = 0;
    ADD("by hand\n\n%d atoms\n2 atom types\n0 4 xlo xhi\n0 4 ylo yhi\n0 4 zlo zhi\n\n"
        "Atom Type Labels\n\n1 A\n2 Bb\n\nMasses\n\nA 12\nBb 14\n\nAtoms # bond\n\n",
        ATOMS);
    for (int n = 0; n < ATOMS; n++)
        ADD("%d %d %s 0 0 %g\n", n + 1, n / 3 + 1, n % 3 == 1 ? "Bb" : "A", 0.1 * n);
    small_inputs_write(*state, "named.data", text, NULL, NULL);
    MEASURE("chains.dump", "--file-units", "nano", "-s", "named.data", "--molecules", "chain.mol",
            "-o", "named");
    assert_chains("molecule-1", "R_g^2 0.07795 ");
}

static void write_gro(struct temporary_folder *folder) {
    static const char *const names[] = {"NC3", "PO4", "GL1"};
    char text[SIZE];
    int length = 0;
    ADD("by hand\n%d\n", ATOMS);
    for (int n = 0; n < ATOMS; n++)
        ADD("%5dLIP  %5s%5d%8.3f%8.3f%8.3f\n", n / 3 + 1, names[n % 3], n + 1,
            0.4 * (n / 3) + x_of(n % 3), 0.5 * (n / 3), 0.3 * (n / 3 % 3));
    ADD("   4.00000   4.00000   4.00000\n");
    small_inputs_write(folder, "chains.gro", text, NULL, NULL);
}

static const char topology[] =
    "[ defaults ]\n1 1\n[ atomtypes ]\nQ0 72 0 A 0 0\nQa 60 0 A 0 0\n"
    "[ moleculetype ]\nLIP 1\n[ atoms ]\n1 Q0 1 LIP NC3 1 1\n2 Qa 1 LIP PO4 2 -1\n"
    "3 Q0 1 LIP GL1 3 0\n[ constraints ]\n1 2 1 0.3\n[ bonds ]\n2 3 6 0.4 1250\n"
    "[ angles ]\n1 2 3 10 180 25\n[ exclusions ]\n1 3\n[ position_restraints ]\n1 1 1 1 1\n";

/// Names of atoms in the one, their types in the other; constraints, functions that are no laws
/// here, sections that say nothing of what is measured; masses of the same file.
static void test_molecules_are_those_of_a_topology_whatever_its_laws(void **state) {
    char whole[sizeof topology + 64];
    snprintf(whole, sizeof whole, "%s[ system ]\ns\n[ molecules ]\nLIP %d\n", topology, CHAINS);
    write_gro(*state);
    small_inputs_write(*state, "topol.top", whole, NULL, NULL);
    small_inputs_write(*state, "lip.itp", topology, NULL, NULL);
    MEASURE("chains.gro", "--molecules", "topol.top", "-o", "top");
    assert_chains("LIP", "R_g^2 0.08699 "); // of 72, 60 and 72 u
    assert_contains(result.err, "Q0: 16 beads of 1 atom, the first of 72 u");
    assert_contains(result.err, "Qa: 8 beads of 1 atom, the first of 60 u");
    assert_holds("top/bond_lengths.tsv", "\tQ0-Qa[1/nm]");
    assert_holds("top/bond_lengths.tsv", "\tQa-Q0[1/nm]");
    assert_holds("top/bond_angles.tsv", "\tQ0-Qa-Q0[1/degrees]");
    MEASURE("chains.gro", "--molecules", "lip.itp", "-o", "itp");
    assert_chains("LIP", "R_g^2 0.08699 "); // of 72, 60 and 72 u
    results_assert_same("top", "itp",
                        (const char *const[]){"rdf_Q0-Qa.tsv", "bond_lengths.tsv", NULL});
}

/// A library defines more kinds and types than a system may have, with laws that nobody knows.
static void test_moleculetypes_that_nobody_has_are_not_looked_at(void **state) {
    char text[SIZE];
    int length = 0;
    for (int k = 0; k < 30; k++)
        ADD("[ moleculetype ]\nL%d 1\n[ atoms ]\n1 T%d+ 1 LIB A 1\n2 T%d 1 LIB B 1\n[ bonds ]\n1 2 "
            "99 x\n",
            k, k, k);
    small_inputs_write(*state, "library.itp", text, NULL, NULL);
    length = 0;
    ADD("#include \"library.itp\"\n%s[ system ]\ns\n[ molecules ]\nL3 0\nLIP %d\n", topology,
        CHAINS);
    small_inputs_write(*state, "topol.top", text, NULL, NULL);
    write_gro(*state);
    MEASURE("chains.gro", "--molecules", "topol.top", "-o", "out");
    assert_chains("LIP", "R_g^2 0.08699 ");
}

static void test_topologies_say_their_own_errors(void **state) {
    write_gro(*state);
    small_inputs_write(*state, "topol.top",
                       "#ifdef OTHER\n#error not this\n#endif\n#error define WATER first\n", NULL,
                       NULL);
    RUN_PROGRAM(&result, "measure", "chains.gro", "--molecules", "topol.top", "-o", "none");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "topol.top:4: #error define WATER first");
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_molecules_are_those_of_a_data_file_of_lammps),
        TEST(test_a_data_file_of_other_types_is_refused),
        TEST(test_molecules_are_those_of_a_template_of_lammps),
        TEST(test_molecules_are_those_of_a_topology_whatever_its_laws),
        TEST(test_moleculetypes_that_nobody_has_are_not_looked_at),
        TEST(test_topologies_say_their_own_errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
