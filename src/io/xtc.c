// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/xtc.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/// Whole numbers in a nm; the most atoms of a run.
enum { PRECISION = 1000, LONGEST_RUN = 8 };

const int32_t mf_xtc_radix[XTC_LEVELS] = {
    0,        0,        0,       0,       0,       0,       0,       0,       0,       8,
    10,       12,       16,      20,      25,      32,      40,      50,      64,      80,
    101,      128,      161,     203,     256,     322,     406,     512,     645,     812,
    1024,     1290,     1625,    2048,    2580,    3250,    4096,    5060,    6501,    8192,
    10321,    13003,    16384,   20642,   26007,   32768,   41285,   52015,   65536,   82570,
    104031,   131072,   165140,  208063,  262144,  330280,  416127,  524287,  660561,  832255,
    1048576,  1321122,  1664510, 2097152, 2642245, 3329021, 4194304, 5284491, 6658042, 8388607,
    10568983, 13316085, 16777216};

// Numbers of XDR ----------------------------------------------------------------------------------

static void put_word(uint32_t word, FILE *stream) {
    for (int shift = 24; shift >= 0; shift -= 8)
        putc((int)(word >> shift & 0xff), stream);
}

static void put_float(double number, FILE *stream) {
    const float value = (float)number;
    uint32_t word;
    memcpy(&word, &value, sizeof word);
    put_word(word, stream);
}

// Bits --------------------------------------------------------------------------------------------

/// Atoms being packed: once to count the bits, and once more to write them.
struct packer {
    const struct xtc_frame *frame;
    int32_t min[3], max[3];
    uint64_t range[3];
    bool apart;         ///< a range is too wide for three digits in one number
    unsigned bits;      ///< of an atom that is told in full
    int first;          ///< level, and the finest
    FILE *stream;       ///< NULL: bits are counted
    uint64_t written;   ///< bits
    unsigned char byte; ///< that is not full yet
};

static void put_bits(struct packer *packer, uint32_t number, unsigned bits) {
    while (bits-- > 0) {
        packer->byte = (unsigned char)(packer->byte << 1 | (number >> bits & 1));
        if (++packer->written % 8 == 0 && packer->stream)
            putc(packer->byte, packer->stream);
    }
}

/// Three digits as one number: byte by byte, the lowest first, then what is left of the highest.
static void put_digits(struct packer *packer, const uint32_t digit[3], const uint64_t radix[3],
                       unsigned bits) {
    unsigned __int128 number = digit[0];
    number = (number * radix[1] + digit[1]) * radix[2] + digit[2];
    for (; bits >= 8; bits -= 8, number >>= 8)
        put_bits(packer, (uint32_t)number & 0xff, 8);
    put_bits(packer, (uint32_t)number, bits);
}

static unsigned bit_length(unsigned __int128 number) {
    unsigned bits = 0;
    for (; number; number >>= 1)
        bits++;
    return bits;
}

// Atoms -------------------------------------------------------------------------------------------

static void place_of(const struct packer *packer, size_t atom, int32_t place[3]) {
    double position[3];
    packer->frame->place(packer->frame->context, atom, position);
    for (int d = 0; d < 3; d++)
        place[d] = (int32_t)rint(PRECISION * fmin(fmax(position[d], -XTC_FARTHEST), XTC_FARTHEST));
}

/// The largest of the differences.
static uint32_t apart(const int32_t a[3], const int32_t b[3]) {
    uint32_t most = 0;
    for (int d = 0; d < 3; d++) {
        const uint32_t difference =
            a[d] > b[d] ? (uint32_t)a[d] - (uint32_t)b[d] : (uint32_t)b[d] - (uint32_t)a[d];
        most = difference > most ? difference : most;
    }
    return most;
}

static bool fits(uint32_t difference, int level) {
    return difference < (uint32_t)mf_xtc_radix[level] / 2;
}

static int level_of(uint32_t difference) {
    int level = XTC_FIRST_LEVEL;
    while (level < XTC_LEVELS - 1 && !fits(difference, level))
        level++;
    return level;
}

static void put_whole(struct packer *packer, const int32_t place[3]) {
    uint32_t digit[3];
    for (int d = 0; d < 3; d++)
        digit[d] = (uint32_t)place[d] - (uint32_t)packer->min[d];
    if (!packer->apart)
        put_digits(packer, digit, packer->range, packer->bits);
    for (int d = 0; packer->apart && d < 3; d++)
        put_bits(packer, digit[d], bit_length(packer->range[d]));
}

static void put_difference(struct packer *packer, const int32_t place[3], const int32_t from[3],
                           int level) {
    const uint64_t radix = (uint64_t)mf_xtc_radix[level];
    const uint64_t radices[3] = {radix, radix, radix};
    uint32_t digit[3];
    for (int d = 0; d < 3; d++)
        digit[d] = (uint32_t)place[d] - (uint32_t)from[d] + (uint32_t)radix / 2;
    put_digits(packer, digit, radices, (unsigned)level);
}

/// Atoms of a run: the first, and those after it that are told by differences.
struct run {
    int32_t place[LONGEST_RUN + 1][3];
    int more;
    uint32_t widest; ///< difference
};

static void find_run(const struct packer *packer, size_t first, int level, struct run *run) {
    const int32_t *last = run->place[0];
    run->more = 0;
    run->widest = 0;
    place_of(packer, first, run->place[0]);
    while (run->more < LONGEST_RUN && first + (size_t)run->more + 1 < packer->frame->atoms) {
        int32_t *const next = run->place[run->more + 1];
        place_of(packer, first + (size_t)run->more + 1, next);
        const uint32_t difference = apart(next, last);
        if (!fits(difference, level))
            return;
        run->widest = difference > run->widest ? difference : run->widest;
        run->more++;
        last = run->more == 1 ? run->place[0] : next; // the first two are exchanged
    }
}

/// One level coarser if the next two atoms ask for it and it is worth it, finer if they and those
/// of the run have room.
static int find_change(const struct packer *packer, size_t next, int level, const struct run *run) {
    int32_t a[3], b[3];
    if (next + 1 >= packer->frame->atoms)
        return 0;
    place_of(packer, next, a);
    place_of(packer, next + 1, b);
    const int wanted = level_of(apart(a, b)), had = run->more ? level_of(run->widest) : level;
    if (wanted > level && (unsigned)wanted < packer->bits)
        return 1;
    return wanted < level && had < level && level > packer->first ? -1 : 0;
}

static void put_run(struct packer *packer, const struct run *run, int level, int change,
                    int previous) {
    const bool told = run->more != previous || change != 0;
    const int32_t *last = run->place[run->more > 0];
    put_whole(packer, last);
    put_bits(packer, told, 1);
    if (told)
        put_bits(packer, (uint32_t)(3 * run->more + change + 1), 5);
    for (int k = 0; k < run->more; k++) {
        const int32_t *const place = run->place[k == 0 ? 0 : k + 1];
        put_difference(packer, place, last, level);
        last = place;
    }
}

static void put_atoms(struct packer *packer) {
    int level = packer->first, previous = 0;
    struct run run;
    packer->written = 0;
    for (size_t k = 0; k < packer->frame->atoms; k += (size_t)run.more + 1) {
        find_run(packer, k, level, &run);
        const int change = find_change(packer, k + (size_t)run.more + 1, level, &run);
        put_run(packer, &run, level, change, previous);
        previous = run.more;
        level += change;
    }
    if (packer->written % 8 != 0)
        put_bits(packer, 0, 8 - packer->written % 8);
}

// Frames ------------------------------------------------------------------------------------------

static void find_ranges(struct packer *packer) {
    uint32_t nearest = UINT32_MAX;
    int32_t place[3], last[3] = {0};
    for (size_t k = 0; k < packer->frame->atoms; k++) {
        place_of(packer, k, place);
        for (int d = 0; d < 3; d++) {
            packer->min[d] = k == 0 || place[d] < packer->min[d] ? place[d] : packer->min[d];
            packer->max[d] = k == 0 || place[d] > packer->max[d] ? place[d] : packer->max[d];
        }
        const uint32_t difference = apart(place, last);
        nearest = k > 0 && difference < nearest ? difference : nearest;
        memcpy(last, place, sizeof last);
    }
    for (int d = 0; d < 3; d++) {
        packer->range[d] = (uint64_t)((int64_t)packer->max[d] - packer->min[d] + 1);
        packer->apart = packer->apart || packer->range[d] > 0xFFFFFF;
    }
    packer->bits =
        bit_length((unsigned __int128)packer->range[0] * packer->range[1] * packer->range[2]);
    packer->first = level_of(nearest);
}

static void put_packed(const struct xtc_frame *frame, FILE *stream) {
    struct packer packer = {.frame = frame};
    find_ranges(&packer);
    put_float(PRECISION, stream);
    for (int d = 0; d < 3; d++)
        put_word((uint32_t)packer.min[d], stream);
    for (int d = 0; d < 3; d++)
        put_word((uint32_t)packer.max[d], stream);
    put_word((uint32_t)packer.first, stream);
    put_atoms(&packer);
    const uint64_t bytes = packer.written / 8;
    put_word((uint32_t)bytes, stream);
    packer.stream = stream;
    put_atoms(&packer);
    for (uint64_t k = bytes; k % 4 != 0; k++)
        putc(0, stream);
}

void mf_xtc_write(const struct xtc_frame *frame, FILE *stream) {
    const int64_t step = frame->step > INT32_MAX ? INT32_MAX : frame->step;
    put_word(XTC_MAGIC, stream);
    put_word((uint32_t)frame->atoms, stream);
    put_word((uint32_t)step, stream);
    put_float(frame->time, stream);
    for (int k = 0; k < 9; k++)
        put_float(frame->box[k / 3][k % 3], stream);
    put_word((uint32_t)frame->atoms, stream);
    if (frame->atoms > XTC_FEW_ATOMS) {
        put_packed(frame, stream);
        return;
    }
    for (size_t k = 0; k < frame->atoms; k++) {
        double position[3];
        frame->place(frame->context, k, position);
        for (int d = 0; d < 3; d++)
            put_float(position[d], stream);
    }
}
