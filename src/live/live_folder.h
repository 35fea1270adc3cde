// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Files beneath one folder, and none outside it.
///
/// A path is relative and of plain names: no "..", nothing hidden, no control characters, nothing
/// that is no UTF-8, in which alone a page can name it. It is
/// opened name by name beneath the folder, and no link is followed, so that it cannot lead out
/// whatever changes meanwhile. Tested: test_live_folder.
#pragma once

#include "base/status.h"
#include "io/tracked_files.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/// Most that a page may write into a file [bytes].
enum { LIVE_FOLDER_LARGEST = 16 << 20 };

/// Whether a path is of plain names; "" is the folder itself.
bool mf_live_folder_is_plain(const char *path);

/// Open a folder beneath a folder; −1 with a message of BAD_INPUT or IO.
/// @param[in] root  an open folder
int mf_live_folder_enter(int root, const char *path);

/// Whether a folder is there or can be made without leaving `root`: no part of its path that exists
/// is a link or a file. Fails: BAD_INPUT.
enum status mf_live_folder_check_new(int root, const char *path) MUST_USE;

/// Open a regular file for reading; −1 with a message. `size` gets its bytes.
int mf_live_folder_read(int root, const char *path, size_t *size);

/// Write a file, whole or not at all: data and settings alone, by the ends of their names.
/// Fails: BAD_INPUT for another name, or if it is there and is not to be replaced; IO.
enum status mf_live_folder_write(int root, const char *path, const void *bytes, size_t size,
                                 bool replace) MUST_USE;

/// What is in a folder that a plain path can name, sorted by names, as JSON: a list of objects with
/// name, size, seconds (when it was written), folder (0 or 1). Fails: IO, NO_MEMORY, BAD_INPUT.
enum status mf_live_folder_list(int root, const char *path, FILE *stream) MUST_USE;

/// Act for every regular file of a folder and, `deep` folders down, of those in it.
/// @param[in] act  gets an open file, which stays the caller's, and its path beneath the root
enum status mf_live_folder_each(int root, const char *path, int deep,
                                enum status (*act)(void *context, int file, size_t size,
                                                   const char *name),
                                void *context) MUST_USE;

/// A folder for a while: tables of a simulation that runs, beneath TMPDIR or /tmp. Its list of
/// files (io/tracked_files.h) says what it is. The process that made it holds a lock on it, which
/// the system takes back however the process ends: one with a list and without a lock is left over
/// from a process that was killed, and who makes the next one removes what is in that list, if it
/// is of the same user.
struct live_scratch {
    char path[OUTPUT_PATH_SIZE]; ///< "": there is none
    struct tracked_files own;
};

/// Make one, and remove those that are left over. Without a place for it the path is "". It must
/// not be moved. Tested: test_live_scratch.
void mf_live_scratch_make(struct live_scratch *scratch);

/// Remove it with its files.
void mf_live_scratch_remove(struct live_scratch *scratch);
