// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Vectors of LANES numbers: the one place with intrinsics, with lanes_single.h and
/// lanes_double.h.
///
/// A kernel is written once on these types and compiled for each instruction set: a file that
/// selects one by a pragma (pair_avx2.c) includes this header and then the kernel. A lane's real
/// number, REAL, is a float; a file that defines LANES_DOUBLE before this header gets doubles
/// (pair_avx2_double.c). Arithmetic is C's own: `a * b + c` works lane by lane, with numbers among
/// the vectors too. Below are only the operations for which C has no sign. The vectors have
/// typedefs, unlike anything else here, because the attribute cannot be written at each use.
#pragma once

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

/// Bytes of a register.
#if defined(__AVX512F__)
#define LANES_BYTES 64
#elif defined(__AVX2__)
#define LANES_BYTES 32
#else
#define LANES_BYTES 16
#endif

// Four lanes at least, as many as a record has words: GCC splits what a register cannot hold.
#if defined(LANES_DOUBLE)
#define REAL double
#define LANES (LANES_BYTES == 64 ? 8 : 4)
#else
#define REAL float
#define LANES (LANES_BYTES / 4)
#endif

#define LANES_INLINE static inline __attribute__((always_inline))

typedef REAL lanes_real __attribute__((vector_size(sizeof(REAL) * LANES)));
typedef int32_t lanes_int __attribute__((vector_size(4 * LANES)));
typedef uint32_t lanes_uint __attribute__((vector_size(4 * LANES)));
typedef float lanes_float __attribute__((vector_size(4 * LANES)));     ///< whatever REAL is
typedef uint64_t lanes_wide __attribute__((vector_size(LANES_BYTES))); ///< a register, always
typedef double lanes_double4 __attribute__((vector_size(32)));

/// The same number in every lane.
LANES_INLINE lanes_real lanes_all(REAL x) {
    return x - (lanes_real){0};
}

LANES_INLINE lanes_int lanes_all_int(int32_t x) {
    return x - (lanes_int){0};
}

/// 0, 1, 2, …
LANES_INLINE lanes_int lanes_number(void) {
    lanes_int number = {0};
    for (int lane = 0; lane < LANES; lane++)
        number[lane] = lane;
    return number;
}

// Loads and stores need no alignment.
LANES_INLINE lanes_real lanes_load(const REAL *from) {
    lanes_real a;
    memcpy(&a, from, sizeof a);
    return a;
}

LANES_INLINE lanes_int lanes_load_int(const int32_t *from) {
    lanes_int a;
    memcpy(&a, from, sizeof a);
    return a;
}

LANES_INLINE void lanes_store(REAL *to, lanes_real a) {
    memcpy(to, &a, sizeof a);
}

LANES_INLINE void lanes_store_int(int32_t *to, lanes_int a) {
    memcpy(to, &a, sizeof a);
}

LANES_INLINE lanes_wide lanes_load_wide(const int32_t *from) {
    lanes_wide a;
    memcpy(&a, from, sizeof a);
    return a;
}

LANES_INLINE void lanes_store_wide(int32_t *to, lanes_wide a) {
    memcpy(to, &a, sizeof a);
}

LANES_INLINE lanes_real lanes_to_real(lanes_int a) {
    return __builtin_convertvector(a, lanes_real);
}

LANES_INLINE lanes_float lanes_to_float(lanes_int a) {
    return __builtin_convertvector(a, lanes_float);
}

/// Rounded towards 0.
LANES_INLINE lanes_int lanes_to_int(lanes_real a) {
    return __builtin_convertvector(a, lanes_int);
}

/// The nearest integers to numbers below 2²² (of floats; 2⁵¹ of doubles) in size: adding and
/// subtracting a large number leaves no room for a fraction.
LANES_INLINE lanes_real lanes_nearest(lanes_real a) {
    const REAL large = sizeof(REAL) == 4 ? (REAL)0x1.8p23 : (REAL)0x1.8p52;
    return a + large - large;
}

/// Σ of all lanes.
LANES_INLINE REAL lanes_sum(lanes_real a) {
    REAL sum = 0;
    for (int lane = 0; lane < LANES; lane++)
        sum += a[lane];
    return sum;
}

// What each instruction set says in its own way: of integers here, of reals in lanes_single.h and
// lanes_double.h. Masks are the bits of an unsigned: bit n stands for lane n.
//   lanes_min_int, lanes_max_int
//   lanes_set_bits(mask)     numbers of the bits that are set, in order; the rest is arbitrary
//   lanes_eights(a, b)       a in the first eight lanes, b in the next, as far as there are any
//   lanes_multiply_low(a, b) 64-bit products of the lower halves
#if LANES == 16

LANES_INLINE lanes_int lanes_min_int(lanes_int a, lanes_int b) {
    return (lanes_int)_mm512_min_epi32((__m512i)a, (__m512i)b);
}

LANES_INLINE lanes_int lanes_max_int(lanes_int a, lanes_int b) {
    return (lanes_int)_mm512_max_epi32((__m512i)a, (__m512i)b);
}

LANES_INLINE lanes_int lanes_set_bits(unsigned mask) {
    return (lanes_int)_mm512_maskz_compress_epi32((__mmask16)mask, (__m512i)lanes_number());
}

LANES_INLINE lanes_int lanes_eights(int32_t a, int32_t b) {
    return (lanes_int)_mm512_mask_set1_epi32(_mm512_set1_epi32(a), 0xFF00, b);
}

#elif LANES == 8

LANES_INLINE lanes_int lanes_min_int(lanes_int a, lanes_int b) {
    return (lanes_int)_mm256_min_epi32((__m256i)a, (__m256i)b);
}

LANES_INLINE lanes_int lanes_max_int(lanes_int a, lanes_int b) {
    return (lanes_int)_mm256_max_epi32((__m256i)a, (__m256i)b);
}

#if defined(__AVX512VL__)

LANES_INLINE lanes_int lanes_set_bits(unsigned mask) {
    return (lanes_int)_mm256_maskz_compress_epi32((__mmask8)mask, (__m256i)lanes_number());
}

#else

// Byte n of entry m is the number of the n-th set bit of m. From a table: pext makes it in three
// instructions, but takes hundreds of cycles on Zen 1 and 2.
#define LANES_BIT(m, bit)                                                                          \
    ((uint64_t)((m) >> (bit)&1) * (bit) << 8 * __builtin_popcount((m) & ((1 << (bit)) - 1)))
#define LANES_BITS(m)                                                                              \
    (LANES_BIT(m, 1) | LANES_BIT(m, 2) | LANES_BIT(m, 3) | LANES_BIT(m, 4) | LANES_BIT(m, 5) |     \
     LANES_BIT(m, 6) | LANES_BIT(m, 7))
#define LANES_BITS4(m) LANES_BITS(m), LANES_BITS(m + 1), LANES_BITS(m + 2), LANES_BITS(m + 3)
#define LANES_BITS16(m) LANES_BITS4(m), LANES_BITS4(m + 4), LANES_BITS4(m + 8), LANES_BITS4(m + 12)
#define LANES_BITS64(m)                                                                            \
    LANES_BITS16(m), LANES_BITS16(m + 16), LANES_BITS16(m + 32), LANES_BITS16(m + 48)
static const uint64_t lanes_bits[256] = {LANES_BITS64(0), LANES_BITS64(64), LANES_BITS64(128),
                                         LANES_BITS64(192)};

LANES_INLINE lanes_int lanes_set_bits(unsigned mask) {
    return (lanes_int)_mm256_cvtepu8_epi32(_mm_loadl_epi64((const __m128i *)&lanes_bits[mask]));
}

#endif

LANES_INLINE lanes_int lanes_eights(int32_t a, int32_t b) {
    (void)b;
    return lanes_all_int(a);
}

#else

LANES_INLINE lanes_int lanes_min_int(lanes_int a, lanes_int b) {
    const lanes_int less = a < b;
    return (less & a) | (~less & b);
}

LANES_INLINE lanes_int lanes_max_int(lanes_int a, lanes_int b) {
    const lanes_int less = a < b;
    return (less & b) | (~less & a);
}

static const lanes_int lanes_bits[16] = {
    {0}, {0},    {1},    {0, 1},    {2},    {0, 2},    {1, 2},    {0, 1, 2},
    {3}, {0, 3}, {1, 3}, {0, 1, 3}, {2, 3}, {0, 2, 3}, {1, 2, 3}, {0, 1, 2, 3},
};

LANES_INLINE lanes_int lanes_set_bits(unsigned mask) {
    return lanes_bits[mask];
}

LANES_INLINE lanes_int lanes_eights(int32_t a, int32_t b) {
    (void)b;
    return lanes_all_int(a);
}

#endif

LANES_INLINE lanes_wide lanes_multiply_low(lanes_wide a, lanes_wide b) {
#if LANES_BYTES == 64
    return (lanes_wide)_mm512_mul_epu32((__m512i)a, (__m512i)b);
#elif LANES_BYTES == 32
    return (lanes_wide)_mm256_mul_epu32((__m256i)a, (__m256i)b);
#elif defined(__SSE2__)
    return (lanes_wide)_mm_mul_epu32((__m128i)a, (__m128i)b);
#else
    return (a & 0xFFFFFFFF) * (b & 0xFFFFFFFF);
#endif
}

/// Four words for each lane.
struct lanes_record {
    lanes_real word[4];
};

// Of reals:
//   lanes_below(a, b)        in which lanes a < b; never where one is NaN
//   lanes_sqrt(a)
//   lanes_min(a, b)        the smaller of two; b where a is NaN
//   lanes_permute(a, order), lanes_permute_int    lane n becomes lane order[n] of a
//   lanes_row(records, index)    records number index[0], index[4], … one after the other
//   lanes_store_row(to, row)     and back, to every fourth record
//   lanes_transposed(a, b, c, d) rows and columns exchanged in blocks of 4 × 4
//   lanes_load_double4(from)     four reals as doubles
#if defined(LANES_DOUBLE)
#include "base/lanes_double.h"
#else
#include "base/lanes_single.h"
#endif

/// Records number index[0 … LANES − 1] of an array of records of four words: one for each lane.
/// Whole records are loaded and transposed: gather instructions take four times as long on Zen 3.
LANES_INLINE struct lanes_record lanes_load_records(const void *records, const int32_t *index) {
    return lanes_transposed(lanes_row(records, index), lanes_row(records, index + 1),
                            lanes_row(records, index + 2), lanes_row(records, index + 3));
}

/// Store LANES records (a, b, c, d), one after the other.
LANES_INLINE void lanes_store_records(REAL (*to)[4], lanes_real a, lanes_real b, lanes_real c,
                                      lanes_real d) {
    const struct lanes_record row = lanes_transposed(a, b, c, d);
    for (int k = 0; k < 4; k++)
        lanes_store_row(to + k, row.word[k]);
}
