// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The family in which a fit looks for ω, by a word: any curve, or one that other engines
/// run.
#pragma once

#include "defaults/fit_file.h"

/// "friction" at the top of a run file, a FIELD_CHOICE at offset 0.
enum fit_friction { FIT_FRICTION_FREE, FIT_FRICTION_EXPORTABLE, FIT_FRICTION_LINEAR };
extern const struct field mf_fit_friction_fields[];

/// Let ω be of the family: "curve": "power" without an inner cutoff, and its exponent 1 if it is to
/// be linear. What the file says itself is never replaced. False if it says another curve. Tested:
/// test_fit_friction.
bool mf_fit_friction_take(struct fit_unknown *omega, enum fit_friction family);
