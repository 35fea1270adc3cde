// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the pair kernels read: a curve on a uniform grid of polynomials.
///
/// A potential becomes a twice continuously differentiable cubic spline; value and slope come from
/// the same polynomial, so F = −dΦ/dr holds to rounding. ω becomes straight pieces, since ω(r) may
/// jump and a spline would ring there.
///
/// A mixture has a curve for each pair type. They stand in one table, one after the other: row
/// k of curve p is p (TABLE_INTERVALS + 1) + k. Each keeps the grid it would have alone, up to its
/// own cutoff, so that none loses its resolution or its end to a longer one.
#pragma once

#include "curves/curve.h"

#include <math.h>

/// Intervals of a table. Measured: at 1024 the force of Lennard-Jones at r = 0.9 σ is within 1e-5
/// of the formula, and the single-precision copy (16 KiB) still fits the first-level cache.
enum { TABLE_INTERVALS = 1024 };

/// Pair types of a mixture of eight types.
enum { TABLE_MAX_CURVES = 36 };

struct table {
    double cutoff;                    ///< the largest of all curves [λ]
    double inverse_spacing;           ///< of a table of one curve: intervals / cutoff [1/λ]
    int terms;                        ///< coefficients an interval: 4 (Φ) or 2 (ω)
    int curves;                       ///< 1, for all pairs, or one for each pair type
    double cutoffs[TABLE_MAX_CURVES]; ///< of each curve; 0: it is 0 everywhere [λ]
    double *coefficient; ///< shape [curves, TABLE_INTERVALS + 1, terms]; the last row of each is 0
    /// What kernels want, shape [curves, TABLE_INTERVALS + 1, 4], a row for one load; f is the
    /// fraction of the interval. Φ: value at f = 0, then the force F = c1 + f(c2 + f c3),
    /// so that Φ = c0 − f(c1 + f(c2/2 + f c3/3)) / inverse_spacing. ω = c0 + f c1.
    double (*precise)[4];
    float (*single)[4]; ///< the same rounded
};

/// Φ: cubic spline, shifted so that Φ(cutoff) = 0. Fails, as for ω: NO_MEMORY, BAD_INPUT where the
/// curve's parameters do not go together.
enum status mf_table_init_potential(struct table *table, const struct curve *curve) MUST_USE;

/// ω: straight pieces.
enum status mf_table_init_omega(struct table *table, const struct curve *curve) MUST_USE;

/// One table of the curves of several, of one curve each, for the pair types in their order. A
/// zeroed part is a curve that is 0 everywhere; one at least is not.
/// @param[in] parts  shape [curves]; copied
/// Fails: NO_MEMORY.
enum status mf_table_stack(struct table *table, const struct table *parts, int curves) MUST_USE;

/// A copy of `from`, all of whose curves are `factor` times as large. Fails: NO_MEMORY.
/// Tested: test_curves.
enum status mf_table_scale(struct table *table, const struct table *from, double factor) MUST_USE;

void mf_table_clear(struct table *table);

/// Which curve a pair type has: a table of one is for all.
static inline int table_curve(const struct table *table, int pair) {
    return table->curves > 1 ? pair : 0;
}

/// From the curve of one pair type to that of the next, in rows.
static inline int table_stride(const struct table *table) {
    return table->curves > 1 ? TABLE_INTERVALS + 1 : 0;
}

/// Cutoff of the curve of a pair type [λ].
static inline double table_cutoff(const struct table *table, int pair) {
    return table->cutoffs[table_curve(table, pair)];
}

/// Intervals of that curve per length [1/λ]; for one that is 0 everywhere any would do.
double mf_table_inverse_spacing(const struct table *table, int pair);

/// Value, slope and curvature in double precision, of a table of one curve; each may be NULL.
void mf_table_evaluate(const struct table *table, double r, double *value, double *slope,
                       double *curvature);

/// The same of the curve of a pair type.
void mf_table_evaluate_pair(const struct table *table, int pair, double r, double *value,
                            double *slope, double *curvature);
