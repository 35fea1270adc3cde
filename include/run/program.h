// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Other programs: start one, wait for its end, keep what it says; and the files of this one.
#pragma once

#include "base/status.h"

#include <stddef.h>

/// What to keep of what a program says.
enum program_says {
    PROGRAM_ERRORS,     ///< stderr; stdout goes nowhere
    PROGRAM_EVERYTHING, ///< both, as they come
};

/// Run words[0], found in PATH, with `words`, NULL-terminated, in `folder`, without input.
/// @param[in] seconds  it is stopped, with all that it has started, if it takes longer; 0: any time
/// @param[out] text  the last size − 1 bytes of what it says
/// @param[in]  size  above 512
/// Fails: IO with one line that names the program: not installed, ended by a signal, stopped as
/// too slow, or failed with the last line that it said. Tested: test_program.
enum status program_run(const char *folder, const char *const *words, enum program_says says,
                        double seconds, char *text, size_t size) MUST_USE;

/// Find a folder that ships with this program, such as "plots", by a file that it must have.
///
/// A program that is being built lies one or more folders below the source tree; one that is
/// installed lies in bin beside share: `name` or `share/mesofit/name`, in the program's folder or
/// in any folder above it.
/// @param[out] path  of `size` bytes
/// Fails: IO. Tested: test_program.
enum status program_find_folder(char *path, size_t size, const char *name,
                                const char *file) MUST_USE;
