// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The "method" of a run file: a method by its name with its parameters, or parameters alone,
/// beside which it is chosen.
#pragma once

#include "defaults/fit_file.h"

/// Read it, if it is there. Fails: NO_MEMORY.
enum status mf_fit_method_read(struct fit_file *fit, struct json_object *root) MUST_USE;

/// Once a method is chosen: whether the parameters without a name are its own.
void mf_fit_method_check(const struct fit_file *fit, struct json_object *root);
