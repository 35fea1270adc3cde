// SPDX-License-Identifier: GPL-3.0-or-later
/// @file `mesofit fit`: from a run file to a verified potential.
#pragma once

#include "report/run_folder.h"

/// Carry out the fit in `file`. After every iteration the folder holds history.tsv, timing.tsv,
/// potential.tsv, potential_history.tsv and a checkpoint; at the end also rdf.tsv and
/// summary.json of the verification simulation, and figures.
/// Fails: BAD_INPUT, IO, NO_MEMORY; INTERRUPTED with everything so far on disk; UNCONVERGED when
/// the results are complete but the method's criterion was not met; UNSTABLE when the verification
/// blew up, with a summary that says so. Tested: test_fit.
enum status mf_fit_run(const char *file, const struct run_options *options) MUST_USE;

/// Print what the simulations of the fit in `file` will pay for, and run nothing. Fails: BAD_INPUT.
/// @param[in] ranks  how much faster so many will be (work/fit_tasks.h) is printed, too; 0: it is
/// not
enum status mf_fit_explain(const char *file, const struct run_options *options, int ranks) MUST_USE;
