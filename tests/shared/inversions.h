// SPDX-License-Identifier: GPL-3.0-or-later
/// @file An inversion of g(r) from beginning to end, small enough for a test.
#pragma once

#include "inversion/inversion.h"

/// Invert until the method says that it is done, or 40 iterations.
/// @param[in]  precision  of g; 0: the method's default
/// @param[out] phi        of the best, shape [pairs, bins + 1]
/// @param[out] phi_error  its standard errors, the same shape; may be NULL
/// @param[out] step       the last
void inversions_run(const struct inverse_method *method, const struct inverse_problem *problem,
                    double precision, double *phi, double *phi_error, struct inverse_step *step);
