// SPDX-License-Identifier: GPL-3.0-or-later
//
// Files that have atoms and no coordinates: topologies of GROMACS, whose includes stand beside
// them, and PSF.
#include "shared/temporary_folder.h"
#include "shared/testing.h"
#include "trajectory/trajectory.h"

#include <math.h>
#include <stdio.h>

static struct trajectory trajectory;

static enum status try(void **state, const char *name, const char *text) {
    static char file[1024];
    snprintf(file, sizeof file, "%s", temporary_folder_write(*state, name, text, strlen(text)));
    return mf_trajectory_open(&trajectory, file, &(struct trajectory_options){0});
}

static void assert_atom(size_t k, const char *name, const char *residue, double mass,
                        size_t number) {
    const struct structure_atom *const atom = &trajectory.structure.atom[k];
    assert_string_equal(atom->name, name);
    assert_string_equal(atom->residue_name, residue);
    assert_true(atom->mass == mass);
    assert_int_equal(atom->residue, number);
}

/// United atoms have the masses of their types, or their own; waters all have the residue 1.
static const char topology[] = "; a mixture\n"
                               "#include \"united.itp\"\n"
                               "#ifdef FLEXIBLE\n#error\n#endif\n"
                               "[ moleculetype ]\nSOL 2\n"
                               "[ atoms ]\n1 OW 1 SOL OW 1 -0.8\n2 HW 1 SOL HW1 1 0.4\n"
                               "3 HW 1 SOL HW2 1 0.4 1.5\n"
                               "[ settles ]\n1 1 0.1 0.16\n"
                               "[ system ]\nsome [ words ]\n"
                               "[ molecules ]\nSOL 2\nEthane 1\nSOL 1\n";
static const char united[] = "[ defaults ]\n1 2\n"
                             "[ atomtypes ]\nCH3 CH3 6 15.035 0.0 A 1 2\n"
                             "OW 8 15.9994 0 A 1 2 ; with an atomic number\nHW 1.008 0.4 D 0 0\n"
                             "[ moleculetype ]\nEthane 3\n"
                             "[ atoms ]\n1 CH3 1 ETH CA 1\n2 CH3 2 ETB \\\nCB 1 0\n"
                             "[ bonds ]\n1 2 1 0.153 1000\n";

static void test_topology_has_names_masses_and_molecules(void **state) {
    temporary_folder_write(*state, "united.itp", united, strlen(united));
    assert_ok(try(state, "topol.top", topology));
    assert_string_equal(trajectory.format->name, "top");
    assert_int_equal(trajectory.structure.atoms, 11);
    assert_int_equal(trajectory.structure.residues, 5);
    for (size_t n = 0; n < 3; n++) {
        const size_t k = n < 2 ? 3 * n : 8, residue = n < 2 ? n : 4;
        assert_atom(k, "OW", "SOL", 15.9994, residue);
        assert_atom(k + 1, "HW1", "SOL", 1.008, residue);
        assert_atom(k + 2, "HW2", "SOL", 1.5, residue);
    }
    assert_atom(6, "CA", "ETH", 15.035, 2);
    assert_atom(7, "CB", "ETB", 15.035, 3);
    assert_int_equal(trajectory.structure.atom[6].molecule, trajectory.structure.atom[7].molecule);
    mf_trajectory_close(&trajectory);
    assert_ok(try(state, "one.itp", united)); // no [ molecules ]: one
    assert_int_equal(trajectory.structure.atoms, 2);
    mf_trajectory_close(&trajectory);
}

/// GROMACS does not look at the case of directives: the second kind is not a part of the first.
static void test_topology_has_sections_of_any_case(void **state) {
    assert_ok(try(state, "a.top",
                  "[ defaults ]\n1 2\n[ AtomTypes ]\nA 0 10 0 A 1 1\n[ moleculetype ]\nONE 1\n"
                  "[ atoms ]\n1 A 1 ONE A 1\n[ Moleculetype ]\nTWO 1\n[ atoms ]\n"
                  "1 A 1 TWO B 1\n[ MOLECULES ]\nTWO 1\nONE 2\n"));
    assert_int_equal(trajectory.structure.atoms, 3);
    assert_atom(0, "B", "TWO", 10, 0);
    assert_atom(1, "A", "ONE", 10, 1);
    assert_atom(2, "A", "ONE", 10, 2);
    mf_trajectory_close(&trajectory);
}

static void test_topology_is_refused_with_its_line(void **state) {
    assert_fails(try(state, "a.top", "[ defaults ]\n#include \"no.itp\"\n"), STATUS_BAD_INPUT,
                 "a.top:2: #include: there is no file");
    assert_fails(try(state, "a.top", "[ moleculetype ]\nA 1\n[ atoms ]\n1 C 1 A\n"),
                 STATUS_BAD_INPUT, "a.top:4: expected an atom");
    assert_fails(try(state, "a.top", "[ moleculetype ]\nA 1\n[ molecules ]\nB 1\n"),
                 STATUS_BAD_INPUT, "a.top:4: there is no moleculetype B");
    assert_fails(try(state, "a.top", "[ defaults ]\n1 2\n"), STATUS_BAD_INPUT,
                 "its molecules have 0 atoms");
    assert_fails(try(state, "a.top", "[ atomtypes ]\nC 12 0 B 1 1\n"), STATUS_BAD_INPUT,
                 "a.top:2: expected an atom type");
}

/// Residues of one number differ by their segments; a letter may follow a number.
static void test_psf_has_names_residues_and_masses(void **state) {
    struct trajectory_frame frame = {0};
    bool more;
    assert_ok(try(state, "a.psf",
                  "PSF CMAP\n\n       1 !NTITLE\n REMARKS 7 !NATOM in a title\n\n"
                  "       5 !NATOM\n"
                  "       1 W1   1    TIP3 OH2  OT    -0.834000       15.9994           0\n"
                  "       2 W1   1    TIP3 H1   HT     0.417000        1.0080           0\n"
                  "       3 W2   1    TIP3 OH2  OT    -0.834000       15.9994           0   0.0\n"
                  "       4 P1   12A  LYS  CA   CT1    0.07            12.011           0\n"
                  "       5 P1   13   LYS  CA   CT1    0.07            12.5             0\n\n"
                  "       1 !NBOND: bonds\n       1       2\n"));
    assert_string_equal(trajectory.format->name, "psf");
    assert_int_equal(trajectory.structure.atoms, 5);
    assert_atom(0, "OH2", "TIP3", 15.9994, 0);
    assert_atom(1, "H1", "TIP3", 1.008, 0);
    assert_atom(2, "OH2", "TIP3", 15.9994, 1);
    assert_atom(3, "CA", "LYS", 12.011, 2);
    assert_atom(4, "CA", "LYS", 12.5, 3);
    assert_fails(mf_trajectory_next(&trajectory, &frame, &more), STATUS_BAD_INPUT,
                 "a.psf: has no coordinates: give it by -s");
    mf_frame_clear(&frame);
    mf_trajectory_close(&trajectory);
    assert_fails(try(state, "a.psf", "PSF\n\n 2 !NATOM\n 1 W 1 TIP3 O OT 0 16\n"), STATUS_BAD_INPUT,
                 "expected an atom");
    assert_fails(try(state, "a.psf", "PSF\n\n"), STATUS_BAD_INPUT, "there is no section !NATOM");
}

static size_t molecule(size_t k) {
    return (size_t)trajectory.structure.atom[k].molecule;
}

/// Waters that are all called and numbered the same, as VMD writes them, are told apart by bonds,
/// which go on over lines, and what has none is on its own; but a site without bonds is of its
/// residue, if that is one molecule. A chain's residues are one molecule. No segment has a name.
static void test_psf_has_molecules_by_bonds(void **state) {
    static const char atoms[] = "PSF\n\n 10 !NATOM\n"
                                " 1      0    WAT  M    4      0.0   0.0     0\n"
                                " 2      0    WAT  O    1      0.0  16.0     0\n"
                                " 3      0    WAT  H    2      0.0   1.0     0\n"
                                " 4      0    WAT  O    1      0.0  16.0     0\n"
                                " 5      0    WAT  H    2      0.0   1.0     0\n"
                                " 6      0    WAT  M    4      0.0   0.0     0\n"
                                " 7      2    UNK  M    3      0.0  12.0     0\n"
                                " 8      2    UNK  C    3      0.0  12.0     0\n"
                                " 9      3    UNK  C    3      0.0  12.0     0\n"
                                "10      2    ION  X    5      0.0  12.0     0\n\n";
    char text[2048];
    snprintf(text, sizeof text, "%s%s", atoms,
             " 3 !NBOND: bonds\n 2 3 4 5\n 8\n9\n\n 1 !NTHETA: angles\n 1 2 3\n");
    assert_ok(try(state, "a.psf", text));
    static const size_t residue[] = {0, 1, 1, 2, 2, 3, 4, 4, 5, 6};
    for (size_t k = 0; k < 10; k++)
        assert_int_equal(trajectory.structure.atom[k].residue, residue[k]);
    assert_true(trajectory.structure.has_molecules);
    assert_true(molecule(1) == molecule(2) && molecule(3) == molecule(4));
    assert_true(molecule(2) != molecule(3));
    assert_true(molecule(6) == molecule(7) && molecule(7) == molecule(8) && molecule(9) == 0);
    assert_atom(1, "O", "WAT", 16, 1);
    assert_int_equal(trajectory.structure.terms[0].count, 3);
    assert_int_equal(trajectory.structure.terms[0].atom[5], 8);
    assert_int_equal(trajectory.structure.terms[1].count, 1);
    assert_int_equal(trajectory.structure.terms[1].atom[2], 2);
    mf_trajectory_close(&trajectory);
    snprintf(text, sizeof text, "%s%s", atoms, " 2 !NBOND: bonds\n 2 3 4 11\n");
    assert_fails(try(state, "a.psf", text), STATUS_BAD_INPUT,
                 "a.psf:16: frame 0: expected an atom from 1 to 10, not 11");
    snprintf(text, sizeof text, "%s%s", atoms, " 2 !NBOND: bonds\n 2 3 4\n");
    assert_fails(try(state, "a.psf", text), STATUS_BAD_INPUT, "the file ends with 3 of 4 numbers");
    snprintf(text, sizeof text, "%s%s", atoms, " x !NBOND: bonds\n 2 3 4\n");
    assert_fails(try(state, "a.psf", text), STATUS_BAD_INPUT, "expected the number of terms");
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_topology_has_names_masses_and_molecules),
        TEST(test_topology_has_sections_of_any_case),
        TEST(test_topology_is_refused_with_its_line),
        TEST(test_psf_has_names_residues_and_masses),
        TEST(test_psf_has_molecules_by_bonds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
