// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The family in which a fit looks for ω, by a word: any curve, or one that other engines
/// run.
#pragma once

#include "base/fields.h"
#include "io/json.h"

/// "friction" at the top of a run file, a FIELD_CHOICE at offset 0.
enum fit_friction { FIT_FRICTION_FREE, FIT_FRICTION_EXPORTABLE, FIT_FRICTION_LINEAR };
extern const struct field mf_fit_friction_fields[];

/// Put the family into "unknowns.omega", if that is there: "curve": "power" without an inner
/// cutoff, and its exponent 1 if it is to be linear. What the file says itself is never replaced;
/// another curve, and "unknowns" without omega, are faults. Only of a document whose "friction" was
/// read.
/// @param[out] changed  whether something was put in
/// Fails: NO_MEMORY. Tested: test_fit_friction.
enum status mf_fit_friction_put(struct json_object *root, bool *changed) MUST_USE;
