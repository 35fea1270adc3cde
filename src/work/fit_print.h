// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a fit says before it begins, and inside its iterations.
#pragma once

#include "defaults/fit_file.h"
#include "report/progress.h"
#include "targets/target_sanity.h"
#include "work/fit_verify.h"

enum { FIT_TELL_SIZE = 192 };

/// An iteration that has ended, with the error of a method that has one.
void mf_fit_print_step(const struct inverse_step *step, double seconds, struct progress *progress);

/// Where an iteration is, in words for the line of its progress. Tested: test_fit_print.
void mf_fit_print_iteration(const struct inverse_progress *now, const struct units *units,
                            char text[FIT_TELL_SIZE]);

/// Say what is to be fitted, so that a wrong column or unit is seen before the work. Fails: as
/// mf_target_sanity_report.
enum status mf_fit_print_targets(struct progress *to, const struct fit_file *fit) MUST_USE;

/// The lines about the targets of one state, and a warning if the steps of the verification are too
/// long for the bonds among them. Fails: as mf_target_sanity_report. Tested: test_fit_molecules,
/// test_fit_print.
enum status mf_fit_print_state(const struct fit_file *fit,
                               const struct target_sanity_listener *listener) MUST_USE;

/// What the verification of each state warns of.
/// @param[in] verification  shape [states]
void mf_fit_print_warnings(struct progress *to, const struct fit_file *fit,
                           const struct verification *verification);

/// The message of a fit that has not converged. A method without an error and without a reason has
/// not measured anything.
void mf_fit_print_unconverged(const char *folder, const struct inverse_step *step,
                              const char *reason);

/// Refuse a command line with an engine beside a run file without one. Fails: BAD_INPUT.
enum status mf_fit_engine_expect(const struct fit_file *fit,
                                 const struct engine_door *door) MUST_USE;

/// Open it for the problem of the fit; nothing if the file has none.
/// @param[in]  door    who opens, with the command; NULL: nobody
/// @param[in]  folder  of the fit
/// Fails: BAD_INPUT if file and command line do not go together; as engine_door.open.
enum status mf_fit_engine_open(struct fit_file *fit, const struct engine_door *door,
                               const char *folder, bool resume) MUST_USE;

/// Whether a fit that was stopped waits for somebody who runs its pieces: the message says so then,
/// and that is no failure.
bool mf_fit_engine_waits(const struct fit_file *fit, const struct engine_door *door);

/// mf_fit_print_targets, but for the rounds of one fit that goes on again and again.
enum status mf_fit_engine_print_targets(struct progress *to, const struct fit_file *fit,
                                        bool resume) MUST_USE;

void mf_fit_engine_close(struct fit_file *fit, const struct engine_door *door);
