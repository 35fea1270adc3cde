// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Files that appear whole or not at all. Of several ranks (base/ranks.h) rank 0 writes; what
/// the others write goes nowhere.
#pragma once

#include "base/status.h"

#include <stdbool.h>
#include <stdio.h>

enum { OUTPUT_PATH_SIZE = 4096 };

/// Ends the name of a file that is being written: path, number of the process, that of the file in
/// it, and this.
#define OUTPUT_PARTIAL ".partial"
enum { OUTPUT_PARTIAL_SIZE = 48 };

/// A file being written under a temporary name beside its place. The stream knows its address: it
/// must not be copied.
struct output {
    FILE *stream;
    int file;      ///< that the stream writes to
    int error;     ///< number of the first write that failed, or 0
    bool later;    ///< its bytes come to the disk with those of a file after it
    bool finished; ///< and not published
    char path[OUTPUT_PATH_SIZE];
    char temporary[OUTPUT_PATH_SIZE + OUTPUT_PARTIAL_SIZE];
};

/// Open "path.PROCESS-NUMBER.partial" for writing, a new file that no other process or thread has.
/// Fails: IO; as mf_tracked_files_claim, before anything is written.
enum status mf_output_open(struct output *output, const char *path) MUST_USE;

/// The same of a file that comes to the disk with the next one that this thread commits and that is
/// not so itself: of many snapshots with the checkpoint that counts them.
enum status mf_output_open_later(struct output *output, const char *path) MUST_USE;

/// Flush, check every write, bring the bytes to the disk and rename to the final path, so that
/// after a power cut the file is whole, or the old one is; on any error (disk full, …) the
/// temporary file is removed and the status is STATUS_IO. Tested: test_output.
enum status mf_output_commit(struct output *output) MUST_USE;

/// What this thread has written elsewhere comes to the disk in the same way.
void mf_output_leave_for_later(void);

/// The same in two steps: all bytes are on the disk, and the file gets its name.
enum status mf_output_finish(struct output *output) MUST_USE;
enum status mf_output_publish(struct output *output) MUST_USE;

/// Give up: remove the temporary file. Allowed after a failed commit.
void mf_output_abandon(struct output *output);

/// What a new temporary name ends with, ".PROCESS-NUMBER.partial"; and how long the name is without
/// it, 0 if it does not end so.
void mf_output_partial(char ending[OUTPUT_PARTIAL_SIZE]);
size_t mf_output_partial_stem(const char *name);

/// Make a folder and its missing parents; an existing folder is fine. Fails: IO; as
/// mf_tracked_files_make_folder.
enum status mf_output_make_folder(const char *path) MUST_USE;
