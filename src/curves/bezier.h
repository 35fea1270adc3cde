// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Bézier-smoothed spline random walk: coefficients → function values.
#pragma once

#include "base/status.h"

#include <stddef.h>

/// Values at `t` of the Bézier curve whose control points are the coefficients, shifted to end at
/// 0:
///   y(t) = Σ_k C(n, k) t^k (1 − t)^(n−k) x_k − x_n,  k = 0 … n,  0 ≤ t ≤ 1.
/// The curve begins at x_0 − x_n and is smoother than the coefficients by about sqrt(t(1 − t)/n) of
/// the range: neighbouring coefficients act together.
///
/// A. G. Baydin (thesis on DPD coarse-graining by evolutionary optimisation, 2008), where the
/// walk's last value is likewise 0 at the cutoff. Here that is done by a shift: setting the last
/// coefficient to 0 leaves a cliff of half the coefficient range within the last coefficient, whose
/// force heats four of five individuals of a first generation beyond their temperature.
/// @param[in]  coefficients      shape [count], count ≥ 1
/// @param[in]  t, values  shape [points]
/// Fails: NO_MEMORY. Tested: test_curves.
enum status mf_bezier_values(const double *coefficients, size_t count, const double *t,
                             double *values, size_t points) MUST_USE;
