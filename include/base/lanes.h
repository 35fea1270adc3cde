// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Vectors of LANES numbers: the one place with intrinsics.
///
/// A kernel is written once on these types and compiled for each instruction set: a file that
/// selects one by a pragma (pair_avx2.c) includes this header and then the kernel. Arithmetic is
/// C's own: `a * b + c` works lane by lane, with numbers among the vectors too. Below are only the
/// operations for which C has no sign. The vectors have typedefs, unlike anything else here,
/// because the attribute cannot be written at each use.
#pragma once

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#if defined(__AVX512F__)
#define LANES 16
#elif defined(__AVX2__)
#define LANES 8
#else
#define LANES 4
#endif

// All is inlined, so how a vector would be passed to a function does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"
#define LANES_INLINE static inline __attribute__((always_inline))

typedef float lanes_float __attribute__((vector_size(4 * LANES)));
typedef int32_t lanes_int __attribute__((vector_size(4 * LANES)));
typedef uint32_t lanes_uint __attribute__((vector_size(4 * LANES)));
typedef uint64_t lanes_wide __attribute__((vector_size(4 * LANES))); ///< half as many
typedef double lanes_double4 __attribute__((vector_size(32)));

/// The same number in every lane.
LANES_INLINE lanes_float lanes_all(float x) {
    return x - (lanes_float){0};
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
LANES_INLINE lanes_float lanes_load(const float *from) {
    lanes_float a;
    memcpy(&a, from, sizeof a);
    return a;
}

LANES_INLINE lanes_int lanes_load_int(const int32_t *from) {
    lanes_int a;
    memcpy(&a, from, sizeof a);
    return a;
}

LANES_INLINE void lanes_store(float *to, lanes_float a) {
    memcpy(to, &a, sizeof a);
}

LANES_INLINE void lanes_store_int(int32_t *to, lanes_int a) {
    memcpy(to, &a, sizeof a);
}

/// a − from[n] with wrap-around.
LANES_INLINE lanes_int lanes_difference(int32_t a, const int32_t *from) {
    return (lanes_int)((uint32_t)a - (lanes_uint)lanes_load_int(from));
}

LANES_INLINE lanes_float lanes_to_float(lanes_int a) {
    return __builtin_convertvector(a, lanes_float);
}

/// Rounded towards 0.
LANES_INLINE lanes_int lanes_to_int(lanes_float a) {
    return __builtin_convertvector(a, lanes_int);
}

/// Σ of all lanes.
LANES_INLINE float lanes_sum(lanes_float a) {
    float sum = 0;
    for (int lane = 0; lane < LANES; lane++)
        sum += a[lane];
    return sum;
}

/// The first `count` lanes, all if there are fewer, as bits.
LANES_INLINE unsigned lanes_first(size_t count) {
#if defined(__BMI2__)
    return (unsigned)_bzhi_u64(~UINT64_C(0), (unsigned)(count < 64 ? count : 64)); // no branch
#else
    return count < LANES ? (1u << count) - 1 : ~0u;
#endif
}

// What each instruction set says in its own way. Masks are the bits of an unsigned: bit n stands
// for lane n.
//   lanes_below(a, b)        in which lanes a < b; never where one is NaN
//   lanes_sqrt(a)
//   lanes_least(a, b)        the smaller of two; b where a is NaN
//   lanes_least_int, lanes_most_int
//   lanes_set_bits(mask)     numbers of the bits that are set, in order; the rest is arbitrary
//   lanes_permute(a, order)  lane n becomes lane order[n] of a
//   lanes_eights(a, b)       a in the first eight lanes, b in the next, as far as there are any
//   lanes_multiply_low(a, b) 64-bit products of the lower halves
//   lanes_row(records, index)    records number index[0], index[4], … one after the other
//   lanes_store_row(to, row)     and back, to every fourth record
//   LANES_ZIP_LOW …              exchanges within blocks of four lanes, see lanes_transposed
#if LANES == 16

LANES_INLINE unsigned lanes_below(lanes_float a, lanes_float b) {
    return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_LT_OQ);
}

LANES_INLINE lanes_float lanes_sqrt(lanes_float a) {
    return (lanes_float)_mm512_sqrt_ps((__m512)a);
}

LANES_INLINE lanes_float lanes_least(lanes_float a, lanes_float b) {
    return (lanes_float)_mm512_min_ps((__m512)a, (__m512)b);
}

LANES_INLINE lanes_int lanes_least_int(lanes_int a, lanes_int b) {
    return (lanes_int)_mm512_min_epi32((__m512i)a, (__m512i)b);
}

LANES_INLINE lanes_int lanes_most_int(lanes_int a, lanes_int b) {
    return (lanes_int)_mm512_max_epi32((__m512i)a, (__m512i)b);
}

LANES_INLINE lanes_int lanes_set_bits(unsigned mask) {
    return (lanes_int)_mm512_maskz_compress_epi32((__mmask16)mask, (__m512i)lanes_number());
}

LANES_INLINE lanes_float lanes_permute(lanes_float a, lanes_int order) {
    return (lanes_float)_mm512_permutexvar_ps((__m512i)order, (__m512)a);
}

LANES_INLINE lanes_int lanes_eights(int32_t a, int32_t b) {
    return (lanes_int)_mm512_mask_set1_epi32(_mm512_set1_epi32(a), 0xFF00, b);
}

LANES_INLINE lanes_wide lanes_multiply_low(lanes_wide a, lanes_wide b) {
    return (lanes_wide)_mm512_mul_epu32((__m512i)a, (__m512i)b);
}

LANES_INLINE lanes_float lanes_row(const float (*records)[4], const int32_t *index) {
    __m512 row = _mm512_castps128_ps512(_mm_loadu_ps(records[index[0]]));
    row = _mm512_insertf32x4(row, _mm_loadu_ps(records[index[4]]), 1);
    row = _mm512_insertf32x4(row, _mm_loadu_ps(records[index[8]]), 2);
    return (lanes_float)_mm512_insertf32x4(row, _mm_loadu_ps(records[index[12]]), 3);
}

LANES_INLINE void lanes_store_row(float (*to)[4], lanes_float row) {
    _mm_storeu_ps(to[0], _mm512_castps512_ps128((__m512)row));
    _mm_storeu_ps(to[4], _mm512_extractf32x4_ps((__m512)row, 1));
    _mm_storeu_ps(to[8], _mm512_extractf32x4_ps((__m512)row, 2));
    _mm_storeu_ps(to[12], _mm512_extractf32x4_ps((__m512)row, 3));
}

#define LANES_ZIP_LOW(a, b) (lanes_float) _mm512_unpacklo_ps((__m512)(a), (__m512)(b))
#define LANES_ZIP_HIGH(a, b) (lanes_float) _mm512_unpackhi_ps((__m512)(a), (__m512)(b))
#define LANES_PAIR_LOW(a, b) (lanes_float) _mm512_unpacklo_pd((__m512d)(a), (__m512d)(b))
#define LANES_PAIR_HIGH(a, b) (lanes_float) _mm512_unpackhi_pd((__m512d)(a), (__m512d)(b))

#elif LANES == 8

LANES_INLINE unsigned lanes_below(lanes_float a, lanes_float b) {
    return (unsigned)_mm256_movemask_ps(_mm256_cmp_ps((__m256)a, (__m256)b, _CMP_LT_OQ));
}

LANES_INLINE lanes_float lanes_sqrt(lanes_float a) {
    return (lanes_float)_mm256_sqrt_ps((__m256)a);
}

LANES_INLINE lanes_float lanes_least(lanes_float a, lanes_float b) {
    return (lanes_float)_mm256_min_ps((__m256)a, (__m256)b);
}

LANES_INLINE lanes_int lanes_least_int(lanes_int a, lanes_int b) {
    return (lanes_int)_mm256_min_epi32((__m256i)a, (__m256i)b);
}

LANES_INLINE lanes_int lanes_most_int(lanes_int a, lanes_int b) {
    return (lanes_int)_mm256_max_epi32((__m256i)a, (__m256i)b);
}

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

LANES_INLINE lanes_float lanes_permute(lanes_float a, lanes_int order) {
    return (lanes_float)_mm256_permutevar8x32_ps((__m256)a, (__m256i)order);
}

LANES_INLINE lanes_int lanes_eights(int32_t a, int32_t b) {
    (void)b;
    return lanes_all_int(a);
}

LANES_INLINE lanes_wide lanes_multiply_low(lanes_wide a, lanes_wide b) {
    return (lanes_wide)_mm256_mul_epu32((__m256i)a, (__m256i)b);
}

LANES_INLINE lanes_float lanes_row(const float (*records)[4], const int32_t *index) {
    const __m256 row = _mm256_castps128_ps256(_mm_loadu_ps(records[index[0]]));
    return (lanes_float)_mm256_insertf128_ps(row, _mm_loadu_ps(records[index[4]]), 1);
}

LANES_INLINE void lanes_store_row(float (*to)[4], lanes_float row) {
    _mm_storeu_ps(to[0], _mm256_castps256_ps128((__m256)row));
    _mm_storeu_ps(to[4], _mm256_extractf128_ps((__m256)row, 1));
}

#define LANES_ZIP_LOW(a, b) (lanes_float) _mm256_unpacklo_ps((__m256)(a), (__m256)(b))
#define LANES_ZIP_HIGH(a, b) (lanes_float) _mm256_unpackhi_ps((__m256)(a), (__m256)(b))
#define LANES_PAIR_LOW(a, b) (lanes_float) _mm256_unpacklo_pd((__m256d)(a), (__m256d)(b))
#define LANES_PAIR_HIGH(a, b) (lanes_float) _mm256_unpackhi_pd((__m256d)(a), (__m256d)(b))

#else // plain C, but for two places where x86 has the instruction and GCC does not find it

LANES_INLINE unsigned lanes_below(lanes_float a, lanes_float b) {
#if defined(__SSE2__)
    return (unsigned)_mm_movemask_ps(_mm_cmplt_ps((__m128)a, (__m128)b));
#else
    const lanes_int below = a < b;
    return (unsigned)(-below[0] - 2 * below[1] - 4 * below[2] - 8 * below[3]);
#endif
}

LANES_INLINE lanes_float lanes_sqrt(lanes_float a) {
    return (lanes_float){sqrtf(a[0]), sqrtf(a[1]), sqrtf(a[2]), sqrtf(a[3])};
}

LANES_INLINE lanes_float lanes_least(lanes_float a, lanes_float b) {
    const lanes_int less = a < b;
    return (lanes_float)((less & (lanes_int)a) | (~less & (lanes_int)b));
}

LANES_INLINE lanes_int lanes_least_int(lanes_int a, lanes_int b) {
    const lanes_int less = a < b;
    return (less & a) | (~less & b);
}

LANES_INLINE lanes_int lanes_most_int(lanes_int a, lanes_int b) {
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

LANES_INLINE lanes_float lanes_permute(lanes_float a, lanes_int order) {
    return (lanes_float){a[order[0]], a[order[1]], a[order[2]], a[order[3]]};
}

LANES_INLINE lanes_int lanes_eights(int32_t a, int32_t b) {
    (void)b;
    return lanes_all_int(a);
}

LANES_INLINE lanes_wide lanes_multiply_low(lanes_wide a, lanes_wide b) {
#if defined(__SSE2__)
    return (lanes_wide)_mm_mul_epu32((__m128i)a, (__m128i)b);
#else
    return (a & 0xFFFFFFFF) * (b & 0xFFFFFFFF);
#endif
}

LANES_INLINE lanes_float lanes_row(const float (*records)[4], const int32_t *index) {
    return lanes_load(records[index[0]]);
}

LANES_INLINE void lanes_store_row(float (*to)[4], lanes_float row) {
    lanes_store(to[0], row);
}

#define LANES_ZIP_LOW(a, b) ((lanes_float){(a)[0], (b)[0], (a)[1], (b)[1]})
#define LANES_ZIP_HIGH(a, b) ((lanes_float){(a)[2], (b)[2], (a)[3], (b)[3]})
#define LANES_PAIR_LOW(a, b) ((lanes_float){(a)[0], (a)[1], (b)[0], (b)[1]})
#define LANES_PAIR_HIGH(a, b) ((lanes_float){(a)[2], (a)[3], (b)[2], (b)[3]})

#endif

LANES_INLINE lanes_int lanes_permute_int(lanes_int a, lanes_int order) {
    return (lanes_int)lanes_permute((lanes_float)a, order);
}

/// Four words for each lane.
struct lanes_record {
    lanes_float word[4];
};

/// Exchange rows and columns in blocks of 4 × 4.
LANES_INLINE struct lanes_record lanes_transposed(lanes_float a, lanes_float b, lanes_float c,
                                                  lanes_float d) {
    const lanes_float ab_low = LANES_ZIP_LOW(a, b), ab_high = LANES_ZIP_HIGH(a, b);
    const lanes_float cd_low = LANES_ZIP_LOW(c, d), cd_high = LANES_ZIP_HIGH(c, d);
    return (struct lanes_record){{LANES_PAIR_LOW(ab_low, cd_low), LANES_PAIR_HIGH(ab_low, cd_low),
                                  LANES_PAIR_LOW(ab_high, cd_high),
                                  LANES_PAIR_HIGH(ab_high, cd_high)}};
}

/// Records number index[0 … LANES − 1] of an array of records of 16 bytes: one for each lane.
/// Whole records are loaded and transposed: gather instructions take four times as long on Zen 3.
LANES_INLINE struct lanes_record lanes_load_records(const void *records, const int32_t *index) {
    return lanes_transposed(lanes_row(records, index), lanes_row(records, index + 1),
                            lanes_row(records, index + 2), lanes_row(records, index + 3));
}

/// Store LANES records (x, y, z, 0), one after the other.
LANES_INLINE void lanes_store_records(float (*to)[4], lanes_float x, lanes_float y, lanes_float z) {
    const struct lanes_record row = lanes_transposed(x, y, z, lanes_all(0));
    for (int k = 0; k < 4; k++)
        lanes_store_row(to + k, row.word[k]);
}

/// Four floats as doubles.
LANES_INLINE lanes_double4 lanes_load_double4(const float from[4]) {
#if defined(__AVX__)
    return (lanes_double4)_mm256_cvtps_pd(_mm_loadu_ps(from)); // GCC would make five of this one
#else
    return (lanes_double4){from[0], from[1], from[2], from[3]};
#endif
}
