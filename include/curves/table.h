// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the pair kernels read: a curve on a uniform grid of polynomials.
///
/// A potential becomes a twice continuously differentiable cubic spline; value and slope come from
/// the same polynomial, so F = −dΦ/dr holds to rounding. A weight becomes straight pieces, since
/// ω(r) may jump and a spline would ring there.
#pragma once

#include "curves/curve.h"

#include <math.h>

/// Intervals of a table. Measured: at 1024 the force of Lennard-Jones at r = 0.9 σ is within 1e-5
/// of the formula, and the single-precision copy (16 KiB) still fits the first-level cache.
enum { TABLE_INTERVALS = 1024 };

struct table {
    double cutoff;          ///< [λ]
    double inverse_spacing; ///< intervals / cutoff [1/λ]
    int terms;              ///< coefficients an interval: 4 (potential) or 2 (weight)
    double *coefficient;    ///< shape [TABLE_INTERVALS + 1, terms]; the last row is 0
    /// What kernels want, a row for one load; f is the fraction of the interval. Potential: value
    /// at f = 0, then the force F = c1 + f(c2 + f c3), so that Φ = c0 − f(c1 + f(c2/2 + f c3/3)) /
    /// inverse_spacing. Weight: ω = c0 + f c1.
    double (*precise)[4];
    float (*single)[4]; ///< the same rounded
};

/// Potential: cubic spline, shifted so that Φ(cutoff) = 0.
enum status table_init_potential(struct table *table, const struct curve *curve) MUST_USE;

/// Weight: straight pieces.
enum status table_init_weight(struct table *table, const struct curve *curve) MUST_USE;

void table_clear(struct table *table);

/// Interval of distance r, clamped to the zero row beyond the cutoff.
static inline int table_interval(const struct table *table, double r) {
    return (int)fmin(r * table->inverse_spacing, TABLE_INTERVALS);
}

/// Value, slope and curvature of a potential's table in double precision; each may be NULL.
void table_evaluate(const struct table *table, double r, double *value, double *slope,
                    double *curvature);
