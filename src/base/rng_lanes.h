// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Philox for vector kernels.
#pragma once

#include "base/lanes.h"
#include "base/rng.h"

/// Numbers in a register, and how many rng_philox_lanes makes at a time: they are integers, so that
/// the precision of a kernel does not matter.
enum { RNG_WORDS = LANES_BYTES / 4, RNG_LANES = 2 * RNG_WORDS };

/// The first `words` words of Philox4x32-10 for RNG_LANES counters (c0, c1[n], c2[n], c3):
/// rng_philox_words of each.
/// @param[out] word  shape [words, stride]
///
/// Even and odd lanes go separately, in the lower halves of 64-bit words whose upper halves hold
/// rubbish. A round is a chain of seven cycles; the four chains side by side keep a processor busy.
/// Measured on Zen 3: 44 cycles for 8 numbers, with two chains 47, one number after another 193.
LANES_INLINE void rng_philox_lanes_words(uint32_t key0, uint32_t key1, uint32_t c0,
                                         const int32_t *c1, const int32_t *c2, uint32_t c3,
                                         const int words, int32_t *word, size_t stride) {
    enum { CHAINS = 4 };
    const lanes_wide multiplier0 = RNG_PHILOX_MULTIPLIER0 + (lanes_wide){0};
    const lanes_wide multiplier1 = RNG_PHILOX_MULTIPLIER1 + (lanes_wide){0};
    lanes_wide x0[CHAINS], x1[CHAINS], x2[CHAINS], x3[CHAINS];
#pragma GCC unroll 4
    for (int n = 0; n < CHAINS; n++) {
        const int vector = n / 2 * RNG_WORDS, odd = n % 2;
        x0[n] = c0 + (lanes_wide){0};
        x1[n] = lanes_load_wide(c1 + vector) >> 32 * odd;
        x2[n] = lanes_load_wide(c2 + vector) >> 32 * odd;
        x3[n] = c3 + (lanes_wide){0};
    }
#pragma GCC unroll 10
    for (uint32_t round = 0; round < 10; round++) {
        const uint64_t round_key0 = (uint32_t)(key0 + round * RNG_PHILOX_STEP0);
        const uint64_t round_key1 = (uint32_t)(key1 + round * RNG_PHILOX_STEP1);
#pragma GCC unroll 4
        for (int n = 0; n < CHAINS; n++) {
            const lanes_wide product0 = lanes_multiply_low(x0[n], multiplier0);
            const lanes_wide product1 = lanes_multiply_low(x2[n], multiplier1);
            x0[n] = (product1 >> 32) ^ x1[n] ^ round_key0;
            x1[n] = product1;
            x2[n] = (product0 >> 32) ^ x3[n] ^ round_key1;
            x3[n] = product0;
        }
    }
    const lanes_wide *const x[] = {x0, x1, x2, x3};
#pragma GCC unroll 4
    for (int w = 0; w < words; w++)
        for (int n = 0; n < CHAINS; n += 2)
            lanes_store_wide(word + (size_t)w * stride + n / 2 * RNG_WORDS,
                             (x[w][n] & 0xFFFFFFFF) | x[w][n + 1] << 32);
}

/// Word 0 alone: rng_philox_lane of each.
LANES_INLINE void rng_philox_lanes(uint32_t key0, uint32_t key1, uint32_t c0, const int32_t *c1,
                                   const int32_t *c2, uint32_t c3, int32_t *word0) {
    rng_philox_lanes_words(key0, key1, c0, c1, c2, c3, 1, word0, 0);
}
