// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What an input of LAMMPS, with the files that it includes, says of itself: which files it
/// reads and writes, whether it sets a pair style, and where mesofit's own lines stand.
#pragma once

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { LAMMPS_INPUT_FILES = 64, LAMMPS_INPUT_NAME = 256, LAMMPS_INPUT_UNITS = 16 };

struct lammps_input {
    size_t files;
    char file[LAMMPS_INPUT_FILES][LAMMPS_INPUT_NAME]; ///< that it reads, as it names them
    char units[LAMMPS_INPUT_UNITS];                   ///< as of `units`; made of variables: ""
    bool sets_style, is_hybrid;                       ///< pair_style
    bool has_interactions, has_run; ///< `include mesofit.lmp` and `include mesofit-run.lmp`
    uint64_t digest;                ///< of all text and of the files that it reads
};

/// Read an input; names are relative to its folder. A name that is made of variables is not known.
/// Fails: IO; BAD_INPUT without one of the includes, for too many files, and if it writes a file
/// that it reads: all replicas would write there. Tested: cli/test_fit_engine.
enum status mf_lammps_input_read(struct lammps_input *input, const char *file) MUST_USE;
