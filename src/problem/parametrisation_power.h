// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A friction weight that is a formula: what its variables make, for
/// problem/parametrisation.c.
#pragma once

#include "problem/parametrisation.h"

/// ω at the points of the grid from all variables, shape [OMEGA_POINTS].
void mf_parametrisation_power_curve(const struct parametrisation *parametrisation,
                                    const double *variables, double *curve);

/// Variables of a formula with sigma in the middle of its range, or those of the start if it is the
/// same formula.
void mf_parametrisation_power_start(const struct parametrisation *parametrisation,
                                    double *variables);
