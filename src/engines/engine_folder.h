// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The folder of a piece: made anew, with links to what its input needs, and removed.
#pragma once

#include "base/status.h"

#include <stdio.h>

/// Make the folder of a piece below that of the fit, empty. Fails: IO.
enum status mf_engine_folder_make(const char *fit, const char *folder) MUST_USE;

/// Remove it with all that is in it; links are removed, not what they name. Fails: IO.
enum status mf_engine_folder_remove(const char *folder) MUST_USE;

/// Link there all that lies beside a file, so that an input finds what it reads: but for the folder
/// of the fit, and names that are there already. Fails: IO.
enum status mf_engine_folder_link(const char *folder, const char *file, const char *fit) MUST_USE;

/// Write a file of a folder. Fails: IO.
typedef void engine_print(const void *context, FILE *stream);
enum status mf_engine_write(const char *folder, const char *name, engine_print *print,
                            const void *context) MUST_USE;
enum status mf_engine_write_text(const char *folder, const char *name, const char *text) MUST_USE;
