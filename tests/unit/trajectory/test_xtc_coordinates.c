// SPDX-License-Identifier: GPL-3.0-or-later
//
// Coordinates packed here, bit by bit and digit by digit as the format is described, are unpacked
// to the same whole numbers; files of GROMACS are in test_trajectory_gromacs.
#include "shared/testing.h"
#include "trajectory/xtc.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { ATOMS = 3000, BYTES = 16 * ATOMS, FIRST_LEVEL = 9, LEVELS = 73, LONGEST_RUN = 9 };

static uint64_t random_state;

static uint32_t random_below(uint32_t bound) {
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)((random_state >> 33) % bound);
}

/// The table of the format is 2^(k/3), rounded up or down, but for three entries.
static uint32_t radix_of(int level) {
    if (level == 37)
        return 5060;
    if (level == 57 || level == 69)
        return (1u << (level / 3)) - 1;
    return (uint32_t)(pow(2, level / 3.0) + 1e-9);
}

struct writer {
    unsigned char bytes[BYTES + XTC_SLACK];
    size_t bit;
};

static void write_bit(struct writer *writer, unsigned bit) {
    assert_true(writer->bit < 8 * BYTES);
    writer->bytes[writer->bit / 8] |= (unsigned char)(bit << (7 - writer->bit % 8));
    writer->bit++;
}

static void write_bits(struct writer *writer, uint32_t number, int bits) {
    for (int k = bits - 1; k >= 0; k--)
        write_bit(writer, number >> k & 1);
}

/// Three digits as one number: byte by byte, the lowest first, then what is left of the highest.
static void write_digits(struct writer *writer, const uint32_t digit[3], const uint32_t radix[3],
                         int bits) {
    unsigned __int128 number = digit[0];
    number = (number * radix[1] + digit[1]) * radix[2] + digit[2];
    for (; bits >= 8; bits -= 8, number >>= 8)
        write_bits(writer, (uint32_t)(number & 0xFF), 8);
    write_bits(writer, (uint32_t)number, bits);
}

static int bits_of(unsigned __int128 number) {
    int bits = 0;
    for (; number; number >>= 1)
        bits++;
    return bits;
}

struct sample {
    struct xtc_packing packing;
    int32_t atom[ATOMS][3]; ///< in the order of the file
    struct writer writer;
};

static void write_whole(struct sample *sample, const int32_t atom[3]) {
    const struct xtc_packing *const packing = &sample->packing;
    uint32_t radix[3], digit[3];
    bool apart = false;
    for (int d = 0; d < 3; d++) {
        radix[d] = (uint32_t)(packing->max[d] - packing->min[d]) + 1;
        digit[d] = (uint32_t)(atom[d] - packing->min[d]);
        apart |= radix[d] > 0xFFFFFF;
    }
    const unsigned __int128 product = (unsigned __int128)radix[0] * radix[1] * radix[2];
    if (!apart)
        write_digits(&sample->writer, digit, radix, bits_of(product));
    for (int d = 0; apart && d < 3; d++)
        write_bits(&sample->writer, digit[d], bits_of(radix[d]));
}

/// A random step within a level that stays in range.
static void take_step(const struct xtc_packing *packing, uint32_t radix, const int32_t from[3],
                      int32_t to[3]) {
    for (int d = 0; d < 3; d++) {
        int64_t next = from[d] + (int64_t)random_below(radix) - radix / 2;
        next = next < packing->min[d] ? packing->min[d] : next;
        next = next > packing->max[d] ? packing->max[d] : next;
        to[d] = (int32_t)next;
    }
}

static void write_difference(struct writer *writer, const int32_t from[3], const int32_t to[3],
                             uint32_t radix, int level) {
    const uint32_t radices[3] = {radix, radix, radix};
    uint32_t digit[3];
    for (int d = 0; d < 3; d++)
        digit[d] = (uint32_t)(to[d] - from[d] + (int32_t)(radix / 2));
    write_digits(writer, digit, radices, level);
}

/// Random atoms in random runs, whose levels walk up and down.
static void pack(struct sample *sample, int level, int32_t range) {
    struct xtc_packing *const packing = &sample->packing;
    int run = 0;
    memset(sample, 0, sizeof *sample);
    *packing = (struct xtc_packing){.atoms = ATOMS, .precision = 1000, .level = level};
    for (int d = 0; d < 3; d++) {
        packing->min[d] = -range / 3 * d;
        packing->max[d] = packing->min[d] + range - d;
    }
    for (int k = 0; k < ATOMS;) {
        const uint32_t radix = radix_of(level);
        int longest = ATOMS - k - 1;
        int change = (int)random_below(3) - 1;
        int next = (int)random_below(3) ? run : (int)random_below(LONGEST_RUN + 1);
        next = next > longest ? longest : next;
        change = level + change < FIRST_LEVEL || level + change >= LEVELS ? 0 : change;
        int32_t whole[3];
        for (int d = 0; d < 3; d++)
            whole[d] = packing->min[d] +
                       (int32_t)random_below((uint32_t)(packing->max[d] - packing->min[d]) + 1);
        write_whole(sample, whole);
        const bool told = next != run || change != 0;
        write_bit(&sample->writer, told);
        if (told)
            write_bits(&sample->writer, (uint32_t)(3 * next + change + 1), 5);
        run = next;
        const int32_t *last = whole;
        for (int i = 0; i < run; i++) {
            int32_t *const place = sample->atom[k + (i == 0 ? 0 : i + 1)];
            take_step(packing, radix, last, place);
            write_difference(&sample->writer, last, place, radix, level);
            last = place;
        }
        memcpy(sample->atom[run > 0 ? k + 1 : k], whole, sizeof whole);
        k += run + 1;
        level += change;
    }
}

static size_t bytes_of(const struct sample *sample) {
    return (sample->writer.bit + 7) / 8;
}

static double (*unpacked)[3];

static const char *unpack(const struct sample *sample) {
    size_t damage;
    const char *fault = mf_xtc_check(&sample->packing, bytes_of(sample));
    return fault ? fault
                 : mf_xtc_unpack(&sample->packing, sample->writer.bytes, bytes_of(sample), unpacked,
                                 &damage);
}

/// From levels of 9 bits to those of 72, and from small ranges to those that are stored apart.
static void test_coordinates_come_back_when_they_were_packed(void **state) {
    static const int32_t ranges[] = {50, 4384, 300000, 16000000, 200000000};
    struct sample *const sample = malloc(sizeof *sample);
    (void)state;
    assert_non_null(sample);
    for (int range = 0; range < 5; range++)
        for (int level = FIRST_LEVEL; level < LEVELS; level++) {
            random_state = (uint64_t)(1000 * range + level);
            pack(sample, level, ranges[range]);
            const char *const fault = unpack(sample);
            if (fault)
                fail_msg("level %d, range %d: %s", level, (int)ranges[range], fault);
            for (int k = 0; k < ATOMS; k++)
                for (int d = 0; d < 3; d++)
                    assert_true(unpacked[k][d] == sample->atom[k][d] / 1000.0);
        }
    free(sample);
}

/// No flipped bit and no missing byte makes it read or write beyond its arrays (the sanitizers see
/// that). Most are but another coordinate; those that shift what follows are found.
static void test_damaged_bits_are_refused_or_harmless(void **state) {
    struct sample *const sample = malloc(sizeof *sample);
    int refused = 0, flips = 0;
    (void)state;
    assert_non_null(sample);
    random_state = 5;
    pack(sample, 20, 4384);
    for (size_t bit = 0; bit < sample->writer.bit; bit += 37, flips++) {
        sample->writer.bytes[bit / 8] ^= (unsigned char)(1u << bit % 8);
        refused += unpack(sample) != NULL;
        sample->writer.bytes[bit / 8] ^= (unsigned char)(1u << bit % 8);
    }
    assert_null(unpack(sample));
    assert_true(refused > flips / 50 && refused < flips);
    sample->writer.bit -= 64;
    assert_non_null(unpack(sample));
    free(sample);
}

static void test_packing_is_refused_when_it_cannot_be(void **state) {
    const struct xtc_packing good = {
        .atoms = 100, .precision = 1000, .min = {0}, .max = {9, 9, 9}, .level = 9};
    struct xtc_packing bad = good;
    (void)state;
    assert_null(mf_xtc_check(&good, 200));
    assert_string_equal(mf_xtc_check(&good, 100), "too few bytes for the number of atoms");
    bad.level = 8;
    assert_non_null(mf_xtc_check(&bad, 200));
    bad.level = 73;
    assert_non_null(mf_xtc_check(&bad, 200));
    bad = good;
    bad.precision = NAN;
    assert_non_null(mf_xtc_check(&bad, 200));
    bad = good;
    bad.max[1] = -1;
    assert_non_null(mf_xtc_check(&bad, 200));
    bad.min[1] = INT32_MIN;
    bad.max[1] = INT32_MAX;
    assert_non_null(mf_xtc_check(&bad, 200));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_coordinates_come_back_when_they_were_packed),
        cmocka_unit_test(test_damaged_bits_are_refused_or_harmless),
        cmocka_unit_test(test_packing_is_refused_when_it_cannot_be),
    };
    unpacked = malloc(ATOMS * sizeof *unpacked);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
