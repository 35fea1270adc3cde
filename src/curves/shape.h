// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Curves made of coefficients, by name: values on a grid, their basis, and the coefficients
/// that fit a given curve best.
#pragma once

#include "base/status.h"

#include <stddef.h>

struct shape {
    const char *name;
    const char *summary; ///< one line, with citation
    /// Values at t in [0, 1]; linear in the coefficients, and 0 at t = 1.
    /// @param[in]  coefficients      shape [count], count ≥ 1
    /// @param[in]  t, values  shape [points]
    /// Fails: NO_MEMORY.
    enum status (*values)(const double *coefficients, size_t count, const double *t, double *values,
                          size_t points);
};

/// All shapes, NULL-terminated: "bezier" (curves/bezier.h) and "bspline" (curves/bspline.h).
extern const struct shape *const mf_shapes[];

/// What each coefficient adds to the curve: values = basis · coefficients.
/// @param[out] basis  shape [points, coefficients]
/// Fails: NO_MEMORY. Tested: test_shape.
enum status mf_shape_basis(const struct shape *shape, size_t coefficients, const double *t,
                           size_t points, double *basis) MUST_USE;

/// Coefficients x of the curve nearest to `values`: least Σ_p w_p (y_p − Σ_k B_pk x_k)² + λ² Σ_k
/// x_k², with λ of 1e-7 times the largest singular value of the weighted basis. That is too little
/// to see in the curve, and enough to choose the smallest coefficients where the points leave them
/// open (more coefficients than points, or a Bézier curve, whose coefficients may all be moved
/// together).
/// @param[in]  t, values  shape [points]
/// @param[in]  weights    shape [points], none below 0; NULL: all 1
/// @param[out] coefficients      shape [count], count ≥ 1
/// Fails: NO_MEMORY, BAD_INPUT without points or where numbers are not finite. Tested: test_shape.
enum status mf_shape_fit(const struct shape *shape, const double *t, const double *values,
                         const double *weights, size_t points, double *coefficients,
                         size_t count) MUST_USE;
