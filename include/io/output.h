// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Files that appear whole or not at all.
#pragma once

#include "base/status.h"

#include <stdio.h>

enum { OUTPUT_PATH_SIZE = 4096 };

/// A file being written under a temporary name beside its place.
struct output {
    FILE *stream;
    char path[OUTPUT_PATH_SIZE];
    char temporary[OUTPUT_PATH_SIZE + 8];
};

/// Open "path.partial" for writing.
enum status output_open(struct output *output, const char *path) MUST_USE;

/// Flush, check every write, and rename to the final path; on any error (disk full, …) the
/// temporary file is removed and the status is STATUS_IO.
enum status output_commit(struct output *output) MUST_USE;

/// Give up: remove the temporary file. Allowed after a failed commit.
void output_abandon(struct output *output);

/// Make a folder and its missing parents; an existing folder is fine.
enum status output_make_folder(const char *path) MUST_USE;
