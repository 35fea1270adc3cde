// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Each state of a fit is verified, and its tables written.
#pragma once

#include "input/fit_file.h"
#include "problem/verify.h"
#include "report/run_folder.h"

/// Simulate a state, or the only one, with what was found.
/// @param[in] curve   shape [UNKNOWNS][points]
/// @param[in] number  shape [INVERSE_MOST_NUMBERS]
/// Fails: as mf_verify and mf_unknowns_laws_make. `verification` is to be cleared.
enum status mf_fit_verify_state(const struct fit_file *state, double *const *curve,
                                const struct inverse_parameter *number,
                                const struct inverse_listener *listener,
                                struct verification *verification) MUST_USE;

/// Tables of state number s: the first has those of the run's folder, the others have folders and
/// figures of their own. Fails: IO, NO_MEMORY.
enum status mf_fit_verify_write(const struct fit_file *fit, size_t s,
                                const struct verification *verification,
                                const struct run_folder *folder) MUST_USE;
