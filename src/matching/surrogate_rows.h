// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The linear model of a surrogate: features of the rows nearest to a centre by weighted
/// least squares, how they scatter about it, and how well its coefficients are known.
#pragma once

#include "matching/surrogate.h"

/// A row and its distance from the centre.
struct surrogate_near {
    double distance;
    size_t row;
};

/// What a fit works on. Matrices are row-major.
struct surrogate_work {
    const struct surrogate *surrogate;
    size_t rows, terms;          ///< terms: 1 and the variables
    struct surrogate_near *near; ///< shape [kept]: nearest first
    double *weight;              ///< shape [rows]
    double *design;              ///< shape [rows, terms]: 1, x − x_c
    double *normal;              ///< shape [terms, terms]: Cholesky factor of Σ w d dᵀ + ridge
    double *model;               ///< shape [features, terms]: y_c, J
    double *residual;            ///< shape [rows, features]
    double *scatter;             ///< shape [features]: σ_j²
    double *spread;  ///< shape [terms, terms]: covariance of a row of `model` over its scatter
    double *term;    ///< shape [terms]: scratch
    double *hessian; ///< shape [variables, variables]: Cholesky factor of Jᵀ W J + damping
    double *miss;    ///< shape [features]: t − y_c
    double *scale;   ///< shape [features]: scratch
    double *delta;   ///< shape [variables]: a step
    double freedom;  ///< rows that the scatter rests on
};

/// Fit the model to the `rows` nearest to the centre among `kept`; those that a linear model does
/// not describe count less if it is to be `robust`. Must be cleared, also after a failure. Fails:
/// NO_MEMORY.
enum status mf_surrogate_fit_rows(struct surrogate_work *work, const struct surrogate *surrogate,
                                  const double *centre, size_t kept, size_t rows,
                                  bool robust) MUST_USE;
void mf_surrogate_clear_rows(struct surrogate_work *work);

/// Σ += share · δ δᵀ, shape [size, size].
void mf_surrogate_add_outer(double *covariance, const double *delta, size_t size, double share);
