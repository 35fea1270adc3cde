// SPDX-License-Identifier: GPL-3.0-or-later
//
// Files that LAMMPS wrote of one run of free atoms, in which all is known: they begin at 300 K and
// fly straight on (tests/trajectories/README.md); and data files of other atom styles, written out
// here.
#include "shared/temporary_folder.h"
#include "shared/testing.h"
#include "trajectory/trajectory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define FOLDER "tests/trajectories/lammps-"
enum { ATOMS = 32, FRAMES = 3 };

/// Six digits of some 10 Å, and of fractions of the box.
static const double digits = 1e-5;

static const struct trajectory_options real = {.units = "real", .time_step = 2e-3};

struct run {
    struct trajectory trajectory;
    struct trajectory_frame frame[FRAMES];
};

static void read_run(struct run *run, const char *file, size_t frames) {
    struct trajectory_frame none = {0};
    bool more;
    memset(run, 0, sizeof *run);
    assert_ok(mf_trajectory_open(&run->trajectory, file, &real));
    assert_int_equal(run->trajectory.structure.atoms, ATOMS);
    for (size_t k = 0; k < frames; k++) {
        assert_ok(mf_trajectory_next(&run->trajectory, &run->frame[k], &more));
        assert_true(more);
    }
    assert_ok(mf_trajectory_next(&run->trajectory, &none, &more));
    assert_false(more);
    mf_frame_clear(&none);
}

static void clear_run(struct run *run) {
    for (int k = 0; k < FRAMES; k++)
        mf_frame_clear(&run->frame[k]);
    mf_trajectory_close(&run->trajectory);
}

static void assert_near(double (*a)[3], double (*b)[3], double tolerance) {
    for (int k = 0; k < ATOMS; k++)
        for (int d = 0; d < 3; d++)
            if (!(fabs(a[k][d] - b[k][d]) <= tolerance))
                fail_msg("atom %d: %.9g and %.9g", k, a[k][d], b[k][d]);
}

static void assert_box(const struct trajectory_frame *frame) {
    static const double box[3][3] = {{0.91, 0, 0}, {0.15, 0.95, 0}, {-0.07, 0.09, 1.325}};
    for (int k = 0; k < 9; k++)
        assert_true(fabs(frame->box[k / 3][k % 3] - box[k / 3][k % 3]) < 1e-12);
    assert_true(frame->has_box);
    assert_true(frame->periodic[0] && frame->periodic[1] && !frame->periodic[2]);
}

/// xu, and x with images, and xs with images: all three are where the atoms have flown to.
static void test_dumps_are_the_same_whatever_their_columns(void **state) {
    static const char *const files[] = {FOLDER "plain.dump", FOLDER "images.dump"};
    struct run run, other;
    (void)state;
    read_run(&run, FOLDER "tri.dump", FRAMES);
    for (int file = 0; file < 2; file++) {
        read_run(&other, files[file], FRAMES);
        for (int k = 0; k < FRAMES; k++) {
            assert_box(&other.frame[k]);
            assert_near(run.frame[k].position, other.frame[k].position, digits);
            assert_true(run.frame[k].unwrapped && other.frame[k].unwrapped);
            assert_int_equal(other.frame[k].step, 5 * k);
            assert_true(fabs(other.frame[k].time - 0.01 * k) < 1e-12);
        }
        clear_run(&other);
    }
    clear_run(&run);
}

/// Without images an atom may be in another image, by whole vectors of the box.
static void test_atom_dump_is_the_same_but_for_images(void **state) {
    struct run run, other;
    (void)state;
    read_run(&run, FOLDER "tri.dump", FRAMES);
    read_run(&other, FOLDER "atom.dump", FRAMES);
    assert_false(other.frame[2].unwrapped);
    for (int k = 0; k < ATOMS; k++) {
        double difference[3];
        for (int d = 0; d < 3; d++)
            difference[d] = run.frame[2].position[k][d] - other.frame[2].position[k][d];
        for (int i = 2; i >= 0; i--) {
            const double *const vector = run.frame[2].box[i];
            const double images = rint(difference[i] / vector[i]);
            for (int d = 0; d < 3; d++)
                difference[d] -= images * vector[d];
        }
        for (int d = 0; d < 3; d++)
            assert_true(fabs(difference[d]) < digits);
    }
    clear_run(&run);
    clear_run(&other);
}

/// Free flight: x(0.02 ps) = x(0) + v 0.02 ps in nm and nm/ps, and 300 K of 93 degrees of freedom.
static void test_velocities_are_those_of_the_flight(void **state) {
    struct run run, masses;
    double energy = 0;
    (void)state;
    read_run(&run, FOLDER "tri.dump", FRAMES);
    read_run(&masses, FOLDER "plain.dump", FRAMES);
    const struct structure *const structure = &masses.trajectory.structure;
    assert_true(structure->has_masses && structure->has_elements);
    for (int k = 0; k < ATOMS; k++)
        for (int d = 0; d < 3; d++) {
            const double speed = run.frame[0].velocity[k][d];
            const double flown = run.frame[2].position[k][d] - run.frame[0].position[k][d];
            assert_true(fabs(flown - 0.02 * speed) < digits);
            energy += structure->atom[k].mass * speed * speed;
        }
    assert_true(fabs(energy / (93 * 0.0083144626) - 300) < 0.01);
    clear_run(&run);
    clear_run(&masses);
}

/// The data file has 16 digits of the last step's positions and velocities.
static void test_data_file_is_the_last_frame(void **state) {
    struct run run, data;
    (void)state;
    read_run(&run, FOLDER "tri.dump", FRAMES);
    read_run(&data, FOLDER "tri.data", 1);
    const struct structure *const structure = &data.trajectory.structure;
    assert_near(run.frame[2].position, data.frame[0].position, digits);
    assert_near(run.frame[2].velocity, data.frame[0].velocity, 100 * digits);
    assert_int_equal(data.frame[0].step, 10);
    for (int k = 0; k < ATOMS; k++) {
        const struct structure_atom *const atom = &structure->atom[k];
        assert_int_equal(atom->id, run.trajectory.structure.atom[k].id);
        assert_int_equal(atom->type, run.trajectory.structure.atom[k].type);
        assert_true(atom->mass == (atom->type == 1 ? 15.9994 : 1.008));
    }
    clear_run(&run);
    clear_run(&data);
}

static struct trajectory trajectory;

static enum status try(void **state, const char *text, const char *units) {
    static char file[1024];
    snprintf(file, sizeof file, "%s", temporary_folder_write(*state, "a.txt", text, strlen(text)));
    const struct trajectory_options options = {.units = units};
    return mf_trajectory_open(&trajectory, file, &options);
}

/// A data file of two atoms with these words for "Atoms" and each atom, ids 9 and 4.
static const char *data_file(const char *atoms, const char *first, const char *second) {
    static char text[2048];
    snprintf(
        text, sizeof text,
        "title, units = metal\n\n2 atoms # few\n3 atom types\n1 bonds\n0 10 xlo xhi\n0 10 ylo "
        "yhi\n0 10 zlo zhi\n\nMasses\n\n1 1\n2 2 # two\n3 3\n\nPair Coeffs\n\n1 7\n2 7\n3 7\n\n"
        "%s\n\n9 %s\n4 %s # the first\n\nBonds\n\n1 1 9 4\n\nVelocities\n\n4 1 2 3\n9 4 5 6\n",
        atoms, first, second);
    return text;
}

static void check_style(void **state, const char *atoms, const char *first, const char *second,
                        bool molecules) {
    struct trajectory_frame frame = {0};
    bool more;
    assert_ok(try(state, data_file(atoms, first, second), NULL));
    const struct structure_atom *const atom = trajectory.structure.atom;
    assert_ok(mf_trajectory_next(&trajectory, &frame, &more));
    assert_true(atom[0].id == 4 && atom[1].id == 9);
    assert_true(atom[0].type == 2 && atom[1].type == 3 && atom[1].mass == 3);
    assert_int_equal(trajectory.structure.has_molecules, molecules);
    if (molecules)
        assert_true(atom[0].molecule == 5 && atom[1].molecule == 1);
    assert_true(frame.position[0][0] == 0.1 * 1 && frame.position[0][2] == 0.1 * 3);
    assert_true(frame.position[1][0] == 0.1 * 7 && frame.position[1][2] == 0.1 * 9);
    assert_true(frame.velocity[0][1] == 0.1 * 2 && frame.velocity[1][0] == 0.1 * 4);
    mf_frame_clear(&frame);
    mf_trajectory_close(&trajectory);
}

static void test_data_file_has_any_of_four_styles(void **state) {
    check_style(state, "Atoms # atomic", "3 7 8 9", "2 1 2 3", false);
    check_style(state, "Atoms # charge", "3 1 7 8 9", "2 -1 1 2 3", false);
    check_style(state, "Atoms # molecular", "1 3 7 8 9", "5 2 1 2 3", true);
    check_style(state, "Atoms # full", "1 3 0.5 7 8 9", "5 2 0.5 1 2 3", true);
    check_style(state, "Atoms", "3 7 8 9", "2 1 2 3", false);
    check_style(state, "Atoms", "3 0.5 7 8 9", "2 -0.5 1 2 3", false);
    check_style(state, "Atoms", "1 3 7 8 9 0 0 0", "5 2 1 2 3 0 0 0", true);
    check_style(state, "Atoms", "1 3 0.5 7 8 -1 0 0 1", "5 2 0.5 1 2 3", true);
    check_style(state, "Atoms # I like comments", "1 3 7 8 9", "5 2 1 2 3", true);
}

/// Manual, Howto_triclinic and Howto_type_labels: any right-handed vectors, positions as they are,
/// labels in place of numbers, also without a comment that names the style.
static void test_data_file_has_a_general_box_and_labels(void **state) {
    static const char text[] =
        "units = nano\n\n2 atoms\n2 atom types\n1 bonds\n2 bond types\n\n0 3 1 avec\n-2 0 1 bvec\n"
        "1 0.5 4 cvec\n1 1 1 abc origin\n\nAtom Type Labels\n\n1 OW # oxygen\n2 H+2\n\n"
        "Bond Type Labels\n\n1 x\n2 OW-H\n\nMasses\n\nH+2 3\nOW 2\n\nAtoms\n\n"
        "7 1 H+2 1 2 3 1 0 -1\n5 1 OW 4 5 6 0 2 0\n\nBonds\n\n1 OW-H 5 7\n";
    static const double image[2][3] = {{4 - 4, 5, 6 + 2}, {1 - 1, 2 + 3 - 0.5, 3 + 1 - 4}};
    struct trajectory_frame frame = {0};
    bool more;
    assert_ok(try(state, text, NULL));
    const struct structure *const structure = &trajectory.structure;
    assert_ok(mf_trajectory_next(&trajectory, &frame, &more));
    for (int k = 0; k < 2; k++)
        for (int d = 0; d < 3; d++)
            assert_true(frame.position[k][d] == image[k][d]);
    assert_true(frame.box[0][0] == 0 && frame.box[0][1] == 3 && frame.box[1][0] == -2 &&
                frame.box[2][1] == 0.5 && frame.has_box && frame.periodic[2]);
    assert_string_equal(structure->atom[0].name, "OW");
    assert_string_equal(structure->atom[1].name, "H+2");
    assert_int_equal(structure->atom[1].type, 2);
    assert_true(structure->atom[0].mass != structure->atom[1].mass);
    assert_int_equal(structure->terms[0].count, 1);
    assert_int_equal(structure->terms[0].type[0], 2);
    assert_true(structure->terms[0].atom[0] == 0 && structure->terms[0].atom[1] == 1);
    assert_int_equal(structure->residues, 1);
    mf_frame_clear(&frame);
    mf_trajectory_close(&trajectory);
}

/// A template's, too: what follows a section counts nothing.
static void test_template_says_how_many_atoms_it_has_before_its_sections(void **state) {
    assert_ok(try(state, "# water\n\n2 atoms\n\nTypes\n\n1 OW\n2 HW\n", "lj"));
    assert_int_equal(trajectory.structure.atoms, 2);
    mf_trajectory_close(&trajectory);
    assert_int_equal(try(state, "# water\n\nTypes\n\n1 OW\n2 HW\n\n2 atoms\n", "lj"),
                     STATUS_BAD_INPUT);
    assert_contains(mf_status_message(),
                    "a template of LAMMPS has \"N atoms\" before its sections");
}

static const char dump[] =
    "ITEM: TIMESTEP\n7\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n"
    "0 1\n0 1\n0 1\nITEM: ATOMS id x y z\n2 1 2 3\n1 4 5 6\n";

/// A box of any three vectors: x = origin + xs a + ys b + zs c, and images are such vectors, too.
static void test_dump_has_a_box_of_three_vectors(void **state) {
    struct trajectory_frame frame = {0};
    bool more;
    assert_ok(try(state,
                  "ITEM: TIMESTEP\n7\nITEM: NUMBER OF ATOMS\n1\n"
                  "ITEM: BOX BOUNDS abc origin pp ff pp\n1 2 0 10\n0 3 1 20\n2 0 4 30\n"
                  "ITEM: ATOMS xs ys zs iz iy ix\n0.5 0.25 0.5 1 0 -1\n",
                  "lj"));
    assert_ok(mf_trajectory_next(&trajectory, &frame, &more));
    const double wanted[3] = {10 - 0.5 + 1.5 * 2, 20 - 0.5 * 2 + 0.25 * 3, 30 + 0.25 + 1.5 * 4};
    for (int d = 0; d < 3; d++)
        assert_true(fabs(frame.position[0][d] - wanted[d]) < 1e-13);
    assert_true(frame.box[0][1] == 2 && frame.box[2][0] == 2 && frame.box[1][2] == 1);
    assert_true(frame.periodic[0] && !frame.periodic[1] && frame.periodic[2]);
    assert_true(frame.step == 7 && isnan(frame.time));
    mf_frame_clear(&frame);
    mf_trajectory_close(&trajectory);
}

/// Old versions and other programs do not say what is periodic.
static void test_dump_is_periodic_when_it_does_not_say(void **state) {
    struct trajectory_frame frame = {0};
    bool more;
    assert_ok(try(state,
                  "ITEM: TIMESTEP\n7\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS\n0 1\n0 2\n"
                  "-1 3\nITEM: ATOMS x y z\n1 2 3\n",
                  "lj"));
    assert_ok(mf_trajectory_next(&trajectory, &frame, &more));
    assert_true(frame.periodic[0] && frame.periodic[1] && frame.periodic[2]);
    assert_true(frame.box[2][2] == 4 && !trajectory.structure.has_ids);
    mf_frame_clear(&frame);
    mf_trajectory_close(&trajectory);
}

/// "dump_modify types labels": what stands in the column of types are names.
static void test_dump_has_labels_in_the_place_of_types(void **state) {
    struct trajectory_frame frame = {0};
    bool more;
    assert_ok(try(state,
                  "ITEM: TIMESTEP\n7\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 1\n"
                  "0 1\n0 1\nITEM: ATOMS id type x y z\n2 c3 1 2 3\n1 OW 4 5 6\n",
                  "lj"));
    assert_ok(mf_trajectory_next(&trajectory, &frame, &more));
    const struct structure *const structure = &trajectory.structure;
    assert_true(structure->names == STRUCTURE_NAMES && !structure->has_types);
    assert_string_equal(structure->atom[0].name, "OW");
    assert_string_equal(structure->atom[1].name, "c3");
    assert_true(frame.position[1][2] == 3);
    mf_frame_clear(&frame);
    mf_trajectory_close(&trajectory);
}

static void test_units_must_be_told_unless_the_file_does(void **state) {
    char text[1024];
    assert_int_equal(try(state, dump, NULL), STATUS_BAD_INPUT);
    assert_contains(mf_status_message(), "has no units: give them by --file-units");
    assert_int_equal(try(state, dump, "reel"), STATUS_BAD_INPUT);
    assert_contains(mf_status_message(), "did you mean \"real\"?");
    snprintf(text, sizeof text, "ITEM: UNITS\nlj\n%s", dump);
    assert_ok(try(state, text, NULL));
    assert_true(trajectory.scale.length == 1);
    mf_trajectory_close(&trajectory);
    assert_int_equal(try(state, text, "real"), STATUS_BAD_INPUT);
    assert_contains(mf_status_message(), "the file has the units \"lj\"");
    assert_ok(try(state, data_file("Atoms", "3 7 8 9", "2 1 2 3"), NULL));
    assert_true(trajectory.scale.length == 0.1 && trajectory.scale.time == 1);
    mf_trajectory_close(&trajectory);
}

/// An attogram is 602214.076 u; 5 m/s are 5e-3 nm/ps in SI.
static void test_units_are_those_of_the_manual(void **state) {
    struct trajectory_scale scale;
    (void)state;
    assert_ok(mf_trajectory_units_find("nano", &scale));
    assert_true(fabs(scale.mass / 602214.076 - 1) < 1e-8 && scale.time == 1000);
    for (int k = 0; mf_trajectory_unit_names[k]; k++) {
        const char *const name = mf_trajectory_unit_names[k];
        assert_ok(mf_trajectory_units_find(name, &scale));
        if (strcmp(name, "electron") != 0) // whose time is not that of its velocities
            assert_true(fabs(scale.length / scale.time / scale.speed - 1) < 1e-12);
    }
}

/// kcal/mol/Å, eV/Å and newtons in kJ/mol/nm: those of the manual.
static void test_dump_has_forces_where_they_are_asked_for(void **state) {
    static const char text[] =
        "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp "
        "pp\n0 9\n0 9\n0 9\nITEM: ATOMS id x y z fx fy fz\n"
        "2 1 2 3 4 5 -6\n1 1 2 3 7 8 9\n";
    static const struct {
        const char *units;
        double force;
    } known[] = {
        {"real", 41.84}, {"metal", 964.853321}, {"si", 6.02214076e11}, {"lj", 1}, {"nm-ps", 1}};
    struct trajectory_frame frame = {0};
    bool more;
    const char *const file = temporary_folder_write(*state, "a.txt", text, strlen(text));
    for (size_t k = 0; k < 2 * sizeof known / sizeof *known; k++) {
        const struct trajectory_options options = {.units = known[k / 2].units, .forces = k % 2};
        assert_ok(mf_trajectory_open(&trajectory, file, &options));
        assert_ok(mf_trajectory_next(&trajectory, &frame, &more));
        assert_int_equal(frame.has_forces, k % 2);
        if (frame.has_forces)
            assert_true(fabs(frame.force[1][2] / (-6 * known[k / 2].force) - 1) < 1e-8);
        mf_trajectory_close(&trajectory);
    }
    mf_frame_clear(&frame);
}

static void assert_refused(void **state, const char *text, const char *part) {
    struct trajectory_frame frame = {0};
    bool more = true;
    enum status status = try(state, text, "lj");
    const bool opened = status == STATUS_OK;
    while (status == STATUS_OK && more)
        status = mf_trajectory_next(&trajectory, &frame, &more);
    assert_int_equal(status, STATUS_BAD_INPUT);
    assert_contains(mf_status_message(), part);
    mf_frame_clear(&frame);
    if (opened)
        mf_trajectory_close(&trajectory);
}

/// Two frames of an atom of id 7 with these columns.
static void assert_change_refused(void **state, const char *columns, const char *first,
                                  const char *second, const char *part) {
    char text[1024];
    snprintf(text, sizeof text,
             "ITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS id %s x y z\n7 %s 1 2 3\n"
             "ITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS id %s x y z\n7 %s 1 2 3\n",
             columns, first, columns, second);
    assert_refused(state, text, part);
}

/// As by fix atom/swap.
static void test_dump_is_refused_when_atoms_change_their_types(void **state) {
    assert_change_refused(state, "type", "1", "2",
                          "a.txt:8: frame 1: atom 7 is of type 2, in the first frame of 1: where "
                          "atoms swap types, leave out ids, sort rows by type");
    assert_change_refused(state, "type", "Na", "Cl",
                          "atom 7 is of type Cl, in the first frame of Na: where");
    assert_change_refused(state, "element", "Na", "Cl",
                          "atom 7 is of type Cl, in the first frame of Na: where");
    assert_change_refused(state, "type element", "1 C", "2 C",
                          "atom 7 is of type 2, in the first frame of 1: where");
}

static void test_dump_is_refused_with_its_line(void **state) {
    char text[2048];
    snprintf(text, sizeof text, "%s%.*s", dump, (int)sizeof dump - 9, dump);
    assert_refused(state, text, "a.txt:21: frame 1: the file ends within the frame, 1 lines");
    snprintf(text, sizeof text, "%s%.*s2 4 5 6\n", dump, (int)sizeof dump - 9, dump);
    assert_refused(state, text, "a.txt:22: frame 1: duplicate atom id 2");
    snprintf(text, sizeof text, "%s%.*s3 4 5 6\n", dump, (int)sizeof dump - 9, dump);
    assert_refused(state, text, "a.txt:22: frame 1: the first frame has no atom of id 3");
    snprintf(text, sizeof text, "%s%.*s1 4 five 6\n", dump, (int)sizeof dump - 9, dump);
    assert_refused(state, text, "a.txt:22: frame 1: a coordinate is not a finite number");
    snprintf(text, sizeof text, "%s%.*s1 4 5\n", dump, (int)sizeof dump - 9, dump);
    assert_refused(state, text, "a.txt:22: frame 1: 3 columns, expected 4");
    snprintf(text, sizeof text, "%s%.*s1 4 5,5 6\n", dump, (int)sizeof dump - 9, dump);
    assert_refused(state, text,
                   "a.txt:22: frame 1: a coordinate is not a finite number: a decimal");
    assert_refused(state,
                   "ITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS\n0 9,5\n0 9,5\n0 9,5\n"
                   "ITEM: ATOMS id x y z\n1 2 3 4\n",
                   "a.txt:4: frame 0: expected the bounds of the box: a decimal comma?");
    assert_refused(state, "ITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS id mass x y z\n1 -2 3 4 5\n",
                   "a.txt: the mass of atom 1 is -2 u");
    snprintf(text, sizeof text, "%s%.*s1 4 5 6 7\n", dump, (int)sizeof dump - 9, dump);
    assert_refused(state, text, "a.txt:22: frame 1: 5 columns, expected 4");
    snprintf(text, sizeof text, "%.*s2 4 5 6\n", (int)sizeof dump - 9, dump);
    assert_refused(state, text, "two atoms have the id 2");
    snprintf(text, sizeof text, "%sITEM: TIMESTEP\n8\nITEM: NUMBER OF ATOMS\n3\n", dump);
    assert_refused(state, text, "a.txt:15: frame 1: it has 3 atoms, the first frame 2");
    // Without ids a change of order shows by the types.
    static const char frames[] = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\n"
                                 "ITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\n"
                                 "ITEM: ATOMS type x y z\n1 1 2 3\n2 4 5 6\n";
    snprintf(text, sizeof text, "%s%.*s2 1 2 3\n1 4 5 6\n", frames, (int)sizeof frames - 17,
             frames);
    assert_refused(state, text,
                   "a.txt:21: frame 1: atom 1 is of type 2, in the first frame of 1: without ids");
    assert_refused(state, "ITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS id x y\n1 2 3\n", "no positions");
    assert_refused(state, "ITEM: ATOMS id x y z\n1 2 3 4\n",
                   "a.txt:1: frame 0: expected the number of atoms");
    assert_refused(state, "ITEM: NUMBER OF ATOMS\n999999999999999\nITEM: ATOMS x y z\n1 2 3\n",
                   "999999999999998 lines are missing");
    assert_int_equal(try(state, data_file("Atoms # dipole", "3 7 8 9", "2 1 2 3"), NULL),
                     STATUS_BAD_INPUT);
    assert_contains(mf_status_message(), "the atom style \"dipole\" is not read");
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_dumps_are_the_same_whatever_their_columns),
        cmocka_unit_test(test_atom_dump_is_the_same_but_for_images),
        cmocka_unit_test(test_velocities_are_those_of_the_flight),
        cmocka_unit_test(test_data_file_is_the_last_frame),
        TEST(test_data_file_has_any_of_four_styles),
        TEST(test_data_file_has_a_general_box_and_labels),
        TEST(test_template_says_how_many_atoms_it_has_before_its_sections),
        TEST(test_dump_has_a_box_of_three_vectors),
        TEST(test_dump_is_periodic_when_it_does_not_say),
        TEST(test_dump_has_labels_in_the_place_of_types),
        TEST(test_units_must_be_told_unless_the_file_does),
        cmocka_unit_test(test_units_are_those_of_the_manual),
        TEST(test_dump_has_forces_where_they_are_asked_for),
        TEST(test_dump_is_refused_when_atoms_change_their_types),
        TEST(test_dump_is_refused_with_its_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
