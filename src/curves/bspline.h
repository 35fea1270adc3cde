// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Clamped uniform cubic B-spline: coefficients → function values.
#pragma once

#include "base/status.h"

#include <stddef.h>

/// Values at `t` of a cubic B-spline with these coefficients, and with 0 after the last one:
///   y(t) = Σ_k x_k B_k(t),  k = 0 … count − 1,  0 ≤ t ≤ 1,  x_count = 0,
/// with count + 1 basis functions on equal knot intervals, the end knots fourfold (C. de Boor, A
/// Practical Guide to Splines, 1978, chapter IX). y(0) = x_0, y(1) = 0, and each coefficient acts
/// on four intervals alone. Fewer than three coefficients take a lower degree: a parabola, a
/// straight line.
///
/// The curve ends at 0 since the coefficient after the last is fixed to 0. A shift, with which the
/// Bézier curve ends at 0, would let the last coefficient move the whole curve, while here each
/// acts near its place alone. No coefficient is idle (a Bézier curve with equal coefficients is 0,
/// whatever they are), and the basis functions, which add up to 1 but near the end, stay well
/// conditioned for fits.
/// @param[in]  coefficients      shape [count], count ≥ 1
/// @param[in]  t, values  shape [points]
/// Fails: NO_MEMORY. Tested: test_shape.
enum status mf_bspline_values(const double *coefficients, size_t count, const double *t,
                              double *values, size_t points) MUST_USE;
