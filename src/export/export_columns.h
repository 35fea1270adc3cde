// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Columns of a result's table by their names, in reduced units whatever its heading says;
/// and the friction that stands in such tables, and what of it another engine could have.
#pragma once

#include "base/status.h"
#include "export/export_model.h"
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

/// Read what was fitted of the friction, and part it: model->own_omega and own_memory are all of
/// it; the setup keeps what is without memory, along pairs and across them. If any has memory the
/// setup has none, as what would be left of it is another friction. Fails: IO; BAD_INPUT;
/// NO_MEMORY.
/// @param[in] unknown  a sum of scene_unknown: what the scene left to the fit
/// Tested: cli/test_export_fits, cli/test_export_folders.
enum status mf_export_friction_find(struct export_model *model, int unknown) MUST_USE;

void mf_export_friction_clear(struct export_model *model);
