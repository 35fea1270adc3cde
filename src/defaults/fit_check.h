// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What only the parts of a run file together can get wrong.
#pragma once

#include "defaults/fit_file.h"

/// Check how the parts of what was read fit together, by beginning a simulation; `file` is named in
/// messages. Fails: BAD_INPUT; NO_MEMORY. Tested: test_bad_targets, test_fit_numbers.
enum status mf_fit_check(const struct fit_file *fit, const char *file) MUST_USE;
