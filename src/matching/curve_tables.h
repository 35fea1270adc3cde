// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The curves of several candidates, side by side in tables.
#pragma once

#include "problem/parametrisation.h"

enum { CURVE_TABLES_NAME_SIZE = 24 };

struct curve_tables_member {
    const double *variables;
    char name[CURVE_TABLES_NAME_SIZE]; ///< of its column
};

/// Write a table for each curve of each unknown, `prefix`_potential.tsv and so on: r and a column
/// for each member.
/// @param[in] comment  first line, or NULL
/// Fails: IO, NO_MEMORY. Tested: cli/test_fit, cli/test_fit_pareto.
enum status mf_curve_tables_write(const struct parametrisation *parametrisation,
                                  const struct inverse_folder *folder, const char *prefix,
                                  const char *comment, const struct curve_tables_member *member,
                                  size_t members) MUST_USE;
