// SPDX-License-Identifier: GPL-3.0-or-later
//
// Formats of text, from files written out here, in numbers that are known.
#include "shared/temporary_folder.h"
#include "shared/testing.h"
#include "trajectory/trajectory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static struct trajectory trajectory;
static struct trajectory_frame frame;

static void open_text(void **state, const char *name, const char *text, const char *units) {
    const struct trajectory_options options = {.units = units};
    const char *file = temporary_folder_write(*state, name, text, strlen(text));
    static char kept[1024];
    snprintf(kept, sizeof kept, "%s", file);
    assert_ok(mf_trajectory_open(&trajectory, kept, &options));
}

static void next(bool wanted) {
    bool more;
    assert_ok(mf_trajectory_next(&trajectory, &frame, &more));
    assert_int_equal(more, wanted);
}

static void close_all(void) {
    mf_trajectory_close(&trajectory);
    mf_frame_clear(&frame);
}

static void assert_vector(const double *vector, double x, double y, double z) {
    const double wanted[3] = {x, y, z};
    for (int d = 0; d < 3; d++)
        if (!(fabs(vector[d] - wanted[d]) <= 1e-13 * (1 + fabs(wanted[d]))))
            fail_msg("component %d is %.17g, not %.17g", d, vector[d], wanted[d]);
}

/// Two frames of five decimals in a tilted box; the second has no velocities and no time.
static void test_gro_has_any_precision_and_many_frames(void **state) {
    open_text(state, "a.gro",
              "two, t=   1.50000 step= 750\n    2\n"
              "    7ABC     C1    1   0.12345   0.20000  -0.30000  0.100000 -0.200000  0.000001\n"
              "99999DEFGH   X2    2   1.00000   2.00000   3.00000  1.000000  2.000000  3.000000\n"
              "   3.00000   2.00000   1.00000   0.00000   0.00000   0.50000   0.00000   0.25000  "
              "-0.50000\n"
              "\n2\n"
              "    7ABC     C1    1   0.10000   0.20000   0.30000\n"
              "99999DEFGH   X2    2   1.00000   2.00000   3.00000\n"
              "   3.00000   2.00000   1.00000\n\n",
              NULL);
    const struct structure *const structure = &trajectory.structure;
    assert_int_equal(structure->residues, 2);
    assert_string_equal(structure->atom[1].residue_name, "DEFGH");
    assert_int_equal(structure->atom[1].residue_number, 99999);
    next(true);
    assert_true(frame.time == 1.5 && frame.step == 750 && frame.has_velocities);
    assert_vector(frame.position[0], 0.12345, 0.2, -0.3);
    assert_vector(frame.velocity[0], 0.1, -0.2, 0.000001);
    assert_vector(frame.box[0], 3, 0, 0);
    assert_vector(frame.box[1], 0.5, 2, 0);
    assert_vector(frame.box[2], 0.25, -0.5, 1);
    next(true);
    assert_true(isnan(frame.time) && frame.step == -1 && !frame.has_velocities);
    assert_vector(frame.position[1], 1, 2, 3);
    assert_vector(frame.box[1], 0, 2, 0);
    next(false);
    close_all();
}

#define ARGON "1\n    1AR     AR    1   0.500   0.600   0.700\n"
#define BOX "   2.00000   3.00000   4.00000"

/// The end of the last line may be missing where all digits are there.
static void test_gro_ends_with_its_box(void **state) {
    open_text(state, "a.gro", "a t= 0\n" ARGON BOX "\nb t= 1\n" ARGON BOX, NULL);
    next(true);
    next(true);
    assert_true(frame.time == 1);
    assert_vector(frame.box[2], 0, 0, 4);
    next(false);
    close_all();
}

static void test_gro_has_a_box_without_blanks(void **state) {
    open_text(state, "a.gro", "huge\n" ARGON "40000.0000030000.0000020000.00000\n", NULL);
    next(true);
    assert_vector(frame.box[0], 40000, 0, 0);
    assert_vector(frame.box[1], 0, 30000, 0);
    assert_vector(frame.box[2], 0, 0, 20000);
    close_all();
    open_text(state, "a.gro",
              "skewed\n" ARGON "40000.0000030000.0000020000.00000   0.00000   0.00000-5000.00000"
              "   0.00000  10.00000  20.00000\n",
              NULL);
    next(true);
    assert_vector(frame.box[1], -5000, 30000, 0);
    assert_vector(frame.box[2], 10, 20, 20000);
    close_all();
}

static void test_xyz_is_in_angstrom_when_nothing_is_told(void **state) {
    open_text(state, "a.dat",
              "2\nwater, i = 3, E = -17\nO 1.0 2.0 3.0\nH 4 5 6 anything else\n"
              "2\n\nO 10 20 30\nH 40 50 60\n\n\n",
              NULL);
    assert_string_equal(trajectory.format->name, "xyz");
    assert_string_equal(trajectory.structure.atom[1].name, "H");
    next(true);
    assert_vector(frame.position[0], 0.1, 0.2, 0.3);
    assert_true(!frame.has_box && isnan(frame.time) && !frame.has_velocities);
    next(true);
    assert_vector(frame.position[1], 4, 5, 6);
    next(false);
    close_all();
}

static void test_byte_order_mark_is_no_part_of_a_text(void **state) {
    open_text(state, "a.xyz",
              "\xEF\xBB\xBF"
              "1\n\nAr 1 2 3\n",
              NULL);
    next(true);
    assert_vector(frame.position[0], 0.1, 0.2, 0.3);
    next(false);
    close_all();
}

static void test_extended_xyz_has_box_velocities_and_columns(void **state) {
    open_text(state, "a.xyz",
              "2\nLattice=\"10 0 0 1 9 0 -2 3 8\" "
              "Properties=id:I:1:species:S:1:velo:R:3:forces:R:3:pos:R:3"
              ":mass:R:1:mol:I:1 pbc=\"T F True\" Time=2000 Step=1000 note='a b' flag\n"
              "5 Ar 0.1 0.2 0.3 9 9 9 1 2 3 40 2\n3 C 1 2 3 8 8 8 4 5 6 12 1\n",
              NULL);
    const struct structure *const structure = &trajectory.structure;
    assert_int_equal(structure->atom[0].id, 3);
    assert_string_equal(structure->atom[1].name, "Ar");
    assert_true(structure->atom[1].mass == 40 && structure->atom[1].molecule == 2);
    assert_int_equal(structure->residues, 2);
    next(true);
    assert_vector(frame.position[0], 0.4, 0.5, 0.6);
    assert_vector(frame.velocity[0], 100, 200, 300); // Å/fs
    assert_vector(frame.position[1], 0.1, 0.2, 0.3);
    assert_vector(frame.box[1], 0.1, 0.9, 0);
    assert_vector(frame.box[2], -0.2, 0.3, 0.8);
    assert_true(frame.periodic[0] && !frame.periodic[1] && frame.periodic[2]);
    assert_true(frame.time == 2 && frame.step == 1000);
    next(false);
    close_all();
    open_text(state, "a.xyz", "1\nProperties=pos:R:3\n1 2 3\n", "lj");
    next(true);
    assert_vector(frame.position[0], 1, 2, 3);
    close_all();
    open_text(state, "a.xyz", "1\nUnits=nm-ps Time=4 Properties=pos:R:3:velo:R:3\n1 2 3 4 5 6\n",
              NULL);
    next(true);
    assert_vector(frame.position[0], 1, 2, 3);
    assert_vector(frame.velocity[0], 4, 5, 6);
    assert_true(frame.time == 4);
    close_all();
}

/// ASE writes sqrt(u eV): 1 of it for 4 u is a quarter of 9822.694743 m/s (CODATA 2018, eV and u),
/// and an element has its mass.
static void test_extended_xyz_of_ase_has_momenta(void **state) {
    open_text(state, "a.xyz",
              "2\nProperties=species:S:1:pos:R:3:masses:R:1:momenta:R:3 pbc=\"F F F\"\n"
              "X 1 2 3 4.0 1 0 -2\nX 1 2 3 2.0 0 1 0\n",
              NULL);
    next(true);
    assert_true(frame.has_velocities);
    assert_true(fabs(frame.velocity[0][0] - 2.4556736858) < 1e-8);
    assert_true(fabs(frame.velocity[0][2] + 4.9113473717) < 1e-8);
    assert_true(fabs(frame.velocity[1][1] - 4.9113473717) < 1e-8);
    close_all();
    open_text(state, "a.xyz", "1\nProperties=species:S:1:pos:R:3:momenta:R:3\nAr 1 2 3 39.95 0 0\n",
              NULL);
    next(true);
    assert_true(trajectory.structure.has_masses && trajectory.structure.atom[0].mass == 39.95);
    assert_true(fabs(frame.velocity[0][0] - 9.822694743) < 1e-8);
    close_all();
    open_text(state, "a.xyz", "1\nProperties=species:S:1:pos:R:3:momenta:R:3\nBead 1 2 3 1 0 0\n",
              NULL);
    next(true);
    assert_false(frame.has_velocities || trajectory.structure.has_masses);
    close_all();
}

#define PDB_ATOM(number, name, chain, x)                                                           \
    "ATOM      " number " " name " ALA " chain "   " number "    " x                               \
    "   2.000  -3.000  1.00  0.00           C\n"

static void test_pdb_has_models_and_a_box_that_changes(void **state) {
    open_text(state, "a.ent",
              "TITLE     something t= 12.50000 step= 5\n"
              "CRYST1   30.000   20.000   10.000  90.00  90.00  60.00 P 1           1\nMODEL       "
              " 1\n" PDB_ATOM("1", " CA ", "A", "   1.000") "TER\n" PDB_ATOM(
                  "1", " CB ", "B",
                  " 100.000") "HETATM    3 CL    CL B   9      12.345   6.789   0.001  1.00  0.00  "
                              "        CL\n"
                              "ATOM      4  N  BALA B   1       9.999   9.999   9.999\n"
                              "ENDMDL\nREMARK another\nCRYST1   40.000   40.000   40.000  90.00  "
                              "90.00  90.00 P 1\n"
                              "MODEL        2\n" PDB_ATOM("1", " CA ", "A", "   7.000")
                                  PDB_ATOM("1", " CB ", "B",
                                           "   8.000") "HETATM    3 CL    CL B   9      12.345   "
                                                       "6.789   0.001  1.00  0.00          CL\n"
                                                       "ENDMDL\nEND\n",
              NULL);
    const struct structure *const structure = &trajectory.structure;
    assert_string_equal(trajectory.format->name, "pdb");
    assert_int_equal(structure->atoms, 3);
    assert_int_equal(structure->residues, 3);
    assert_string_equal(structure->atom[2].element, "Cl");
    assert_string_equal(structure->atom[0].name, "CA");
    next(true);
    assert_true(frame.time == 12.5 && frame.step == 5);
    assert_vector(frame.position[0], 0.1, 0.2, -0.3);
    assert_vector(frame.position[2], 1.2345, 0.6789, 0.0001);
    assert_vector(frame.box[0], 3, 0, 0);
    assert_vector(frame.box[1], 1, sqrt(3), 0);
    assert_vector(frame.box[2], 0, 0, 1);
    next(true);
    assert_vector(frame.position[1], 0.8, 0.2, -0.3);
    assert_vector(frame.box[1], 0, 4, 0);
    next(false);
    close_all();
}

/// Residues beyond 9999, as some programs number them, are residues of their own.
static void test_pdb_residues_are_apart_when_their_numbers_are_not_decimal(void **state) {
    open_text(state, "a.pdb",
              "ATOM  99999  OW  SOL X9999       0.000   0.000   0.000\n"
              "ATOM  A0000  OW  SOL XA000       0.000   0.000   0.000\n"
              "ATOM  A0001  OW  SOL XA001       0.000   0.000   0.000\n"
              "ATOM  A0002  OW  SOL XA001       0.000   0.000   0.000\n"
              "ATOM  A0003  OW  SOL XA001A      0.000   0.000   0.000\n",
              NULL);
    assert_int_equal(trajectory.structure.atoms, 5);
    assert_int_equal(trajectory.structure.residues, 4);
    close_all();
}

/// A box of three lengths and three angles has them again.
static void test_box_of_angles_has_these_angles(void **state) {
    const double length[3] = {2, 3, 4}, angle[3] = {70, 80, 110}, flat[3] = {60, 60, 170};
    static const int pair[3][2] = {{1, 2}, {0, 2}, {0, 1}};
    (void)state;
    assert_true(mf_frame_box_of_angles(&frame, length, angle));
    for (int i = 0; i < 3; i++) {
        const double *a = frame.box[pair[i][0]], *b = frame.box[pair[i][1]];
        const double product = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        const double cosine = product / (length[pair[i][0]] * length[pair[i][1]]);
        assert_true(fabs(cosine - cos(angle[i] * acos(-1) / 180)) < 1e-14);
    }
    assert_false(mf_frame_box_of_angles(&frame, length, flat));
}

static void assert_refused(void **state, const char *name, const char *text, const char *part) {
    char file[1024];
    bool more = true;
    snprintf(file, sizeof file, "%s", temporary_folder_write(*state, name, text, strlen(text)));
    enum status status = mf_trajectory_open(&trajectory, file, &(struct trajectory_options){0});
    const bool opened = status == STATUS_OK;
    while (status == STATUS_OK && more)
        status = mf_trajectory_next(&trajectory, &frame, &more);
    assert_int_equal(status, STATUS_BAD_INPUT);
    assert_contains(mf_status_message(), part);
    assert_contains(mf_status_message(), name);
    if (opened)
        close_all();
}

/// As GROMACS and VOTCA read it.
static void test_gro_has_a_box_where_a_fourth_number_stands(void **state) {
    open_text(state, "a.gro",
              "t\n1\n    1ABC      C    1   0.100   0.200   0.300\n 3.1 4.2 5.3 7\n", NULL);
    next(true);
    assert_vector(frame.box[0], 3.1, 0, 0);
    assert_vector(frame.box[1], 0, 4.2, 0);
    assert_vector(frame.box[2], 0, 0, 5.3);
    close_all();
}

static void test_text_is_refused_with_its_line(void **state) {
    assert_refused(state, "a.gro", "t\n2\n    1ABC      C    1   0.1", "a.gro:3: frame 0: ");
    assert_refused(state, "a.gro", "t\nmany\n", "a.gro:2: frame 0: expected the number of atoms");
    assert_refused(state, "a.gro", "t\n99999999999\n    1ABC      C    1   0.100   0.200   0.300\n",
                   "99999999998 lines are missing");
    assert_refused(state, "a.gro", "t\n1\n    1ABC      C    1   0.100   0.2x0   0.300\n 1 1 1\n",
                   "a.gro:3: frame 0: expected an atom position");
    assert_refused(state, "a.gro", "t\n1\n    1ABC      C    1   0.100   0.200   0.300\n 1 1\n",
                   "a.gro:4: frame 0: expected the box");
    assert_refused(state, "a.gro", "a\n" ARGON BOX "\nb\n" ARGON "   2.00000   3.00000   4.000",
                   "a.gro:8: frame 1: the file ends within this line");
    assert_refused(state, "a.gro", "a\n" ARGON BOX "\nb\n" ARGON "   2.00000   3.00000",
                   "a.gro:8: frame 1: expected the box");
    assert_refused(state, "a.gro", "a\n" ARGON BOX "\nb\n" ARGON,
                   "a.gro:7: frame 1: the file ends within the frame, the box is missing");
    assert_refused(state, "a.gro", "a\n" ARGON "40000.0000030000.00000\n",
                   "a.gro:4: frame 0: expected the box");
    assert_refused(state, "a.xyz", "1\n\nO 1 2 3\n2\n\nO 1 2 3\nO 1 2 3\n",
                   "a.xyz:4: frame 1: it has 2 atoms, the first frame 1");
    assert_refused(state, "a.xyz", "1\n\nO 1 2 3\n1\n\nO 1 2 3",
                   "a.xyz:6: frame 1: the file ends within this line");
    assert_refused(state, "a.xyz", "1\n\nO 1 2 3\n1\n\n", "a.xyz:5: frame 1: the file ends within");
    assert_refused(state, "a.xyz", "1\n\nO 1 nan 3\n", "a.xyz:3: frame 0: a coordinate");
    assert_refused(state, "a.xyz", "1\n\nNa 1 2 3\n1\n\nCl 1 2 3\n",
                   "a.xyz:6: frame 1: atom 1 is of type Cl, in the first frame of Na");
    assert_refused(state, "a.xyz", "1\nProperties=pos:R:2\n1 2\n",
                   "a.xyz:2: frame 0: expected name:kind:number in Properties");
    assert_refused(state, "a.xyz", "1\nLattice=\"1 2 3\"\nO 1 2 3\n", "nine numbers");
    assert_refused(state, "a.xyz", "1\nUnits=furlong Properties=pos:R:3\n1 2 3\n",
                   "a.xyz: unknown units \"furlong\"");
    assert_refused(state, "a.pdb", "MODEL 1\n" PDB_ATOM("1", " CA ", "A", "   1.000"),
                   "ENDMDL is missing");
    assert_refused(state, "a.pdb", "REMARK nothing\nEND\n", "a.pdb: the file has no frame");
    assert_refused(state, "a.pdb", "CRYST1   40.000   40.000\n",
                   "a.pdb:1: frame 0: expected three lengths and three angles in CRYST1");
    assert_refused(state, "a.odd", "who knows\n",
                   "a.odd: not a trajectory: read are xtc, trr, dcd");
    assert_refused(state, "a.odd", "who knows\n", "MDAnalysis convert others");
    assert_refused(state, "a.tng", "any bytes", "-o traj.xtc\" makes what is");
    assert_refused(state, "a.mdcrd", "any bytes", "-x traj.nc\" makes what is read");
    assert_refused(state, "a.trz", "any bytes", "MDAnalysis makes .xtc or .dcd of it");
    assert_refused(state, "a.tpr", "any bytes", "a.tpr: not a trajectory: GROMACS's .tpr is not");
    assert_refused(state, "a.xtc", "", "a.xtc: the file is empty");
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_gro_has_any_precision_and_many_frames),
        TEST(test_gro_ends_with_its_box),
        TEST(test_gro_has_a_box_without_blanks),
        TEST(test_xyz_is_in_angstrom_when_nothing_is_told),
        TEST(test_byte_order_mark_is_no_part_of_a_text),
        TEST(test_extended_xyz_has_box_velocities_and_columns),
        TEST(test_pdb_has_models_and_a_box_that_changes),
        TEST(test_pdb_residues_are_apart_when_their_numbers_are_not_decimal),
        cmocka_unit_test(test_box_of_angles_has_these_angles),
        TEST(test_extended_xyz_of_ase_has_momenta),
        TEST(test_gro_has_a_box_where_a_fourth_number_stands),
        TEST(test_text_is_refused_with_its_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
