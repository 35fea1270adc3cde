// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Are the velocities those of Maxwell at the set temperature?
#pragma once

#include "base/memory.h"
#include "system/particles.h"

/// Bins of equal probability under Maxwell's distribution: their edges are where the distribution
/// functions are compared, which understates the statistic by 2^-16 at most.
enum { MAXWELL_BINS = 1 << 16, MAXWELL_CELLS = 16, MAXWELL_SPANS = 3 };

struct maxwell {
    uint64_t *counts;    ///< shape [MAXWELL_BINS]: numbers of all configurations
    uint64_t taken;      ///< configurations
    size_t blocks, each; ///< of time, and configurations of one
    double *cells;       ///< shape [blocks, MAXWELL_CELLS]: the same numbers in wide bins
};

/// @param[in] planned  configurations, at least as many as there will be
enum status mf_maxwell_init(struct maxwell *maxwell, size_t planned) MUST_USE;
void mf_maxwell_clear(struct maxwell *maxwell);

/// Begin a configuration, and add a number to it: the share of Maxwell's distribution below it.
void mf_maxwell_begin(struct maxwell *maxwell);
void mf_maxwell_add(struct maxwell *maxwell, double share);

/// What a checkpoint must keep.
size_t mf_maxwell_spans(struct maxwell *maxwell, struct memory_span *spans);

/// Add all velocity components of a configuration, times the square roots of the masses.
///
/// The total momentum of a simulation is 0, so that its components are not independent: their mean
/// is known, which narrows the statistic by a finite factor however many particles there are (the
/// case of H. W. Lilliefors, J. Am. Stat. Assoc. 62, 399 (1967)), and p-values would crowd at 1.
/// The velocity of the centre of mass is therefore replaced by one drawn from N(0, T/Σm): what was
/// canonical with momentum 0 is then exactly dN independent numbers N(0, T/m).
/// @param[in] temperature  that was set [k_B T_0]
/// @param[in] seed, step   of the drawn mean: the same for any order of particles or threads
void mf_maxwell_sample(struct maxwell *maxwell, const struct particles *particles,
                       double temperature, uint64_t seed, uint64_t step);

struct maxwell_summary {
    double numbers;     ///< in all
    double independent; ///< as many of them would scatter as much
    double statistic;   ///< Kolmogorov and Smirnov's D = sup |F_n − F|; NaN without numbers
    double probability; ///< of a larger D by chance
};

/// Configurations that are too close for velocities to decorrelate count for fewer: by how
/// much F_n scatters from block to block of time, where that of `independent` numbers would have
/// the variance F (1 − F)/n, if that is no chance. Without a thermostat the total energy is
/// remembered for ever.
/// Tested: test_maxwell.
struct maxwell_summary mf_maxwell_result(const struct maxwell *maxwell);

/// Probability that D exceeds `statistic` for n independent numbers of a known distribution:
///   Q(λ) = 2 Σ_k (−1)^(k−1) exp(−2 k² λ²),  λ = (√n + 0.12 + 0.11/√n) D,
/// M. A. Stephens, J. R. Stat. Soc. B 32, 115 (1970); good to 0.001 from n = 5 on.
double mf_maxwell_probability(double statistic, double n);
