// SPDX-License-Identifier: GPL-3.0-or-later
/// @file All methods of fits, which stand in a run file by name.
#pragma once

#include "inversion/inversions.h"
#include "matching/matchings.h"

/// Ends with NULL.
extern const struct inverse_method *const mf_methods[];

/// The names of the methods that can do something, for a message: "\"auto\", \"imc\" and \"ibi\"".
/// Returns `text`. Tested: test_methods.
enum { METHODS_TEXT_SIZE = 256 };
const char *mf_methods_list(bool (*can)(const struct inverse_method *method),
                            char text[METHODS_TEXT_SIZE]);

/// Whether a method simulates candidates, and so fits whatever is measured of them.
bool mf_methods_fits_any_target(const struct inverse_method *method);
