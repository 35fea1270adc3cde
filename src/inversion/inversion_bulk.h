// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the ramp of a potential moves, and how it follows the potential: the pressure of an
/// inversion's samples, or their density where the pressure is held.
#pragma once

#include "base/status.h"
#include "problem/inverse.h"

struct inversion_state;

struct inversion_bulk {
    double value, error;             ///< of it in the samples, and its standard error
    double *slope;                   ///< its derivatives by Φ_b, shape [known]
    double pressure, pressure_error; ///< ρ k_B T + ⟨W⟩/(dV) of the samples
};

/// What it is: inverse_problem_bulk.
enum target_kind mf_inversion_bulk_kind(const struct inversion_state *state);

/// Whether it is a target, and what is missing of that.
bool mf_inversion_bulk_is_asked(const struct inversion_state *state);
double mf_inversion_bulk_missing(const struct inversion_state *state);

/// Whether a density that is a target can move. Fails: BAD_INPUT if the volume of all samples is
/// one.
enum status mf_inversion_bulk_check(const struct inversion_state *state) MUST_USE;

/// Value and error, the distance from the target, and how near to it a step may be asked to come:
/// not nearer than the noise, nor, where S is to change by the part δ of itself, than 2 δ of what
/// is missing. By so much the slopes change on the way, as covariances of counts do, and a step
/// that goes by what they promise exactly goes astray. The error is the scatter of the chains'
/// means, or what that of the samples makes of as many independent ones as g(r) sees, if that is
/// more: few chains may agree by chance.
void mf_inversion_bulk_measure(struct inversion_state *state);

/// The error of it, and how small the samples are to make it near to the target's g: as that of its
/// target, or half of what it is off; 0 of 1 if it is not asked for, far from g, and after a few
/// doublings: what is asked for more exactly is not to cost many times what g does. Tested:
/// test_inversion_doubling.
/// @param[in] doublings  of the present samples
struct inverse_doubling mf_inversion_bulk_noise(const struct inversion_state *state, int doublings);

/// Whether the samples have a pressure: an engine that knows more than we, and tells none, leaves
/// 0.
bool mf_inversion_bulk_knows_pressure(const struct inversion_state *state);

/// How far from that of equilibrium it may be, see mf_inversion_equilibrium_shift.
double mf_inversion_bulk_shift(const struct inversion_state *state);

/// Slopes. Of the pressure from how the virial W = −Σ r Φ'(r) over all pairs depends on the
/// potential itself, and on the pairs that it makes:
///   ∂P/∂Φ_b = [⟨∂W/∂Φ_b⟩ − cov(W, S_b)/k_B T]/(dV).
/// Of the density ρ from how it goes with the pairs, as ∂ρ/∂Φ_b = −cov(ρ, S_b)/k_B T.
/// Fails: NO_MEMORY. Tested: test_inversion_pressure, against differences of simulations;
/// test_inversion_response.
enum status mf_inversion_bulk_slopes(struct inversion_state *state) MUST_USE;

/// The derivative by A of the ramp A (1 − r/r_c).
double mf_inversion_bulk_ramp_slope(const struct inversion_state *state);

/// Add to a step the ramp A (1 − r/r_c) that makes up for what is missing, if the problem asks for
/// it; of the pressure
///   A = (P* − P − Σ_b ∂P/∂Φ_b step_b)/(∂P/∂A).
/// After H. Wang, C. Junghans and K. Kremer, Eur. Phys. J. E 28, 221 (2009), who leave out the sum
/// and take for ∂P/∂A the direct response of the virial, 2π ρ² ∫ g r³ dr/(3 r_c), times a factor
/// below 1. This differs because a step towards g has a pressure of its own: with theirs, tried at
/// P* = 0 for water, hypernetted-chain steps stayed between 0.8 and 1.2. What is too much for the
/// linear response is damped as the whole step is.
void mf_inversion_bulk_add_ramp(const struct inversion_state *state, double *step);
