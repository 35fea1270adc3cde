// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Several finished fits and simulations side by side.
#pragma once

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>

/// Compare the fits in `folders`: print a table on stdout unless `quiet`, and write to the folder
/// `out` (made if missing)
///   compare.tsv            one row a fit; comment lines give each index its name
///   rdf_compare.tsv        r, target, target_error, result, result_error
///   etd_compare.tsv        time, r0, target, target_error, result, result_error
///   vacf_compare.tsv       time, target, target_error, result, result_error
///   potential_compare.tsv  r, phi, phi_error, truth
///   omega_compare.tsv      r, omega, omega_error, truth
///   error_compare.tsv      iteration, evaluations, engine_steps, seconds, error, noise
///   figures/compare.svg and .png, and compare_dynamics of E and VACF if any fit has them
/// The tables but the first hold one block a fit, two empty lines apart (gnuplot's `index`), with
/// one row of nan for a fit that has no such table; one that no fit has is not written.
/// Of Φ and ω there is what was fitted. A simulation has g(r), E and VACF
/// without a target. A fit is called after the last part of its path that is not "out", with as
/// many parts before it as are needed to tell the fits apart; the same folder again gets a number.
/// `out` may be the folder of a run: nothing there is replaced but an earlier comparison, unless
/// `force`. Fails: BAD_INPUT, also if two units of length differ, or IO with one line that names
/// the file. A figure that fails is a warning on stderr. Tested: test_compare.
enum status mf_compare_folders(const char *const *folders, size_t count, const char *out,
                               bool force, bool quiet) MUST_USE;
