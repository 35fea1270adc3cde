// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the tasks of a fit took, and how much faster more processes will be.
#pragma once

#include "defaults/fit_file.h"
#include "problem/unknowns.h"
#include "report/run_folder.h"

#include <stdio.h>

/// Write tasks.tsv: for each number of tasks that were done together how often that was, what a
/// task took, how much that scatters within a round, and how long all were waited for, since this
/// process began; in the first row, of no tasks, all else, which every rank does itself.
/// @param[in] seconds  since the process began [s]
enum status mf_fit_tasks_write(const struct run_folder *folder, double seconds) MUST_USE;

/// The mean of that over many draws of times that are log-normal.
/// @param[in] mean, spread  of a task's time [s], and its standard deviation [s]
/// Tested: test_fit_tasks.
double mf_fit_tasks_span(size_t tasks, double mean, double spread, int workers);

/// Print how much faster the fit of `file` will be with up to `ranks` processes of as many threads
/// as the options say, by the tasks.tsv in its folder. Fails: IO, BAD_INPUT if that is no such
/// table.
enum status mf_fit_tasks_explain(FILE *out, const char *file, const struct run_options *options,
                                 int ranks) MUST_USE;

/// Digest of what was read and of how this processor computes: ranks that differ here would keep
/// different states. The C library takes other instructions for exp and its like on processors of
/// another kind, and so do the kernels.
uint64_t mf_fit_ranks_digest(const struct fit_file *fit);

/// Digest of the curves after an iteration.
/// @param[in] curve  shape [UNKNOWNS][mf_unknowns_points]
uint64_t mf_fit_ranks_digest_curves(const struct unknowns *unknowns, double *const *curve);
