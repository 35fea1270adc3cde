// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a finished fit says on the terminal.
#pragma once

#include "problem/unknowns.h"
#include "report/fit_output.h"
#include "report/progress.h"

/// How it ended, how far the fit came from its first iteration, the parameters of a formula, and
/// what the verification found.
void mf_fit_report_print(struct progress *to, const struct fit_file *fit,
                         const struct unknowns *unknowns, const struct fit_result *result);

/// The formula that a fit found, in the units of its file; NULL: none, which is "".
void mf_fit_report_formula(const struct fit_file *fit, const char *formula,
                           char text[FIELD_TEXT_SIZE]);

/// Of one curve, over the points that the data determine.
struct fit_change {
    double rms;           ///< of the difference, in the unknown's unit
    double well, well_at; ///< the lowest point of a potential [k_B T_0] [λ]
    double well_error;    ///< of the potential there; NAN: not known
    double first_well, first_well_at;
};

/// From the first iteration to the last. Tested: test_fit_change.
struct fit_change mf_fit_change_find(const struct unknowns *unknowns, enum unknown_kind kind,
                                     size_t curve, const struct fit_result *result);
