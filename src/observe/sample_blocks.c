// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/sample_blocks.h"

#include <string.h>

enum { BLOCKS = 20 };

enum status mf_sample_blocks_init(struct sample_blocks *blocks, size_t planned) {
    *blocks = (struct sample_blocks){.planned = planned, .each = planned == 0};
    blocks->count = planned == 0 ? 2 * BLOCKS : planned < BLOCKS ? planned : BLOCKS;
    TRY_ARRAY(blocks->samples, blocks->count);
    return STATUS_OK;
}

void mf_sample_blocks_clear(struct sample_blocks *blocks) {
    mf_memory_free(blocks->samples);
    *blocks = (struct sample_blocks){0};
}

bool mf_sample_blocks_are_full(const struct sample_blocks *blocks) {
    return blocks->each > 0 && blocks->taken == blocks->count * blocks->each;
}

void mf_sample_blocks_join(const struct sample_blocks *blocks, double *sums, size_t row) {
    const size_t half = blocks->count / 2;
    for (size_t b = 0; b < half; b++)
        for (size_t k = 0; k < row; k++)
            sums[b * row + k] = sums[2 * b * row + k] + sums[(2 * b + 1) * row + k];
    memset(sums + half * row, 0, half * row * sizeof *sums);
}

void mf_sample_blocks_double(struct sample_blocks *blocks) {
    mf_sample_blocks_join(blocks, blocks->samples, 1);
    blocks->each *= 2;
}

size_t mf_sample_blocks_take(struct sample_blocks *blocks) {
    const size_t block = blocks->each > 0 ? blocks->taken / blocks->each
                                          : blocks->taken * blocks->count / blocks->planned;
    blocks->samples[block] += 1;
    blocks->taken++;
    return block;
}

size_t mf_sample_blocks_whole(const struct sample_blocks *blocks) {
    const double min = blocks->each > 0 ? (double)blocks->each : 1;
    size_t whole = 0;
    while (whole < blocks->count && blocks->samples[whole] >= min)
        whole++;
    return whole;
}

size_t mf_sample_blocks_spans(struct sample_blocks *blocks, struct memory_span *spans) {
    spans[0] = (struct memory_span){&blocks->taken, sizeof blocks->taken};
    spans[1] = (struct memory_span){blocks->samples, blocks->count * sizeof *blocks->samples};
    return SAMPLE_BLOCKS_SPANS;
}
