// SPDX-License-Identifier: GPL-3.0-or-later
/// @file All methods of fits, which stand in a run file by name.
#pragma once

#include "defaults/fit_file.h"
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

/// Read the "method" of a run file, if it is there: one by its name with its parameters, or
/// parameters alone, beside which it is chosen. Fails: NO_MEMORY.
enum status mf_methods_read(struct fit_file *fit, struct json_object *root) MUST_USE;

/// Once a method is chosen: whether the parameters without a name are its own.
void mf_methods_check(const struct fit_file *fit, struct json_object *root);

/// Particles of the samples of an inversion; 0: as many as the scene has, or no samples.
size_t mf_methods_sampled_particles(const struct fit_file *fit);
