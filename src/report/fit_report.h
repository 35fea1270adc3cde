// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a finished fit says on the terminal.
#pragma once

#include "report/fit_output.h"
#include "report/progress.h"

/// How it ended, how far the fit came from its first iteration, the parameters of a formula, and
/// what the verification found.
void mf_fit_report_print(struct progress *to, const struct fit_file *fit,
                         const struct unknowns *unknowns, const struct fit_result *result);

/// The formula that a fit found, in the units of its file; NULL: none, which is "".
void mf_fit_report_formula(const struct fit_file *fit, const char *formula,
                           char text[FIELD_TEXT_SIZE]);
