// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Clamped uniform cubic B-spline: coefficients → function values.
#pragma once

#include "base/status.h"

#include <stddef.h>

/// Values at `t` of a cubic B-spline whose coefficients are the coefficients, and 0 after them:
///   y(t) = Σ_k x_k B_k(t),  k = 0 … count − 1,  0 ≤ t ≤ 1,  x_count = 0,
/// with count + 1 basis functions on equal knot intervals, the end knots fourfold (C. de Boor, A
/// Practical Guide to Splines, 1978, chapter IX). y(0) = x_0, y(1) = 0, and each coefficient acts
/// on four intervals alone. Fewer than three coefficients take a lower degree: a parabola, a
/// straight line.
///
/// Unlike the Bézier curve, which ends at 0 by a shift, a last coefficient is fixed to 0: the
/// curve is local, and by a shift the last coefficient would move all of it. No coefficient is idle
/// for it (equal coefficients of a Bézier curve are all the same curve, 0), and basis functions of
/// coefficients, which add up to 1 where the last coefficient does not act, stay a well conditioned
/// basis of fits.
/// @param[in]  coefficients      shape [count], count ≥ 1
/// @param[in]  t, values  shape [points]
/// Fails: NO_MEMORY. Tested: test_shape.
enum status mf_bspline_values(const double *coefficients, size_t count, const double *t,
                              double *values, size_t points) MUST_USE;
