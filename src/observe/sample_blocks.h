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
    size_t row;      ///< numbers of a sample
    double *samples; ///< shape [count]
    double *sums;    ///< shape [count, row]: over the samples of a block
};

/// Fails: NO_MEMORY. Tested: test_sample_blocks.
enum status mf_sample_blocks_init(struct sample_blocks *blocks, size_t planned,
                                  size_t row) MUST_USE;
void mf_sample_blocks_clear(struct sample_blocks *blocks);

/// Take a sample; returns the sums of its block, to which it is to be added, shape [row]. What is
/// beyond those planned belongs to the last.
double *mf_sample_blocks_next(struct sample_blocks *blocks);

/// Make of every two of `count` blocks one; the second half is then empty.
/// @param[in,out] sums  shape [count, row]
void mf_sample_blocks_join(double *sums, size_t count, size_t row);

/// How many blocks, the first ones, have all their samples: errors are of these.
size_t mf_sample_blocks_whole(const struct sample_blocks *blocks);

/// The mean of number k of a sample over the whole blocks, NaN if there are none, and its error.
/// @param[in] divisor  of the number
double mf_sample_blocks_mean(const struct sample_blocks *blocks, size_t k, double divisor,
                             double *error);

/// Whether the errors of means are those of single samples, so that neighbours scatter together as
/// they do in each sample: the numbers from `first` on are counts, and the variances of those with
/// enough of them are in the mean less than 1.5 times those of as many counts that know nothing of
/// each other. Means of correlated samples have the covariance of what is slow.
/// @param[in] mean, error  shape [count], of any unit
/// Tested: test_sample_blocks.
bool mf_sample_blocks_are_independent(const struct sample_blocks *blocks, size_t first,
                                      size_t count, const double *mean, const double *error);

/// A comment of tables with such errors, which targets are read by (targets/target_rows.h).
#define SAMPLE_BLOCKS_COMMENT "errors of samples"

/// What goes with a checkpoint, if samples are planned; returns how many spans.
size_t mf_sample_blocks_spans(struct sample_blocks *blocks, struct memory_span *spans);
