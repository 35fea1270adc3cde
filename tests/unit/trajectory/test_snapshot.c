// SPDX-License-Identifier: GPL-3.0-or-later
//
// Snapshots of three particles whose numbers are known, read back by other means than they were
// written with.
#include "trajectory/snapshot.h"
#include "shared/is_close.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"
#include "trajectory/trajectory.h"

#include <stdlib.h>
#include <string.h>

enum { COUNT = 3 };
static const struct composition mixture = {.types = 2, .count = {2, 1}, .name = {"A", "Big"}};

/// Particle k of the arrays has the id (k + 1) mod 3; the second is outside of the box.
static void make_in(struct particles *particles, int dimensions) {
    const struct box box = {dimensions, {4, 8, 1}};
    int number;
    assert_ok(mf_particles_init(particles, &box, COUNT));
    assert_ok(mf_particles_add_attribute(particles,
                                         &(struct particles_attribute){.name = "radius[lambda]",
                                                                       .type = PARTICLES_DOUBLE,
                                                                       .components = 1},
                                         &number));
    for (int k = 0; k < COUNT; k++) {
        particles->id[k] = (uint32_t)(k + 1) % COUNT;
        for (int d = 0; d < dimensions; d++) {
            particles->position[d][k] = 1.1 + k + 10 * (k == 1);
            particles->velocity[d][k] = 100 + 10 * d + k;
            particles->force[d][k] = -1.0 / (3 + k + d);
        }
        ((double *)particles->attribute[number].value[0])[k] = 0.5 * k;
    }
    particles->image[0][1] = 7;
}

static void make(struct particles *particles) {
    make_in(particles, 2);
}

static char *write_one(void **state, const struct snapshot_format *format, const char *name) {
    struct temporary_folder *folder = *state;
    struct particles particles;
    struct snapshot snapshot;
    int64_t size = 0;
    make(&particles);
    assert_ok(mf_snapshot_take(&snapshot, &particles, &mixture, NULL, 20, 0.5));
    assert_ok(mf_snapshot_write(&snapshot, format, folder->path, &size));
    mf_snapshot_clear(&snapshot);
    mf_particles_clear(&particles);
    return temporary_folder_read(temporary_folder_file(folder, name));
}

static void test_extxyz_has_a_line_for_each_particle_by_id(void **state) {
    char *text = write_one(state, &mf_snapshot_xyz, "trajectory.extxyz");
    assert_string_equal(
        text, "3\n"
              "Lattice=\"4 0 0 0 8 0 0 0 1\" pbc=\"T T F\" Step=20 Time=0.5 "
              "Properties=species:S:1:pos:R:3:image:I:3:velo:R:3:forces:R:3:radius:R:1:masses:R:"
              "1:id:I:1:type:I:1:name:S:1\n"
              "X 3.1 3.1 0 0 0 0 102 112 0 -0.2 -0.1666666667 0 1 1 0 1 A\n"
              "X 1.1 1.1 0 0 0 0 100 110 0 -0.3333333333 -0.25 0 0 1 1 1 A\n"
              "X 0.1 4.1 0 10 1 0 101 111 0 -0.25 -0.2 0 0.5 1 2 2 Big\n");
    free(text);
}

static void test_json_has_all_digits_of_each_column(void **state) {
    char *text = write_one(state, &mf_snapshot_json, "step_000000020.json");
    assert_contains(text, "\"step\": 20,\n  \"time\": 0.5,\n  \"count\": 3,\n  \"box\": [4, 8],");
    assert_contains(text, "\"type\": [\"A\", \"A\", \"Big\"]");
    assert_contains(text, "\"x\": [3.1, 1.1, 0.0999999999999996");
    assert_contains(text, "\"image_x\": [0, 0, 10]");
    assert_contains(text, "\"force_x\": [-0.2, -0.3333333333333333");
    assert_contains(text, "\"radius\": [1, 0, 0.5]");
    free(text);
}

/// A solvent of two, the second beyond the edge, comes after the particles and has no forces.
static void test_companions_follow_as_a_type_of_their_own(void **state) {
    struct temporary_folder *folder = *state;
    double x[] = {0.5, 4.5}, y[] = {1, 2}, vx[] = {-1, 3}, vy[] = {7, 8};
    double *const position[] = {x, y}, *const velocity[] = {vx, vy};
    const struct snapshot_solvent_particles solvent_particles = {"solvent", 2, position, velocity,
                                                                 1};
    struct particles particles;
    struct snapshot snapshot;
    int64_t size = 0;
    make(&particles);
    assert_ok(mf_snapshot_take(&snapshot, &particles, &mixture, &solvent_particles, 20, 0.5));
    assert_ok(mf_snapshot_write(&snapshot, &mf_snapshot_xyz, folder->path, &size));
    assert_ok(mf_snapshot_write(&snapshot, &mf_snapshot_json, folder->path, &size));
    assert_int_equal(mf_snapshot_type(&snapshot, 2), 1);
    assert_int_equal(mf_snapshot_type(&snapshot, 3), 2);
    mf_snapshot_clear(&snapshot);
    mf_particles_clear(&particles);
    char *frames = temporary_folder_read(temporary_folder_file(folder, "trajectory.extxyz"));
    assert_contains(frames, "5\nLattice");
    assert_contains(frames, "X 0.1 4.1 0 10 1 0 101 111 0 -0.25 -0.2 0 0.5 1 2 2 Big\n"
                            "X 0.5 1 0 0 0 0 -1 7 0 0 0 0 0 1 3 3 solvent\n"
                            "X 0.5 2 0 0 0 0 3 8 0 0 0 0 0 1 4 3 solvent\n");
    char *text = temporary_folder_read(temporary_folder_file(folder, "step_000000020.json"));
    assert_contains(text, "\"count\": 3,");
    assert_contains(text, "\"image_x\": [0, 0, 10]");
    assert_contains(text, "\"solvent\": {\n    \"type\": [\"solvent\", \"solvent\"],\n"
                          "    \"x\": [0.5, 0.5],\n    \"y\": [1, 2],\n"
                          "    \"velocity_x\": [-1, 3],\n    \"velocity_y\": [7, 8]\n  }\n}");
    free(frames);
    free(text);
}

/// Two frames with a solvent, read as a trajectory: places beyond the box by their images, which
/// the particle at 0.1 + 10 and 4.1 + 1 boxes shows.
static void test_lammps_dump_is_read_back(void **state) {
    struct temporary_folder *folder = *state;
    double x[] = {0.5, 4.5}, y[] = {1, 2}, vx[] = {-1, 3}, vy[] = {7, 8};
    double *const position[] = {x, y}, *const velocity[] = {vx, vy};
    const struct snapshot_solvent_particles solvent_particles = {"solvent", 2, position, velocity,
                                                                 1};
    static const double expected[COUNT + 2][4] = {{3.1, 3.1, 102, 112},
                                                  {1.1, 1.1, 100, 110},
                                                  {40.1, 12.1, 101, 111},
                                                  {0.5, 1, -1, 7},
                                                  {0.5, 2, 3, 8}};
    struct particles particles;
    struct snapshot snapshot;
    struct trajectory trajectory;
    struct trajectory_frame frame = {0};
    int64_t size = 0;
    bool more;
    make(&particles);
    for (uint64_t step = 20; step <= 40; step += 20) {
        assert_ok(mf_snapshot_take(&snapshot, &particles, &mixture, &solvent_particles, step,
                                   0.025 * (double)step));
        assert_ok(
            mf_snapshot_write(&snapshot, &mf_format_lammps_dump_snapshot, folder->path, &size));
        mf_snapshot_clear(&snapshot);
    }
    mf_particles_clear(&particles);
    assert_ok(mf_trajectory_open(&trajectory, temporary_folder_file(folder, "trajectory.lammpstrj"),
                                 &(struct trajectory_options){.units = "lj"}));
    assert_string_equal(trajectory.format->name, mf_format_lammps_dump_snapshot.name);
    for (int n = 1; n <= 2; n++) {
        assert_ok(mf_trajectory_next(&trajectory, &frame, &more));
        assert_true(more && frame.atoms == COUNT + 2 && frame.has_velocities);
        assert_int_equal(frame.step, 20 * n);
        assert_close(frame.time, 0.5 * n, 1e-12);
        assert_close(frame.box[0][0], 4, 1e-12);
        assert_close(frame.box[1][1], 8, 1e-12);
        for (int k = 0; k < COUNT + 2; k++)
            for (int d = 0; d < 3; d++) {
                assert_close(frame.position[k][d], d < 2 ? expected[k][d] : 0, 1e-9);
                assert_close(frame.velocity[k][d], d < 2 ? expected[k][2 + d] : 0, 1e-9);
            }
    }
    assert_int_equal(trajectory.structure.atom[2].type, 2);
    assert_int_equal(trajectory.structure.atom[4].type, 3);
    assert_ok(mf_trajectory_next(&trajectory, &frame, &more));
    assert_false(more);
    mf_frame_clear(&frame);
    mf_trajectory_close(&trajectory);
}

/// The bytes after the first > after a text, out of base64.
static void decode(const char *text, const char *after, unsigned char *bytes, size_t size) {
    static const char letters[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *at = strchr(strstr(text, after), '>') + 1;
    for (size_t k = 0; k < size; at += 4) {
        uint32_t word = 0;
        for (int n = 0; n < 4; n++)
            word = word << 6 | (at[n] == '=' ? 0 : (uint32_t)(strchr(letters, at[n]) - letters));
        for (int n = 2; n >= 0 && k < size; n--)
            bytes[k++] = (unsigned char)(word >> 8 * n);
    }
}

static void test_vtp_holds_the_bits_of_vectors_with_three_components(void **state) {
    char *text = write_one(state, &mf_snapshot_vtp, "step_000000020.vtp");
    struct {
        uint64_t size;
        double value[3 * COUNT];
    } force;
    struct {
        uint64_t size;
        int64_t value[COUNT];
    } type;
    decode(text, "Name=\"force\"", (unsigned char *)&force, sizeof force);
    decode(text, "Name=\"type\"", (unsigned char *)&type, sizeof type);
    assert_int_equal(force.size, sizeof force.value);
    assert_int_equal(type.size, sizeof type.value);
    for (int k = 0; k < COUNT; k++) {
        const int id = (k + 1) % COUNT;
        assert_int_equal(type.value[id], id == 2);
        for (int d = 0; d < 3; d++)
            assert_identical(force.value[3 * id + d], d < 2 ? -1.0 / (3 + k + d) : 0);
    }
    assert_contains(text, "NumberOfPoints=\"3\"");
    assert_contains(text, "</VTKFile>\n");
    free(text);
}

/// A frame goes behind what counts, and what a killed run left behind that is gone.
static void test_extxyz_is_continued_behind_the_bytes_that_count(void **state) {
    struct temporary_folder *folder = *state;
    struct particles particles;
    struct snapshot snapshot;
    make(&particles);
    assert_ok(mf_snapshot_take(&snapshot, &particles, &mixture, NULL, 20, 0.5));
    int64_t size = 0;
    assert_ok(mf_snapshot_write(&snapshot, &mf_snapshot_xyz, folder->path, &size));
    const int64_t first = size;
    assert_ok(mf_snapshot_write(&snapshot, &mf_snapshot_xyz, folder->path, &size));
    assert_int_equal(size, 2 * first);
    assert_ok(mf_snapshot_write(&snapshot, &mf_snapshot_xyz, folder->path, &size));
    size = first; // of a checkpoint after the first
    assert_ok(mf_snapshot_write(&snapshot, &mf_snapshot_xyz, folder->path, &size));
    char *text = temporary_folder_read(temporary_folder_file(folder, "trajectory.extxyz"));
    assert_int_equal(strlen(text), 2 * first);
    assert_memory_equal(text, text + first, (size_t)first);
    free(text);
    mf_snapshot_clear(&snapshot);
    mf_particles_clear(&particles);
}

/// How many frames a reader finds, whose steps are 10, 20, …
static size_t count_gsd_frames(const char *path) {
    static const struct trajectory_options options = {.units = "lj"};
    struct trajectory gsd;
    struct trajectory_frame frame = {0};
    size_t frames = 0;
    bool more = true;
    assert_ok(mf_trajectory_open(&gsd, path, &options));
    while (true) {
        assert_ok(mf_trajectory_next(&gsd, &frame, &more));
        if (!more)
            break;
        frames++;
        assert_int_equal(frame.step, 10 * frames);
        assert_close(frame.velocity[2][0], 101, 1e-3);
    }
    mf_frame_clear(&frame);
    mf_trajectory_close(&gsd);
    return frames;
}

/// Frames up to a number, from one behind whose predecessors the file ends after so many bytes.
static int64_t write_gsd(struct snapshot *snapshot, const char *folder, const char *path,
                         size_t from, int64_t size, size_t to) {
    for (size_t k = from; k < to; k++) {
        snapshot->number = k;
        snapshot->step = 10 * (k + 1);
        assert_ok(mf_snapshot_write(snapshot, &mf_gsd_snapshot, folder, &size));
        assert_int_equal(count_gsd_frames(path), k + 1);
    }
    return size;
}

/// The number at byte 8 of a file: where its index is.
static uint64_t find_index(const char *bytes) {
    uint64_t at;
    memcpy(&at, bytes + 8, sizeof at);
    return at;
}

/// A GSD file is whole after each frame, and has the same bytes after a run that was killed and
/// continued. Its index is written anew where the number of frames has doubled, not with each.
static void test_gsd_is_whole_after_each_frame_and_its_index_is_seldom_written(void **state) {
    enum { FRAMES = 70, KEPT = 20 };
    struct temporary_folder *folder = *state;
    struct particles particles;
    struct snapshot snapshot;
    const char *const path = temporary_folder_file(folder, "trajectory.gsd");
    make_in(&particles, 3);
    assert_ok(mf_snapshot_take(&snapshot, &particles, &mixture, NULL, 0, 0.5));
    const int64_t kept = write_gsd(&snapshot, folder->path, path, 0, 0, KEPT);
    int64_t size = write_gsd(&snapshot, folder->path, path, KEPT, kept, KEPT + 1);
    char *before = temporary_folder_read(path);
    size = write_gsd(&snapshot, folder->path, path, KEPT + 1, size, KEPT + 2);
    char *after = temporary_folder_read(path);
    assert_int_equal(find_index(before), find_index(after));
    free(before);
    free(after);
    size = write_gsd(&snapshot, folder->path, path, KEPT + 2, size, FRAMES);
    char *whole = temporary_folder_read(path);
    write_gsd(&snapshot, folder->path, path, KEPT, kept, KEPT + 1);
    assert_int_equal(write_gsd(&snapshot, folder->path, path, KEPT, kept, FRAMES), size);
    char *again = temporary_folder_read(path);
    assert_memory_equal(whole, again, (size_t)size);
    free(whole);
    free(again);
    mf_snapshot_clear(&snapshot);
    mf_particles_clear(&particles);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_extxyz_has_a_line_for_each_particle_by_id,
                                        temporary_folder_create, temporary_folder_remove),
        cmocka_unit_test_setup_teardown(test_json_has_all_digits_of_each_column,
                                        temporary_folder_create, temporary_folder_remove),
        cmocka_unit_test_setup_teardown(test_vtp_holds_the_bits_of_vectors_with_three_components,
                                        temporary_folder_create, temporary_folder_remove),
        cmocka_unit_test_setup_teardown(test_extxyz_is_continued_behind_the_bytes_that_count,
                                        temporary_folder_create, temporary_folder_remove),
        cmocka_unit_test_setup_teardown(
            test_gsd_is_whole_after_each_frame_and_its_index_is_seldom_written,
            temporary_folder_create, temporary_folder_remove),
        cmocka_unit_test_setup_teardown(test_lammps_dump_is_read_back, temporary_folder_create,
                                        temporary_folder_remove),
        cmocka_unit_test_setup_teardown(test_companions_follow_as_a_type_of_their_own,
                                        temporary_folder_create, temporary_folder_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
