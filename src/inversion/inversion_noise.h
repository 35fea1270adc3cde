// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The covariance V of the excess ⟨S⟩ − S* of a state in its known bins.
///
/// The samples' part has the correlations of S itself: bins beside each other scatter together, and
/// what hardly any potential changes hardly scatters either. So the same samples tell the ramp, and
/// the pressure with it, many times better than if their bins scattered by themselves. The errors
/// of a target are its bins' own, but for that of the factor of a pair type.
///
/// C of n independent samples of N bins counts as N more of its diagonal: the mean of an inverse
/// Wishart distribution whose prior is that (A. Gelman et al., Bayesian Data Analysis (2013),
/// section 3.6), so that V has an inverse.
#pragma once

struct inversion_state;

/// The lower Cholesky factor L of V = L Lᵀ. A bin of which the target does not tell is by itself.
/// @param[in]  more    variance of each bin beside these, shape [known]; NULL: none
/// @param[out] factor  shape [known, known]
/// Tested: test_inversion_noise.
void mf_inversion_noise_find(const struct inversion_state *state, const double *more,
                             double *factor);
