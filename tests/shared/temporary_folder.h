// SPDX-License-Identifier: GPL-3.0-or-later
/// @file An empty folder for one test, under $TMPDIR or /tmp.
#pragma once

#include <stdbool.h>
#include <stddef.h>

/// cmocka setup: makes a folder and puts a new `struct temporary_folder *` into *state.
int temporary_folder_create(void **state);

/// cmocka teardown: removes the folder with all that is in it.
int temporary_folder_remove(void **state);

struct temporary_folder {
    char path[512];
    char file[1024]; ///< result of the last temporary_folder_file
};

/// Path of `name` in the folder; valid until the next call.
const char *temporary_folder_file(struct temporary_folder *folder, const char *name);

/// Write `length` bytes to a file in the folder; @return its path as temporary_folder_file does.
const char *temporary_folder_write(struct temporary_folder *folder, const char *name,
                                   const char *bytes, size_t length);

/// The whole file as a NUL-terminated text; free() it.
char *temporary_folder_read(const char *path);

bool temporary_folder_exists(const char *path);
