// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A standard normal number from one random word, by the inverse of the normal law.
///
/// The word, folded at its middle, is a number n = 0 … 2³¹ − 1 from the tail: |ζ| is the quantile
/// that is exceeded with the probability p = (n + ½) 2⁻³², and the sign is the word's. So ζ is
/// symmetric, and reaches 6.3. The quantile is a cubic in p in each of 8 pieces of an octave
/// of p, good to 3e-7. Vector kernels compute the same (forces/pair_steps.h). Tested: test_normal.
#pragma once

#include <stdint.h>
#include <string.h>

enum {
    NORMAL_PIECES = 8,                  ///< of an octave
    NORMAL_BITS = 20,                   ///< of a float's 23 that are left for the place in a piece
    NORMAL_FIRST = 126 * NORMAL_PIECES, ///< upper bits of the float ½
    NORMAL_ROWS = (158 - 126) * NORMAL_PIECES + 1 ///< up to the float 2³¹, where ζ is 0
};

struct normal_table {
    double precise[NORMAL_ROWS][4]; ///< coefficients of a cubic in the place 0 … 1 in a piece
    float single[NORMAL_ROWS][4];   ///< the same rounded
};

void mf_normal_table_init(struct normal_table *table);

/// ζ of a word, in the lanes of a vector loop.
static inline double normal_of_word(const struct normal_table *table, uint32_t word) {
    const int32_t sign = (int32_t)word < 0 ? -1 : 0;
    const float tail = (float)((int32_t)word ^ sign) + 0.5F;
    int32_t bits;
    memcpy(&bits, &tail, sizeof bits);
    const double *c = table->precise[(bits >> NORMAL_BITS) - NORMAL_FIRST];
    const double place = (bits & ((1 << NORMAL_BITS) - 1)) / (double)(1 << NORMAL_BITS);
    return (sign | 1) * (c[0] + place * (c[1] + place * (c[2] + place * c[3])));
}
