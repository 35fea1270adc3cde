// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Bézier curve: coefficients → function values.
#pragma once

#include "base/status.h"

#include <stddef.h>

/// Values at `t` of the Bézier curve whose control points are the coefficients, shifted to end at
/// 0:
///   y(t) = Σ_k C(n, k) t^k (1 − t)^(n−k) x_k − x_n,  k = 0 … n,  0 ≤ t ≤ 1.
/// The curve begins at x_0 − x_n and is smoother than the coefficients by about sqrt(t(1 − t)/n) of
/// the range: neighbouring coefficients act together.
///
/// A. G. Baydin (thesis on DPD coarse-graining by evolutionary optimisation, 2008), whose control
/// points are a random walk that is likewise 0 at the cutoff. Here a shift makes the end 0. To set
/// the last coefficient to 0 instead leaves a cliff of half the range of coefficients at the end of
/// the curve, whose force heats four of five individuals of a first generation too much.
/// @param[in]  coefficients      shape [count], count ≥ 1
/// @param[in]  t, values  shape [points]
/// Fails: NO_MEMORY. Tested: test_curves.
enum status mf_bezier_values(const double *coefficients, size_t count, const double *t,
                             double *values, size_t points) MUST_USE;
