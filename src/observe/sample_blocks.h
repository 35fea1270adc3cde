// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Blocks of samples in time, whose scatter gives errors: 20 of them if it is known how many
/// samples there will be; else blocks of equal size, which are joined two by two when there are 40.
#pragma once

#include "base/memory.h"

#include <stdbool.h>

struct sample_blocks {
    size_t planned;  ///< samples; 0: as many as there will be
    size_t taken;    ///< so far
    size_t count;    ///< of blocks
    size_t each;     ///< samples of a block if nothing is planned, else 0
    double *samples; ///< shape [count]
};

/// Fails: NO_MEMORY. Tested: test_sample_blocks.
enum status mf_sample_blocks_init(struct sample_blocks *blocks, size_t planned) MUST_USE;
void mf_sample_blocks_clear(struct sample_blocks *blocks);

/// Whether the next sample has no block: sums of shape [count, row] are then to be joined, each by
/// mf_sample_blocks_join, and at last the blocks, by mf_sample_blocks_double.
bool mf_sample_blocks_are_full(const struct sample_blocks *blocks);
void mf_sample_blocks_join(const struct sample_blocks *blocks, double *sums, size_t row);
void mf_sample_blocks_double(struct sample_blocks *blocks);

/// Take a sample; returns its block.
size_t mf_sample_blocks_take(struct sample_blocks *blocks);

/// How many blocks, the first ones, have all their samples: errors are of these.
size_t mf_sample_blocks_whole(const struct sample_blocks *blocks);

/// What goes with a checkpoint, if samples are planned: two spans.
enum { SAMPLE_BLOCKS_SPANS = 2 };
size_t mf_sample_blocks_spans(struct sample_blocks *blocks, struct memory_span *spans);
