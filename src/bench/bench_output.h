// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Results of the benchmark for people, for programs, and for the record.
#pragma once

#include "bench/bench_case.h"

#include <stdio.h>

/// Print the results of one scene, at least one, as an aligned table: one line a result.
/// @param[in] lammps  show the columns of the comparison instead of those of the engine
/// Fails: NO_MEMORY. Tested: test_bench_output.
enum status mf_bench_output_table(FILE *stream, const struct bench_result *results, size_t count,
                                  bool lammps) MUST_USE;

/// Print all results as a JSON list of objects with all digits; what is not finite is left out.
/// Fails: IO, NO_MEMORY. Tested: test_bench_output.
enum status mf_bench_output_json(FILE *stream, const struct bench_result *results,
                                 size_t count) MUST_USE;

/// Print all results tab-separated under one `#` line with names and units.
/// Tested: test_bench_output.
void mf_bench_output_tsv(FILE *stream, const struct bench_result *results, size_t count);
