// SPDX-License-Identifier: GPL-3.0-or-later
/// @file `mesofit simulate`: run one scene and measure it.
#pragma once

#include "base/fields.h"
#include "report/run_folder.h"

/// Fields of the object "rdf" of a scene file, for `mesofit describe`.
extern const struct field mf_simulate_rdf_fields[];

/// Run the scene in `file`; writes used.json, summary.json, rdf.tsv (in a mixture rdf_A-A.tsv,
/// rdf_A-B.tsv and so on, each with the columns of rdf.tsv), thermodynamics.tsv,
/// motion.tsv if the scene asks for it, and figures into the run's folder.
/// Fails: BAD_INPUT, IO; UNSTABLE; INTERRUPTED with a checkpoint in the folder.
enum status mf_simulate_file(const char *file, const struct run_options *options) MUST_USE;

/// Print what the scene in `file` will pay for, and run nothing. Fails: BAD_INPUT.
enum status mf_simulate_explain(const char *file, const struct run_options *options) MUST_USE;
