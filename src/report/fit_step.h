// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What is said of the time step of a verification (problem/verify_step.h).
#pragma once

#include "problem/verify.h"

enum { FIT_STEP_TEXT_SIZE = 384 };

/// One line: the step that was taken, whether it holds, and what would if it does not; "" for a
/// step that the file gives and that holds. Tested: test_fit_time_step.
void mf_fit_step_text(const struct verification *verification, const struct units *units,
                      char text[FIT_STEP_TEXT_SIZE]);

/// Why temperatures are off, as far as other time steps tell, and what helps; "" if they do not
/// tell. Tested: test_fit_verification.
void mf_fit_step_cause(const struct verification *verification, const struct units *units,
                       char text[FIT_STEP_TEXT_SIZE]);

/// Whether the time step shifts the verification's pressure by more than the errors of both.
bool mf_fit_step_shifts_pressure(const struct verification *verification);

/// Whether simulations of a fit that took the first step were too coarse for its result.
bool mf_fit_step_was_shortened(const struct verification *verification);
