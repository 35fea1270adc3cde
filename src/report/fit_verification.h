// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Whether the verification confirms a fit that has converged by its own measure.
///
/// The samples of an inversion are of another size, and by moves that know no time step: they can
/// agree with g(r) where a simulation does not. A liquid under tension holds in a small box and
/// cavitates in a large one; a rough potential heats a simulation of too long a step.
#pragma once

#include "defaults/fit_file.h"
#include "problem/verify.h"

/// Why the verified g(r), or the pressure or an integral of Kirkwood and Buff if it was fitted, is
/// not that of the fit, or the temperature more than 5 % off, into `reason`.
/// @param[in] verification  with its agreement
/// @param[in] fitted        the targets that were fitted
/// Returns whether there is a reason. Tested: test_fit_verification.
bool mf_fit_verification_contradicts(const struct verification *verification,
                                     const struct targets *fitted, double temperature,
                                     const struct units *units, char reason[INVERSE_REASON_SIZE]);

/// Why the verified error of all targets is not the one that a method measured itself: it is larger
/// by five standard errors of the difference and by a quarter. The best of many candidates is a
/// lucky draw of one to two standard errors, and a finer time step of the verification makes some
/// per cent.
/// @param[in] error, variance  mf_targets_error by the method, and its variance
/// Returns whether there is a reason. Tested: test_fit_verification.
bool mf_fit_verification_is_worse(const struct verification *verification,
                                  const struct targets *targets, double error, double variance,
                                  char reason[INVERSE_REASON_SIZE]);

/// The same of an inversion whose potentials need not meet the targets: the verification is worse
/// than the samples were, or its temperature more than 5 % off, with the likely cause. Tested:
/// test_fit_verification.
bool mf_fit_verification_is_worse_than_samples(const struct verification *verification,
                                               const struct targets *targets, double error,
                                               double variance, double temperature,
                                               const struct units *units,
                                               char reason[INVERSE_REASON_SIZE]);

/// Simulations warn in reduced units: add the scale to a warning if the file has others. What
/// is known of the time step replaces it.
void mf_fit_verification_add_units(const struct units *units, struct verification *verification);

enum { FIT_STEP_TEXT_SIZE = 384 };

/// One line: the step that was taken, whether it holds, and what would if it does not; "" for a
/// step that the file gives and that holds. Tested: test_fit_time_step.
void mf_fit_step_text(const struct verification *verification, const struct units *units,
                      char text[FIT_STEP_TEXT_SIZE]);

/// ' and "scene.dynamics": {…}' into the verification where the fit chose inner steps for its time
/// step: beside one that the file gives it chooses none. "" elsewhere. Tested:
/// test_fit_verification.
void mf_fit_step_add_dynamics(const struct fit_file *fit, struct verification *verification);

/// Whether the time step shifts the verification's pressure by more than the errors of both.
bool mf_fit_step_shifts_pressure(const struct verification *verification);

/// Whether simulations of a fit that took the first step were too coarse for its result.
bool mf_fit_step_was_shortened(const struct verification *verification);
