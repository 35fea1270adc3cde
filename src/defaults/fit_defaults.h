// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the program chooses where a run file does not say it.
///
/// A file that names no method leaves to the program what it does not say: the particles and the
/// time step of the simulations, where the potential ends, friction, method, verification. All of
/// that follows from the targets, the density and the temperature, and is put into the structs that
/// were read: what the file says stays, and used.json, which prints them, gives the same fit. A
/// file with a "method" gets the fixed defaults of the field tables, but for the time step, and
/// friction where nothing else moves the beads; and of molecules for the end of g(r) and the
/// verification.
#pragma once

#include "defaults/fit_file.h"

/// Choose what a fit that was read leaves out, and keep a line of each choice with its reason. What
/// follows from the choices is done by mf_scene_complete, mf_target_files_complete and
/// mf_fit_unknowns_complete.
/// @param[in] leader  the first state, whose range of g(r) the others have; NULL without
/// Fails: NO_MEMORY. Tested: test_fit_defaults, test_default_fits.
enum status mf_fit_defaults_choose(struct fit_file *fit, const struct fit_file *leader) MUST_USE;

/// Find those among the groups of a fit that was read and that looks for what has a target.
void mf_fit_constraints_find(struct fit_file *fit);

/// Give their groups the laws, take their targets out, and keep a line for each as the choices of a
/// fit. Fails: NO_MEMORY. Tested: cli/test_measure_own_targets.
enum status mf_fit_constraints_apply(struct fit_file *fit) MUST_USE;
