// SPDX-License-Identifier: GPL-3.0-or-later
//
// Files that end too early or hold other bytes: all frames before are delivered, the fault is one
// line with file and frame, and what a header promises takes no memory.
#include "shared/temporary_folder.h"
#include "shared/testing.h"
#include "trajectory/trajectory.h"

#include <stdio.h>
#include <stdlib.h>

enum { MAX = 1 << 18 };

/// Files, how much of each is used, and where its frames end.
static const struct sample {
    const char *file;
    size_t size, end[4];
    bool needs_units;
} samples[] = {
    {"tests/trajectories/water.xtc", 57880, {28936, 57880}, false},
    {"tests/trajectories/water-atoms-wrapped.xtc", 29676, {29676}, false},
    {"tests/trajectories/water.trr", 197688, {197688}, false},
    {"tests/trajectories/lammps-tri.dump", 12091, {0}, true},
    {"tests/trajectories/lammps-plain.dump", 5140, {0}, true},
    {"tests/trajectories/lammps-tri.data", 4554, {0}, true},
};
enum { SAMPLES = sizeof samples / sizeof *samples };

static unsigned char bytes[MAX];
static struct trajectory trajectory;
static struct trajectory_frame frame;

static void read_sample(const struct sample *sample) {
    FILE *stream = fopen(sample->file, "rb");
    assert_non_null(stream);
    assert_int_equal(fread(bytes, 1, sample->size, stream), sample->size);
    fclose(stream);
}

/// Read all of the first `size` bytes, and count the frames.
static enum status read_all(void **state, size_t size, const char *units, size_t *frames) {
    static char file[1024];
    const struct trajectory_options options = {.units = units};
    bool more = true;
    *frames = 0;
    snprintf(file, sizeof file, "%s",
             temporary_folder_write(*state, "a.bin", (const char *)bytes, size));
    enum status status = mf_trajectory_open(&trajectory, file, &options);
    const bool opened = status == STATUS_OK;
    while (status == STATUS_OK && more) {
        status = mf_trajectory_next(&trajectory, &frame, &more);
        *frames += status == STATUS_OK && more;
    }
    if (opened)
        mf_trajectory_close(&trajectory);
    return status;
}

static void assert_clear_fault(enum status status, size_t frames) {
    char place[64];
    if (status == STATUS_OK)
        return;
    assert_int_equal(status, STATUS_BAD_INPUT);
    assert_contains(mf_status_message(), "a.bin");
    snprintf(place, sizeof place, "frame %zu", frames);
    if (frames > 0)
        assert_contains(mf_status_message(), place);
    assert_null(strchr(mf_status_message(), '\n'));
}

static void test_binary_files_give_all_whole_frames_when_cut(void **state) {
    size_t frames;
    for (int k = 0; k < 3; k++) {
        read_sample(&samples[k]);
        for (size_t size = 1; size <= samples[k].size; size += 1 + size / 17) {
            size_t whole = 0;
            while (samples[k].end[whole] && samples[k].end[whole] <= size)
                whole++;
            const bool ends = whole > 0 && samples[k].end[whole - 1] == size;
            const enum status status = read_all(state, size, NULL, &frames);
            assert_int_equal(frames, whole);
            assert_int_equal(status, ends ? STATUS_OK : STATUS_BAD_INPUT);
            assert_clear_fault(status, frames);
            if (whole > 0 && !ends)
                assert_contains(mf_status_message(), ", byte ");
        }
    }
}

/// A dump that is cut has the frames before the cut, whatever the place: never half a number.
static void test_dumps_give_all_whole_frames_when_cut(void **state) {
    const struct sample *const sample = &samples[3];
    size_t frames, end[4] = {0}, count = 0;
    read_sample(sample);
    for (size_t k = 1; k < sample->size; k++)
        if (memcmp(&bytes[k], "ITEM: TIMESTEP", 14) == 0)
            end[count++] = k;
    end[count++] = sample->size;
    assert_int_equal(count, 3);
    for (size_t size = end[0]; size <= sample->size; size += 23) {
        const size_t whole = 1 + (size >= end[1]) + (size >= end[2]);
        const enum status status = read_all(state, size, "real", &frames);
        assert_int_equal(frames, whole);
        assert_int_equal(status, size == end[whole - 1] ? STATUS_OK : STATUS_BAD_INPUT);
        assert_clear_fault(status, frames);
    }
}

/// Random bytes in random places: read or refused.
static void test_files_are_read_or_refused_when_bytes_are_others(void **state) {
    uint64_t random = 7;
    size_t frames;
    for (int k = 0; k < SAMPLES; k++)
        for (int time = 0; time < 60; time++) {
            read_sample(&samples[k]);
            for (int change = 0; change <= time % 4; change++) {
                random = random * 6364136223846793005u + 1442695040888963407u;
                const size_t reach = time % 2 ? 120 : samples[k].size; // headers more often
                bytes[(random >> 33) % reach] = (unsigned char)(random >> 25);
            }
            const char *const units = samples[k].needs_units ? "real" : NULL;
            const enum status status = read_all(state, samples[k].size, units, &frames);
            assert_clear_fault(status, frames);
        }
}

static void write_word(size_t at, uint32_t value) {
    for (int k = 0; k < 4; k++)
        bytes[at + (size_t)k] = (unsigned char)(value >> (24 - 8 * k));
}

/// 2^31 − 1 atoms, or so many bytes of them.
static void test_promises_of_a_header_take_no_memory(void **state) {
    size_t frames;
    read_sample(&samples[0]);
    write_word(4, INT32_MAX);
    write_word(52, INT32_MAX);
    mf_frame_clear(&frame);
    assert_int_equal(read_all(state, samples[0].size, NULL, &frames), STATUS_BAD_INPUT);
    assert_contains(mf_status_message(), "too few bytes for the number of atoms");
    assert_int_equal(frame.capacity, 0);
    write_word(88, INT32_MAX);
    assert_int_equal(read_all(state, samples[0].size, NULL, &frames), STATUS_BAD_INPUT);
    assert_contains(mf_status_message(), "the file ends within the frame");
    assert_true(frame.raw.capacity < 1 << 26);
    mf_frame_clear(&frame);
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_binary_files_give_all_whole_frames_when_cut),
        TEST(test_dumps_give_all_whole_frames_when_cut),
        TEST(test_files_are_read_or_refused_when_bytes_are_others),
        TEST(test_promises_of_a_header_take_no_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
