// SPDX-License-Identifier: GPL-3.0-or-later
/// @file `mesofit bench engine`: the speed of scenes with every instruction set and precision.
#pragma once

#include "report/run_folder.h"

#include <stddef.h>

struct bench_options {
    const char *isa, *precision; ///< the only one to be timed; NULL: all there are
    const char *output;          ///< a TSV file, or NULL
    const char *seconds;         ///< of a repeat, or NULL: long enough
    bool json;                   ///< instead of tables for people
    bool against_lammps;         ///< compare with LAMMPS; the best instruction set alone
    bool skips;                  ///< what each part of a step costs; the best instruction set alone
};

/// Time the scenes in `files`, or those that ship with the program if there are none, and print
/// the results to stdout. What a scene file says of measurements is ignored.
/// @param[in] common  threads, seed and quiet count
/// Fails: BAD_INPUT, IO, NO_MEMORY; UNSTABLE; INTERRUPTED, and nothing is kept.
enum status mf_bench_engine(const char *const *files, size_t count,
                            const struct run_options *common,
                            const struct bench_options *options) MUST_USE;
