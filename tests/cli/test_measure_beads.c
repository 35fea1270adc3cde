// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit measure --beads`: molecules whose centres are known, broken across a tilted box, become
// a trajectory of beads with the box, times, types, masses and velocities of the atoms.
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"
#include "trajectory/trajectory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOLECULES = 30, FRAMES = 4, TEXT = 1 << 16 };

static struct run_program_result result;

/// Box of the dump [Å]; every third molecule is an ion.
static const double box[3][3] = {{40, 0, 0}, {9, 38, 0}, {-7, 5, 36}};

static bool is_ion(int molecule) {
    return molecule % 3 == 2;
}

/// Where the centre of a molecule is [Å].
static void find_centre(int molecule, int frame, double centre[3]) {
    for (int d = 0; d < 3; d++)
        centre[d] =
            fmod(7.3 * molecule + 11.9 * d * molecule + 3.1 * d, 35) + 0.25 * frame * (d - 1);
}

/// The images of atoms are any.
static int print_atom(char *text, size_t size, int id, int molecule, const char *element,
                      double mass, int frame, const double offset[3]) {
    double x[3];
    find_centre(molecule, frame, x);
    for (int d = 0; d < 3; d++)
        x[d] += offset[d] + ((id * 7) % 3 - 1) * box[0][d] - (id % 2) * box[1][d] +
                ((id * 5) % 4 - 2) * box[2][d];
    return snprintf(text, size, "%d %d %s %g %.10g %.10g %.10g %g %g %g\n", id, molecule + 1,
                    element, mass, x[0], x[1], x[2], -0.0025, 0.0 + offset[0], 0.0025);
}

/// Heavy atoms in the middle of light ones.
static void write_dump(struct temporary_folder *folder) {
    static const double offset[3][3] = {{0, 0, 0}, {0.9, 0.3, -0.5}, {-0.9, -0.3, 0.5}};
    static char text[TEXT];
    size_t length = 0;
    for (int t = 0; t < FRAMES; t++) {
        int id = 0;
        length +=
            (size_t)snprintf(text + length, TEXT - length,
                             "ITEM: TIME\n%d\nITEM: TIMESTEP\n%d\nITEM: NUMBER OF ATOMS\n%d\n"
                             "ITEM: BOX BOUNDS abc origin pp pp pp\n40 0 0 0\n9 38 0 0\n-7 5 36 0\n"
                             "ITEM: ATOMS id mol element mass x y z vx vy vz\n",
                             500 * t, 250 * t, MOLECULES * 3 - MOLECULES / 3 * 2);
        for (int m = 0; m < MOLECULES; m++)
            for (int k = 0; k < (is_ion(m) ? 1 : 3); k++)
                length += (size_t)print_atom(text + length, TEXT - length, ++id, m,
                                             is_ion(m) ? "K"
                                             : k       ? "H"
                                                       : "O",
                                             is_ion(m) ? 39
                                             : k       ? 1
                                                       : 16,
                                             t, offset[k]);
    }
    temporary_folder_write(folder, "a.dump", text, length);
}

/// A place is where it should be, or in an image of it [nm].
static void assert_place(const double place[3], const double expected[3], double tolerance) {
    double apart[3];
    for (int d = 0; d < 3; d++)
        apart[d] = 10 * place[d] - expected[d];
    for (int i = 2; i >= 0; i--) {
        const double boxes = rint(apart[i] / box[i][i]);
        for (int d = 0; d < 3; d++)
            apart[d] -= boxes * box[i][d];
    }
    for (int d = 0; d < 3; d++)
        assert_true(fabs(apart[d]) < tolerance);
}

/// What a file has beside positions: .xtc rounds them to 0.001 nm.
struct known {
    const char *name;
    bool velocities, masses, times, names;
    double rounding; ///< [Å]
};

static void check_frame(const struct known *known, const struct trajectory_frame *frame, int t) {
    if (known->times)
        assert_close(frame->time, 0.5 * t, 1e-6);
    assert_true(frame->step < 0 || frame->step == 250 * t);
    assert_true(frame->has_box && frame->atoms == MOLECULES);
    assert_true(frame->has_velocities == known->velocities);
    for (int k = 0; k < 9; k++)
        assert_true(fabs(10 * frame->box[k / 3][k % 3] - box[k / 3][k % 3]) < 1e-6);
    for (int m = 0; m < MOLECULES; m++) {
        double centre[3];
        find_centre(m, t, centre);
        assert_place(frame->position[m], centre, known->rounding);
        if (!known->velocities)
            continue;
        assert_true(fabs(frame->velocity[m][0] + 0.25) < 1e-6);
        assert_true(fabs(frame->velocity[m][1]) < 1e-6);
        assert_true(fabs(frame->velocity[m][2] - 0.25) < 1e-6);
    }
}

static void check_file(const struct known *known) {
    const struct trajectory_options options = {.units =
                                                   strstr(known->name, ".gsd") ? "nm-ps" : NULL};
    struct trajectory trajectory;
    struct trajectory_frame frame = {0};
    bool more = true;
    assert_ok(mf_trajectory_open(&trajectory, known->name, &options));
    for (int m = 0; m < MOLECULES; m++) {
        const struct structure_atom *const atom = &trajectory.structure.atom[m];
        if (known->names) {
            assert_string_equal(atom->name, is_ion(m) ? "K" : "A");
            assert_true(!known->times || atom->residue == (size_t)m); // of GSD by bonds alone
        }
        if (known->masses)
            assert_close(atom->mass, is_ion(m) ? 39 : 18, 1e-9);
    }
    for (int t = 0; t < FRAMES; t++) {
        assert_ok(mf_trajectory_next(&trajectory, &frame, &more));
        assert_true(more);
        check_frame(known, &frame, t);
    }
    assert_ok(mf_trajectory_next(&trajectory, &frame, &more));
    assert_false(more);
    mf_frame_clear(&frame);
    mf_trajectory_close(&trajectory);
}

#define MEASURE(...)                                                                               \
    RUN_PROGRAM(&result, "measure", "a.dump", "--file-units", "real", "--temperature", "300",      \
                "--quiet", __VA_ARGS__)

static void test_beads_are_the_centres_of_molecules(void **state) {
    static const struct known files[] = {{"beads.gro", true, false, true, true, 2e-5},
                                         {"beads.extxyz", true, true, true, true, 2e-5},
                                         {"beads.lammpstrj", true, true, true, true, 2e-5},
                                         {"beads.xtc", false, false, true, false, 5.1e-3},
                                         {"beads.gsd", true, true, false, true, 1e-4}};
    write_dump(*state);
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
        MEASURE("--begin", "0", "--beads", files[k].name, "-o", "of");
        run_program_assert_code(&result, 0);
        check_file(&files[k]);
    }
    char *const dump = temporary_folder_read("beads.lammpstrj"); // as MDAnalysis and LAMMPS want it
    assert_contains(dump, "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS time=0 units=real\n30\n"
                          "ITEM: BOX BOUNDS xy xz yz pp pp pp\n");
    free(dump);
    assert_true(results_number("of/summary.json", "frames") == FRAMES);
}

/// What was measured of the atoms is what is measured of the file.
static void test_beads_have_the_results_of_their_atoms(void **state) {
    write_dump(*state);
    MEASURE("--begin", "0.5", "--range", "1.5", "--beads", "beads.xyz", "-o", "of");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "measure", "beads.xyz", "--range", "1.5", "--begin", "0.5", "--quiet",
                "-o", "again");
    run_program_assert_code(&result, 0);
    assert_true(results_number("again/summary.json", "frames") == FRAMES - 1);
    results_assert_same("of", "again", (const char *const[]){"rdf_A-A.tsv", "rdf_A-K.tsv", NULL});
}

static void test_beads_replace_no_file_and_leave_none(void **state) {
    write_dump(*state);
    temporary_folder_write(*state, "mine.xyz", "mine", 4);
    MEASURE("--beads", "mine.xyz", "-o", "of");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "mine.xyz is there: --force replaces it, --beads OTHER keeps it");
    MEASURE("--beads", "a.dump", "--force", "-o", "of");
    run_program_assert_code(&result, 2);
    MEASURE("--beads", "beads.pdb", "-o", "of");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "--beads beads.pdb: expected a name that ends with .gro");
    MEASURE("--beads", "beads.gro", "--range", "5", "-o", "of"); // more than the box has
    run_program_assert_code(&result, 2);
    assert_false(temporary_folder_exists("beads.gro"));
    assert_false(temporary_folder_exists("of"));
    MEASURE("--beads", "mine.xyz", "--force", "-o", "of");
    run_program_assert_code(&result, 0);
    char *text = temporary_folder_read("mine.xyz");
    assert_contains(text, "30\nLattice=\"40 0 0 9 38 0 -7 5 36\"");
    free(text);
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_beads_are_the_centres_of_molecules),
        TEST(test_beads_have_the_results_of_their_atoms),
        TEST(test_beads_replace_no_file_and_leave_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
