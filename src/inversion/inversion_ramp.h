// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The part of a step that goes along the ramp, found by itself.
///
/// A step that has a value for each bin goes a part of its way where g hardly responds: the noise
/// of C is a response of its own, and adds to what is weighed against the prior. C times the ramp
/// is the mean over many bins and is hardly noisy, so that its least squares go all of the way.
///
/// The ramp is that of all pair types together, as in inversion_band. Of molecules that are all
/// alike, ramps of single pair types make up for each other, so that g tells next to nothing of
/// them: they stay where the bins leave them.
#pragma once

#include "inversion/imc_solve.h"
#include "problem/potential_grid.h"

/// Minimise Σ_a (excess_a − A Σ_b C_ab d_b/k_B T)²/variance_a, d = 1 − r/r_c, over A, with the
/// ridge of mf_imc_solve_prior; returns A [k_B T_0].
double mf_inversion_ramp_find(const struct potential_grid *grid, const struct imc_system *system);

/// Take this ramp out of the excess.
/// @param[out] y         A d, shape [points] [k_B T_0]
/// @param[out] residual  what it leaves of the excess, shape [known]
void mf_inversion_ramp_take(const struct potential_grid *grid, const struct imc_system *system,
                            double amplitude, double *y, double *residual);
