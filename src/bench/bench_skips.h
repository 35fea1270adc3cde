// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a scene saves by the parts of a step that it does not need.
#pragma once

#include "bench/bench_case.h"

#include <stdio.h>

/// Time the scene as a fit runs it, and, in turn with it, with one part more or less: each part
/// that it has left out, each that it skips added. Print a line each, with the instruction set and
/// precision of `how`.
/// @param[in] table  for the same tab-separated, or NULL
/// Fails: as mf_bench_case_begin. Tested: test_bench_case, cli/test_bench.
enum status mf_bench_skips(FILE *out, FILE *table, const struct bench_scene *scene,
                           const struct bench_how *how) MUST_USE;

/// The line with the names of the table's columns.
void mf_bench_skips_head(FILE *table);
