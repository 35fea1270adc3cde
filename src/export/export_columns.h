// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Columns of a result's table by their names, in reduced units whatever its heading says.
#pragma once

#include "base/status.h"
#include "io/units.h"

#include <stdbool.h>
#include <stddef.h>

/// A column that is to be read.
struct export_column {
    const char *name, *unit; ///< its reduced unit
    bool required;
};

struct export_columns {
    size_t rows;
    double *values; ///< shape [columns wanted, rows]; NAN where the table has no such column
};

/// Read the columns `wanted`, up to one without a name, from a table whose heading is
/// "name[unit]<tab>name[unit]…"; of two of one name the first counts. Those that are required come
/// first.
/// Fails: IO; BAD_INPUT for a table without one of those, or with a unit that `units` do not know;
/// NO_MEMORY. Tested: test_export_model.
enum status mf_export_columns_read(struct export_columns *columns, const char *file,
                                   const struct units *units,
                                   const struct export_column *wanted) MUST_USE;
void mf_export_columns_clear(struct export_columns *columns);
