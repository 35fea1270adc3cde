// SPDX-License-Identifier: GPL-3.0-or-later
/// @file `mesofit import`: a run file of another program's settings.
#pragma once

#include "import/import_system.h"

struct import_request {
    const char *file, *folder;
    struct import_options options;
    bool force;                ///< replace what is not of an import
    struct progress *progress; ///< that tells what is read and what is left out
};

/// Write DIR/run.json, which `mesofit fit` runs, and copies of the tables that it names. Fails:
/// BAD_INPUT, IO, NO_MEMORY; nothing is then written. Tested: cli/test_import.
enum status mf_import_votca(const struct import_request *request) MUST_USE;
