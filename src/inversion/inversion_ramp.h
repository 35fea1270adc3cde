// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The part of a step that goes along the ramps of pair types, found by itself.
///
/// A step that has a value for each bin goes a part of its way where g hardly responds: the noise
/// of C is a response of its own, and adds to what is weighed against the prior. C times a ramp is
/// the mean over many bins and is hardly noisy, so that the least squares of a few ramps go all of
/// the way.
#pragma once

#include "base/status.h"
#include "inversion/imc_solve.h"

struct inversion;

/// Minimise Σ_a (excess_a − Σ_b C_ab y_b/k_B T)²/variance_a over y = Σ_p A_p (1 − r/r_c), a ramp
/// for each pair type, with the ridge of mf_imc_solve_prior.
/// @param[out] y         shape [points] [k_B T_0]
/// @param[out] residual  what y leaves of the excess, shape [known]
/// Fails: NO_MEMORY.
enum status mf_inversion_ramp_step(const struct inversion *inversion,
                                   const struct imc_system *system, double *y,
                                   double *residual) MUST_USE;
