// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Texts and tables in the caller's memory, read as if they were files.
#pragma once

#include "base/status.h"
#include "io/text_file.h"
#include "mesofit/run.h"
#include "mesofit/table.h"

/// Texts under the names of the files that they stand for, and tables beside them, as texts.
struct memory_files {
    struct memory_file *text; ///< shape [count]
    size_t count, borrowed;   ///< the first ones are the caller's own
};

/// Fails: BAD_INPUT for a text or table without name or content; NO_MEMORY.
enum status mf_memory_files_begin(struct memory_files *memory_files,
                                  const struct mesofit_text *texts, size_t text_count,
                                  const struct mesofit_table *tables, size_t table_count) MUST_USE;

/// The same with one text.
enum status mf_memory_files_begin_one(struct memory_files *memory_files, const char *name,
                                      const char *text, const struct mesofit_table *tables,
                                      size_t table_count) MUST_USE;
void mf_memory_files_end(struct memory_files *memory_files);
