// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The last lines of a fit, for a reader who knows nothing of the method: whether it worked,
/// what the result does not know, what can be done next.
#pragma once

#include "report/fit_output.h"
#include "report/progress.h"

/// How well a curve is known over the points that are fitted.
struct curve_knowledge {
    double rms, error; ///< of the curve and of its standard error
    double seen;       ///< share of the points that are two standard errors above 0; NaN: no errors
};

/// Of a friction weight. Tested: test_fit_closing.
struct curve_knowledge mf_fit_closing_knowledge(const struct unknowns *unknowns,
                                                enum unknown_kind kind, const double *curve,
                                                const double *error);

/// Whether more than half of a friction weight is noise, or, where what moves is given without
/// errors, so that all noise is that of the fit's own samples, more than a tenth of it: such a fit
/// has not converged to it, however well its targets are met. Why, into `reason`. Tested:
/// test_fit_closing.
bool mf_fit_closing_is_noise(const struct unknowns *unknowns, const struct targets *targets,
                             const double *const curve[UNKNOWNS],
                             const double *const error[UNKNOWNS], const struct units *units,
                             char reason[INVERSE_REASON_SIZE]);

/// Whether independent simulations of a friction weight that was found are farther from a fitted
/// target than noise explains: such a fit has not converged to it, however well the method settled.
/// Why, into `reason`. Tested: test_fit_closing.
/// @param[in] noise  that of the samples of the fit, in mf_targets_error
bool mf_fit_closing_is_missed(const struct fit_file *fit, const struct verification *verification,
                              double noise, char reason[INVERSE_REASON_SIZE]);

enum { FIT_VERDICT_SIZE = 768 };

/// Whether the fit succeeded: it has, if independent simulations agree with the targets within
/// their errors (problem/verify_agreement.h) and what was fitted is known. Tested:
/// test_fit_closing.
/// @param[in] noise  why it is not known, of mf_fit_closing_is_noise, or ""
void mf_fit_closing_verdict(const struct fit_file *fit, const struct fit_result *result,
                            const char *noise, char text[FIT_VERDICT_SIZE]);

/// Whether g(r) leaves the pressure, or the density at constant pressure, open, and how far, which
/// one that is only compared does not mend. Tested: test_fit_closing.
bool mf_fit_closing_is_open(const struct fit_file *fit, const struct fit_result *result,
                            char text[FIT_VERDICT_SIZE]);

/// Say them. What to do next stands here of a fit that succeeded; of another it follows the reason,
/// which is the message that the program ends with.
void mf_fit_closing_print(struct progress *to, const struct fit_file *fit,
                          const struct unknowns *unknowns, const struct fit_result *result,
                          const char *folder);
