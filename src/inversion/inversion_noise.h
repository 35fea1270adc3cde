// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The covariance V of the excess ⟨S⟩ − S* of a state in its known bins.
///
/// The samples' part has the correlations of S itself: bins beside each other scatter together, and
/// what hardly any potential changes hardly scatters either. So the same samples tell the ramp, and
/// the pressure with it, many times better than if their bins scattered by themselves.
///
/// A target gives an error for each bin, and not what they have in common. Mostly it is the mean of
/// samples, too, of the same liquid: then its noise has the correlations of S (W). A figure's, or a
/// rounded table's, is each bin's own (V), and so are errors that no file gives:
/// W is V then. Steps are made with W, which is the maximum likelihood of samples: minus the
/// logarithm of that is the relative entropy, which is convex in the potential, and C enters it as
/// such and not as C², so that its noise is not taken for information. Bands are those of such
/// steps by V, which is the larger noise of what g hardly sees: where W is true they are too wide,
/// and go by W if all targets say that their errors are of samples (enum target_errors) and the
/// excess does not say otherwise. Of a repulsive shoulder a step with W over 1.1 k_B T left 0.05,
/// with V 0.9; the error of its ramp by V was 0.66 and 0.51.
///
/// Which of both it is the excess says, at a potential of which it may be what the prior of steps
/// allows: the likelier of two normal laws, of the covariances W + C P⁻¹C and V + C P⁻¹C with the
/// prior P (mf_imc_solve_prior). Where errors are each bin's own, steps with W follow them along
/// what g hardly sees: one of four targets of the WCA liquid, with noise of each bin twice as large
/// as that of samples, ended six stated errors of the pressure off.
///
/// C of n independent samples in N functions counts as N more of its diagonal: the mean of an
/// inverse Wishart distribution whose prior is that (A. Gelman et al., Bayesian Data Analysis
/// (2013), section 3.6), so that V has an inverse.
#pragma once

#include "base/status.h"

struct inversion_state;

/// Whose errors a target's bins have.
enum inversion_noise_kind { INVERSION_NOISE_OF_SAMPLES, INVERSION_NOISE_OF_BINS };

/// The lower Cholesky factor L of W or V = L Lᵀ. A bin of which the target does not tell is by
/// itself.
/// @param[in]  more    variance of each bin beside these, shape [known]; NULL: none
/// @param[out] factor  shape [known, known]; above its diagonal 0
/// Tested: test_inversion_noise.
void mf_inversion_noise_find(const struct inversion_state *state, enum inversion_noise_kind kind,
                             const double *more, double *factor);

/// The kind of noise that bands are by, where steps are by the one that was chosen. Tested:
/// test_inversion_noise.
enum inversion_noise_kind mf_inversion_noise_of_band(const struct inversion_state *state,
                                                     enum inversion_noise_kind chosen);

/// The kind of noise that the excess is likelier to have. Fails: NO_MEMORY. Tested:
/// test_inversion_noise.
enum status mf_inversion_noise_choose(const struct inversion_state *state,
                                      enum inversion_noise_kind *kind) MUST_USE;
