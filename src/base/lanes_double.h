// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Lanes of doubles. Included by lanes.h, which says what the functions do.
#pragma once

#if LANES == 8

LANES_INLINE unsigned lanes_below(lanes_real a, lanes_real b) {
    return _mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_LT_OQ);
}

LANES_INLINE lanes_real lanes_sqrt(lanes_real a) {
    return (lanes_real)_mm512_sqrt_pd((__m512d)a);
}

LANES_INLINE lanes_real lanes_min(lanes_real a, lanes_real b) {
    return (lanes_real)_mm512_min_pd((__m512d)a, (__m512d)b);
}

LANES_INLINE lanes_real lanes_permute(lanes_real a, lanes_int order) {
    return (lanes_real)_mm512_permutexvar_pd(_mm512_cvtepi32_epi64((__m256i)order), (__m512d)a);
}

LANES_INLINE lanes_int lanes_permute_int(lanes_int a, lanes_int order) {
    return (lanes_int)_mm256_permutevar8x32_epi32((__m256i)a, (__m256i)order);
}

LANES_INLINE lanes_real lanes_row(const double (*records)[4], const int32_t *index) {
    const __m512d row = _mm512_castpd256_pd512(_mm256_loadu_pd(records[index[0]]));
    return (lanes_real)_mm512_insertf64x4(row, _mm256_loadu_pd(records[index[4]]), 1);
}

LANES_INLINE void lanes_store_row(double (*to)[4], lanes_real row) {
    _mm256_storeu_pd(to[0], _mm512_castpd512_pd256((__m512d)row));
    _mm256_storeu_pd(to[4], _mm512_extractf64x4_pd((__m512d)row, 1));
}

#define LANES_ZIP_LOW(a, b) (lanes_real) _mm512_unpacklo_pd((__m512d)(a), (__m512d)(b))
#define LANES_ZIP_HIGH(a, b) (lanes_real) _mm512_unpackhi_pd((__m512d)(a), (__m512d)(b))
#define LANES_CHOOSE(a, b, ...)                                                                    \
    (lanes_real) _mm512_permutex2var_pd((__m512d)(a), _mm512_setr_epi64(__VA_ARGS__), (__m512d)(b))
#define LANES_HALF_LOW(a, b) LANES_CHOOSE(a, b, 0, 1, 8, 9, 4, 5, 12, 13)
#define LANES_HALF_HIGH(a, b) LANES_CHOOSE(a, b, 2, 3, 10, 11, 6, 7, 14, 15)

#elif defined(__AVX2__)

LANES_INLINE unsigned lanes_below(lanes_real a, lanes_real b) {
    return (unsigned)_mm256_movemask_pd(_mm256_cmp_pd((__m256d)a, (__m256d)b, _CMP_LT_OQ));
}

LANES_INLINE lanes_real lanes_sqrt(lanes_real a) {
    return (lanes_real)_mm256_sqrt_pd((__m256d)a);
}

LANES_INLINE lanes_real lanes_min(lanes_real a, lanes_real b) {
    return (lanes_real)_mm256_min_pd((__m256d)a, (__m256d)b);
}

/// As pairs of words 2n, 2n + 1: doubles can only be permuted in an order known beforehand.
LANES_INLINE lanes_real lanes_permute(lanes_real a, lanes_int order) {
    const lanes_wide even = 2 * (lanes_wide)_mm256_cvtepu32_epi64((__m128i)order);
    const lanes_wide words = even | (even + 1) << 32;
    return (lanes_real)_mm256_permutevar8x32_ps((__m256)a, (__m256i)words);
}

LANES_INLINE lanes_int lanes_permute_int(lanes_int a, lanes_int order) {
    return (lanes_int)_mm_permutevar_ps((__m128)a, (__m128i)order);
}

LANES_INLINE lanes_real lanes_row(const double (*records)[4], const int32_t *index) {
    return lanes_load(records[index[0]]);
}

LANES_INLINE void lanes_store_row(double (*to)[4], lanes_real row) {
    lanes_store(to[0], row);
}

#define LANES_ZIP_LOW(a, b) (lanes_real) _mm256_unpacklo_pd((__m256d)(a), (__m256d)(b))
#define LANES_ZIP_HIGH(a, b) (lanes_real) _mm256_unpackhi_pd((__m256d)(a), (__m256d)(b))
#define LANES_HALF_LOW(a, b) (lanes_real) _mm256_permute2f128_pd((__m256d)(a), (__m256d)(b), 0x20)
#define LANES_HALF_HIGH(a, b) (lanes_real) _mm256_permute2f128_pd((__m256d)(a), (__m256d)(b), 0x31)

#else // plain C

LANES_INLINE unsigned lanes_below(lanes_real a, lanes_real b) {
    return (unsigned)(a[0] < b[0]) | (unsigned)(a[1] < b[1]) << 1 | (unsigned)(a[2] < b[2]) << 2 |
           (unsigned)(a[3] < b[3]) << 3;
}

LANES_INLINE lanes_real lanes_sqrt(lanes_real a) {
    return (lanes_real){sqrt(a[0]), sqrt(a[1]), sqrt(a[2]), sqrt(a[3])};
}

LANES_INLINE lanes_real lanes_min(lanes_real a, lanes_real b) {
    return (lanes_real){a[0] < b[0] ? a[0] : b[0], a[1] < b[1] ? a[1] : b[1],
                        a[2] < b[2] ? a[2] : b[2], a[3] < b[3] ? a[3] : b[3]};
}

LANES_INLINE lanes_real lanes_permute(lanes_real a, lanes_int order) {
    return (lanes_real){a[order[0]], a[order[1]], a[order[2]], a[order[3]]};
}

LANES_INLINE lanes_int lanes_permute_int(lanes_int a, lanes_int order) {
    return (lanes_int){a[order[0]], a[order[1]], a[order[2]], a[order[3]]};
}

LANES_INLINE lanes_real lanes_row(const double (*records)[4], const int32_t *index) {
    return lanes_load(records[index[0]]);
}

LANES_INLINE void lanes_store_row(double (*to)[4], lanes_real row) {
    lanes_store(to[0], row);
}

#define LANES_ZIP_LOW(a, b) ((lanes_real){(a)[0], (b)[0], (a)[2], (b)[2]})
#define LANES_ZIP_HIGH(a, b) ((lanes_real){(a)[1], (b)[1], (a)[3], (b)[3]})
#define LANES_HALF_LOW(a, b) ((lanes_real){(a)[0], (a)[1], (b)[0], (b)[1]})
#define LANES_HALF_HIGH(a, b) ((lanes_real){(a)[2], (a)[3], (b)[2], (b)[3]})

#endif

LANES_INLINE struct lanes_record lanes_transposed(lanes_real a, lanes_real b, lanes_real c,
                                                  lanes_real d) {
    const lanes_real ab_even = LANES_ZIP_LOW(a, b), ab_odd = LANES_ZIP_HIGH(a, b);
    const lanes_real cd_even = LANES_ZIP_LOW(c, d), cd_odd = LANES_ZIP_HIGH(c, d);
    return (struct lanes_record){{LANES_HALF_LOW(ab_even, cd_even), LANES_HALF_LOW(ab_odd, cd_odd),
                                  LANES_HALF_HIGH(ab_even, cd_even),
                                  LANES_HALF_HIGH(ab_odd, cd_odd)}};
}

LANES_INLINE lanes_double4 lanes_load_double4(const double from[4]) {
    lanes_double4 a;
    memcpy(&a, from, sizeof a);
    return a;
}
