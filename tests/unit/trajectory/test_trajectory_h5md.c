// SPDX-License-Identifier: GPL-3.0-or-later
//
// H5MD files as the HDF5 library writes them here, by the words of the specification (version 1.1):
// elements that change in time or do not, numbers of either precision, boxes of lengths and
// vectors, units, species, ids; several groups; files that are damaged, cut, or of other shapes.
#include "shared/is_close.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"
#include "trajectory/h5md_file.h"
#include "trajectory/trajectory.h"

#include <hdf5.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { ATOMS = 3, FRAMES = 4 };

static const hsize_t vectors[] = {FRAMES, ATOMS, 3}, scalars[] = {FRAMES, ATOMS};

static char path[1024];
static hid_t file;

// A writer ----------------------------------------------------------------------------------------

static hid_t make_group(hid_t place, const char *name) {
    return H5Gcreate(place, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
}

/// Texts of units take so many bytes at least: others write all of them as long as the longest.
static size_t min_text;

static void write_text(hid_t object, const char *name, const char *text) {
    const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
    char capacity[1024] = "";
    snprintf(capacity, sizeof capacity, "%s", text);
    H5Tset_size(type, strlen(text) < min_text ? min_text : strlen(text) + 1);
    H5Tset_cset(type, min_text > 0 ? H5T_CSET_UTF8 : H5T_CSET_ASCII);
    const hid_t attribute = H5Acreate(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(H5Awrite(attribute, type, capacity) >= 0);
    H5Aclose(attribute);
    H5Sclose(space);
    H5Tclose(type);
}

/// A dataset of `rank` dimensions, in chunks of two frames, packed, if `stored` is of single
/// precision.
static void put(hid_t place, const char *name, hid_t stored, hid_t type, int rank,
                const hsize_t *size, const void *numbers, const char *unit) {
    const hid_t space = rank > 0 ? H5Screate_simple(rank, size, NULL) : H5Screate(H5S_SCALAR);
    const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
    if (H5Tequal(stored, H5T_IEEE_F32LE) > 0 && rank == 3) {
        H5Pset_chunk(how, 3, (const hsize_t[]){2, size[1], size[2]});
        H5Pset_deflate(how, 6);
    }
    const hid_t dataset = H5Dcreate(place, name, stored, space, H5P_DEFAULT, how, H5P_DEFAULT);
    assert_true(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers) >= 0);
    if (unit)
        write_text(dataset, "unit", unit);
    H5Dclose(dataset);
    H5Pclose(how);
    H5Sclose(space);
}

/// A group with values, steps 10, 20, … and times 0.5, 1, ….
static void write_element(hid_t place, const char *name, hid_t stored, hid_t type, int rank,
                          const hsize_t *size, const void *values, const char *unit) {
    int step[FRAMES];
    double time[FRAMES];
    const hid_t group = make_group(place, name);
    for (int k = 0; k < FRAMES; k++) {
        step[k] = 10 * (k + 1);
        time[k] = 0.5 * (k + 1);
    }
    put(group, "value", stored, type, rank, size, values, unit);
    put(group, "step", H5T_STD_I32LE, H5T_NATIVE_INT, 1, size, step, NULL);
    put(group, "time", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 1, size, time, unit ? "ps" : NULL);
    H5Gclose(group);
}

static void begin_file(void **state) {
    snprintf(path, sizeof path, "%s/a.h5", ((struct temporary_folder *)*state)->path);
    file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(file >= 0);
    H5Gclose(make_group(file, "particles"));
}

static double coordinate(int frame, int atom, int d) {
    return 100 * frame + 10 * atom + d + 0.25;
}

/// Positions of all frames, or of the first.
static void write_positions(hid_t group, hid_t stored, bool timed, const char *unit) {
    double numbers[FRAMES][ATOMS][3];
    for (int t = 0; t < FRAMES; t++)
        for (int k = 0; k < 3 * ATOMS; k++)
            numbers[t][k / 3][k % 3] = coordinate(t, k / 3, k % 3);
    if (timed)
        write_element(group, "position", stored, H5T_NATIVE_DOUBLE, 3, vectors, numbers, unit);
    else
        put(group, "position", stored, H5T_NATIVE_DOUBLE, 2, vectors + 1, numbers, unit);
}

static hid_t begin_group(const char *name) {
    const hid_t particles = H5Gopen(file, "particles", H5P_DEFAULT),
                group = make_group(particles, name);
    H5Gclose(particles);
    return group;
}

static void write_boundary(hid_t box, const char *text) {
    const hsize_t size = 3;
    const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate_simple(1, &size, NULL);
    char texts[3][9] = {"periodic", "periodic", "periodic"};
    snprintf(texts[2], 9, "%s", text);
    H5Tset_size(type, 9);
    const hid_t attribute = H5Acreate(box, "boundary", type, space, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(H5Awrite(attribute, type, texts) >= 0);
    H5Aclose(attribute);
    H5Sclose(space);
    H5Tclose(type);
}

/// A cube of fixed edges.
static void write_cube(hid_t group, double edge) {
    const double edges[3] = {edge, edge, edge};
    const hid_t box = make_group(group, "box");
    write_boundary(box, "periodic");
    put(box, "edges", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 1, (const hsize_t[]){3}, edges, NULL);
    H5Gclose(box);
}

static void end_file(void) {
    H5Fclose(file);
}

// The reader --------------------------------------------------------------------------------------

static struct trajectory trajectory;
static struct trajectory_frame frame;

static enum status try(const struct trajectory_options *options) {
    return mf_trajectory_open(&trajectory, path, options);
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

static void assert_positions(int t, double factor) {
    for (int k = 0; k < 3 * ATOMS; k++)
        assert_close(frame.position[k / 3][k % 3], factor * coordinate(t, k / 3, k % 3), 1e-12);
}

static const struct trajectory_options nothing = {0};

/// The shortest: what is not there is not known, and what is assumed is said.
static void test_h5md_is_in_nm_and_ps_when_it_does_not_say(void **state) {
    begin_file(state);
    const hid_t group = begin_group("all");
    write_positions(group, H5T_IEEE_F64LE, true, NULL);
    write_cube(group, 400);
    H5Gclose(group);
    end_file();
    assert_ok(try(&nothing));
    assert_string_equal(trajectory.format->name, "h5md");
    assert_contains(trajectory.note, "nm, ps and u are assumed");
    assert_int_equal(trajectory.structure.atoms, ATOMS);
    for (int t = 0; t < FRAMES; t++) {
        next(true);
        assert_int_equal(frame.step, 10 * (t + 1));
        assert_close(frame.time, 0.5 * (t + 1), 0);
        assert_positions(t, 1);
        assert_false(frame.has_velocities);
        assert_true(frame.has_box && frame.periodic[2]);
        assert_close(frame.box[1][1], 400, 0);
        assert_close(frame.box[1][0], 0, 0);
    }
    next(false);
    close_all();
    assert_ok(try(&(struct trajectory_options){.units = "real"})); // Å and fs
    assert_string_equal(trajectory.note, "");
    next(true);
    assert_positions(0, 0.1);
    assert_close(frame.time, 0.5e-3, 1e-15);
    assert_close(frame.box[0][0], 40, 1e-12);
    close_all();
}

/// Texts of h5py's "S256" are as long, whatever they say.
static void test_h5md_unit_is_read_when_its_text_has_room_to_spare(void **state) {
    begin_file(state);
    const hid_t group = begin_group("all");
    min_text = 256;
    write_positions(group, H5T_IEEE_F64LE, true, "Angstrom");
    min_text = 0;
    write_cube(group, 400);
    H5Gclose(group);
    end_file();
    assert_ok(try(&nothing));
    assert_string_equal(trajectory.note, "");
    next(true);
    assert_positions(0, 0.1);
    assert_close(frame.box[0][0], 40, 1e-12);
    close_all();
}

/// Å and ps, single precision, packed; a tilted box of vectors that changes; velocities of every
/// other step; images; masses, and species with names.
static void test_h5md_gives_all_that_it_has_when_it_speaks_angstrom(void **state) {
    double velocity[2][ATOMS][3], edges[FRAMES][3][3];
    int image[FRAMES][ATOMS][3], step[2] = {10, 30};
    const double mass[ATOMS] = {15.9994, 1.008, 1.008};
    const signed char species[ATOMS] = {8, 1, 1};
    begin_file(state);
    const hid_t group = begin_group("all"), box = make_group(group, "box");
    write_positions(group, H5T_IEEE_F32LE, true, "Angstrom");
    for (int t = 0; t < FRAMES; t++)
        for (int k = 0; k < 9; k++) {
            edges[t][k / 3][k % 3] = (double[]){30, 0, 0, 10, 28, 0, -10, 14, 25}[k] + t;
            image[t][k / 3][k % 3] = k == 4 ? -2 : 0; // of atom 1, along b
            velocity[t / 2][k / 3][k % 3] = -coordinate(t / 2, k / 3, k % 3);
        }
    write_boundary(box, "none");
    write_element(box, "edges", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 3,
                  (const hsize_t[]){FRAMES, 3, 3}, edges, "Angstrom");
    write_element(group, "image", H5T_STD_I32LE, H5T_NATIVE_INT, 3, vectors, image, NULL);
    const hid_t velocities = make_group(group, "velocity");
    put(velocities, "value", H5T_IEEE_F32LE, H5T_NATIVE_DOUBLE, 3, (const hsize_t[]){2, ATOMS, 3},
        velocity, "Angstrom ps-1");
    put(velocities, "step", H5T_STD_I64LE, H5T_NATIVE_INT, 1, (const hsize_t[]){2}, step, NULL);
    put(group, "mass", H5T_IEEE_F32LE, H5T_NATIVE_DOUBLE, 1, (const hsize_t[]){ATOMS}, mass,
        "g mol-1");
    const hid_t elements = H5Tenum_create(H5T_STD_I8LE);
    H5Tenum_insert(elements, "H", (const signed char[]){1});
    H5Tenum_insert(elements, "O", (const signed char[]){8});
    put(group, "species", elements, elements, 1, (const hsize_t[]){ATOMS}, species, NULL);
    H5Tclose(elements);
    H5Gclose(velocities);
    H5Gclose(box);
    H5Gclose(group);
    end_file();
    assert_ok(try(&nothing));
    assert_string_equal(trajectory.note, "");
    assert_close(trajectory.structure.atom[0].mass, 15.9994, 1e-5);
    assert_string_equal(trajectory.structure.atom[0].name, "O");
    assert_string_equal(trajectory.structure.atom[2].name, "H");
    for (int t = 0; t < FRAMES; t++) {
        next(true);
        assert_close(frame.time, 0.5 * (t + 1), 1e-12);
        assert_close(frame.box[2][1], 0.1 * (14 + t), 1e-12);
        assert_true(frame.periodic[0] && frame.periodic[1] && !frame.periodic[2]);
        assert_close(frame.position[2][1], 0.1 * coordinate(t, 2, 1), 1e-6);
        for (int d = 0; d < 3; d++)
            assert_close(frame.position[1][d], 0.1 * coordinate(t, 1, d) - 2 * frame.box[1][d],
                         1e-6);
        assert_true(frame.unwrapped);
        assert_int_equal(frame.has_velocities, t % 2 == 0);
        if (t % 2 == 0)
            assert_close(frame.velocity[1][2], -0.1 * coordinate(t / 2, 1, 2), 1e-6);
    }
    next(false);
    close_all();
}

/// kcal/mol/Å are 41.84 kJ/mol/nm; without a unit it is not known what they are.
static void test_h5md_has_forces_where_they_are_asked_for(void **state) {
    static const struct trajectory_options asked = {.forces = true};
    static const char *const unit[] = {"kcal mol-1 Angstrom-1", "kJ mol-1 nm-1", NULL, "nm"};
    static const double factor[] = {41.84, 1};
    for (int k = 0; k < 4; k++) {
        double force[FRAMES][ATOMS][3];
        begin_file(state);
        const hid_t group = begin_group("all");
        write_positions(group, H5T_IEEE_F32LE, true, "nm");
        for (int n = 0; n < FRAMES * ATOMS * 3; n++)
            force[n / 3 / ATOMS][n / 3 % ATOMS][n % 3] = n;
        write_element(group, "force", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 3, vectors, force,
                      unit[k]);
        H5Gclose(group);
        end_file();
        if (k >= 2) {
            assert_int_equal(try(&asked), STATUS_BAD_INPUT);
            assert_contains(mf_status_message(),
                            k == 2 ? "\"force\" has no unit: its values want the attribute"
                                   : "the unit \"nm\" is not that of a force");
            continue;
        }
        assert_ok(try(&asked));
        next(true);
        assert_true(frame.has_forces);
        assert_close(frame.force[1][2], 5 * factor[k], 1e-9);
        close_all();
    }
}

static void test_h5md_has_no_times_when_its_positions_are_fixed(void **state) {
    begin_file(state);
    const hid_t group = begin_group("all");
    write_positions(group, H5T_IEEE_F32LE, false, "nm");
    H5Gclose(group);
    end_file();
    assert_ok(try(&nothing));
    next(true);
    assert_positions(0, 1);
    assert_false(frame.unwrapped);
    assert_true(isnan(frame.time));
    assert_false(frame.has_box);
    next(false);
    close_all();
}

/// Ids in another order in each frame; steps and times that are equally spaced.
static void test_h5md_atoms_are_sorted_when_it_has_ids(void **state) {
    double numbers[FRAMES][ATOMS][3];
    int id[FRAMES][ATOMS];
    const int every = 5, first = 100;
    const double spacing = 0.25, begin = 7;
    begin_file(state);
    const hid_t group = begin_group("all"), position = make_group(group, "position");
    for (int t = 0; t < FRAMES; t++)
        for (int k = 0; k < ATOMS; k++) {
            const int atom = (k + t + 1) % ATOMS;
            id[t][k] = 7 + atom;
            for (int d = 0; d < 3; d++)
                numbers[t][k][d] = coordinate(t, atom, d);
        }
    put(position, "value", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 3, vectors, numbers, "nm");
    put(position, "step", H5T_STD_I32LE, H5T_NATIVE_INT, 0, NULL, &every, NULL);
    put(position, "time", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 0, NULL, &spacing, "ns");
    const hid_t steps = H5Dopen(position, "step", H5P_DEFAULT),
                times = H5Dopen(position, "time", H5P_DEFAULT), space = H5Screate(H5S_SCALAR);
    const hid_t step_offset =
                    H5Acreate(steps, "offset", H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT),
                time_offset =
                    H5Acreate(times, "offset", H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(step_offset, H5T_NATIVE_INT, &first);
    H5Awrite(time_offset, H5T_NATIVE_DOUBLE, &begin);
    const hid_t ids = make_group(group, "id");
    put(ids, "value", H5T_STD_I32LE, H5T_NATIVE_INT, 2, scalars, id, NULL);
    H5Lcreate_hard(position, "step", ids, "step", H5P_DEFAULT, H5P_DEFAULT);
    H5Aclose(step_offset);
    H5Aclose(time_offset);
    H5Sclose(space);
    H5Dclose(steps);
    H5Dclose(times);
    H5Gclose(ids);
    H5Gclose(position);
    H5Gclose(group);
    end_file();
    assert_ok(try(&nothing));
    assert_int_equal(trajectory.structure.atom[1].id, 8);
    for (int t = 0; t < FRAMES; t++) {
        next(true);
        assert_int_equal(frame.step, 100 + 5 * t);
        assert_close(frame.time, 1e3 * (7 + 0.25 * t), 1e-9);
        assert_positions(t, 1);
    }
    close_all();
}

/// Species may be written for each frame; two particles swap theirs in the last.
static void test_h5md_is_refused_when_particles_change_their_species(void **state) {
    int species[FRAMES][ATOMS];
    bool more;
    for (int t = 0; t < FRAMES; t++)
        for (int k = 0; k < ATOMS; k++)
            species[t][k] = k == (t < FRAMES - 1 ? 0 : 1) ? 8 : 1;
    begin_file(state);
    const hid_t group = begin_group("all");
    write_positions(group, H5T_IEEE_F64LE, true, "nm");
    write_element(group, "species", H5T_STD_I32LE, H5T_NATIVE_INT, 2, scalars, species, NULL);
    H5Gclose(group);
    end_file();
    assert_ok(try(&nothing));
    for (int t = 0; t < FRAMES - 1; t++)
        next(true);
    assert_fails(mf_trajectory_next(&trajectory, &frame, &more), STATUS_BAD_INPUT,
                 "particle 1 is of species 1, in the first frame of 8");
    close_all();
}

/// Without ids a frame's particles may stand in any order.
static void test_h5md_is_refused_when_some_frames_have_no_ids(void **state) {
    const int id[1][ATOMS] = {{9, 7, 8}}, first = 10;
    begin_file(state);
    const hid_t group = begin_group("all"), ids = make_group(group, "id");
    write_positions(group, H5T_IEEE_F64LE, true, "nm");
    put(ids, "value", H5T_STD_I32LE, H5T_NATIVE_INT, 2, (const hsize_t[]){1, ATOMS}, id, NULL);
    put(ids, "step", H5T_STD_I32LE, H5T_NATIVE_INT, 1, (const hsize_t[]){1}, &first, NULL);
    H5Gclose(ids);
    H5Gclose(group);
    end_file();
    assert_ok(try(&nothing));
    next(true);
    assert_close(frame.position[2][0], coordinate(0, 0, 0), 0);
    bool more;
    const enum status status = mf_trajectory_next(&trajectory, &frame, &more);
    assert_int_equal(status, STATUS_BAD_INPUT);
    assert_contains(mf_status_message(), "frame 1: \"id\" has no frame of the positions' step, 20");
    close_all();
}

static void test_h5md_names_its_groups_when_there_are_several(void **state) {
    begin_file(state);
    const hid_t one = begin_group("solvent"), two = begin_group("polymer"),
                none = begin_group("no");
    write_positions(one, H5T_IEEE_F64LE, true, "nm");
    write_positions(two, H5T_IEEE_F64LE, true, "pm");
    H5Gclose(one);
    H5Gclose(two);
    H5Gclose(none);
    end_file();
    assert_fails(
        try(&nothing), STATUS_BAD_INPUT,
        "several groups of particles, \"polymer\", \"solvent\": choose one by --file-group");
    assert_fails(try(&(struct trajectory_options){.group = "no"}), STATUS_BAD_INPUT,
                 "no group of particles with positions is called \"no\"");
    assert_ok(try(&(struct trajectory_options){.group = "polymer"}));
    next(true);
    assert_positions(0, 1e-3);
    close_all();
}

// What is wrong -----------------------------------------------------------------------------------

/// A file whose positions are `frames` of `atoms` times `numbers`.
static void write_shape(void **state, int rank, hsize_t frames, hsize_t atoms, hsize_t numbers) {
    static const double zeros[4096];
    const hsize_t size[] = {frames, atoms, numbers};
    begin_file(state);
    const hid_t group = begin_group("all"), position = make_group(group, "position");
    put(position, "value", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, rank, size, zeros, NULL);
    H5Gclose(position);
    H5Gclose(group);
    end_file();
}

/// Add to the group "all" of the file a dataset of zeros.
static void add_zeros(const char *name, int rank, const hsize_t *size) {
    static const double zeros[4096];
    file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
    const hid_t group = H5Gopen(file, "/particles/all", H5P_DEFAULT);
    put(group, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, rank, size, zeros, NULL);
    H5Gclose(group);
    end_file();
}

static void test_h5md_is_refused_when_shapes_do_not_fit(void **state) {
    write_shape(state, 3, FRAMES, ATOMS, 2);
    assert_fails(try(&nothing), STATUS_BAD_INPUT,
                 "a.h5: \"position\" has frames of 3 times 2 numbers; it should have 3 of each");
    write_shape(state, 1, 12, 0, 0);
    assert_fails(try(&nothing), STATUS_BAD_INPUT, "\"position\" has frames of 1 times 1 numbers");
    write_shape(state, 3, 0, ATOMS, 3);
    assert_fails(try(&nothing), STATUS_BAD_INPUT, "the file has no frame");
    write_shape(state, 3, FRAMES, ATOMS, 3);
    add_zeros("mass", 1, (const hsize_t[]){ATOMS + 1});
    assert_fails(try(&nothing), STATUS_BAD_INPUT,
                 "\"mass\" has 1 frames of 4 times 1 numbers; \"position\" has 3 particles");
}

static void test_h5md_is_refused_when_its_box_or_steps_do_not_fit(void **state) {
    const double edges[4] = {1, 1, 1, 1};
    begin_file(state);
    hid_t group = begin_group("all"), box = make_group(group, "box");
    write_positions(group, H5T_IEEE_F64LE, true, "nm");
    put(box, "edges", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 1, (const hsize_t[]){2}, edges, NULL);
    H5Gclose(box);
    H5Gclose(group);
    end_file();
    assert_fails(try(&nothing), STATUS_BAD_INPUT, "expected 3 lengths or 3 vectors");
    begin_file(state);
    group = begin_group("all");
    write_positions(group, H5T_IEEE_F64LE, true, "nm");
    const hid_t position = H5Gopen(group, "position", H5P_DEFAULT);
    H5Ldelete(position, "step", H5P_DEFAULT);
    put(position, "step", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 1, (const hsize_t[]){2}, edges, NULL);
    H5Gclose(position);
    H5Gclose(group);
    end_file();
    assert_fails(try(&nothing), STATUS_BAD_INPUT, "not have one step and one time for each");
    begin_file(state);
    group = begin_group("all");
    write_positions(group, H5T_IEEE_F64LE, true, "kg");
    H5Gclose(group);
    end_file();
    assert_fails(try(&nothing), STATUS_BAD_INPUT,
                 "\"position\": the unit \"kg\" is not that of a length");
}

/// 2^50 particles that no file has: the numbers are not asked for.
static void test_h5md_is_refused_when_it_promises_more_than_it_holds(void **state) {
    const hsize_t size[] = {1, (hsize_t)1 << 50, 3}, chunk[] = {1, 1024, 3};
    begin_file(state);
    const hid_t group = begin_group("all"), position = make_group(group, "position"),
                space = H5Screate_simple(3, size, NULL), how = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(how, 3, chunk);
    H5Dclose(H5Dcreate(position, "value", H5T_IEEE_F32LE, space, H5P_DEFAULT, how, H5P_DEFAULT));
    H5Pclose(how);
    H5Sclose(space);
    H5Gclose(position);
    H5Gclose(group);
    end_file();
    assert_fails(try(&nothing), STATUS_BAD_INPUT, "more numbers in a frame than fit into the file");
}

/// Cut at many places: always a line, never a crash; and a packed frame that is damaged.
static void test_h5md_is_refused_when_it_is_cut_or_damaged(void **state) {
    struct stat is;
    begin_file(state);
    hid_t group = begin_group("all");
    write_positions(group, H5T_IEEE_F32LE, true, "nm");
    H5Gclose(group);
    end_file();
    assert_int_equal(stat(path, &is), 0);
    const off_t whole = is.st_size;
    char *bytes = malloc((size_t)whole);
    FILE *stream = fopen(path, "rb");
    assert_int_equal(fread(bytes, 1, (size_t)whole, stream), (size_t)whole);
    fclose(stream);
    for (off_t cut = whole - 1; cut > 8; cut -= 97) {
        assert_int_equal(truncate(path, cut), 0);
        assert_fails(try(&nothing), STATUS_BAD_INPUT, "HDF5 cannot open it; it may be truncated");
    }
    // The packed bytes begin with those of zlib; the frame after the first two is broken.
    char *place = bytes;
    for (int found = 0; found < 2; place++)
        found += memcmp(place, "\x78\x5E", 2) == 0 || memcmp(place, "\x78\x9C", 2) == 0;
    memset(place + 2, 0, 8);
    stream = fopen(path, "wb");
    fwrite(bytes, 1, (size_t)whole, stream);
    fclose(stream);
    free(bytes);
    bool more;
    assert_ok(try(&nothing));
    next(true);
    next(true);
    assert_positions(1, 1);
    assert_fails(mf_trajectory_next(&trajectory, &frame, &more), STATUS_BAD_INPUT,
                 "a.h5: frame 2: \"position\" cannot be read: ");
    close_all();
}

/// The numbers of a compact dataset stand in its header, behind their size in bytes, which is set
/// to 0: HDF5 1.10 would read them from nowhere.
static void test_h5md_is_refused_when_less_is_stored_than_its_size(void **state) {
    static const int id[ATOMS] = {1, 2, 3};
    static const hsize_t size[] = {ATOMS};
    static const char layout[] = {3, H5D_COMPACT, sizeof id, 0};
    char bytes[65536];
    begin_file(state);
    const hid_t group = begin_group("all"), space = H5Screate_simple(1, size, NULL),
                how = H5Pcreate(H5P_DATASET_CREATE);
    write_positions(group, H5T_IEEE_F64LE, true, "nm");
    H5Pset_layout(how, H5D_COMPACT);
    const hid_t ids = H5Dcreate(group, "id", H5T_NATIVE_INT, space, H5P_DEFAULT, how, H5P_DEFAULT);
    H5Dwrite(ids, H5T_NATIVE_INT, H5S_ALL, H5S_ALL, H5P_DEFAULT, id);
    H5Dclose(ids);
    H5Pclose(how);
    H5Sclose(space);
    H5Gclose(group);
    end_file();
    assert_ok(try(&nothing));
    close_all();
    FILE *stream = fopen(path, "r+b");
    const size_t whole = fread(bytes, 1, sizeof bytes, stream);
    size_t at = 0;
    while (at < whole && memcmp(bytes + at, layout, sizeof layout) != 0)
        at++;
    assert_in_range(at, 1, whole - sizeof layout);
    fseek(stream, (long)at + 2, SEEK_SET);
    fputc(0, stream);
    fclose(stream);
    assert_fails(try(&nothing), STATUS_BAD_INPUT,
                 "a.h5: HDF5 crashes where it reads it: it is damaged");
}

static void link_elsewhere(hid_t place, const char *name, const char *to) {
    assert_true(H5Lcreate_external("other.h5", to, place, name, H5P_DEFAULT, H5P_DEFAULT) >= 0);
}

static void assert_elsewhere(const char *words) {
    end_file();
    assert_int_equal(try(&nothing), STATUS_BAD_INPUT);
    assert_contains(mf_status_message(), words);
    close_all();
}

/// A whole file, some of which is read from "a.h5" by links.
static void make_other(void **state) {
    char other[1100];
    begin_file(state);
    const hid_t group = begin_group("all");
    write_positions(group, H5T_IEEE_F64LE, true, NULL);
    write_cube(group, 400);
    H5Gclose(group);
    end_file();
    snprintf(other, sizeof other, "%s/other.h5", ((struct temporary_folder *)*state)->path);
    assert_int_equal(rename(path, other), 0);
}

static void test_h5md_is_refused_when_links_lead_into_other_files(void **state) {
    make_other(state);
    begin_file(state);
    hid_t group = begin_group("all");
    link_elsewhere(group, "position", "/particles/all/position");
    H5Gclose(group);
    assert_elsewhere("\"position\" is neither a group nor a dataset of this file");
    begin_file(state);
    group = begin_group("all");
    link_elsewhere(file, "away", "/particles/all/position/value");
    const hid_t position = make_group(group, "position");
    assert_true(H5Lcreate_soft("/away", position, "value", H5P_DEFAULT, H5P_DEFAULT) >= 0);
    H5Gclose(position);
    H5Gclose(group);
    assert_elsewhere("\"position\" is a group without a dataset \"value\" of this file");
    begin_file(state);
    group = begin_group("all");
    write_positions(group, H5T_IEEE_F64LE, true, NULL);
    link_elsewhere(group, "box", "/particles/all/box");
    H5Gclose(group);
    assert_elsewhere("\"box\" is not a group of this file");
    begin_file(state);
    group = H5Gopen(file, "particles", H5P_DEFAULT);
    link_elsewhere(group, "all", "/particles/all");
    H5Gclose(group);
    assert_elsewhere("no group of \"particles\" in this file has positions");
}

/// Numbers in a pipe, which would wait for a writer, and in the dataset of another file.
static void test_h5md_is_refused_when_its_numbers_are_elsewhere(void **state) {
    char pipe[1100];
    make_other(state);
    snprintf(pipe, sizeof pipe, "%s/pipe", ((struct temporary_folder *)*state)->path);
    assert_int_equal(mkfifo(pipe, 0600), 0);
    for (int virtual = 0; virtual <= 1; virtual ++) {
        begin_file(state);
        const hid_t group = begin_group("all"), position = make_group(group, "position");
        const hid_t space = H5Screate_simple(3, vectors, NULL), how = H5Pcreate(H5P_DATASET_CREATE);
        if (virtual)
            H5Pset_virtual(how, space, "other.h5", "/particles/all/position/value", space);
        else
            H5Pset_external(how, pipe, 0, H5F_UNLIMITED);
        H5Dclose(
            H5Dcreate(position, "value", H5T_IEEE_F64LE, space, H5P_DEFAULT, how, H5P_DEFAULT));
        H5Pclose(how);
        H5Sclose(space);
        H5Gclose(position);
        H5Gclose(group);
        assert_elsewhere("\"position\" has its numbers in other files");
    }
}

static void test_h5md_is_told_apart_when_it_is_other_hdf5(void **state) {
    snprintf(path, sizeof path, "%s/a.h5", ((struct temporary_folder *)*state)->path);
    H5Fclose(H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
    assert_fails(try(&nothing), STATUS_BAD_INPUT, "HDF5, but not H5MD");
    begin_file(state);
    end_file();
    assert_fails(try(&nothing), STATUS_BAD_INPUT,
                 "no group of \"particles\" in this file has positions");
}

static void test_h5md_units_are_products_when_written_as_such(void **state) {
    (void)state;
    static const struct {
        const char *unit;
        enum h5md_kind kind;
        double factor;
    } known[] = {{"nm", H5MD_LENGTH, 1},
                 {"Angstrom fs-1", H5MD_SPEED, 100},
                 {"m s-1", H5MD_SPEED, 1e-3},
                 {"nm+1 ps-1", H5MD_SPEED, 1},
                 {"kg", H5MD_MASS, 6.02214076208e26},
                 {"g mol-1", H5MD_MASS, 1},
                 {"us", H5MD_TIME, 1e6}};
    double factor;
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        assert_ok(mf_h5md_unit_find(known[k].unit, known[k].kind, &factor));
        assert_close(factor / known[k].factor, 1, 1e-8);
    }
    assert_ok(mf_h5md_unit_find("AKMA", H5MD_TIME, &factor));
    assert_close(1 / factor, 20.455, 1e-3); // CHARMM's units in a picosecond, by its manual
    assert_fails(mf_h5md_unit_find("furlong", H5MD_LENGTH, &factor), STATUS_BAD_INPUT, "not known");
    assert_fails(mf_h5md_unit_find("nm ps", H5MD_SPEED, &factor), STATUS_BAD_INPUT, "of a speed");
    assert_fails(mf_h5md_unit_find("nm/ps", H5MD_SPEED, &factor), STATUS_BAD_INPUT, "not known");
}

#define TEST(test)                                                                                 \
    cmocka_unit_test_setup_teardown(test, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_h5md_is_in_nm_and_ps_when_it_does_not_say),
        TEST(test_h5md_unit_is_read_when_its_text_has_room_to_spare),
        TEST(test_h5md_gives_all_that_it_has_when_it_speaks_angstrom),
        TEST(test_h5md_has_forces_where_they_are_asked_for),
        TEST(test_h5md_has_no_times_when_its_positions_are_fixed),
        TEST(test_h5md_atoms_are_sorted_when_it_has_ids),
        TEST(test_h5md_is_refused_when_particles_change_their_species),
        TEST(test_h5md_is_refused_when_some_frames_have_no_ids),
        TEST(test_h5md_names_its_groups_when_there_are_several),
        TEST(test_h5md_is_refused_when_shapes_do_not_fit),
        TEST(test_h5md_is_refused_when_its_box_or_steps_do_not_fit),
        TEST(test_h5md_is_refused_when_it_promises_more_than_it_holds),
        TEST(test_h5md_is_refused_when_it_is_cut_or_damaged),
        TEST(test_h5md_is_refused_when_less_is_stored_than_its_size),
        TEST(test_h5md_is_refused_when_links_lead_into_other_files),
        TEST(test_h5md_is_refused_when_its_numbers_are_elsewhere),
        TEST(test_h5md_is_told_apart_when_it_is_other_hdf5),
        TEST(test_h5md_units_are_products_when_written_as_such),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
