// SPDX-License-Identifier: GPL-3.0-or-later
//
// Binary files of kinds that are not among the samples, written out here byte by byte: DCD in both
// orders of bytes, with boxes in degrees and cosines and without; trr in double precision and with
// frames that have no positions; xtc with 64-bit sizes and with few atoms.
#include "shared/temporary_folder.h"
#include "shared/testing.h"
#include "trajectory/trajectory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { MAX = 1 << 16, ATOMS = 3, FRAMES = 2 };

static unsigned char file_bytes[MAX];
static size_t file_size;
static bool big;

static void write_bytes(const void *bytes, size_t size, bool swapped) {
    assert_true(file_size + size <= MAX);
    for (size_t k = 0; k < size; k++)
        file_bytes[file_size++] = ((const unsigned char *)bytes)[swapped ? size - 1 - k : k];
}

/// This machine's order is little-endian, as all that the program is built for.
static void write_int(int32_t value) {
    write_bytes(&value, sizeof value, big);
}

static void write_float(double value) {
    write_bytes(&(float){(float)value}, sizeof(float), big);
}

static void write_double(double value) {
    write_bytes(&value, sizeof value, big);
}

static double coordinate(int frame, int atom, int d) {
    return 100 * frame + 10 * atom + d + 0.25;
}

static struct trajectory trajectory;
static struct trajectory_frame frame;

static enum status try(void **state, const struct trajectory_options *options) {
    static char file[1024];
    snprintf(file, sizeof file, "%s",
             temporary_folder_write(*state, "a.bin", (const char *)file_bytes, file_size));
    return mf_trajectory_open(&trajectory, file, options);
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

static void assert_positions(int number, double scale) {
    for (int k = 0; k < ATOMS; k++)
        for (int d = 0; d < 3; d++)
            assert_true(frame.position[k][d] == scale * coordinate(number, k, d));
}

// DCD ---------------------------------------------------------------------------------------------

enum cell { NO_CELL, DEGREES, COSINES, MATRIX };

/// What the counts around records are, and which title there is.
static int mark_bytes = 4;
static int title_lines = 1, title_told = 1;

static void write_mark(int32_t value) {
    if (mark_bytes == 8)
        write_bytes(&(int64_t){value}, 8, big);
    else
        write_int(value);
}

static const char *title = "";

/// Atoms 1 and 3 move if one is fixed.
static void write_dcd(bool big_endian, enum cell cell, int version, int fixed, bool fourth) {
    file_size = 0;
    big = big_endian;
    const int header[20] = {FRAMES,          500,    50, 0, 0, 0, 0, 0, fixed, 0,
                            cell != NO_CELL, fourth, 0,  0, 0, 0, 0, 0, 0,     version};
    write_mark(84);
    write_bytes("CORD", 4, false);
    for (int k = 0; k < 20; k++) {
        if (k == 9 && version)
            write_float(0.5);
        else if (k == 9)
            write_double(0.5), k++;
        else
            write_int(header[k]);
    }
    write_mark(84);
    write_mark(4 + 80 * title_told);
    write_int(title_lines);
    for (size_t k = 0; k < 80 * (size_t)title_lines; k++)
        write_bytes(k < strlen(title) ? title + k : "x", 1, false);
    write_mark(4 + 80 * title_told);
    write_mark(4), write_int(ATOMS), write_mark(4);
    if (fixed)
        write_mark(8), write_int(1), write_int(3), write_mark(8);
    for (int number = 0; number < FRAMES; number++) {
        const double angle[3] = {60, 90, 120};
        double v[6] = {20 + number, angle[2], 30, angle[1], angle[0], 40};
        for (int k = 1; cell == COSINES && k < 5; k += k == 1 ? 2 : 1)
            v[k] = v[k] == 90 ? 0 : cos(v[k] * acos(-1) / 180);
        const double matrix[6] = {20, 2, 30, -3, 4, 40};
        if (cell == MATRIX)
            memcpy(v, matrix, sizeof v);
        if (cell != NO_CELL) {
            write_mark(48);
            for (int k = 0; k < 6; k++)
                write_double(v[k]);
            write_mark(48);
        }
        for (int d = 0; d < 3 + fourth; d++) {
            const bool partly = fixed && number > 0;
            write_mark(partly ? 8 : 4 * ATOMS);
            for (int k = 0; k < ATOMS; k++)
                if (!partly || k != 1)
                    write_float(coordinate(number, k, d));
            write_mark(partly ? 8 : 4 * ATOMS);
        }
    }
}

static double product(int i, int j) {
    const double *a = frame.box[i], *b = frame.box[j];
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Lengths 2, 3 and 4 nm; α = 60°, β = 90°, γ = 120°.
static void assert_cell(int number) {
    const double a = 2 + 0.1 * number;
    assert_true(frame.has_box);
    assert_true(fabs(product(0, 0) - a * a) < 1e-12 && fabs(product(1, 1) - 9) < 1e-12);
    assert_true(fabs(product(2, 2) - 16) < 1e-12 && fabs(product(1, 2) - 6) < 1e-12);
    assert_true(fabs(product(0, 2)) < 1e-12 && fabs(product(0, 1) + 1.5 * a) < 1e-12);
}

static void test_dcd_is_read_in_all_its_kinds(void **state) {
    for (int kind = 0; kind < 2 * 3 * 2; kind++) {
        const enum cell cell = (enum cell)(kind / 4);
        write_dcd(kind & 1, cell, 24, 0, kind & 2);
        assert_ok(try(state, &(struct trajectory_options){0}));
        assert_string_equal(trajectory.format->name, "dcd");
        for (int number = 0; number < FRAMES; number++) {
            next(true);
            assert_positions(number, 0.1);
            assert_int_equal(frame.step, 500 + 50 * number);
            assert_true(fabs(frame.time - frame.step * 0.5 * 0.0488882129) < 1e-12);
            if (cell == NO_CELL)
                assert_false(frame.has_box);
            else
                assert_cell(number);
        }
        next(false);
        close_all();
    }
}

/// 64-bit Fortran writes counts of 8 bytes.
static void test_dcd_is_read_with_markers_of_eight_bytes(void **state) {
    mark_bytes = 8;
    for (int kind = 0; kind < 2; kind++) {
        write_dcd(kind, DEGREES, 24, 0, false);
        assert_ok(try(state, &(struct trajectory_options){0}));
        for (int number = 0; number < FRAMES; number++) {
            next(true);
            assert_positions(number, 0.1);
            assert_cell(number);
        }
        next(false);
        close_all();
    }
    mark_bytes = 4;
}

/// The count around the title is that of two lines; there are three, as the title itself says.
static void test_dcd_is_read_with_a_title_of_another_length_than_it_is_told(void **state) {
    title_told = 2, title_lines = 3;
    write_dcd(false, DEGREES, 24, 0, false);
    assert_ok(try(state, &(struct trajectory_options){0}));
    next(true);
    assert_positions(0, 0.1);
    close_all();
    title_told = title_lines = 1;
}

/// A symmetric matrix, of the determinant 23202 Å³ by hand: 20 (30·40 − 4·4) − 2 (2·40 + 3·4) − 3
/// (2·4 + 3·30). Before version 25 the same numbers were lengths and angles, which these are not.
static void test_dcd_has_the_matrix_of_newer_versions_of_charmm(void **state) {
    static const double wanted[3][3] = {{2, 0.2, -0.3}, {0.2, 3, 0.4}, {-0.3, 0.4, 4}};
    bool more;
    write_dcd(false, MATRIX, 36, 0, false);
    assert_ok(try(state, &(struct trajectory_options){0}));
    next(true);
    for (int k = 0; k < 9; k++)
        assert_true(fabs(frame.box[k / 3][k % 3] - wanted[k / 3][k % 3]) < 1e-12);
    double reciprocal[3][3], det = 0;
    mf_frame_reciprocal(&frame, reciprocal);
    for (int d = 0; d < 3; d++)
        det += frame.box[0][d] * (frame.box[1][(d + 1) % 3] * frame.box[2][(d + 2) % 3] -
                                  frame.box[1][(d + 2) % 3] * frame.box[2][(d + 1) % 3]);
    assert_true(fabs(det - 23.202) < 1e-9);
    close_all();
    write_dcd(false, MATRIX, 24, 0, false);
    assert_ok(try(state, &(struct trajectory_options){0}));
    assert_fails(mf_trajectory_next(&trajectory, &frame, &more), STATUS_BAD_INPUT,
                 "not a valid box");
    close_all();
    write_dcd(false, DEGREES, 36, 0, false); // no matrix: lengths and angles after all
    assert_ok(try(state, &(struct trajectory_options){0}));
    next(true);
    assert_cell(0);
    close_all();
}

static void test_dcd_keeps_atoms_that_are_fixed(void **state) {
    for (int kind = 0; kind < 4; kind++) {
        mark_bytes = kind & 1 ? 8 : 4;
        write_dcd(kind & 2, DEGREES, 24, 1, kind & 1);
        assert_ok(try(state, &(struct trajectory_options){0}));
        next(true);
        assert_positions(0, 0.1);
        next(true);
        for (int k = 0; k < ATOMS; k++)
            for (int d = 0; d < 3; d++)
                assert_true(frame.position[k][d] == 0.1 * coordinate(k != 1, k, d));
        next(false);
        close_all();
    }
    mark_bytes = 4;
    write_dcd(false, NO_CELL, 24, ATOMS, false);
    assert_fails(try(state, &(struct trajectory_options){0}), STATUS_BAD_INPUT,
                 "the number of atoms is not valid");
}

/// X-PLOR's time step is double; a told one comes first; "lj" leaves lengths alone.
static void test_dcd_has_the_time_and_the_units_that_are_told(void **state) {
    write_dcd(false, NO_CELL, 0, 0, false);
    assert_ok(try(state, &(struct trajectory_options){0}));
    next(true);
    assert_true(fabs(frame.time - 500 * 0.5 * 0.0488882129) < 1e-12);
    close_all();
    assert_ok(try(state, &(struct trajectory_options){.units = "lj", .time_step = 0.01}));
    next(true);
    assert_true(fabs(frame.time - 5) < 1e-12);
    assert_positions(0, 1);
    close_all();
}

/// LAMMPS writes the time step as it has it: in fs, in ps, or as a number.
static void test_dcd_of_lammps_has_the_time_step_of_its_units(void **state) {
    static const struct {
        const char *units;
        double unit;
    } of[] = {{NULL, 1e-3}, {"real", 1e-3}, {"metal", 1}, {"lj", 1}};
    title = "Written by LAMMPS";
    for (size_t k = 0; k < sizeof of / sizeof *of; k++) {
        write_dcd(false, COSINES, 24, 0, false);
        assert_ok(try(state, &(struct trajectory_options){.units = of[k].units}));
        next(true);
        assert_true(fabs(frame.time - 500 * 0.5 * of[k].unit) < 1e-9);
        close_all();
    }
    title = "";
}

static void test_dcd_is_refused_when_its_records_do_not_fit(void **state) {
    write_dcd(true, DEGREES, 24, 0, false);
    file_bytes[file_size - 1] = 99;
    assert_ok(try(state, &(struct trajectory_options){0}));
    bool more;
    next(true);
    assert_fails(
        mf_trajectory_next(&trajectory, &frame, &more), STATUS_BAD_INPUT,
        "a.bin: frame 1, byte 428: the preceding record does not have the expected 12 bytes");
    close_all();
    file_size = 200;
    assert_int_equal(try(state, &(struct trajectory_options){0}), STATUS_BAD_INPUT);
    assert_contains(mf_status_message(), "a.bin: frame 0, byte 200: the file ends within");
}

// trr ---------------------------------------------------------------------------------------------

static void write_trr(int number, bool positions, bool velocities, bool forces) {
    const int vectors = ATOMS * 3 * 8;
    const int size[10] = {
        0, 0, 72, 72, 0, 0, 0, vectors * positions, vectors * velocities, vectors * forces};
    big = true;
    write_int(1993), write_int(13), write_int(12);
    write_bytes("GMX_trn_file", 12, false);
    for (int k = 0; k < 10; k++)
        write_int(size[k]);
    write_int(ATOMS), write_int(50 * number), write_int(0);
    write_double(0.1 * number), write_double(0);
    for (int k = 0; k < 9; k++)
        write_double(k % 4 == 0 ? 3 : k == 6 ? 1.5 : 0);
    for (int k = 0; k < 9; k++)
        write_double(7); // virial
    for (int part = 0; part < positions + velocities + forces; part++)
        for (int k = 0; k < ATOMS; k++)
            for (int d = 0; d < 3; d++)
                write_double((part ? -1 : 1) * coordinate(number, k, d));
}

static void test_trr_is_read_in_double_precision(void **state) {
    file_size = 0;
    write_trr(0, false, true, true); // passed over, even as the first
    write_trr(1, true, true, true);
    write_trr(2, false, true, false);
    write_trr(3, true, false, true);
    write_trr(4, false, false, true);
    assert_ok(try(state, &(struct trajectory_options){0}));
    next(true);
    assert_positions(1, 1);
    assert_true(frame.has_velocities && frame.velocity[2][1] == -coordinate(1, 2, 1));
    assert_true(frame.step == 50 && frame.time == 0.1 * 1);
    assert_true(frame.box[0][0] == 3 && frame.box[2][0] == 1.5 && frame.box[0][1] == 0);
    next(true);
    assert_positions(3, 1);
    assert_true(!frame.has_velocities && frame.step == 150);
    next(false);
    close_all();
}

static void test_trr_has_forces_where_they_are_asked_for(void **state) {
    file_size = 0;
    write_trr(0, true, true, true);
    write_trr(1, true, false, false);
    for (int asked = 0; asked < 2; asked++) {
        assert_ok(try(state, &(struct trajectory_options){.forces = asked}));
        next(true);
        assert_int_equal(frame.has_forces, asked);
        if (asked)
            assert_true(frame.force[2][1] == -coordinate(0, 2, 1));
        next(true);
        assert_false(frame.has_forces);
        close_all();
    }
}

// xtc ---------------------------------------------------------------------------------------------

static void test_xtc_has_few_atoms_unpacked(void **state) {
    file_size = 0;
    big = true;
    for (int number = 0; number < FRAMES; number++) {
        write_int(1995), write_int(ATOMS), write_int(number), write_float(number);
        for (int k = 0; k < 9; k++)
            write_float(k % 4 == 0 ? 5 : 0);
        write_int(ATOMS);
        for (int k = 0; k < ATOMS; k++)
            for (int d = 0; d < 3; d++)
                write_float(coordinate(number, k, d));
    }
    assert_ok(try(state, &(struct trajectory_options){0}));
    for (int number = 0; number < FRAMES; number++) {
        next(true);
        assert_positions(number, 1);
    }
    next(false);
    close_all();
}

/// The frames of 2023 are those of 1995 with another magic number and eight bytes for the size.
static void test_xtc_has_64_bit_sizes_since_2023(void **state) {
    enum { SIZE_AT = 88 };
    struct trajectory sample;
    struct trajectory_frame wanted = {0};
    bool more;
    FILE *stream = fopen("tests/trajectories/water.xtc", "rb");
    assert_non_null(stream);
    const size_t read = fread(file_bytes, 1, 28936, stream);
    fclose(stream);
    assert_int_equal(read, 28936);
    memmove(file_bytes + SIZE_AT + 4, file_bytes + SIZE_AT, read - SIZE_AT);
    memset(file_bytes + SIZE_AT, 0, 4);
    memcpy(file_bytes, "\0\0\x07\xE7", 4);
    file_size = read + 4;
    assert_ok(try(state, &(struct trajectory_options){0}));
    next(true);
    assert_ok(mf_trajectory_open(&sample, "tests/trajectories/water.xtc",
                                 &(struct trajectory_options){0}));
    assert_ok(mf_trajectory_next(&sample, &wanted, &more));
    assert_int_equal(frame.atoms, wanted.atoms);
    assert_memory_equal(frame.position, wanted.position, wanted.atoms * sizeof *wanted.position);
    next(false);
    close_all();
    mf_frame_clear(&wanted);
    mf_trajectory_close(&sample);
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_dcd_is_read_in_all_its_kinds),
        TEST(test_dcd_is_read_with_markers_of_eight_bytes),
        TEST(test_dcd_is_read_with_a_title_of_another_length_than_it_is_told),
        TEST(test_dcd_has_the_matrix_of_newer_versions_of_charmm),
        TEST(test_dcd_keeps_atoms_that_are_fixed),
        TEST(test_dcd_has_the_time_and_the_units_that_are_told),
        TEST(test_dcd_of_lammps_has_the_time_step_of_its_units),
        TEST(test_dcd_is_refused_when_its_records_do_not_fit),
        TEST(test_trr_is_read_in_double_precision),
        TEST(test_trr_has_forces_where_they_are_asked_for),
        TEST(test_xtc_has_few_atoms_unpacked),
        TEST(test_xtc_has_64_bit_sizes_since_2023),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
