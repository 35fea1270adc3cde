// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/xtc_coordinates.h"

#include "io/xtc.h"
#include "trajectory/binary.h"

#include <math.h>
#include <stdbool.h>

enum { MIN_BITS = 9 };

/// Three digits in one number of `bits` bits: (x radix[1] + y) radix[2] + z.
struct digits {
    unsigned bits;
    uint64_t radix[3];
    uint64_t inverse[3]; ///< floor((2^64 − 1)/radix)
};

static unsigned bit_length(uint64_t number) {
    return number ? 64 - (unsigned)__builtin_clzll(number) : 0;
}

static struct digits make_digits(uint64_t x, uint64_t y, uint64_t z) {
    struct digits digits = {.radix = {x, y, z}};
    for (int d = 0; d < 3; d++)
        digits.inverse[d] = UINT64_MAX / digits.radix[d];
    const unsigned __int128 product = (unsigned __int128)(x * y) * z;
    const uint64_t high = (uint64_t)(product >> 64);
    digits.bits = high ? 64 + bit_length(high) : bit_length((uint64_t)product);
    return digits;
}

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
    if (!whole.apart)
        whole.digits = make_digits(range[0], range[1], range[2]);
    return whole;
}

static inline bool take_whole(const struct whole *whole, const unsigned char *data, size_t *bit,
                              uint32_t number[3]) {
    if (!whole->apart)
        return take_digits(&whole->digits, data, bit, number);
    for (int d = 0; d < 3; d++)
        number[d] = take(data, bit, whole->bits[d]);
    return true;
}

const char *mf_xtc_coordinates_check(const struct xtc_packing *packing, size_t bytes) {
    if (!(packing->precision > 0 && isfinite(packing->precision)))
        return "the precision of the coordinates is not positive";
    if (packing->level < XTC_FIRST_LEVEL || packing->level >= XTC_LEVELS)
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

static void make_levels(struct digits levels[XTC_LEVELS]) {
    for (unsigned k = XTC_FIRST_LEVEL; k < XTC_LEVELS; k++) {
        const uint64_t radix = (uint64_t)mf_xtc_radix[k];
        levels[k] = make_digits(radix, radix, radix);
        levels[k].bits = k;
    }
}

const char *mf_xtc_coordinates_unpack(const struct xtc_packing *packing, const unsigned char *data,
                                      size_t bytes, double (*position)[3], size_t *damage) {
    struct digits levels[XTC_LEVELS];
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
        if (level < XTC_FIRST_LEVEL || level >= XTC_LEVELS)
            return "the packed coordinates are damaged";
    }
    *damage = bytes;
    const size_t used = (bit + 7) / 8;
    return used > bytes || bytes - used > 3 ? "the packed coordinates have the wrong length" : NULL;
}
