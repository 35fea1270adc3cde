// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The static structure factor of many samples, with errors.
///
///   S(q) = ⟨|ρ(q)|²⟩/N
///
/// (observe/density_waves.h), the mean over all waves of a bin of |q| and over samples, told at the
/// mean |q| of them. Standard errors are those of means over up to 64 blocks of consecutive
/// samples, by mf_statistics_correlated_error.
///
/// Only vectors of the box obey its periodicity, so that nothing is cut off, and S of the smallest
/// tells the compressibility: S(0) = ρ k_B T κ_T of one component. The same bits for any number of
/// threads. Tested: test_structure_factor (unit, cli), test_density_waves.
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

/// How many numbers a sample has: S of each curve, |q| and 1, summed over the waves of each bin.
size_t mf_structure_factor_numbers(const struct structure_factor *factor);

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

/// The state of the observable.
struct structure_factor_state {
    struct density_waves waves;
    struct structure_factor factor;
    double *share[3]; ///< shape [count]: where the beads are
    double *numbers;  ///< of one sample
};

extern const struct observable mf_structure_factor;
