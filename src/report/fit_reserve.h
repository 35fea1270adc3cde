// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The names of what a fit writes, refused at its start and not after hours of work.
#pragma once

#include "defaults/fit_file.h"
#include "problem/unknowns.h"
#include "report/run_folder.h"

/// The tables of the verification of one state, as mf_fit_output_observables writes them.
/// @param[in] inside  the state's folder in that of the fit, with / at its end, or ""
/// Fails: as mf_run_folder_reserve.
enum status mf_fit_reserve_observables(const struct fit_file *state, const char *inside,
                                       struct run_folder *folder) MUST_USE;

/// The tables of curves and iterations, as mf_fit_output_curves and mf_history_write write them.
/// Fails: as mf_run_folder_reserve.
enum status mf_fit_reserve_curves(const struct fit_file *fit, const struct unknowns *unknowns,
                                  struct run_folder *folder) MUST_USE;
