// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the simulations of a fit have shown, as a linear model: where the targets would be
/// met, and what they leave open.
///
/// Every candidate that was measured is a row of variables x and features y
/// (mf_targets_take_features). Near a centre x_c the features are taken to be linear,
///   y = y_c + J (x − x_c) + noise,
/// fitted to the nearest rows by least squares, so that the whole g(r) or E(t, r_0) of each
/// simulation is used where an optimiser sees one number. The variables that meet the target t
/// best,
///   minimise  Σ_j w_j (y_cj + J_j δ − t_j)² + λ|δ|²,   w_j = 1/(σ_j² + τ_j² + ε_j²),
/// with σ_j the scatter of the rows about the model, τ_j the target's standard error, ε_j what the
/// feature misses beyond noise, and λ as large as the step must be small, are a damped Gauss-Newton
/// step: J. Nocedal and S. J. Wright, Numerical Optimization (2nd ed., 2006), section 10.3. Steps
/// end at the bounds of the variables, and the others make up for it. One feature may be a
/// constraint instead, J_e δ = t_e − y_ce.
///
/// A target that cannot be met is missed by more than noise. The step then goes where the misses
/// are least by the weights of the targets, which ε_j hold, and not by their statistics.
#pragma once

#include "base/memory.h"

#include <stdbool.h>
#include <stdint.h>

struct surrogate {
    size_t variables, features, capacity;
    size_t exact; ///< the feature that steps meet exactly, not in the mean; `features`: none
    const double *target, *target_error; ///< shape [features]; borrowed
    const double *excess;                ///< shape [features]: ε_j²; borrowed
    struct surrogate_rows {
        uint64_t added; ///< rows ever; the last `capacity` are kept
    } rows;
    double *x; ///< shape [capacity, variables]
    double *y; ///< shape [capacity, features]
};

enum status mf_surrogate_init(struct surrogate *surrogate, size_t variables, size_t features,
                              size_t capacity, const double *target, const double *target_error,
                              const double *excess) MUST_USE;
void mf_surrogate_clear(struct surrogate *surrogate);

/// Remember a measurement.
void mf_surrogate_add(struct surrogate *surrogate, const double *variables, const double *features);

/// Rows that a model of so many variables needs at least.
size_t mf_surrogate_min_rows(size_t variables);

/// What the model says at a centre.
struct surrogate_model {
    size_t variables;
    double *best;       ///< shape [variables]: where the target is met best, within [0, 1]
    double *covariance; ///< shape [variables, variables]: of `best`, by the noise of target, model
                        ///< and slopes
};

/// Fit the model to the rows nearest to `centre`; `known` is false, and nothing else set, while
/// there are too few of them for their variables.
/// @param[in] centre  shape [variables]
/// @param[in] reach   largest rms of the step over the variables
/// Fails: NO_MEMORY. Tested: test_surrogate.
enum status mf_surrogate_fit(const struct surrogate *surrogate, const double *centre, double reach,
                             struct surrogate_model *model, bool *known) MUST_USE;
void mf_surrogate_model_clear(struct surrogate_model *model);

enum { SURROGATE_SPANS = 3 };
size_t mf_surrogate_spans(struct surrogate *surrogate, struct memory_span *spans);
