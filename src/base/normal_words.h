// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Standard normal numbers of many words, four at a time. Tested: test_normal.
#pragma once

#include "base/normal.h"

#include <stddef.h>

enum { NORMAL_WORDS = 64 }; ///< the most at once

/// ζ of `count` words, a multiple of four, at most NORMAL_WORDS: the same bits as normal_of_word.
/// Whole rows are loaded and transposed, which is faster than number by number.
/// @param[out] zeta  shape [count]
static inline __attribute__((always_inline)) void normal_of_words(const struct normal_table *table,
                                                                  const uint32_t *restrict word,
                                                                  size_t count,
                                                                  double *restrict zeta) {
    typedef double four __attribute__((vector_size(32)));
    double place[NORMAL_WORDS], sign[NORMAL_WORDS];
    int32_t row[NORMAL_WORDS];
    for (size_t k = 0; k < count; k++) {
        const int32_t negative = (int32_t)word[k] < 0 ? -1 : 0;
        const float tail = (float)((int32_t)word[k] ^ negative) + 0.5F;
        int32_t bits;
        memcpy(&bits, &tail, sizeof bits);
        place[k] = (bits & ((1 << NORMAL_BITS) - 1)) / (double)(1 << NORMAL_BITS);
        sign[k] = negative | 1;
        row[k] = (bits >> NORMAL_BITS) - NORMAL_FIRST;
    }
    for (size_t k = 0; k < count; k += 4) {
        four a, b, c, d, x, s;
        memcpy(&a, table->precise[row[k]], sizeof a);
        memcpy(&b, table->precise[row[k + 1]], sizeof b);
        memcpy(&c, table->precise[row[k + 2]], sizeof c);
        memcpy(&d, table->precise[row[k + 3]], sizeof d);
        memcpy(&x, place + k, sizeof x);
        memcpy(&s, sign + k, sizeof s);
        const four ab_even = {a[0], b[0], a[2], b[2]}, ab_odd = {a[1], b[1], a[3], b[3]};
        const four cd_even = {c[0], d[0], c[2], d[2]}, cd_odd = {c[1], d[1], c[3], d[3]};
        const four c0 = {ab_even[0], ab_even[1], cd_even[0], cd_even[1]};
        const four c1 = {ab_odd[0], ab_odd[1], cd_odd[0], cd_odd[1]};
        const four c2 = {ab_even[2], ab_even[3], cd_even[2], cd_even[3]};
        const four c3 = {ab_odd[2], ab_odd[3], cd_odd[2], cd_odd[3]};
        const four value = s * (c0 + x * (c1 + x * (c2 + x * c3)));
        memcpy(zeta + k, &value, sizeof value);
    }
}
