// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Whole text files in memory.
#pragma once

#include "base/status.h"

#include <stddef.h>

/// No text that this program is for comes near it, and a pipe may never end.
#define TEXT_FILE_LARGEST ((size_t)1 << 30)

/// Read `file` into a new NUL-terminated text; a byte order mark at its start is dropped, and a CR
/// without an LF after it becomes one: lines end with LF, or CR and LF.
/// @param[out] text    to be freed with mf_memory_free; NULL on failure
/// @param[out] length  bytes without the terminating NUL
/// Fails: IO as mf_input_open; BAD_INPUT if it is larger than TEXT_FILE_LARGEST, empty or holds a
/// NUL byte, so that the text ends where the file ends. Tested: test_data_table, test_json.
enum status mf_text_file_read(const char *file, char **text, size_t *length) MUST_USE;

/// An in-memory file.
struct memory_file {
    const char *name; ///< of the file, exactly as the reader will ask for it
    const char *text; ///< NULL: it is a table of these numbers
    size_t rows, columns;
    const double *values; ///< shape [rows, columns]
};

/// Until the next call, mf_text_file_read of this thread finds these texts, and mf_data_table_read
/// these tables, in place of files of their names, for callers who have no files. Borrowed; NULL
/// and 0 end it. Tested: test_library.
void mf_text_file_set_memory_files(const struct memory_file *memory_files, size_t count);

/// That of a name, or NULL.
const struct memory_file *mf_text_file_find_memory_file(const char *name);

/// Where a byte of a text stands; both count from 1, columns in characters of UTF-8.
struct text_place {
    size_t line, column;
};

struct text_place mf_text_file_place(const char *text, const char *at);
