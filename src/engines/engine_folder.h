// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The folder of a piece: made anew, with links to what its input needs, and removed.
#pragma once

#include "base/status.h"

#include <stdbool.h>
#include <stdio.h>

/// Begin the folder "engine" in that of a fit: what an earlier fit has left there goes, unless the
/// fit goes on. A file in it says that it is ours: another folder of that name is not touched.
/// Fails: IO; BAD_INPUT for a folder that is not ours.
enum status mf_engine_folder_begin(const char *fit, bool resume) MUST_USE;

/// Make the folder of a piece below that of the fit, empty. Fails: IO.
enum status mf_engine_folder_make(const char *fit, const char *folder) MUST_USE;

/// Remove it with all that is in it; links are removed, not what they name. Fails: IO.
enum status mf_engine_folder_remove(const char *folder) MUST_USE;

/// Link there what lies beside a file under a name, with the folders of that name. Fails: IO.
enum status mf_engine_folder_link(const char *folder, const char *file, const char *name) MUST_USE;

/// Write a file of a folder. Fails: IO.
typedef void engine_print(const void *context, FILE *stream);
enum status mf_engine_write(const char *folder, const char *name, engine_print *print,
                            const void *context) MUST_USE;
enum status mf_engine_write_text(const char *folder, const char *name, const char *text) MUST_USE;
