// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Constants of a formula by least squares.
#pragma once

#include "optimise/programming.h"

/// Scratch of one thread.
struct programming_scratch {
    double *value, *adjoint;    ///< shape [EXPRESSION_MAX, count + 1]: of each node at each point
    double *difference, *slope; ///< shape [count]: softened f − y, and its derivative by f
    double *jacobian;           ///< shape [EXPRESSION_MAX, count]: ∂f by each constant
    double *residual, *columns; ///< shape [rows], [EXPRESSION_MAX, rows]
};

/// Fails: NO_MEMORY.
enum status mf_programming_fit_init(struct programming_scratch *scratch,
                                    const struct programming_points *points) MUST_USE;
void mf_programming_fit_clear(struct programming_scratch *scratch);

/// rms of a formula's residuals; infinite where it is not finite.
double mf_programming_fit_error(const struct programming_points *points,
                                struct programming_scratch *scratch,
                                const struct expression *expression);

/// Move the constants to the next minimum of that: K. Levenberg (1944) and D. W. Marquardt, J.
/// SIAM 11, 431 (1963). Derivatives are exact, by going back through the nodes. An exponent whose
/// base is negative somewhere stays, and so do squares, cubes and fourth powers, which make another
/// structure: their base may change its sign. Those constants stay as well that `held` names.
/// @param[in] held  shape [expression->length], or NULL: none
/// @return the error
double mf_programming_fit(const struct programming_points *points,
                          struct programming_scratch *scratch, struct expression *expression,
                          const bool *held, int iterations);

/// Whether a node is the exponent of such a power.
bool mf_programming_fit_stays(const struct expression *expression, int node);

/// Move a constant factor of the whole alone, if there is one. Returns the error.
double mf_programming_fit_scale(const struct programming_points *points,
                                struct programming_scratch *scratch, struct expression *expression);
