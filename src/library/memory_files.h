// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Texts and tables in the caller's memory, read as if they were files.
#pragma once

#include "base/status.h"
#include "io/text_file.h"
#include "mesofit/table.h"

/// A text under the name of the file that it stands for, and tables beside it, as texts.
struct memory_files {
    struct memory_file *text; ///< shape [count]
    size_t count;
};

/// Fails: BAD_INPUT for a table without name or numbers; NO_MEMORY.
enum status mf_memory_files_begin(struct memory_files *memory_files, const char *name,
                                  const char *text, const struct mesofit_table *tables,
                                  size_t tables_count) MUST_USE;
void mf_memory_files_end(struct memory_files *memory_files);
