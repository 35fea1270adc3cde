// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Objects whose keys are names of pair types, {"A-A": {…}, "A-B": {…}}: of laws and of
/// targets.
#pragma once

#include "io/json.h"
#include "system/composition.h"

/// Find what the file calls each pair type, "A-B" or "B-A": key[pair], NULL where it has no member.
/// Of the members only objects are looked at, since settings may stand beside. One that names no
/// pair, or names one again, is a fault that lists the names; returns false then.
/// Tested: test_fit_molecules, test_bad_input.
bool mf_pair_names_find(struct json_object *object, const struct composition *composition,
                        const char *key[COMPOSITION_MAX_PAIRS]);

/// Refuse a pair that is named where all are alike, in one line that tells what to write instead.
/// Returns whether there was one.
bool mf_pair_names_refuse(struct json_object *object, const struct composition *composition,
                          const char *instead);
