// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/checkpoint.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>

enum { DIGEST = 77 };

/// A state of three pieces, one of them empty.
struct pieces {
    double numbers[5];
    uint32_t word;
    char text[3];
};

enum { SPANS = 4 };

static void list(struct pieces *pieces, struct memory_span spans[SPANS]) {
    spans[0] = (struct memory_span){pieces->numbers, sizeof pieces->numbers};
    spans[1] = (struct memory_span){&pieces->word, sizeof pieces->word};
    spans[2] = (struct memory_span){pieces->text, 0};
    spans[3] = (struct memory_span){pieces->text, sizeof pieces->text};
}

static const struct pieces saved = {{1.5, -0.0, 1e300, 5e-324, 0.1}, 0xFFFFFFFFu, {'a', 0, 'b'}};
static const struct pieces before = {{9, 9, 9, 9, 9}, 9, {'9', '9', '9'}};

static const char *save(void **state) {
    const char *file = temporary_folder_file(*state, "checkpoint.bin");
    struct pieces pieces = saved;
    struct memory_span spans[SPANS];
    list(&pieces, spans);
    assert_ok(mf_checkpoint_save(file, DIGEST, spans, SPANS));
    return file;
}

static bool is_same(const struct pieces *a, const struct pieces *b) {
    return memcmp(a->numbers, b->numbers, sizeof a->numbers) == 0 && a->word == b->word &&
           memcmp(a->text, b->text, sizeof a->text) == 0;
}

/// Loading fails with `part` in the message and leaves the memory alone.
static void assert_refused(const char *file, uint64_t digest, size_t count, const char *part) {
    struct pieces pieces = before;
    struct memory_span spans[SPANS];
    list(&pieces, spans);
    assert_fails(mf_checkpoint_load(file, digest, spans, count), STATUS_BAD_INPUT, part);
    assert_contains(mf_status_message(), "checkpoint.bin: ");
    assert_true(is_same(&pieces, &before));
}

static void test_checkpoint_load_gives_the_bits_that_were_saved(void **state) {
    const char *file = save(state);
    struct pieces pieces = before;
    struct memory_span spans[SPANS];
    list(&pieces, spans);
    assert_ok(mf_checkpoint_load(file, DIGEST, spans, SPANS));
    assert_true(is_same(&pieces, &saved));
}

static void test_checkpoint_load_refuses_when_the_settings_are_others(void **state) {
    assert_refused(save(state), DIGEST + 1, SPANS, "settings have changed");
    assert_true(mf_checkpoint_is_of_others(save(state), DIGEST + 1));
    assert_false(mf_checkpoint_is_of_others(save(state), DIGEST));
}

static void test_checkpoint_load_refuses_when_the_shape_is_another(void **state) {
    const char *file = save(state);
    struct pieces pieces = before;
    struct memory_span spans[SPANS];
    assert_refused(file, DIGEST, SPANS - 1, "of another shape");
    list(&pieces, spans);
    spans[0].bytes -= 8;
    assert_fails(mf_checkpoint_load(file, DIGEST, spans, SPANS), STATUS_BAD_INPUT, "another shape");
    assert_true(is_same(&pieces, &before));
}

/// Cut at every length, the file is refused and nothing is loaded: also where only the last bytes
/// of the last span are missing, over which a file can be positioned without an error.
static void test_checkpoint_load_refuses_when_the_file_is_cut_short(void **state) {
    char bytes[256];
    const char *file = save(state);
    FILE *stream = fopen(file, "rb");
    assert_non_null(stream);
    const size_t length = fread(bytes, 1, sizeof bytes, stream);
    fclose(stream);
    assert_in_range(length, 80, sizeof bytes - 1);
    for (size_t kept = 0; kept < length; kept++) {
        temporary_folder_write(*state, "checkpoint.bin", bytes, kept);
        assert_refused(file, DIGEST, SPANS, kept < 16 ? "not a checkpoint" : "is damaged");
    }
    bytes[length] = 'x';
    temporary_folder_write(*state, "checkpoint.bin", bytes, length + 1);
    assert_refused(file, DIGEST, SPANS, "is damaged");
    bytes[14] = '0';
    temporary_folder_write(*state, "checkpoint.bin", bytes, length);
    assert_refused(file, DIGEST, SPANS, "not a checkpoint of this version");
}

/// Any byte that is another, to any of two values, is seen, and nothing is loaded: those of a
/// number would fit as well as the right ones, and a length of 2^63 is negative where a file is
/// positioned.
static void test_checkpoint_load_refuses_when_any_byte_is_another(void **state) {
    char bytes[256];
    const char *file = save(state);
    FILE *stream = fopen(file, "rb");
    assert_non_null(stream);
    const size_t length = fread(bytes, 1, sizeof bytes, stream);
    fclose(stream);
    for (size_t k = 0; k < length; k++)
        for (int flip = 1; flip <= 0x80; flip *= 0x80) {
            bytes[k] = (char)(bytes[k] ^ flip);
            temporary_folder_write(*state, "checkpoint.bin", bytes, length);
            assert_refused(file, DIGEST, SPANS, k < 16 ? "not a checkpoint" : "is damaged");
            assert_fails(mf_checkpoint_load_span(file, DIGEST, 0, &(struct memory_span){bytes, 0}),
                         STATUS_BAD_INPUT, "checkpoint.bin: ");
            bytes[k] = (char)(bytes[k] ^ flip);
        }
}

/// The checksum is the one of FNV-1a over all bytes before it, computed here on its own.
static void test_checkpoint_save_ends_with_fnv_1a_of_the_file(void **state) {
    unsigned char bytes[256];
    FILE *stream = fopen(save(state), "rb");
    assert_non_null(stream);
    const size_t length = fread(bytes, 1, sizeof bytes, stream);
    fclose(stream);
    uint64_t expected = 14695981039346656037u, found;
    for (size_t k = 0; k < length - 8; k++)
        expected = (expected ^ bytes[k]) * 1099511628211u;
    memcpy(&found, bytes + length - 8, 8);
    assert_true(found == expected);
}

static void test_checkpoint_load_refuses_when_it_is_no_file(void **state) {
    (void)state;
    assert_fails(mf_checkpoint_load("/dev/zero", DIGEST, NULL, 0), STATUS_IO,
                 "/dev/zero: is a device");
    assert_fails(mf_checkpoint_load("/", DIGEST, NULL, 0), STATUS_IO, "/: is a folder");
}

static void test_checkpoint_load_span_finds_one_alone(void **state) {
    const char *file = save(state);
    struct pieces pieces = before;
    struct memory_span spans[SPANS];
    list(&pieces, spans);
    assert_ok(mf_checkpoint_load(file, DIGEST, spans, SPANS));
    for (size_t k = 0; k < SPANS; k++) {
        memset(spans[k].memory, 1, spans[k].bytes);
        assert_ok(mf_checkpoint_load_span(file, DIGEST, k, &spans[k]));
        assert_true(is_same(&pieces, &saved));
    }
    spans[1].bytes++;
    assert_fails(mf_checkpoint_load_span(file, DIGEST, 1, &spans[1]), STATUS_BAD_INPUT,
                 "another shape");
    assert_fails(mf_checkpoint_load_span(file, DIGEST, SPANS, &spans[0]), STATUS_BAD_INPUT,
                 "another shape");
    assert_fails(mf_checkpoint_load_span(file, DIGEST + 1, 0, &spans[0]), STATUS_BAD_INPUT,
                 "settings have changed");
}

static void test_checkpoint_load_names_the_file_when_it_is_missing(void **state) {
    const char *file = temporary_folder_file(*state, "checkpoint.bin");
    assert_fails(mf_checkpoint_load(file, DIGEST, NULL, 0), STATUS_IO,
                 "checkpoint.bin: No such file or directory");
}

static void test_checkpoint_save_names_the_file_when_it_cannot_be_written(void **state) {
    const char *file = temporary_folder_file(*state, "no/checkpoint.bin");
    assert_fails(mf_checkpoint_save(file, DIGEST, NULL, 0), STATUS_IO, "no/checkpoint.bin");
}

/// Values of FNV-1a, 64 bits, from its authors' page: "" and "foobar".
static void test_checkpoint_digest_is_fnv_1a(void **state) {
    uint64_t digest;
    assert_ok(mf_checkpoint_digest(temporary_folder_write(*state, "a", "", 0), &digest));
    assert_true(digest == 0xcbf29ce484222325u);
    assert_ok(mf_checkpoint_digest(temporary_folder_write(*state, "a", "foobar", 6), &digest));
    assert_true(digest == 0x85944171f73967e8u);
    assert_fails(mf_checkpoint_digest(temporary_folder_file(*state, "b"), &digest), STATUS_IO,
                 "b: No such file");
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_checkpoint_load_span_finds_one_alone),
        TEST(test_checkpoint_load_gives_the_bits_that_were_saved),
        TEST(test_checkpoint_load_refuses_when_the_settings_are_others),
        TEST(test_checkpoint_load_refuses_when_the_shape_is_another),
        TEST(test_checkpoint_load_refuses_when_the_file_is_cut_short),
        TEST(test_checkpoint_load_refuses_when_any_byte_is_another),
        TEST(test_checkpoint_save_ends_with_fnv_1a_of_the_file),
        cmocka_unit_test(test_checkpoint_load_refuses_when_it_is_no_file),
        TEST(test_checkpoint_load_names_the_file_when_it_is_missing),
        TEST(test_checkpoint_save_names_the_file_when_it_cannot_be_written),
        TEST(test_checkpoint_digest_is_fnv_1a),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
