// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The summaries of several fits in one table: on stdout, and in compare.tsv.
#pragma once

#include "io/output.h"
#include "report/result.h"

/// One of the fits that are compared.
struct compared {
    char path[OUTPUT_PATH_SIZE]; ///< absolute, without "out" at its end
    char name[OUTPUT_PATH_SIZE]; ///< without control characters
    struct result result;
};

/// Replace control characters: tabs and line ends have a meaning in the comment lines of tables.
void mf_compare_table_clean(char *text);

/// Print a table of one row a fit. A number that no fit has gets no column.
/// Fails: NO_MEMORY. Tested: test_compare.
enum status mf_compare_table_print(const struct compared *fits, size_t count) MUST_USE;

/// Write compare.tsv to the folder `out`: the numbers that any summary has, under their names
/// there, nan where one does not have them. Comment lines give each index its name and texts.
/// Fails: NO_MEMORY, IO. Tested: test_compare.
enum status mf_compare_table_write(const char *out, const struct compared *fits,
                                   size_t count) MUST_USE;
