// SPDX-License-Identifier: GPL-3.0-or-later
//
// Files that the programs gzip and zstd have compressed (tests/trajectories/lammps-plain.dump.gz
// and .zst, of lammps-plain.dump): what is read is what was compressed, members may follow each
// other, and a file that was cut off says so. Without zlib or libzstd the remedy is named.
#include "shared/temporary_folder.h"
#include "shared/testing.h"
#include "trajectory/trajectory.h"

#include <stdio.h>
#include <stdlib.h>

enum { MAX = 1 << 16 };

#ifdef HAS_ZLIB
static const bool has_gzip = true;
#else
static const bool has_gzip = false;
#endif
#ifdef HAS_ZSTD
static const bool has_zstd = true;
#else
static const bool has_zstd = false;
#endif

static const struct {
    const char *file, *remedy;
} packed[] = {{"tests/trajectories/lammps-plain.dump.gz", "gunzip"},
              {"tests/trajectories/lammps-plain.dump.zst", "unzstd"}};

static const char plain[] = "tests/trajectories/lammps-plain.dump";

static bool has(int kind) {
    return kind == 0 ? has_gzip : has_zstd;
}

static size_t read_file(const char *file, char *bytes) {
    FILE *stream = fopen(file, "rb");
    assert_non_null(stream);
    const size_t size = fread(bytes, 1, MAX, stream);
    fclose(stream);
    return size;
}

/// All bytes, a few at a time.
static enum status unpack(const char *file, struct bytes *bytes) {
    struct source source;
    bool more = true;
    TRY(mf_source_open(&source, file));
    enum status status = mf_source_more(&source, &more);
    while (status == STATUS_OK && more) {
        status = mf_source_take(&source, bytes, 1);
        if (status == STATUS_OK)
            status = mf_source_more(&source, &more);
    }
    mf_source_close(&source);
    return status;
}

static void test_what_was_compressed_is_read(void **state) {
    static char wanted[MAX], file[MAX];
    const size_t size = read_file(plain, wanted);
    for (int kind = 0; kind < 2; kind++) {
        struct bytes bytes = {0};
        if (!has(kind)) {
            assert_fails(unpack(packed[kind].file, &bytes), STATUS_BAD_INPUT, packed[kind].remedy);
            continue;
        }
        assert_ok(unpack(packed[kind].file, &bytes));
        assert_int_equal(bytes.size, size);
        assert_memory_equal(bytes.data, wanted, size);
        const size_t member = read_file(packed[kind].file, file);
        memcpy(file + member, file, member);
        bytes.size = 0;
        assert_ok(unpack(temporary_folder_write(*state, "twice", file, 2 * member), &bytes));
        assert_int_equal(bytes.size, 2 * size);
        assert_memory_equal(bytes.data + size, wanted, size);
        mf_source_free(&bytes);
    }
}

static void test_what_was_cut_off_says_so_when_it_was_compressed(void **state) {
    static char file[MAX];
    for (int kind = 0; kind < 2; kind++) {
        const size_t size = read_file(packed[kind].file, file);
        for (size_t cut = size - 1; has(kind) && cut > 4; cut -= cut > 20 ? 13 : 1) {
            struct bytes bytes = {0};
            assert_fails(unpack(temporary_folder_write(*state, "cut", file, cut), &bytes),
                         STATUS_BAD_INPUT, "ends early");
            mf_source_free(&bytes);
        }
        file[size / 2] ^= 1;
        struct bytes bytes = {0};
        if (has(kind))
            assert_fails(unpack(temporary_folder_write(*state, "odd", file, size), &bytes),
                         STATUS_BAD_INPUT, "damaged");
        mf_source_free(&bytes);
    }
}

static void test_trajectories_are_the_same_when_they_are_compressed(void **state) {
    struct trajectory one, other;
    struct trajectory_frame frame = {0}, same = {0};
    const struct trajectory_options options = {.units = "real"};
    (void)state;
    for (int kind = 0; kind < 2; kind++) {
        bool more = has(kind), there = true;
        if (!more)
            continue;
        assert_ok(mf_trajectory_open(&one, plain, &options));
        assert_ok(mf_trajectory_open(&other, packed[kind].file, &options));
        while (more) {
            assert_ok(mf_trajectory_next(&one, &frame, &more));
            assert_ok(mf_trajectory_next(&other, &same, &there));
            assert_int_equal(more, there);
            assert_memory_equal(frame.position, same.position,
                                frame.atoms * sizeof *frame.position);
        }
        mf_trajectory_close(&one);
        mf_trajectory_close(&other);
    }
    mf_frame_clear(&frame);
    mf_frame_clear(&same);
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_what_was_compressed_is_read),
        TEST(test_what_was_cut_off_says_so_when_it_was_compressed),
        TEST(test_trajectories_are_the_same_when_they_are_compressed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
