// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Texts and tables in the caller's memory, read as if they were files.
#pragma once

#include "base/status.h"
#include "io/text_file.h"
#include "mesofit/run.h"
#include "mesofit/table.h"

/// Texts and tables under the names of the files that they stand for. The caller's own.
struct memory_files {
    struct memory_file *file; ///< shape [count]
    size_t count;
};

/// Fails: BAD_INPUT for a text or table without name or content; NO_MEMORY.
enum status mf_memory_files_begin(struct memory_files *memory_files,
                                  const struct mesofit_text *texts, size_t text_count,
                                  const struct mesofit_table *tables, size_t table_count) MUST_USE;
void mf_memory_files_end(struct memory_files *memory_files);
