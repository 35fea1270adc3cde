// SPDX-License-Identifier: GPL-3.0-or-later
//
// Files that GROMACS wrote, against what another program has computed from them: centres of mass,
// temperature and counts of pairs of 2744 waters (tests/trajectories/README.md).
#include "shared/temporary_folder.h"
#include "shared/testing.h"
#include "trajectory/mapping.h"
#include "trajectory/trajectory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define FOLDER "tests/trajectories/"
static const char gro[] = FOLDER "water.gro", xtc[] = FOLDER "water.xtc",
                  trr[] = FOLDER "water.trr";
static const char wrapped[] = FOLDER "water-atoms-wrapped.xtc";

enum { ATOMS = 8232, WATERS = 2744 };
static const double edge = 4.384;           // nm
static const double water_mass = 18.0154;   // u
static const double boltzmann = 0.00831446; // kJ/(mol K)

/// Digits of what is expected, and of the files: positions of xtc and gro are rounded to 0.001.
static const double printed = 6e-6, rounded = 5.1e-4, rounded_velocity = 6e-5;

/// Time [ps], centres of the first and the last water [nm], velocity of the first [nm/ps],
/// temperature of the centres [K], pairs of centres in [0.2, 0.3), [0.3, 0.4), [0.4, 0.5) nm.
static const struct expected {
    double time, first[3], last[3], velocity[3], temperature;
    int pairs[3];
} expected[] = {
    {0.000,
     {3.56684, 1.08654, 1.21667},
     {0.41702, 4.23920, 0.91052},
     {-0.12362, -0.20022, -0.13461},
     292.570,
     {3977, 6737, 11831}},
    {0.020,
     {3.56466, 1.08301, 1.21416},
     {0.41772, 4.24196, 0.90732},
     {-0.09710, -0.12883, -0.12246},
     287.689,
     {4003, 6683, 11879}},
    {0.040,
     {3.56283, 1.08049, 1.21197},
     {0.41674, 4.23920, 0.90525},
     {-0.07038, -0.18079, -0.09593},
     293.453,
     {4013, 6637, 11926}},
    {0.060,
     {3.56389, 1.07467, 1.20942},
     {0.41549, 4.23157, 0.90460},
     {0.15051, -0.34581, -0.16466},
     298.272,
     {4041, 6624, 11901}},
    {0.080,
     {3.56666, 1.06828, 1.20728},
     {0.41219, 4.22298, 0.90425},
     {0.09554, -0.29792, -0.00456},
     302.752,
     {4045, 6606, 11862}},
};

static const char map[] = "{\"beads\": {\"W\": {\"residue\": \"SOL\"}},"
                          " \"masses\": {\"OW\": 15.9994, \"HW1\": 1.008, \"HW2\": 1.008}}";

static void make_mapping(void **state, struct mapping *mapping) {
    struct mapping_plan plan;
    struct trajectory structure;
    const char *file = temporary_folder_write(*state, "map.json", map, sizeof map - 1);
    assert_ok(mf_mapping_plan_read(&plan, file));
    assert_ok(mf_trajectory_open(&structure, gro, &(struct trajectory_options){0}));
    assert_ok(mf_mapping_init(mapping, &plan, &structure.structure));
    assert_int_equal(mapping->beads, WATERS);
    mf_trajectory_close(&structure);
    mf_mapping_plan_clear(&plan);
}

static double wrap(double x) {
    return x - edge * floor(x / edge);
}

static void assert_place(const double *position, const double *wanted, double tolerance) {
    for (int d = 0; d < 3; d++) {
        const double difference = wrap(position[d]) - wanted[d];
        assert_true(fabs(difference - edge * rint(difference / edge)) <= tolerance);
    }
}

static void assert_pairs(const struct trajectory_frame *beads, const int wanted[3], int tolerance) {
    int pairs[3] = {0};
    for (size_t i = 0; i < WATERS; i++)
        for (size_t j = i + 1; j < WATERS; j++) {
            double square = 0;
            for (int d = 0; d < 3; d++) {
                const double x = beads->position[i][d] - beads->position[j][d];
                square += pow(x - edge * rint(x / edge), 2);
            }
            if (square >= 0.04 && square < 0.25)
                pairs[square < 0.09 ? 0 : square < 0.16 ? 1 : 2]++;
        }
    for (int k = 0; k < 3; k++)
        assert_in_range(pairs[k], wanted[k] - tolerance, wanted[k] + tolerance);
}

static void assert_velocities(const struct trajectory_frame *beads, const struct expected *wanted,
                              double tolerance) {
    double energy = 0;
    for (int d = 0; d < 3; d++)
        assert_true(fabs(beads->velocity[0][d] - wanted->velocity[d]) <= tolerance);
    for (size_t k = 0; k < WATERS; k++)
        for (int d = 0; d < 3; d++)
            energy += water_mass * beads->velocity[k][d] * beads->velocity[k][d];
    const double temperature = energy / (3 * WATERS * boltzmann);
    assert_true(fabs(temperature - wanted->temperature) <= 1000 * tolerance);
}

/// All frames of a file are as expected; returns how many there are.
static size_t check_file(void **state, const char *file, double tolerance, int pairs,
                         double velocity) {
    struct mapping mapping;
    struct trajectory trajectory;
    struct trajectory_frame frame = {0}, beads = {0};
    size_t frames = 0;
    bool more;
    make_mapping(state, &mapping);
    assert_ok(mf_trajectory_open(&trajectory, file, &(struct trajectory_options){0}));
    assert_int_equal(trajectory.structure.atoms, ATOMS);
    for (;; frames++) {
        const struct expected *const wanted = &expected[frames];
        assert_ok(mf_trajectory_next(&trajectory, &frame, &more));
        if (!more)
            break;
        assert_in_range(frames, 0, 4);
        assert_int_equal(frame.number, frames);
        assert_int_equal(frame.step, 10 * frames);
        assert_true(fabs(frame.time - wanted->time) < 1e-6);
        assert_true(frame.has_box && frame.periodic[0]);
        assert_true(fabs(frame.box[2][2] - edge) < 1e-6 && frame.box[1][0] == 0);
        assert_ok(mf_mapping_apply(&mapping, &frame, &beads));
        assert_place(beads.position[0], wanted->first, tolerance);
        assert_place(beads.position[WATERS - 1], wanted->last, tolerance);
        assert_pairs(&beads, wanted->pairs, pairs);
        assert_int_equal(beads.has_velocities, velocity > 0);
        if (velocity > 0)
            assert_velocities(&beads, wanted, velocity);
    }
    mf_frame_clear(&frame);
    mf_frame_clear(&beads);
    mf_trajectory_close(&trajectory);
    mf_mapping_clear(&mapping);
    return frames;
}

static void test_trr_gives_centres_velocities_and_pairs(void **state) {
    assert_int_equal(check_file(state, trr, printed, 0, printed), 2);
}

static void test_xtc_gives_centres_and_pairs(void **state) {
    assert_int_equal(check_file(state, xtc, rounded, 25, 0), 5);
}

static void test_xtc_gives_centres_when_molecules_are_broken(void **state) {
    assert_int_equal(check_file(state, wrapped, rounded, 25, 0), 5);
}

static void test_gro_gives_centres_velocities_and_pairs(void **state) {
    assert_int_equal(check_file(state, gro, rounded, 25, rounded_velocity), 1);
}

/// Every atom of every frame: xtc is trr, rounded to a thousandth.
static void test_xtc_is_trr_to_its_rounding(void **state) {
    struct trajectory exact, packed;
    struct trajectory_frame a = {0}, b = {0};
    bool more;
    (void)state;
    assert_ok(mf_trajectory_open(&exact, trr, &(struct trajectory_options){0}));
    assert_ok(mf_trajectory_open(&packed, xtc, &(struct trajectory_options){0}));
    for (int frame = 0; frame < 2; frame++) {
        double largest = 0;
        assert_ok(mf_trajectory_next(&exact, &a, &more));
        assert_true(more);
        assert_ok(mf_trajectory_next(&packed, &b, &more));
        assert_true(more);
        for (size_t k = 0; k < ATOMS; k++)
            for (int d = 0; d < 3; d++)
                largest = fmax(largest, fabs(a.position[k][d] - b.position[k][d]));
        assert_true(largest > 4.9e-4 && largest < 5.01e-4);
    }
    mf_frame_clear(&a);
    mf_frame_clear(&b);
    mf_trajectory_close(&exact);
    mf_trajectory_close(&packed);
}

static void test_gro_names_atoms_and_residues(void **state) {
    struct trajectory trajectory;
    (void)state;
    assert_ok(mf_trajectory_open(&trajectory, gro, &(struct trajectory_options){0}));
    const struct structure *const structure = &trajectory.structure;
    assert_int_equal(structure->residues, WATERS);
    assert_true(structure->has_names && structure->has_residues && !structure->has_masses);
    const struct structure_atom *const last = &structure->atom[ATOMS - 1];
    assert_string_equal(last->name, "HW2");
    assert_string_equal(last->residue_name, "SOL");
    assert_int_equal(last->residue_number, WATERS);
    assert_int_equal(last->residue, WATERS - 1);
    mf_trajectory_close(&trajectory);
}

/// The content says what a file is, whatever it is called.
static void test_format_is_found_by_content_whatever_the_extension(void **state) {
    static const char *const files[] = {gro, xtc, trr};
    for (int k = 0; k < 3; k++) {
        struct trajectory trajectory;
        char *bytes = malloc(600000);
        FILE *stream = fopen(files[k], "rb");
        assert_true(stream && bytes);
        const size_t size = fread(bytes, 1, 600000, stream);
        fclose(stream);
        const char *file = temporary_folder_write(*state, "some.pdb", bytes, size);
        assert_ok(mf_trajectory_open(&trajectory, file, &(struct trajectory_options){0}));
        assert_string_equal(trajectory.format->name, strrchr(files[k], '.') + 1);
        mf_trajectory_close(&trajectory);
        free(bytes);
    }
}

/// Fetched frames may be decoded later, by threads, with the same bits.
static void test_frames_can_be_decoded_by_threads(void **state) {
    struct trajectory trajectory;
    struct trajectory_frame frame[5] = {{0}}, next = {0};
    bool more;
    (void)state;
    assert_ok(mf_trajectory_open(&trajectory, xtc, &(struct trajectory_options){0}));
    for (int k = 0; k < 5; k++)
        assert_ok(mf_trajectory_fetch(&trajectory, &frame[k], &more));
    assert_ok(mf_trajectory_fetch(&trajectory, &next, &more));
    assert_false(more);
    int failures = 0;
#pragma omp parallel for num_threads(5) reduction(+ : failures)
    for (int k = 0; k < 5; k++)
        failures += mf_trajectory_decode(&trajectory, &frame[k]) != STATUS_OK;
    assert_int_equal(failures, 0);
    mf_trajectory_close(&trajectory);
    assert_ok(mf_trajectory_open(&trajectory, xtc, &(struct trajectory_options){0}));
    for (int k = 0; k < 5; k++) {
        assert_ok(mf_trajectory_next(&trajectory, &next, &more));
        assert_memory_equal(next.position, frame[k].position, ATOMS * sizeof *next.position);
        mf_frame_clear(&frame[k]);
    }
    mf_frame_clear(&next);
    mf_trajectory_close(&trajectory);
}

/// What is fetched and not decoded is passed over, damaged or not.
static void test_frames_can_be_skipped(void **state) {
    struct trajectory trajectory;
    struct trajectory_frame frame = {0};
    bool more;
    (void)state;
    assert_ok(mf_trajectory_open(&trajectory, xtc, &(struct trajectory_options){0}));
    for (int k = 0; k < 4; k++)
        assert_ok(mf_trajectory_fetch(&trajectory, &frame, &more));
    assert_ok(mf_trajectory_next(&trajectory, &frame, &more));
    assert_true(more && frame.number == 4 && frame.step == 40);
    mf_frame_clear(&frame);
    mf_trajectory_close(&trajectory);
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_trr_gives_centres_velocities_and_pairs),
        TEST(test_xtc_gives_centres_and_pairs),
        TEST(test_xtc_gives_centres_when_molecules_are_broken),
        TEST(test_gro_gives_centres_velocities_and_pairs),
        TEST(test_xtc_is_trr_to_its_rounding),
        TEST(test_gro_names_atoms_and_residues),
        TEST(test_format_is_found_by_content_whatever_the_extension),
        TEST(test_frames_can_be_decoded_by_threads),
        cmocka_unit_test(test_frames_can_be_skipped),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
