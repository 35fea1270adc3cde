// SPDX-License-Identifier: GPL-3.0-or-later
/// @file All methods of fits, which stand in a run file by name.
#pragma once

#include "inversion/inversions.h"
#include "matching/matchings.h"

/// Ends with NULL.
extern const struct inverse_method *const mf_methods[];
