// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The pressure of an inversion's samples, and how it follows the potential.
#pragma once

#include "base/status.h"

struct inversion_state;

struct inversion_pressure {
    double value, error; ///< ρ k_B T + ⟨W⟩/(dV) of the samples, and its standard error
    double *slope;       ///< ∂P/∂Φ_b, shape [known]
};

/// Value and error, the distance from the target, and how near to it a step may be asked to come:
/// not nearer than the noise, nor, where S is to change by the part δ of itself, than 2 δ of what
/// is missing. By so much the slopes change on the way, as covariances of counts do, and a step
/// that goes by what they promise exactly goes astray. The error is the scatter of the chains'
/// means, or what that of the samples makes of as many independent ones as g(r) sees, if that is
/// more: few chains may agree by chance.
void mf_inversion_pressure_measure(struct inversion_state *state);

/// How far from that of equilibrium the pressure may be, see mf_inversion_equilibrium_shift.
double mf_inversion_pressure_shift(const struct inversion_state *state);

/// Slopes, from how the virial W = −Σ r Φ'(r) over all pairs depends on the potential itself, and
/// on the pairs that it makes:
///   ∂P/∂Φ_b = [⟨∂W/∂Φ_b⟩ − cov(W, S_b)/k_B T]/(dV).
/// Fails: NO_MEMORY. Tested: test_inversion_pressure, against differences of simulations.
enum status mf_inversion_pressure_slopes(struct inversion_state *state) MUST_USE;

/// ∂P/∂A of the ramp A (1 − r/r_c) [1/λ^d].
double mf_inversion_pressure_ramp_slope(const struct inversion_state *state);

/// Add to a step the ramp A (1 − r/r_c) that makes up for the pressure, if the problem asks for
/// one:
///   A = (P* − P − Σ_b ∂P/∂Φ_b step_b)/(∂P/∂A).
/// After H. Wang, C. Junghans and K. Kremer, Eur. Phys. J. E 28, 221 (2009), who leave out the sum
/// and take for ∂P/∂A the direct response of the virial, 2π ρ² ∫ g r³ dr/(3 r_c), times a factor
/// below 1. This differs because a step towards g has a pressure of its own: with theirs, tried at
/// P* = 0 for water, hypernetted-chain steps stayed between 0.8 and 1.2. What is too much for the
/// linear response is damped as the whole step is.
void mf_inversion_pressure_add_ramp(const struct inversion_state *state, double *step);
