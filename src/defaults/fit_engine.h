// SPDX-License-Identifier: GPL-3.0-or-later
/// @file "engine" of a run file: another program that samples.
#pragma once

#include "defaults/fit_file.h"

/// Faults of what does not fit together are those of the file.
void mf_fit_engine_read(struct fit_file *fit, struct json_object *root);

/// Nothing without an engine.
void mf_fit_engine_write(const struct fit_file *fit, struct json_writer *writer);

/// Whether the engine may know forces that the scene does not: that of a command, or of an input.
bool mf_fit_engine_knows_more(const struct fit_file *fit);

/// Whether the engine verifies, too: what it may know more of than the scene does, and what the
/// file says.
bool mf_fit_engine_verifies(const struct fit_file *fit);

/// Whether nothing moves by the time step and friction of the scene: all is done by a program that
/// has its own.
bool mf_fit_engine_moves(const struct fit_file *fit);

/// Whether the method samples, and the scene can be sampled elsewhere. Fails: BAD_INPUT. Tested:
/// cli/test_fit_engine.
enum status mf_fit_engine_check(const struct fit_file *fit, const char *file) MUST_USE;
