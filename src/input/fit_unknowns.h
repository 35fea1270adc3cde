// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a run file looks for: {"potential": {…}, "omega": {…}, "omega_transverse": {…},
/// "memory": {"slow": {…}}, "numbers": {…}}, the modes of memory by the names that the scene has.
/// A file without "unknowns" looks for the potential.
#pragma once

#include "input/fit_file.h"

/// What the scene leaves out since the object "unknowns" names it: a sum of scene_unknown.
int mf_fit_unknowns_left_out(const struct json_object *unknowns);

/// Read "unknowns" of a run file whose scene is read. Faults go to the document. Fails: NO_MEMORY.
enum status mf_fit_unknowns_read(struct fit_file *fit, struct json_object *root) MUST_USE;

void mf_fit_unknowns_write(const struct fit_file *fit, struct json_writer *writer);
