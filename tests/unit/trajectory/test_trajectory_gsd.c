// SPDX-License-Identifier: GPL-3.0-or-later
//
// GSD files written out byte by byte as its documentation says (gsd.readthedocs.io, file layer and
// schema hoomd): names of file layer 1 and 2, numbers of every type, as versions of HOOMD write
// them, what a frame takes from frame 0, images of a sheared box, molecules by bonds; what is
// refused.
#include "shared/temporary_folder.h"
#include "shared/testing.h"
#include "trajectory/mapping.h"
#include "trajectory/trajectory.h"

#include <math.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
    MAX = 1 << 14,
    ATOMS = 4,
    HEAD = 256,
    UINT8 = 1,
    UINT16,
    UINT32,
    UINT64,
    INT8,
    INT16,
    INT32,
    INT64,
    FLOAT,
    DOUBLE,
    CHARACTER
};

/// Numbers as a program writes them: types of names, of other integers, and of all else.
static struct {
    const char *by;
    uint8_t name, integer, real;
} written, writers[] = {
               {"gsd's module", INT8, UINT32, FLOAT},
               {"HOOMD 2.2 to 6", UINT8, UINT32, FLOAT},
               {"HOOMD 7, double", UINT8, UINT32, DOUBLE},
               {"file layer 2.1", CHARACTER, INT32, DOUBLE},
               {"narrow", INT8, INT8, FLOAT},
               {"half", INT8, INT16, FLOAT},
               {"wide", UINT8, INT64, DOUBLE},
};

static unsigned char file_bytes[MAX], index_bytes[MAX], names[MAX];
static size_t file_size, index_size, names_size;
static char name_of[16][64];
static int name_count, version;

static void put(unsigned char *to, size_t *size, const void *bytes, size_t count) {
    assert_true(*size + count <= MAX);
    memcpy(to + *size, bytes, count);
    *size += count;
}

static void begin_file(int file_version) {
    file_size = HEAD;
    index_size = names_size = 0;
    name_count = 0;
    version = file_version;
    written = writers[0];
}

/// As it is written by one of them.
static void begin_file_by(int writer) {
    begin_file(writer % 2 + 1);
    written = writers[writer];
}

static void add_chunk(uint64_t frame, const char *name, uint8_t type, uint64_t rows,
                      uint32_t columns, const void *numbers, size_t bytes) {
    uint16_t id = 0;
    const int64_t location = (int64_t)file_size;
    const uint8_t flags = 0;
    while (id < name_count && strcmp(name_of[id], name) != 0)
        id++;
    if (id == name_count)
        strcpy(name_of[name_count++], name);
    put(file_bytes, &file_size, numbers, bytes);
    put(index_bytes, &index_size, &frame, 8);
    put(index_bytes, &index_size, &rows, 8);
    put(index_bytes, &index_size, &location, 8);
    put(index_bytes, &index_size, &columns, 4);
    put(index_bytes, &index_size, &id, 2);
    put(index_bytes, &index_size, &type, 1);
    put(index_bytes, &index_size, &flags, 1);
}

static void add_reals(int frame, const char *name, uint64_t rows, uint32_t columns,
                      const float *numbers) {
    double wide[6 * ATOMS];
    const size_t count = rows * columns;
    for (size_t k = 0; k < count; k++)
        wide[k] = (double)numbers[k];
    if (written.real == DOUBLE)
        add_chunk((uint64_t)frame, name, DOUBLE, rows, columns, wide, 8 * count);
    else
        add_chunk((uint64_t)frame, name, FLOAT, rows, columns, numbers, 4 * count);
}

/// Little-endian: the lowest bytes are a number that is narrower.
static void add_integers(int frame, const char *name, uint64_t rows, uint32_t columns,
                         const int32_t *numbers) {
    const size_t bytes = (size_t)1 << (written.integer - 1) % 4, count = rows * columns;
    unsigned char as[8 * 3 * ATOMS];
    for (size_t k = 0; k < count; k++)
        memcpy(as + bytes * k, &(int64_t){numbers[k]}, bytes);
    add_chunk((uint64_t)frame, name, written.integer, rows, columns, as, bytes * count);
}

/// Names and index follow the chunks; both have room that is not used.
static void end_file(const char *schema) {
    static const unsigned char empty[128] = {0};
    const uint64_t magic = 0x65DF65DF65DF65DF;
    char text[64] = "";
    size_t at = 0;
    for (int k = 0; k < name_count; k++)
        put(names, &names_size, name_of[k], version == 1 ? 64 : strlen(name_of[k]) + 1);
    put(names, &names_size, empty, 128 - names_size % 64);
    const uint64_t names_at = file_size, names_room = names_size / 64;
    put(file_bytes, &file_size, names, names_size);
    put(index_bytes, &index_size, empty, 64);
    const uint64_t index_at = file_size, index_room = index_size / 32;
    put(file_bytes, &file_size, index_bytes, index_size);
    memset(file_bytes, 0, HEAD);
    put(file_bytes, &at, &magic, 8);
    put(file_bytes, &at, &index_at, 8);
    put(file_bytes, &at, &index_room, 8);
    put(file_bytes, &at, &names_at, 8);
    put(file_bytes, &at, &names_room, 8);
    put(file_bytes, &at, &(uint32_t){1 << 16 | 4}, 4);
    put(file_bytes, &at, &(uint32_t){(uint32_t)version << 16}, 4);
    strcpy(text, "by hand");
    put(file_bytes, &at, text, 64);
    memset(text, 0, sizeof text);
    strcpy(text, schema);
    put(file_bytes, &at, text, 64);
}

static const float box[6] = {8, 10, 12, 0.5F, 0.25F, -0.5F};
static const int32_t image[ATOMS][3] = {{0, 0, 0}, {1, 0, 0}, {0, -2, 0}, {0, 1, 3}};

static float coordinate(int frame, int atom, int d) {
    return 0.5F * (float)frame + (float)atom - 0.25F * (float)d;
}

static void add_vectors(int frame, const char *name, float factor) {
    float numbers[ATOMS][3];
    for (int k = 0; k < ATOMS; k++)
        for (int d = 0; d < 3; d++)
            numbers[k][d] = factor * coordinate(frame, k, d);
    add_reals(frame, name, ATOMS, 3, numbers[0]);
}

/// Frame 0 has all but a step, frame 1 positions, frame 2 a box, and all velocities if `moves`, or
/// else frame 0 alone.
static void add_frames(bool moves) {
    add_reals(0, "configuration/box", 6, 1, box);
    add_integers(0, "particles/N", 1, 1, (int32_t[]){ATOMS});
    add_chunk(0, "particles/types", written.name, 2, 5, "Pol\0\0Water", 10);
    add_integers(0, "particles/typeid", ATOMS, 1, (int32_t[]){1, 0, 0, 1});
    add_reals(0, "particles/mass", ATOMS, 1, (float[]){18, 2.5F, 3, 18});
    add_vectors(0, "particles/position", 1);
    add_vectors(0, "particles/velocity", -2);
    add_integers(0, "particles/image", ATOMS, 3, image[0]);
    add_integers(0, "bonds/N", 1, 1, (int32_t[]){1});
    add_integers(0, "bonds/group", 1, 2, (int32_t[]){2, 1});
    add_chunk(0, "bonds/types", written.name, 2, 3, "no\0yes", 6);
    add_integers(0, "bonds/typeid", 1, 1, (int32_t[]){1});
    add_chunk(1, "configuration/step", UINT64, 1, 1, &(uint64_t){500}, 8);
    add_vectors(1, "particles/position", 1);
    if (moves)
        add_vectors(1, "particles/velocity", -2);
    add_chunk(2, "configuration/step", UINT64, 1, 1, &(uint64_t){1000}, 8);
    add_reals(2, "configuration/box", 6, 1, (float[]){9, 9, 9, 0, 0, 0});
    if (moves)
        add_vectors(2, "particles/velocity", -2);
}

static struct trajectory trajectory;
static struct trajectory_frame frame;

static enum status try(void **state, const char *units) {
    static char file[1024];
    snprintf(file, sizeof file, "%s",
             temporary_folder_write(*state, "a.bin", (const char *)file_bytes, file_size));
    return mf_trajectory_open(&trajectory, file,
                              &(struct trajectory_options){.units = units, .time_step = 0.01});
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

/// Å are tenths of nm. Vectors of the box: (8, 0, 0), (5, 10, 0), (3, −6, 12).
static void assert_frame(int number, const double vectors[3][3]) {
    for (int i = 0; i < 3; i++)
        for (int d = 0; d < 3; d++)
            assert_true(fabs(frame.box[i][d] - 0.1 * vectors[i][d]) < 1e-12);
    for (int k = 0; k < ATOMS; k++)
        for (int d = 0; d < 3; d++) {
            double x = (double)coordinate(number == 1, k, d);
            for (int i = 0; i < 3; i++)
                x += image[k][i] * vectors[i][d];
            assert_true(fabs(frame.position[k][d] - 0.1 * x) < 1e-12);
            assert_true(fabs(frame.velocity[k][d] + 200 * (double)coordinate(number, k, d)) < 1e-9);
        }
    // Images of frame 0 that are not written again may be old: HOOMD leaves them out unless asked.
    assert_int_equal(frame.unwrapped, number == 0);
    assert_int_equal(frame.step, 500 * number);
    assert_true(fabs(frame.time - 5 * number) < 1e-12);
}

static void test_gsd_is_read_where_frames_lean_on_the_first(void **state) {
    static const double sheared[3][3] = {{8, 0, 0}, {5, 10, 0}, {3, -6, 12}},
                        cube[3][3] = {{9, 0, 0}, {0, 9, 0}, {0, 0, 9}};
    for (int writer = 0; writer < (int)(sizeof writers / sizeof *writers); writer++) {
        begin_file_by(writer);
        add_frames(true);
        end_file("hoomd");
        assert_ok(try(state, "real"));
        assert_string_equal(trajectory.format->name, "gsd");
        assert_int_equal(trajectory.frames, 3);
        const struct structure_terms *const bonds = &trajectory.structure.terms[0];
        assert_int_equal(bonds->count, 1);
        assert_int_equal(bonds->atom[0], 2);
        assert_int_equal(bonds->atom[1], 1);
        assert_string_equal(bonds->name[bonds->type[0]], "yes");
        assert_string_equal(trajectory.structure.atom[3].name, "Water");
        assert_true(trajectory.structure.atom[1].mass == 2.5);
        for (int number = 0; number < 3; number++) {
            next(true);
            assert_frame(number, number < 2 ? sheared : cube);
        }
        next(false);
        close_all();
    }
}

/// HOOMD writes velocities of frame 0 always, and of the others only if asked: they do not stand
/// still in between.
static void test_gsd_has_no_velocities_but_those_of_each_frame(void **state) {
    begin_file(2);
    add_frames(false);
    end_file("hoomd");
    assert_ok(try(state, "real"));
    for (int number = 0; number < 3; number++) {
        next(true);
        assert_false(frame.has_velocities);
    }
    close_all();

    begin_file(2);
    add_chunk(0, "particles/N", UINT32, 1, 1, &(uint32_t){ATOMS}, 4);
    add_vectors(0, "particles/position", 1);
    add_vectors(0, "particles/velocity", -2);
    end_file("hoomd");
    assert_ok(try(state, "real"));
    next(true);
    assert_true(frame.has_velocities); // a start for a simulation
    close_all();
}

static void test_gsd_has_types_masses_and_molecules_by_bonds(void **state) {
    begin_file(2);
    add_frames(true);
    end_file("hoomd");
    assert_ok(try(state, "lj"));
    const struct structure_atom *const atom = trajectory.structure.atom;
    assert_int_equal(trajectory.structure.atoms, ATOMS);
    assert_string_equal(atom[0].name, "Water");
    assert_string_equal(atom[1].name, "Pol");
    assert_true(atom[0].mass == 18 && atom[1].mass == 2.5 && atom[2].mass == 3);
    assert_int_equal(trajectory.structure.residues, 3); // 1 and 2 are one
    assert_string_equal(atom[0].residue_name, "Water"); // what its bead will be called
    assert_string_equal(atom[1].residue_name, "");
    assert_true(atom[1].residue == atom[2].residue && atom[0].residue != atom[3].residue);
    close_all();
}

/// Types are told apart by their names: "Water", number 1 from 0 on, is not the first of others.
static void test_gsd_has_no_other_types_than_those_of_its_names(void **state) {
    struct mapping mapping;
    begin_file(2);
    add_frames(true);
    end_file("hoomd");
    assert_ok(try(state, "lj"));
    assert_fails(mf_mapping_init_atoms(&mapping, &trajectory.structure,
                                       (const char *const[]){"Pol"}, (const double[]){NAN}, 1,
                                       "a.gsd"),
                 STATUS_BAD_INPUT, "no type has the name of atom 1, \"Water\"");
    assert_ok(mf_mapping_init_atoms(&mapping, &trajectory.structure,
                                    (const char *const[]){"Pol", "Water"},
                                    (const double[]){NAN, NAN}, 2, "a.gsd"));
    mf_mapping_clear(&mapping);
    close_all();
}

static void test_gsd_is_refused_when_it_cannot_be_what_it_says(void **state) {
    begin_file(2);
    add_frames(true);
    end_file("hoomd");
    assert_fails(try(state, NULL), STATUS_BAD_INPUT, "the file has no units");
    file_bytes[8 + 3] = 1; // its index is 16 MiB on
    assert_fails(try(state, "lj"), STATUS_BAD_INPUT, "it is damaged");
    begin_file(2);
    add_frames(true);
    end_file("other");
    assert_fails(try(state, "lj"), STATUS_BAD_INPUT, "the schema \"other\"; hoomd is read");
    begin_file(2);
    add_frames(true);
    add_chunk(3, "particles/N", UINT32, 1, 1, &(uint32_t){5}, 4);
    add_chunk(4, "configuration/dimensions", UINT8, 1, 1, &(uint8_t){2}, 1);
    end_file("hoomd");
    bool more;
    assert_ok(try(state, "lj"));
    for (int number = 0; number < 3; number++)
        next(true);
    assert_fails(mf_trajectory_next(&trajectory, &frame, &more), STATUS_BAD_INPUT,
                 "it has 5 particles, the first frame 4");
    close_all();
    begin_file(2);
    add_frames(true);
    add_chunk(3, "particles/typeid", UINT32, ATOMS, 1, (uint32_t[]){1, 0, 1, 1}, 16);
    end_file("hoomd");
    assert_ok(try(state, "lj"));
    for (int number = 0; number < 3; number++)
        next(true);
    assert_fails(mf_trajectory_next(&trajectory, &frame, &more), STATUS_BAD_INPUT,
                 "particle 3 is of type 1, in the first frame of 0");
    close_all();
}

static void test_gsd_is_refused_when_a_number_is_of_no_type_that_it_may_have(void **state) {
    begin_file(2);
    add_frames(true);
    add_chunk(3, "configuration/box", INT32, 6, 1, (int32_t[]){9, 9, 9, 0, 0, 0}, 24);
    end_file("hoomd");
    bool more;
    assert_ok(try(state, "lj"));
    for (int number = 0; number < 3; number++)
        next(true);
    assert_fails(mf_trajectory_next(&trajectory, &frame, &more), STATUS_BAD_INPUT,
                 "has 6 rows of 1 numbers of type 7, which it cannot have");
    close_all();
    begin_file(2);
    add_chunk(0, "particles/N", INT64, 1, 1, &(int64_t){(int64_t)1 << 40}, 8);
    end_file("hoomd");
    assert_fails(try(state, "lj"), STATUS_BAD_INPUT, "\"particles/N\" has a number beyond 32 bits");
}

static void test_gsd_needs_a_file_when_it_comes_by_a_pipe(void **state) {
    char name[1024];
    begin_file(2);
    add_frames(true);
    end_file("hoomd");
    snprintf(name, sizeof name, "%s", temporary_folder_file(*state, "pipe"));
    assert_int_equal(mkfifo(name, 0600), 0);
    const pid_t writer = fork();
    if (writer == 0) {
        FILE *stream = fopen(name, "wb");
        if (stream == NULL || fwrite(file_bytes, 1, file_size, stream) != file_size ||
            fclose(stream) != 0)
            _exit(1);
        _exit(0);
    }
    assert_fails(mf_trajectory_open(&trajectory, name, &(struct trajectory_options){.units = "lj"}),
                 STATUS_BAD_INPUT, "needs a file, neither");
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_gsd_is_read_where_frames_lean_on_the_first),
        TEST(test_gsd_has_no_velocities_but_those_of_each_frame),
        TEST(test_gsd_has_types_masses_and_molecules_by_bonds),
        TEST(test_gsd_has_no_other_types_than_those_of_its_names),
        TEST(test_gsd_is_refused_when_it_cannot_be_what_it_says),
        TEST(test_gsd_is_refused_when_a_number_is_of_no_type_that_it_may_have),
        TEST(test_gsd_needs_a_file_when_it_comes_by_a_pipe),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
