// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The names of a table's columns, and their units, as people write them.
#pragma once

#include "io/data_line.h"

#include <stdint.h>

/// Columns that may be text.
enum { DATA_HEADING_MAX = 64 };

/// Make one line of names, "r[nm]\tg", of the last lines before the rows, comments or not.
///
/// A unit may stand in brackets or, if it is one that is known, in parentheses, or for all columns
/// in the last line, below the names: "r (nm)", "r [nm]" or "nm" below "r" all become "r[nm]".
/// @param[in]  before, last  lines, or zeros
/// @param[in]  separator     of the rows
/// @param[in]  label         a bit for each column of text, whose name is left out
/// @param[in]  columns       of the rows, with those of text
/// @param[out] heading       large enough for both lines and 2 characters more
/// Tested: test_data_table_units.
void mf_data_heading_make(const struct data_line *before, const struct data_line *last,
                          char separator, uint64_t label, size_t columns, char *heading);
