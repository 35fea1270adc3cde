// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What an earlier fit left of states that this one has not.
#pragma once

#include "report/run_folder.h"

/// Remove results and figures from the folders of states but those named, and the folders if
/// nothing else is in them. Links, and folders with a run of their own, are left alone. Fails: IO.
/// Tested: test_fit_states.
enum status mf_stale_states_remove(const struct run_folder *folder, const char *const *name,
                                   size_t count) MUST_USE;
