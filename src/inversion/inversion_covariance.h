// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a finite number of samples can tell of C, the covariance of S.
///
/// C of n independent samples in M bins has noise that counts as information: (C V⁻¹C) of it is too
/// large by tr(V⁻¹C) C/n. In a direction that g hardly sees that is many times what it really
/// tells: each step goes a small part of its way, and its error is stated too small.
///
/// But little of C is unknown. S_a counts pairs, each of them in one bin. Of single pairs the
/// covariance is that of Poisson's law, ⟨S_a⟩ in its diagonal; that of two pairs is an integral
/// over the distributions of three and four particles, K_ab = ⟨S_a⟩ ⟨S_b⟩ κ(r_a, r_b), with a κ as
/// smooth as these are. So, in units of sqrt(⟨S_a⟩ ⟨S_b⟩),
///   C = (1 − Π) + Π C_sampled Π,
/// where Π projects upon sqrt(⟨S_a⟩) times cubic B-splines of r, a number of them for each pair
/// type and group: in few smooth functions C is as sampled, beside them each pair is by itself, so
/// that a step is that of inverse Monte Carlo in the first and of Boltzmann inversion in the rest.
/// The same of terms of a group, which are in one bin each.
///
/// How many functions is found from the samples, by the estimate of the error of the block that is
/// left, squared (C. M. Stein, Ann. Stat. 9, 1135 (1981)): what the functions leave out of
/// |C_sampled − 1|², and twice the variance of what they follow, of which a normal S has
/// ((tr C)² + |C|²)/n.
#pragma once

#include "base/status.h"

#include <stddef.h>

/// The consecutive bins of S that are blocks of their own.
struct inversion_covariance_blocks {
    const size_t *size; ///< shape [blocks]
    size_t blocks, bins;
};

/// Covariance of S with the density, in the same functions and as far as it is more than its noise:
/// W. James and C. Stein, Proc. 4th Berkeley Symp. 1, 361 (1961).
struct inversion_covariance_density {
    const double *sampled; ///< shape [bins]
    double variance;       ///< of the density
    double *covariance;    ///< what is left of it, shape [bins]
};

/// @param[in]  sampled      C of the samples, shape [bins, bins]
/// @param[in]  mean         ⟨S⟩, shape [bins]
/// @param[in]  independent  samples that count as independent
/// @param[out] covariance   shape [bins, bins]
/// @param[out] shared       variance of each bin in the functions, what the noise of C is in
///                          proportion to, shape [bins]
/// @param[out] functions    of all blocks together
/// @param[in]  density      of samples whose boxes change; NULL: they stay
/// Fails: NO_MEMORY. Tested: test_inversion_covariance.
enum status
mf_inversion_covariance_find(const struct inversion_covariance_blocks *blocks,
                             const double *sampled, const double *mean, double independent,
                             double *covariance, double *shared, size_t *functions,
                             const struct inversion_covariance_density *density) MUST_USE;
