// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Files that are read.
#pragma once

#include "base/status.h"

#include <stddef.h>
#include <stdio.h>
#include <sys/types.h>

/// Open a file or a pipe for reading. Fails: IO if it cannot be read, or is a folder, a device or a
/// socket: a device such as /dev/zero has no end. Tested: test_data_table, test_checkpoint.
enum status mf_input_open(FILE **stream, const char *file) MUST_USE;

/// The files that a run reads, known by what they are and not by their names: whatever a path to
/// them looks like, the run must not remove or replace them.
struct input_files {
    struct input_file {
        dev_t device;
        ino_t number;
        char *name;
    } * file;
    size_t count, capacity;
};

/// Add a file; one that is not there is none. Fails: NO_MEMORY.
enum status mf_input_files_add(struct input_files *inputs, const char *name) MUST_USE;

/// Fails: BAD_INPUT, naming both, if `path` is one of the files, or a link to one.
enum status mf_input_files_protect(const struct input_files *inputs, const char *path) MUST_USE;

void mf_input_files_clear(struct input_files *inputs);
