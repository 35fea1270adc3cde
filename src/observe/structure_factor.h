// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The static structure factor of many samples, with errors.
///
///   S(q) = ⟨|ρ(q)|²⟩/N
///
/// (observe/density_waves.h), the mean over all waves of a bin of |q| and over samples, told at the
/// mean |q| of them. Standard errors are those of means over up to 64 blocks of consecutive
/// samples, by mf_statistics_correlated_error.
#pragma once

#include "observe/density_waves.h"
#include "observe/observable.h"

struct structure_factor_settings {
    double q_maximum; ///< [1/λ]
    int64_t bins;
    int64_t waves; ///< of a bin at most; 0: all
};

struct structure_factor {
    struct composition composition;
    size_t curves, bins;
    size_t blocks, each, samples; ///< `each`: samples in a block
    bool endless;                 ///< nothing is planned: blocks are joined when all are full
    double *sums; ///< shape [blocks, curves + 2, bins]: Σ of S, of |q| and of 1 over waves
};

/// Prepare for `planned` samples of such waves; 0: for as many as there will be.
/// Fails: NO_MEMORY.
enum status mf_structure_factor_init(struct structure_factor *factor,
                                     const struct density_waves_plan *plan,
                                     size_t planned) MUST_USE;

void mf_structure_factor_clear(struct structure_factor *factor);

/// How many numbers a sample has: S of each curve, |q| and 1, summed over the waves of each bin.
size_t mf_structure_factor_numbers(const struct structure_factor *factor);

/// Add a sample of waves whose ρ are found; beyond those planned it is left out.
/// @param[out] numbers  as many as said above
void mf_structure_factor_add(struct structure_factor *factor, const struct density_waves *waves,
                             double *numbers);

/// Blocks that are complete: what errors rest on.
size_t mf_structure_factor_blocks(const struct structure_factor *factor);

/// Curves over the bins that have waves.
struct structure_factor_curves {
    size_t bins;
    double *q, *members;   ///< shape [bins]: mean |q|; waves of a sample, on average
    double *value, *error; ///< shape [curves, bins]: of all, and in a mixture of each pair type;
                           ///< NaN before the first block is complete
};

/// Fails: NO_MEMORY. Tested: test_structure_factor, test_measured.
enum status mf_structure_factor_find(const struct structure_factor *factor,
                                     struct structure_factor_curves *curves) MUST_USE;

void mf_structure_factor_curves_clear(struct structure_factor_curves *curves);

/// structure_factor.tsv: q, S with its error, in a mixture those of each pair type, and how many
/// waves there are, of q and −q one. Fails: IO, NO_MEMORY.
enum status mf_structure_factor_write(const struct structure_factor *factor,
                                      const struct observable_results *results) MUST_USE;

/// The state of the observable.
struct structure_factor_state {
    struct density_waves waves;
    struct structure_factor factor;
    double *share[3]; ///< shape [count]: where the beads are
    double *numbers;  ///< of one sample
};

extern const struct observable mf_structure_factor;
