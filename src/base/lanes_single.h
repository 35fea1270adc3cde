// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Lanes of floats. Included by lanes.h, which says what the functions do.
#pragma once

#if LANES == 16

LANES_INLINE unsigned lanes_below(lanes_real a, lanes_real b) {
    return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_LT_OQ);
}

LANES_INLINE lanes_real lanes_sqrt(lanes_real a) {
    return (lanes_real)_mm512_sqrt_ps((__m512)a);
}

LANES_INLINE lanes_real lanes_min(lanes_real a, lanes_real b) {
    return (lanes_real)_mm512_min_ps((__m512)a, (__m512)b);
}

LANES_INLINE lanes_real lanes_permute(lanes_real a, lanes_int order) {
    return (lanes_real)_mm512_permutexvar_ps((__m512i)order, (__m512)a);
}

LANES_INLINE lanes_real lanes_row(const float (*records)[4], const int32_t *index) {
    __m512 row = _mm512_castps128_ps512(_mm_loadu_ps(records[index[0]]));
    row = _mm512_insertf32x4(row, _mm_loadu_ps(records[index[4]]), 1);
    row = _mm512_insertf32x4(row, _mm_loadu_ps(records[index[8]]), 2);
    return (lanes_real)_mm512_insertf32x4(row, _mm_loadu_ps(records[index[12]]), 3);
}

LANES_INLINE void lanes_store_row(float (*to)[4], lanes_real row) {
    _mm_storeu_ps(to[0], _mm512_castps512_ps128((__m512)row));
    _mm_storeu_ps(to[4], _mm512_extractf32x4_ps((__m512)row, 1));
    _mm_storeu_ps(to[8], _mm512_extractf32x4_ps((__m512)row, 2));
    _mm_storeu_ps(to[12], _mm512_extractf32x4_ps((__m512)row, 3));
}

#define LANES_ZIP_LOW(a, b) (lanes_real) _mm512_unpacklo_ps((__m512)(a), (__m512)(b))
#define LANES_ZIP_HIGH(a, b) (lanes_real) _mm512_unpackhi_ps((__m512)(a), (__m512)(b))
#define LANES_PAIR_LOW(a, b) (lanes_real) _mm512_unpacklo_pd((__m512d)(a), (__m512d)(b))
#define LANES_PAIR_HIGH(a, b) (lanes_real) _mm512_unpackhi_pd((__m512d)(a), (__m512d)(b))

#elif LANES == 8

LANES_INLINE unsigned lanes_below(lanes_real a, lanes_real b) {
    return (unsigned)_mm256_movemask_ps(_mm256_cmp_ps((__m256)a, (__m256)b, _CMP_LT_OQ));
}

LANES_INLINE lanes_real lanes_sqrt(lanes_real a) {
    return (lanes_real)_mm256_sqrt_ps((__m256)a);
}

LANES_INLINE lanes_real lanes_min(lanes_real a, lanes_real b) {
    return (lanes_real)_mm256_min_ps((__m256)a, (__m256)b);
}

LANES_INLINE lanes_real lanes_permute(lanes_real a, lanes_int order) {
    return (lanes_real)_mm256_permutevar8x32_ps((__m256)a, (__m256i)order);
}

LANES_INLINE lanes_real lanes_row(const float (*records)[4], const int32_t *index) {
    const __m256 row = _mm256_castps128_ps256(_mm_loadu_ps(records[index[0]]));
    return (lanes_real)_mm256_insertf128_ps(row, _mm_loadu_ps(records[index[4]]), 1);
}

LANES_INLINE void lanes_store_row(float (*to)[4], lanes_real row) {
    _mm_storeu_ps(to[0], _mm256_castps256_ps128((__m256)row));
    _mm_storeu_ps(to[4], _mm256_extractf128_ps((__m256)row, 1));
}

#define LANES_ZIP_LOW(a, b) (lanes_real) _mm256_unpacklo_ps((__m256)(a), (__m256)(b))
#define LANES_ZIP_HIGH(a, b) (lanes_real) _mm256_unpackhi_ps((__m256)(a), (__m256)(b))
#define LANES_PAIR_LOW(a, b) (lanes_real) _mm256_unpacklo_pd((__m256d)(a), (__m256d)(b))
#define LANES_PAIR_HIGH(a, b) (lanes_real) _mm256_unpackhi_pd((__m256d)(a), (__m256d)(b))

#else // plain C, but for a place where x86 has the instruction and GCC does not find it

LANES_INLINE unsigned lanes_below(lanes_real a, lanes_real b) {
#if defined(__SSE2__)
    return (unsigned)_mm_movemask_ps(_mm_cmplt_ps((__m128)a, (__m128)b));
#else
    const lanes_int below = a < b;
    return (unsigned)(-below[0] - 2 * below[1] - 4 * below[2] - 8 * below[3]);
#endif
}

LANES_INLINE lanes_real lanes_sqrt(lanes_real a) {
    return (lanes_real){sqrtf(a[0]), sqrtf(a[1]), sqrtf(a[2]), sqrtf(a[3])};
}

LANES_INLINE lanes_real lanes_min(lanes_real a, lanes_real b) {
    const lanes_int less = a < b;
    return (lanes_real)((less & (lanes_int)a) | (~less & (lanes_int)b));
}

LANES_INLINE lanes_real lanes_permute(lanes_real a, lanes_int order) {
    return (lanes_real){a[order[0]], a[order[1]], a[order[2]], a[order[3]]};
}

LANES_INLINE lanes_real lanes_row(const float (*records)[4], const int32_t *index) {
    return lanes_load(records[index[0]]);
}

LANES_INLINE void lanes_store_row(float (*to)[4], lanes_real row) {
    lanes_store(to[0], row);
}

#define LANES_ZIP_LOW(a, b) ((lanes_real){(a)[0], (b)[0], (a)[1], (b)[1]})
#define LANES_ZIP_HIGH(a, b) ((lanes_real){(a)[2], (b)[2], (a)[3], (b)[3]})
#define LANES_PAIR_LOW(a, b) ((lanes_real){(a)[0], (a)[1], (b)[0], (b)[1]})
#define LANES_PAIR_HIGH(a, b) ((lanes_real){(a)[2], (a)[3], (b)[2], (b)[3]})

#endif

LANES_INLINE lanes_int lanes_permute_int(lanes_int a, lanes_int order) {
    return (lanes_int)lanes_permute((lanes_real)a, order);
}

LANES_INLINE struct lanes_record lanes_transposed(lanes_real a, lanes_real b, lanes_real c,
                                                  lanes_real d) {
    const lanes_real ab_low = LANES_ZIP_LOW(a, b), ab_high = LANES_ZIP_HIGH(a, b);
    const lanes_real cd_low = LANES_ZIP_LOW(c, d), cd_high = LANES_ZIP_HIGH(c, d);
    return (struct lanes_record){{LANES_PAIR_LOW(ab_low, cd_low), LANES_PAIR_HIGH(ab_low, cd_low),
                                  LANES_PAIR_LOW(ab_high, cd_high),
                                  LANES_PAIR_HIGH(ab_high, cd_high)}};
}

LANES_INLINE lanes_double4 lanes_load_double4(const float from[4]) {
#if defined(__AVX__)
    return (lanes_double4)_mm256_cvtps_pd(_mm_loadu_ps(from)); // GCC would make five of this one
#else
    return (lanes_double4){from[0], from[1], from[2], from[3]};
#endif
}
