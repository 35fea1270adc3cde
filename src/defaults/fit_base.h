// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the coefficients of an unknown are added to: "base" of a run file.
#pragma once

#include "defaults/fit_file.h"

/// Faults of what the file says of the base: one of a formula, or a range of coefficients that are
/// to be added but never below 0. Sets what the file leaves out: none where it gives the range of
/// the coefficients, which then is that of the curve; and the lower end of the range.
void mf_fit_base_check(struct fit_unknown *unknown, struct json_object *object);

/// Find the bases of a problem that has been checked, for methods that move coefficients.
/// Fails: NO_MEMORY; BAD_INPUT as mf_inversion_start_curve.
enum status mf_fit_base_find(struct fit_file *fit) MUST_USE;
