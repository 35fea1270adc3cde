// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/xtc.h"

#include "trajectory/binary.h"

#include <math.h>
#include <stdlib.h>

/// Whole numbers in a nm; the most atoms of a run; bits that an atom takes at least.
enum { PRECISION = 1000, LONGEST_RUN = 8, MIN_BITS = 9 };

/// Differences in level k are three digits below radices[k], 2^(k/3) but for a few that the
/// format's author typed otherwise; k bits hold the three.
enum { FIRST_LEVEL = 9, LEVELS = 73 };
static const int32_t radices[LEVELS] = {
    0,        0,        0,       0,       0,       0,       0,       0,       0,       8,
    10,       12,       16,      20,      25,      32,      40,      50,      64,      80,
    101,      128,      161,     203,     256,     322,     406,     512,     645,     812,
    1024,     1290,     1625,    2048,    2580,    3250,    4096,    5060,    6501,    8192,
    10321,    13003,    16384,   20642,   26007,   32768,   41285,   52015,   65536,   82570,
    104031,   131072,   165140,  208063,  262144,  330280,  416127,  524287,  660561,  832255,
    1048576,  1321122,  1664510, 2097152, 2642245, 3329021, 4194304, 5284491, 6658042, 8388607,
    10568983, 13316085, 16777216};

/// Three digits in one number of `bits` bits: (x radix[1] + y) radix[2] + z.
struct digits {
    unsigned bits;
    uint64_t radix[3];
    uint64_t inverse[3]; ///< floor((2^64 − 1)/radix)
};

static unsigned bit_length(unsigned __int128 number) {
    const uint64_t high = (uint64_t)(number >> 64), low = (uint64_t)number;
    return high  ? 128 - (unsigned)__builtin_clzll(high)
           : low ? 64 - (unsigned)__builtin_clzll(low)
                 : 0;
}

static struct digits make_digits(uint64_t x, uint64_t y, uint64_t z) {
    struct digits digits = {.radix = {x, y, z}};
    for (int d = 0; d < 3; d++)
        digits.inverse[d] = UINT64_MAX / digits.radix[d];
    digits.bits = bit_length((unsigned __int128)(x * y) * z);
    return digits;
}

static void make_levels(struct digits levels[LEVELS]) {
    for (unsigned k = FIRST_LEVEL; k < LEVELS; k++) {
        const uint64_t radix = (uint64_t)radices[k];
        levels[k] = make_digits(radix, radix, radix);
        levels[k].bits = k;
    }
}

/// How whole coordinates are stored: as digits, or each on its own if a range is beyond 2^24.
struct whole {
    bool apart;
    unsigned bits[3];
    struct digits digits;
};

static struct whole make_whole(const struct xtc_packing *packing) {
    struct whole whole = {0};
    uint64_t range[3];
    for (int d = 0; d < 3; d++) {
        range[d] = (uint64_t)((int64_t)packing->max[d] - packing->min[d] + 1);
        whole.bits[d] = bit_length(range[d]);
        whole.apart |= range[d] > 0xFFFFFF;
    }
    whole.digits = make_digits(range[0], range[1], range[2]);
    return whole;
}

// Reading -----------------------------------------------------------------------------------------

/// The next 57 bits at least, the first of them highest.
static inline uint64_t look(const unsigned char *data, size_t bit) {
    uint64_t word;
    memcpy(&word, data + (bit >> 3), sizeof word);
    return __builtin_bswap64(word) << (bit & 7);
}

/// `bits` bits, 0 to 32.
static inline uint32_t take(const unsigned char *data, size_t *bit, unsigned bits) {
    const uint64_t word = look(data, *bit);
    *bit += bits;
    return bits ? (uint32_t)(word >> (64 - bits)) : 0;
}

/// number / radix, whose rest stays in `number`. The estimate by the inverse is at most 1 too low.
static inline uint64_t divide(uint64_t *number, uint64_t radix, uint64_t inverse) {
    uint64_t ratio = (uint64_t)(((unsigned __int128)*number * inverse) >> 64);
    *number -= ratio * radix;
    const bool low = *number >= radix;
    ratio += low;
    *number -= low ? radix : 0;
    return ratio;
}

/// Numbers are stored byte by byte, the lowest first, and the odd bits of the highest at the end.
static inline uint64_t take_short(const unsigned char *data, size_t *bit, unsigned bits) {
    const unsigned whole = bits & ~7u, rest = bits & 7;
    const uint64_t word = look(data, *bit);
    *bit += bits;
    const uint64_t low = whole ? __builtin_bswap64(word) & (~0ull >> (64 - whole)) : 0;
    return rest ? low | (word << whole) >> (64 - rest) << whole : low;
}

/// The same of any length that three digits may have, 75 bits.
static unsigned __int128 take_long(const unsigned char *data, size_t *bit, unsigned bits) {
    unsigned __int128 number = 0;
    unsigned at = 0;
    for (; bits - at >= 8; at += 8)
        number |= (unsigned __int128)take(data, bit, 8) << at;
    return number | (unsigned __int128)take(data, bit, bits - at) << at;
}

/// False if the first digit is none: the bits are damaged.
static inline bool take_digits(const struct digits *digits, const unsigned char *data, size_t *bit,
                               uint32_t number[3]) {
    const uint64_t *radix = digits->radix, *inverse = digits->inverse;
    uint64_t first, rest;
    if (digits->bits <= 56) {
        rest = take_short(data, bit, digits->bits);
        first = divide(&rest, radix[2], inverse[2]); // the rest is z
    } else {
        const unsigned __int128 all = take_long(data, bit, digits->bits);
        first = (uint64_t)(all / radix[2]);
        rest = (uint64_t)(all % radix[2]);
    }
    number[2] = (uint32_t)rest;
    number[0] = (uint32_t)divide(&first, radix[1], inverse[1]);
    number[1] = (uint32_t)first;
    return number[0] < radix[0];
}

static inline bool take_whole(const struct whole *whole, const unsigned char *data, size_t *bit,
                              uint32_t number[3]) {
    if (!whole->apart)
        return take_digits(&whole->digits, data, bit, number);
    for (int d = 0; d < 3; d++)
        number[d] = take(data, bit, whole->bits[d]);
    return true;
}

const char *mf_xtc_check(const struct xtc_packing *packing, size_t bytes) {
    if (!(packing->precision > 0 && isfinite(packing->precision)))
        return "the precision of the coordinates is not positive";
    if (packing->level < FIRST_LEVEL || packing->level >= LEVELS)
        return "the size of the differences is not valid";
    for (int d = 0; d < 3; d++)
        if ((int64_t)packing->max[d] - packing->min[d] < 0 ||
            (int64_t)packing->max[d] - packing->min[d] >= INT32_MAX)
            return "the range of the coordinates is not valid";
    const struct whole whole = make_whole(packing);
    // Atoms of one point take no bits but the flag that ends each.
    const unsigned bits = whole.apart ? MIN_BITS : whole.digits.bits + 1;
    if ((double)packing->atoms * (bits < MIN_BITS ? bits : MIN_BITS) > 8.0 * (double)bytes)
        return "too few bytes for the number of atoms";
    return NULL;
}

/// Whole numbers are kept as they are modulo 2^32: damaged ones may be any.
static inline void append(double position[3], const uint32_t number[3], double precision) {
    for (int d = 0; d < 3; d++)
        position[d] = (double)(int32_t)number[d] / precision;
}

/// What is after a whole atom: `run` atoms told by differences, in `level`.
static inline bool take_run(const struct digits *digits, const unsigned char *data, size_t *bit,
                            unsigned run, uint32_t whole[3], double precision,
                            double (*position)[3]) {
    const uint32_t middle = (uint32_t)digits->radix[0] / 2;
    uint32_t last[3] = {whole[0], whole[1], whole[2]};
    for (unsigned k = 0; k < run; k++) {
        uint32_t next[3];
        if (!take_digits(digits, data, bit, next))
            return false;
        for (int d = 0; d < 3; d++)
            next[d] += last[d] - middle;
        if (k == 0) { // the exchanged two: what follows is told from the first
            append(position[0], next, precision);
            append(position[1], whole, precision);
        } else {
            append(position[k + 1], next, precision);
        }
        memcpy(last, next, sizeof last);
    }
    return true;
}

const char *mf_xtc_unpack(const struct xtc_packing *packing, const unsigned char *data,
                          size_t bytes, double (*position)[3], size_t *damage) {
    struct digits levels[LEVELS];
    const struct whole whole = make_whole(packing);
    const double precision = packing->precision;
    size_t bit = 0, level = (size_t)packing->level;
    unsigned run = 0; // stays as it is until another one is told
    make_levels(levels);
    for (size_t atom = 0; atom < packing->atoms;) {
        uint32_t number[3], change = 1;
        *damage = bit / 8;
        if (bit > 8 * bytes || !take_whole(&whole, data, &bit, number))
            return "the packed coordinates are damaged";
        for (int d = 0; d < 3; d++)
            number[d] += (uint32_t)packing->min[d];
        if (take(data, &bit, 1)) {
            const uint32_t code = take(data, &bit, 5);
            change = code % 3; // 0: finer, 2: coarser from the next atom on
            run = code / 3;
        }
        if (run >= packing->atoms - atom)
            return "the packed coordinates are damaged";
        if (run == 0)
            append(position[atom], number, precision);
        else if (!take_run(&levels[level], data, &bit, run, number, precision, &position[atom]))
            return "the packed coordinates are damaged";
        atom += run + 1;
        level += change;
        level--;
        if (level < FIRST_LEVEL || level >= LEVELS)
            return "the packed coordinates are damaged";
    }
    *damage = bytes;
    const size_t used = (bit + 7) / 8;
    return used > bytes || bytes - used > 3 ? "the packed coordinates have the wrong length" : NULL;
}

// Writing -----------------------------------------------------------------------------------------

/// Atoms being packed: once to count the bits, and once more to write them.
struct packer {
    const struct xtc_frame *frame;
    struct xtc_packing packing; ///< its level is the finest, too
    struct whole whole;
    struct digits levels[LEVELS];
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
static void put_digits(struct packer *packer, const uint32_t digit[3],
                       const struct digits *digits) {
    unsigned bits = digits->bits;
    unsigned __int128 number = digit[0];
    number = (number * digits->radix[1] + digit[1]) * digits->radix[2] + digit[2];
    for (; bits >= 8; bits -= 8, number >>= 8)
        put_bits(packer, (uint32_t)number & 0xff, 8);
    put_bits(packer, (uint32_t)number, bits);
}

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
    return difference < (uint32_t)radices[level] / 2;
}

static int level_of(uint32_t difference) {
    int level = FIRST_LEVEL;
    while (level < LEVELS - 1 && !fits(difference, level))
        level++;
    return level;
}

static void put_whole(struct packer *packer, const int32_t place[3]) {
    uint32_t digit[3];
    for (int d = 0; d < 3; d++)
        digit[d] = (uint32_t)place[d] - (uint32_t)packer->packing.min[d];
    if (!packer->whole.apart)
        put_digits(packer, digit, &packer->whole.digits);
    for (int d = 0; packer->whole.apart && d < 3; d++)
        put_bits(packer, digit[d], packer->whole.bits[d]);
}

static void put_difference(struct packer *packer, const int32_t place[3], const int32_t from[3],
                           int level) {
    uint32_t digit[3];
    for (int d = 0; d < 3; d++)
        digit[d] = (uint32_t)place[d] - (uint32_t)from[d] + (uint32_t)radices[level] / 2;
    put_digits(packer, digit, &packer->levels[level]);
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
    if (wanted > level && (unsigned)wanted < packer->whole.digits.bits)
        return 1;
    return wanted < level && had < level && level > packer->packing.level ? -1 : 0;
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
    int level = packer->packing.level, previous = 0;
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

static void find_packing(struct packer *packer) {
    struct xtc_packing *const packing = &packer->packing;
    uint32_t nearest = UINT32_MAX;
    int32_t place[3], last[3] = {0};
    for (size_t k = 0; k < packer->frame->atoms; k++) {
        place_of(packer, k, place);
        for (int d = 0; d < 3; d++) {
            packing->min[d] = k == 0 || place[d] < packing->min[d] ? place[d] : packing->min[d];
            packing->max[d] = k == 0 || place[d] > packing->max[d] ? place[d] : packing->max[d];
        }
        const uint32_t difference = apart(place, last);
        nearest = k > 0 && difference < nearest ? difference : nearest;
        memcpy(last, place, sizeof last);
    }
    packing->level = level_of(nearest);
    packer->whole = make_whole(packing);
    make_levels(packer->levels);
}

static void put_packed(const struct xtc_frame *frame, FILE *stream) {
    struct packer packer = {.frame = frame};
    find_packing(&packer);
    binary_put_float(stream, PRECISION, true);
    for (int d = 0; d < 3; d++)
        binary_put(stream, (uint32_t)packer.packing.min[d], 4, true);
    for (int d = 0; d < 3; d++)
        binary_put(stream, (uint32_t)packer.packing.max[d], 4, true);
    binary_put(stream, (uint32_t)packer.packing.level, 4, true);
    put_atoms(&packer);
    const uint64_t bytes = packer.written / 8;
    binary_put(stream, bytes, 4, true);
    packer.stream = stream;
    put_atoms(&packer);
    for (uint64_t k = bytes; k % 4 != 0; k++)
        putc(0, stream);
}

void mf_xtc_write(const struct xtc_frame *frame, FILE *stream) {
    const int64_t step = frame->step > INT32_MAX ? INT32_MAX : frame->step;
    binary_put(stream, XTC_MAGIC, 4, true);
    binary_put(stream, frame->atoms, 4, true);
    binary_put(stream, (uint64_t)step, 4, true);
    binary_put_float(stream, frame->time, true);
    for (int k = 0; k < 9; k++)
        binary_put_float(stream, frame->box[k / 3][k % 3], true);
    binary_put(stream, frame->atoms, 4, true);
    if (frame->atoms > XTC_FEW_ATOMS) {
        put_packed(frame, stream);
        return;
    }
    for (size_t k = 0; k < frame->atoms; k++) {
        double position[3];
        frame->place(frame->context, k, position);
        for (int d = 0; d < 3; d++)
            binary_put_float(stream, position[d], true);
    }
}
