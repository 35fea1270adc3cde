// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Each state of a fit is verified, and its tables written.
#pragma once

#include "defaults/fit_file.h"
#include "problem/verify.h"
#include "report/progress.h"
#include "report/run_folder.h"

/// Refuse now a fit that could not write the folders of its states, or the tables of their
/// verifications. Fails: as mf_run_folder_check_state and mf_run_folder_reserve.
enum status mf_fit_verify_folders(const struct fit_file *fit, struct run_folder *folder) MUST_USE;

/// Simulate all states with what was found; the listener gets the simulations of all. Those of an
/// inversion that contradict its samples begin once more, after four times as many steps as they
/// had in all: from a random mixture clusters and slow waves of composition are long on their way,
/// and too slow to be seen as a drift.
/// @param[in]  curve         shape [UNKNOWNS][points]
/// @param[in]  number        shape [INVERSE_MAX_NUMBERS]
/// @param[in]  of_fit        of an inversion that has converged; else NULL
/// @param[in]  progress      is told if they begin once more
/// @param[out] verification  shape [states], zeros; to be cleared
/// Fails: as mf_verify and mf_unknowns_laws_make.
enum status mf_fit_verify_states(struct fit_file *fit, double *const *curve,
                                 const struct inverse_parameter *number,
                                 const struct inverse_step *of_fit, struct progress *progress,
                                 const struct inverse_listener *listener,
                                 struct verification *verification) MUST_USE;

/// Whether the verification of any state contradicts the fit, and why. An inversion has converged
/// only if the result agrees with the target, by the same measure as its samples did
/// (problem/verify_agreement.h). Other methods, and inversions by few coefficients, do not say that
/// they agree, but how far they are off: that is what must be borne out.
/// @param[in,out] verification  shape [states]; how far each agrees with its targets is found
bool mf_fit_verify_any_contradicts(const struct fit_file *fit, struct verification *verification,
                                   const struct inverse_step *of_fit,
                                   char reason[INVERSE_REASON_SIZE]);

/// Tables of state number s: the first has those of the run's folder, the others have folders and
/// figures of their own. Fails: IO, NO_MEMORY.
enum status mf_fit_verify_write(const struct fit_file *fit, size_t s,
                                const struct verification *verification,
                                const struct run_folder *folder) MUST_USE;
