// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Whether independent simulations of one system have settled, by what they measure in
/// consecutive parts of their samples.
///
/// An analysis of variance of simulations and parts. Where samples are those of equilibrium and
/// long enough, all parts of all simulations have one mean, and scatter about it alike. It is
/// rejected by two ratios, each of which is 1 then:
///
/// - drift: what the simulations have in common along the time, Σ t x_t, over its scatter between
///   them. They all come from where they began.
/// - memory: the scatter of the simulations' means over that of the parts within them. Each of them
///   remembers where it began: the samples are not much longer than that memory, or the simulations
///   are frozen, each in a structure of its own. A. Gelman and D. B. Rubin, Stat. Sci. 7, 457
///   (1992).
///
/// Of many numbers, as the bins of a g(r) are, the sums of squares are over all of them; they have
/// as many degrees of freedom as there are independent ones, ν = (tr Σ)²/tr Σ² of the covariances
/// that the parts show: G. E. P. Box, Ann. Math. Stat. 25, 290 (1954). A few slow ones do not show
/// in such a sum: each that is frequent is tested by itself, too, and the least chance of n counts
/// as 1 − (1 − p)^n: Z. Šidák, J. Am. Stat. Assoc. 62, 626 (1967). Of both tests the smaller chance
/// counts twice.
#pragma once

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>

/// Parts of the samples of a simulation.
enum { STATIONARY_PARTS = 4, STATIONARY_MAX_CHAINS = 1024 };

/// Numbers that are tested together.
struct stationary_numbers {
    size_t chains;              ///< simulations, 2 at least
    const double *const *chain; ///< shape [chains] of [STATIONARY_PARTS, row]: means of the parts
    size_t row;
    size_t count;         ///< numbers
    const size_t *number; ///< where they stand in a row, shape [count]
    const double *weight; ///< of their squares, shape [count]; 0: left out
    const bool *alone;    ///< tested by themselves, too, shape [count]; NULL: none is
};

/// Chances that samples in equilibrium would be so, or worse, and the ratios of variances that they
/// are of; all 1 where nothing scatters.
struct stationary {
    double drift, memory;
    double drift_ratio, memory_ratio;
};

/// Fails: NO_MEMORY. Tested: test_stationary.
enum status mf_stationary_test(const struct stationary_numbers *numbers,
                               struct stationary *result) MUST_USE;

/// The smaller of both chances.
static inline double stationary_p_value(const struct stationary *is) {
    return is->drift < is->memory ? is->drift : is->memory;
}

/// "g(r) still changes, 5.2 times as much as its noise explains".
/// @param[in] name  "g(r)"
void mf_stationary_describe(const char *name, const struct stationary *is, char *text, size_t size);
