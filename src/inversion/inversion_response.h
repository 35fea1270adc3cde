// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How S responds to the values at the points of a potential.
///
/// U of a group is a cubic spline through its points. A value there acts upon the bins beside its
/// own, and where values alternate, the mean of U over a bin is as low as 0.64 of them. So a p with
/// noise of its own in each bin asks for a U with 1.22 times the noise of −k_B T ln p: with a U
/// that is constant in each bin, errors of bonds and angles were stated too small by so much.
/// Φ of pairs, which their prior keeps smooth, counts as constant in a bin.
///
/// Where boxes change, S of pairs stands for their counts G with the weight V/V_scene, whose mean
/// is that of g, and the energy is that of the pairs as they are, G w with w = V_scene/V:
///   cov(G_a, G_b w) = ⟨w⟩ cov(G_a, G_b) + ⟨G_b⟩ cov(G_a, w),
/// the second of which is what a potential does to g by the density.
#pragma once

#include "base/status.h"

#include <stddef.h>

struct inversion_state;

/// −k_B T ∂⟨S_a⟩/∂Φ_b = Σ_c C_ac M_cb: C is what the samples tell of it, and M_cb the mean over bin
/// c of what a unit at point b makes of the curve. Without groups this is C.
struct inversion_response {
    double *sampled;    ///< C of S in the known bins as sampled, shape [known, known]
    double *covariance; ///< C but for its noise (inversion/inversion_covariance.h), the same shape
    double *shared;     ///< variance of S in its functions, shape [known]
    double *means;      ///< M of each group, one after the other; NULL without groups
    double *of_density; ///< covariance of S with SAMPLER_DENSITY as sampled, shape [known]; NULL
                        ///< where boxes stay
    double *density;    ///< the same but for its noise
    double *values;     ///< the response, shape [known, known]; NULL without groups and density
    double *mean;       ///< of S in the samples that C is made of, shape [known]
    double *phi;        ///< the mean of their potentials in the known bins, shape [known]
    double independent; ///< samples that C is worth at the present potential; 0: nothing is kept
    size_t functions;   ///< in which C is as sampled
};

/// Fails: NO_MEMORY.
enum status mf_inversion_response_init(struct inversion_state *state) MUST_USE;
void mf_inversion_response_clear(struct inversion_response *response);

/// Add the present samples to C, which keeps those before as far as it is the same: by g, and by
/// the variance of S along the way that the potential has gone since. Fails: NO_MEMORY. Tested:
/// test_inversion_response.
enum status mf_inversion_response_add(struct inversion_state *state) MUST_USE;

/// Fill the response from the present C. Tested: test_inversion_response.
void mf_inversion_response_find(struct inversion_state *state);

/// The response, C itself without groups and density.
const double *mf_inversion_response_values(const struct inversion_state *state);

/// What settled samples say besides g: how far the pressure is from what is asked for, and how all
/// respond to the potential. Fails: NO_MEMORY.
enum status mf_inversion_response_assess(struct inversion_state *state) MUST_USE;
