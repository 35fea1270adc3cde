// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Files that appear whole or not at all. Of several ranks (base/ranks.h) rank 0 writes; what
/// the others write goes nowhere.
#pragma once

#include "base/status.h"

#include <stdio.h>

enum { OUTPUT_PATH_SIZE = 4096 };

/// Ends the name of a file that is being written: path, number of the process and this.
#define OUTPUT_PARTIAL ".partial"

/// A file being written under a temporary name beside its place. The stream knows its address: it
/// must not be copied.
struct output {
    FILE *stream;
    int file;  ///< that the stream writes to
    int error; ///< number of the first write that failed, or 0
    char path[OUTPUT_PATH_SIZE];
    char temporary[OUTPUT_PATH_SIZE + 32];
};

/// Open "path.PROCESS.partial" for writing, a new file: one of that name is removed, and a link is
/// not followed.
enum status mf_output_open(struct output *output, const char *path) MUST_USE;

/// Flush, check every write, bring the bytes to the disk and rename to the final path, so that
/// after a power cut the file is whole, or the old one is; on any error (disk full, …) the
/// temporary file is removed and the status is STATUS_IO. Tested: test_output.
enum status mf_output_commit(struct output *output) MUST_USE;

/// Give up: remove the temporary file. Allowed after a failed commit.
void mf_output_abandon(struct output *output);

/// Make a folder and its missing parents; an existing folder is fine.
enum status mf_output_make_folder(const char *path) MUST_USE;
