// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The engine that samples for a fit: what its run file says, and its command line.
#pragma once

#include "defaults/fit_file.h"
#include "report/progress.h"

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
