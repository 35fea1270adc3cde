// SPDX-License-Identifier: GPL-3.0-or-later
//
// Snapshots of `mesofit simulate` as GSD hold what the dump beside them does, read by readers that
// know files of HOOMD and LAMMPS, and the bonds of the scene.
#include "shared/is_close.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"
#include "trajectory/trajectory.h"

#include <math.h>

enum { CHAINS = 20, SINGLE = 10, ATOMS = 3 * CHAINS + SINGLE };

static const char scene[] =
    "{\"seed\": 3, \"box\": [4, 5, 6], \"time_step\": 0.01,\n"
    "\"bonds\": {\"spring\": {\"law\": \"harmonic\", \"k\": 50, \"length\": 0.5}},\n"
    "\"molecules\": {\"chain\": {\"count\": 20, \"chain\": {\"beads\": [\"A\", \"B\", \"A\"],\n"
    "    \"bond\": \"spring\"}}},\n"
    "\"particles\": {\"types\": {\"W\": 10}, \"mass\": {\"A\": 2, \"B\": 1, \"W\": 3}},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\"},\n"
    "\"snapshots\": {\"every\": 100, \"formats\": [\"lammps-dump\", \"gsd\", \"xtc\"]},\n"
    "\"measure\": {\"equilibration\": 200, \"samples\": 20, \"every\": 10}}\n";

static void open_at(struct trajectory *trajectory, struct trajectory_frame *frame, const char *file,
                    int frames) {
    const struct trajectory_options options = {.units = "lj"};
    bool more = true;
    *frame = (struct trajectory_frame){0};
    assert_ok(mf_trajectory_open(trajectory, file, &options));
    for (int k = 0; k < frames; k++) {
        assert_ok(mf_trajectory_next(trajectory, frame, &more));
        assert_true(more);
    }
}

static void compare(const struct trajectory_frame *gsd, const struct trajectory_frame *dump) {
    assert_true(gsd->step == dump->step && gsd->atoms == ATOMS && dump->atoms == ATOMS);
    for (int d = 0; d < 3; d++)
        assert_close(gsd->box[d][d], 4 + d, 1e-6);
    for (int k = 0; k < ATOMS; k++)
        for (int d = 0; d < 3; d++) { // the one is about the middle of the box
            assert_true(fabs(gsd->position[k][d] + (4 + d) / 2.0 - dump->position[k][d]) < 1e-5);
            assert_true(fabs(gsd->velocity[k][d] - dump->velocity[k][d]) < 1e-5);
        }
}

/// XTC has positions in the box, in thousandths.
static void compare_rounded(const struct trajectory_frame *dump) {
    struct trajectory xtc;
    struct trajectory_frame frame;
    open_at(&xtc, &frame, "out/snapshots/trajectory.xtc", 3);
    assert_true(frame.step == dump->step && frame.atoms == ATOMS);
    assert_close(frame.time, 4, 1e-6);
    for (int k = 0; k < ATOMS; k++)
        for (int d = 0; d < 3; d++) {
            const double apart = frame.position[k][d] - dump->position[k][d];
            assert_close(frame.box[d][d], 4 + d, 1e-6);
            assert_true(fabs(apart - (4 + d) * rint(apart / (4 + d))) < 0.000501);
            assert_true(frame.position[k][d] >= 0 && frame.position[k][d] <= 4 + d);
        }
    mf_frame_clear(&frame);
    mf_trajectory_close(&xtc);
}

static void test_gsd_is_the_dump_with_bonds(void **state) {
    static struct run_program_result result;
    struct trajectory gsd, dump;
    struct trajectory_frame gsd_frame, dump_frame;
    small_inputs_write(*state, "scene.json", scene, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--quiet");
    run_program_assert_code(&result, 0);
    open_at(&gsd, &gsd_frame, "out/snapshots/trajectory.gsd", 3);
    open_at(&dump, &dump_frame, "out/snapshots/trajectory.lammpstrj", 3);
    compare(&gsd_frame, &dump_frame);
    compare_rounded(&dump_frame);
    int molecules = 0;
    for (int k = 0; k < ATOMS; k++) {
        const struct structure_atom *const atom = &gsd.structure.atom[k];
        const char *const type = atom->name;
        assert_int_equal(type[0] == 'W' ? 1 : type[0] == 'A' ? 2 : 3, dump.structure.atom[k].type);
        assert_close(atom->mass, type[0] == 'A' ? 2 : type[0] == 'B' ? 1 : 3, 1e-7);
        molecules += atom->molecule != 0;
        for (int j = 0; j < k; j++) // the same molecule in both, if in one
            if (atom->molecule != 0)
                assert_int_equal(atom->molecule == gsd.structure.atom[j].molecule,
                                 dump.structure.atom[k].molecule ==
                                     dump.structure.atom[j].molecule);
    }
    assert_int_equal(molecules, 3 * CHAINS);
    assert_int_equal(gsd.structure.residues, CHAINS + SINGLE);
    mf_frame_clear(&gsd_frame);
    mf_frame_clear(&dump_frame);
    mf_trajectory_close(&gsd);
    mf_trajectory_close(&dump);
}

static void check_masses(const struct run_program_result *result) {
    run_program_assert_code(result, 0);
    assert_contains(result->err, "W: 60 beads of 1 atom, the first of 18 u");
    assert_contains(result->err, ": 40 beads of 2 atoms, the first of 36 u");
}

/// Beads of 18 u: a dump says what they are, their mass and its units, and a GSD their mass.
static void test_what_all_beads_weigh_is_in_the_snapshots(void **state) {
    static struct run_program_result result;
    small_inputs_write(
        *state, "scene.json",
        "{\"units\": \"nm-ps\", \"box\": [3, 3, 3], \"temperature\": 300, \"time_step\": 0.01,\n"
        "\"bonds\": {\"spring\": {\"law\": \"harmonic\", \"k\": 2000, \"length\": 0.4}},\n"
        "\"molecules\": {\"pair\": {\"count\": 40, \"beads\": [\"A\", \"B\"],\n"
        "    \"bonds\": {\"spring\": [[1, 2]]}}},\n"
        "\"particles\": {\"types\": {\"W\": 60}, \"mass\": 18},\n"
        "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 50, \"cutoff\": 0.5},\n"
        "\"snapshots\": {\"every\": 20, \"formats\": [\"lammps-dump\", \"extxyz\", \"gsd\"]},\n"
        "\"measure\": {\"equilibration\": 100, \"samples\": 10, \"every\": 20}}\n",
        NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--quiet");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "measure", "out/snapshots/trajectory.lammpstrj", "-o", "of-dump");
    check_masses(&result);
    RUN_PROGRAM(&result, "measure", "out/snapshots/trajectory.extxyz", "-o", "of-xyz");
    check_masses(&result);
    RUN_PROGRAM(&result, "measure", "out/snapshots/trajectory.gsd", "--file-units", "nm-ps", "-o",
                "of-gsd");
    check_masses(&result);
}

static void test_all_snapshots_are_one_trajectory(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "scene.json", scene, "\"every\": 100", "\"every\": 2");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--quiet");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "measure", "out/snapshots/trajectory.gsd", "-o", "target", "--file-units",
                "lj", "--file-time-step", "0.01");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, "101 frames of 30 beads");
}

/// XTC has positions alone: what tells types and masses is named by `simulate`, and by `measure`
/// where it is not given; the dump of the same run is found by its name.
static void test_xtc_is_measured_with_the_dump_beside_it(void **state) {
    static struct run_program_result result;
    static const char mixed[] =
        "{\"units\": \"nm-ps\", \"box\": [3, 3, 3], \"temperature\": 300, \"time_step\": 0.01,\n"
        "\"particles\": {\"types\": {\"A\": 40, \"B\": 20}, \"mass\": {\"A\": 18, \"B\": 30}},\n"
        "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 20, \"cutoff\": 0.7},\n"
        "\"snapshots\": {\"every\": 10, \"formats\": [FORMATS]},\n"
        "\"measure\": {\"equilibration\": 20, \"samples\": 40, \"every\": 10}}\n";
    static const char *const xtc = "out/snapshots/trajectory.xtc";
    small_inputs_write(*state, "scene.json", mixed, "FORMATS", "\"xtc\"");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    assert_contains(result.err, "41 snapshots in out/snapshots; trajectory.xtc has no types: ");
    RUN_PROGRAM(&result, "measure", xtc, "-o", "alone");
    assert_contains(result.err, "give their types and masses by -s FILE, a .gro");
    small_inputs_write(*state, "scene.json", mixed, "FORMATS", "\"xtc\", \"lammps-dump\"");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--force");
    assert_contains(result.err, "41 snapshots in out/snapshots; there: mesofit measure "
                                "trajectory.xtc -s trajectory.lammpstrj\n");
    RUN_PROGRAM(&result, "measure", xtc, "-o", "alone", "--force");
    assert_contains(result.err,
                    "give their types and masses by -s out/snapshots/trajectory.lammpstrj\n");
    RUN_PROGRAM(&result, "measure", xtc, "-s", "out/snapshots/trajectory.lammpstrj", "-o", "told");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, "A: 40 beads of 1 atom, the first of 18 u");
    assert_contains(result.err, "B: 20 beads of 1 atom, the first of 30 u");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_gsd_is_the_dump_with_bonds,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_what_all_beads_weigh_is_in_the_snapshots,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_xtc_is_measured_with_the_dump_beside_it,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_all_snapshots_are_one_trajectory,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
