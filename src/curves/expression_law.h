// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Φ(r) or ω(r) as a formula that the scene states: the law "expression".
#pragma once

#include "curves/curve.h"
#include "curves/expression.h"

/// Φ by the formula, shifted to 0 at the cutoff; below the inner cutoff it goes on as a straight
/// line with its slope there, so that what is infinite at r = 0 can be written down.
extern const struct curve_family mf_expression_potential;

/// ω by the formula for r_0 < r ≤ r_c, else 0, as the law "power".
extern const struct curve_family mf_expression_omega;

struct expression_parameters {
    char formula[FIELD_TEXT_SIZE];
    double inner_cutoff, cutoff;
    /// In which units it is written: its r is r times `length`, and its value the curve's times
    /// `unit`; 0: 1.
    double length, unit;
    /// The formula once it was read (mf_curve_check).
    struct expression expression;
    double shift, inner_value, inner_slope; ///< of it at the cutoffs
};
