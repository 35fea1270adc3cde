// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A curve through given points: the law "table".
#pragma once

#include "curves/curve.h"

#include <gsl/gsl_spline.h>

/// Cubic spline through points (r_k, y_k); below r_0 the straight line with the spline's slope
/// there, beyond the cutoff 0.
extern const struct curve_family mf_sampled_family;

/// Of a friction weight: straight pieces between the points, which never swing below 0; before the
/// first 0, as a fit's friction weight is below its inner cutoff.
extern const struct curve_family mf_sampled_omega_family;

/// Of the weight of a local density: as of a potential, from a file of columns.
extern const struct curve_family mf_sampled_weight_family;

static inline bool curve_is_sampled(const struct curve_family *family) {
    return family == &mf_sampled_family || family == &mf_sampled_omega_family ||
           family == &mf_sampled_weight_family;
}

enum { SAMPLED_COLUMNS, SAMPLED_VOTCA };

struct sampled_parameters {
    char file[FIELD_TEXT_SIZE]; ///< where the points came from; "" if from memory
    int format;                 ///< SAMPLED_…: of the file
    double cutoff;              ///< 0 means the last point [λ]
    gsl_spline *spline;         ///< NULL until mf_sampled_set_points
    double first_slope;
};

/// Give a curve of either family its points.
/// @param[in] r, y  shape [count], r ≥ 0 growing strictly, count ≥ 3   [λ], [curve's unit]
/// Fails: NO_MEMORY; BAD_INPUT if the last r lies below the cutoff or r does not grow.
enum status mf_sampled_set_points(struct curve *curve, const double *r, const double *y,
                                  size_t count) MUST_USE;

/// A new curve of the first family through points in memory.
enum status mf_sampled_create(struct curve *curve, const double *r, const double *y,
                              size_t count) MUST_USE;
