// SPDX-License-Identifier: GPL-3.0-or-later
//
// Files of Amber's conventions written out byte by byte as Unidata's specification of NetCDF-3
// says, classic, with 64-bit offsets and with 64-bit data: variables of no use between those that
// are read, scale factors, a restart without records; what is refused.
#include "shared/temporary_folder.h"
#include "shared/testing.h"
#include "trajectory/trajectory.h"

#include <math.h>
#include <stdio.h>

enum { MAX = 1 << 14, ATOMS = 3, FRAMES = 2, FLOAT = 5, DOUBLE = 6, SHORT = 3, INTEGER = 4 };

static unsigned char file_bytes[MAX];
static size_t file_size;
static int version;

static void put(const void *bytes, size_t size) {
    assert_true(file_size + size <= MAX);
    for (size_t k = 0; k < size; k++) // the most significant first; this machine is the other way
        file_bytes[file_size++] = ((const unsigned char *)bytes)[size - 1 - k];
}

static void put_word(uint32_t value) {
    put(&value, 4);
}

/// Numbers that 64-bit data makes longer.
static void put_count(uint64_t value) {
    if (version == 5)
        put(&value, 8);
    else
        put_word((uint32_t)value);
}

static void put_float(double value) {
    put(&(float){(float)value}, 4);
}

static void put_text(const char *text) {
    put_count(strlen(text));
    for (size_t k = 0; k < strlen(text) || k % 4 != 0; k++)
        file_bytes[file_size++] = k < strlen(text) ? (unsigned char)text[k] : 0;
}

enum { FRAME, ATOM, SPATIAL, CELL, ODD, NONE };
static const uint64_t sizes[] = {0, ATOMS, 3, 3, 5};

struct variable {
    const char *name, *unit;
    double scale;
    int dimension[3], type;
    uint64_t bytes; ///< of one frame, filled up
};

static void put_variable(const struct variable *variable, uint64_t begin) {
    int rank = 0;
    while (rank < 3 && variable->dimension[rank] != NONE)
        rank++;
    put_text(variable->name);
    put_count((uint64_t)rank);
    for (int k = 0; k < rank; k++)
        put_count((uint64_t)variable->dimension[k]);
    const int attributes = (variable->unit != NULL) + (variable->scale != 0);
    put_word(attributes ? 12 : 0);
    put_count((uint64_t)attributes);
    if (variable->unit) {
        put_text("units");
        put_word(2);
        put_text(variable->unit);
    }
    if (variable->scale != 0) {
        put_text("scale_factor");
        put_word(FLOAT);
        put_count(1);
        put_float(variable->scale);
    }
    put_word((uint32_t)variable->type);
    put_count(variable->bytes);
    if (version == 1)
        put_word((uint32_t)begin);
    else
        put(&begin, 8);
}

/// All but the numbers; where the first variable has its own is found by a first pass.
static void put_head(const struct variable *all, int count, uint32_t records) {
    uint64_t begin = 0;
    for (int pass = 0; pass < 2; pass++) {
        file_size = 0;
        file_bytes[file_size++] = 'C', file_bytes[file_size++] = 'D', file_bytes[file_size++] = 'F';
        file_bytes[file_size++] = (unsigned char)version;
        put_count(records);
        put_word(10), put_count(5);
        static const char *const names[] = {"frame", "atom", "spatial", "cell_spatial", "odd"};
        for (int k = 0; k < 5; k++)
            put_text(names[k]), put_count(sizes[k]);
        put_word(12), put_count(1);
        put_text("Conventions"), put_word(2), put_text("AMBER");
        put_word(11), put_count((uint64_t)count);
        uint64_t at = begin;
        for (int k = 0; k < count; at += all[k++].bytes)
            put_variable(&all[k], at);
        begin = file_size;
    }
}

static double coordinate(int frame, int atom, int d) {
    return 100 * frame + 10 * atom + d + 0.25;
}

static const struct variable trajectory_variables[] = {
    {"time", "picosecond", 0, {FRAME, NONE}, FLOAT, 4},
    {"odd", NULL, 0, {FRAME, ODD, NONE}, SHORT, 12}, // 10 bytes and 2 that fill up
    {"coordinates", "angstrom", 0, {FRAME, ATOM, SPATIAL}, FLOAT, 36},
    {"velocities", "angstrom/picosecond", 2, {FRAME, ATOM, SPATIAL}, FLOAT, 36},
    {"cell_lengths", "angstrom", 0, {FRAME, CELL, NONE}, DOUBLE, 24},
    {"cell_angles", "degree", 0, {FRAME, CELL, NONE}, DOUBLE, 24},
};

static void put_frame(int frame) {
    put_float(0.5 * frame + 1);
    put_word(0xDEADBEEF), put_word(0xDEADBEEF), put_word(0xDEADBEEF);
    for (int part = 0; part < 2; part++)
        for (int k = 0; k < ATOMS; k++)
            for (int d = 0; d < 3; d++)
                put_float((part ? -1 : 1) * coordinate(frame, k, d));
    for (int k = 0; k < 6; k++)
        put(&(double){k < 3 ? 20 + 10 * k + frame : k == 5 ? 120 : 90}, 8);
}

static void write_trajectory(int file_version, uint32_t records) {
    version = file_version;
    put_head(trajectory_variables, 6, records);
    for (int frame = 0; frame < FRAMES; frame++)
        put_frame(frame);
}

static struct trajectory trajectory;
static struct trajectory_frame frame;

static enum status try(void **state) {
    static char file[1024];
    snprintf(file, sizeof file, "%s",
             temporary_folder_write(*state, "a.bin", (const char *)file_bytes, file_size));
    return mf_trajectory_open(&trajectory, file, &(struct trajectory_options){0});
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

static bool is(double value, double wanted) {
    return fabs(value - wanted) < 1e-6 * (1 + fabs(wanted));
}

static void test_netcdf_is_read_in_its_three_versions(void **state) {
    static const int versions[] = {1, 2, 5};
    for (int n = 0; n < 6; n++) {
        write_trajectory(versions[n / 2], n % 2 && versions[n / 2] < 5 ? UINT32_MAX : FRAMES);
        assert_ok(try(state));
        assert_string_equal(trajectory.format->name, "netcdf");
        for (int number = 0; number < FRAMES; number++) {
            next(true);
            for (int k = 0; k < ATOMS; k++)
                for (int d = 0; d < 3; d++) {
                    assert_true(is(frame.position[k][d], 0.1 * coordinate(number, k, d)));
                    assert_true(is(frame.velocity[k][d], -0.2 * coordinate(number, k, d)));
                }
            const double b = 3 + 0.1 * number;
            assert_true(is(frame.time, 1 + 0.5 * number));
            assert_true(is(frame.box[0][0], 2 + 0.1 * number) && is(frame.box[1][0], -0.5 * b));
            assert_true(is(frame.box[1][1], sqrt(0.75) * b) && is(frame.box[2][2], b + 1));
        }
        next(false);
        close_all();
    }
}

static void test_netcdf_restart_is_one_frame(void **state) {
    static const struct variable restart[] = {
        {"time", "femtosecond", 0, {NONE}, DOUBLE, 8},
        {"coordinates", NULL, 0, {ATOM, SPATIAL, NONE}, DOUBLE, 72},
    };
    version = 2;
    put_head(restart, 2, 0);
    put(&(double){2500}, 8);
    for (int k = 0; k < 9; k++)
        put(&(double){coordinate(0, k / 3, k % 3)}, 8);
    assert_ok(try(state));
    next(true);
    assert_true(is(frame.time, 2.5) && is(frame.position[2][1], 0.1 * coordinate(0, 2, 1)));
    assert_false(frame.has_box || frame.has_velocities);
    next(false);
    close_all();
}

/// A slab has a box of two lengths.
static void test_netcdf_has_a_box_that_is_endless_along_a_length_of_0(void **state) {
    static const struct variable slab[] = {
        {"coordinates", NULL, 0, {FRAME, ATOM, SPATIAL}, FLOAT, 36},
        {"cell_lengths", NULL, 0.5, {FRAME, CELL, NONE}, DOUBLE, 24},
    };
    version = 2;
    put_head(slab, 2, 2);
    for (int number = 0; number < 2; number++) {
        for (int k = 0; k < 9; k++)
            put_float(k);
        for (int k = 0; k < 3; k++)
            put(&(double){number == 0 && k < 2 ? 40 + k : 0}, 8);
    }
    assert_ok(try(state));
    next(true);
    assert_true(frame.periodic[0] && frame.periodic[1] && !frame.periodic[2]);
    assert_true(is(frame.box[0][0], 2) && is(frame.box[1][1], 2.05));
    next(true);
    assert_false(frame.has_box);
    close_all();
}

/// Ids of LAMMPS, 1 2 3, then 1 3 2.
static void test_netcdf_is_refused_when_atoms_change_places(void **state) {
    static const struct variable dump[] = {
        {"id", NULL, 0, {FRAME, ATOM, NONE}, INTEGER, 12},
        {"coordinates", "Angstrom", 0, {FRAME, ATOM, SPATIAL}, FLOAT, 36},
    };
    bool more;
    version = 2;
    put_head(dump, 2, 2);
    for (int number = 0; number < 2; number++) {
        put_word(1), put_word(number ? 3 : 2), put_word(number ? 2 : 3);
        for (int k = 0; k < 9; k++)
            put_float(k);
    }
    assert_ok(try(state));
    next(true);
    assert_fails(mf_trajectory_next(&trajectory, &frame, &more), STATUS_BAD_INPUT,
                 "frame 1: atoms are not in the order of their ids");
    close_all();
}

static void test_netcdf_is_refused_when_it_ends_early_or_is_of_others(void **state) {
    bool more;
    write_trajectory(2, FRAMES + 1);
    assert_ok(try(state));
    next(true), next(true);
    assert_fails(mf_trajectory_next(&trajectory, &frame, &more), STATUS_BAD_INPUT, "frame 2, byte");
    close_all();
    write_trajectory(2, 0);
    assert_fails(try(state), STATUS_BAD_INPUT, "the file has no frame");
    static const struct variable other[] = {{"x", NULL, 0, {FRAME, ATOM, NONE}, FLOAT, 12}};
    put_head(other, 1, 1);
    assert_fails(try(state), STATUS_BAD_INPUT, "NetCDF, but not of Amber's conventions");
    static const struct variable lj[] = {
        {"coordinates", "lj", 0, {FRAME, ATOM, SPATIAL}, FLOAT, 36}};
    put_head(lj, 1, 1);
    assert_fails(try(state), STATUS_BAD_INPUT, "\"coordinates\" is in \"lj\"");
    write_trajectory(2, FRAMES);
    file_size = 100;
    assert_fails(try(state), STATUS_BAD_INPUT, "the file ends");
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_netcdf_is_read_in_its_three_versions),
        TEST(test_netcdf_restart_is_one_frame),
        TEST(test_netcdf_has_a_box_that_is_endless_along_a_length_of_0),
        TEST(test_netcdf_is_refused_when_atoms_change_places),
        TEST(test_netcdf_is_refused_when_it_ends_early_or_is_of_others),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
