// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the program chooses where a run file does not say it.
///
/// A file that names no method leaves to the program what it does not say: the particles and the
/// time step of the simulations, where the potential ends, friction, method, verification. All of
/// that follows from the targets, the density and the temperature, and is put into the document
/// before it is read, as if the file had said it: what it says stays, and used.json gives the same
/// fit. A file with a "method" gets the fixed defaults of the field tables, but for the time step,
/// and friction where nothing else moves the beads; and of molecules for the end of g(r) and the
/// verification.
#pragma once

#include "defaults/fit_file.h"

/// Whether the root of a run file leaves something of that to the program.
bool mf_fit_defaults_wanted(const struct json_object *root);

/// Put in what is chosen, and keep a line of each choice with its reason.
/// @param[in]  read    the same file
/// @param[in]  leader  the first state, whose range of g(r) the others have; NULL without
/// @param[in]  root    of the file as it stands
/// Fails: NO_MEMORY. Tested: test_fit_defaults, test_default_fits.
enum status mf_fit_defaults_choose(const struct fit_file *read, const struct fit_file *leader,
                                   struct json_object *root, struct fit_choices *choices) MUST_USE;
