// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Energies of local densities that a fit is to find: those that its scene leaves out.
#pragma once

#include "defaults/fit_file.h"

/// Check that the target says what they are found from, and give it an error where it saw nothing.
/// Faults go to the document. Fails: NO_MEMORY.
/// @param[in,out] fit  scene and targets have been read
enum status mf_fit_densities_read(struct fit_file *fit, struct json_object *root) MUST_USE;

/// Refuse what cannot find them. Fails: BAD_INPUT.
enum status mf_fit_densities_check(const struct fit_file *fit, const char *file) MUST_USE;

/// Give the target of a density this many bins, of which its own are the first, and measure it in
/// them. What it has not seen has p = 0 and the error of its last bin. Fails: NO_MEMORY.
enum status mf_fit_densities_widen(struct fit_file *fit, size_t bins) MUST_USE;

/// Append them to the groups of the problem.
void mf_fit_densities_state(const struct fit_file *fit, struct inverse_problem *problem);
