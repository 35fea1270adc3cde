// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How many beads a scene has, and what they weigh, before it is read.
#pragma once

#include "io/json.h"

/// An object if one stands there: what else does is the reader's to say.
struct json_object mf_units_peek(const struct json_object *parent, const char *key);

/// How many beads there are, single ones and those of molecules that stand in the scene itself; 0
/// if a fault will tell why it is not known.
/// @param[out] mean_mass  of all of them, or of the one type; 0 if the scene does not say it
/// Tested: test_units.
double mf_units_beads(const struct json_object *scene, double *mean_mass);
