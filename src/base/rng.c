// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/rng.h"

#include <Random123/philox.h>

struct rng_block mf_rng_philox(uint64_t seed, enum rng_stream stream, uint32_t a, uint32_t b,
                               uint32_t c) {
    const philox4x32_ctr_t counter = {{a, b, c, rng_stream_word(stream, 0)}};
    const philox4x32_key_t key = {{(uint32_t)seed, (uint32_t)(seed >> 32)}};
    const philox4x32_ctr_t out = philox4x32(counter, key);
    return (struct rng_block){{out.v[0], out.v[1], out.v[2], out.v[3]}};
}

uint64_t mf_rng_child_seed(uint64_t seed, enum rng_stream stream, uint32_t a, uint32_t b) {
    const struct rng_block block = mf_rng_philox(seed, stream, a, b, 0);
    return (uint64_t)block.word[0] << 32 | block.word[1];
}

double mf_rng_uniform(uint32_t high, uint32_t low) {
    const uint64_t bits = ((uint64_t)high << 32 | low) >> 12;
    return ((double)bits + 0.5) * 0x1p-52;
}

void mf_rng_normal4(struct rng_block block, double normal[4]) {
    for (int pair = 0; pair < 2; pair++) {
        const double u = ((double)block.word[2 * pair] + 0.5) * 0x1p-32;
        const double v = (double)block.word[2 * pair + 1] * 0x1p-32;
        rng_box_muller(u, v, normal + 2 * pair);
    }
}

struct rng_sequence mf_rng_sequence_begin(uint64_t seed, enum rng_stream stream, uint32_t a,
                                          uint32_t b) {
    return (struct rng_sequence){.seed = seed, .stream = stream, .a = a, .b = b, .used = 4};
}

static uint32_t next_word(struct rng_sequence *sequence) {
    if (sequence->used == 4) {
        sequence->block = mf_rng_philox(sequence->seed, sequence->stream, sequence->a, sequence->b,
                                        sequence->c++);
        sequence->used = 0;
    }
    return sequence->block.word[sequence->used++];
}

double mf_rng_sequence_uniform(struct rng_sequence *sequence) {
    const uint32_t high = next_word(sequence);
    return mf_rng_uniform(high, next_word(sequence));
}

uint32_t mf_rng_sequence_below(struct rng_sequence *sequence, uint32_t count) {
    return (uint32_t)(mf_rng_sequence_uniform(sequence) * count);
}
