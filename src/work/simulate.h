// SPDX-License-Identifier: GPL-3.0-or-later
/// @file `mesofit simulate`: run one scene and measure it.
#pragma once

#include "report/run_folder.h"

/// Run the scene in `file`; writes used.json, summary.json, the tables of all observables that are
/// measured, and figures into the run's folder.
/// Fails: BAD_INPUT, IO; UNSTABLE; INTERRUPTED with a checkpoint in the folder.
enum status mf_simulate_file(const char *file, const struct run_options *options) MUST_USE;

/// Print what the scene in `file` will pay for, and run nothing. Fails: BAD_INPUT.
enum status mf_simulate_explain(const char *file, const struct run_options *options) MUST_USE;
