// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The table of where all beads are, and beside it which of them are bonded.
#pragma once

#include "io/data_table.h"
#include "system/composition.h"
#include "system/topology.h"

#define CONFIGURATION_FILE "configuration.tsv"
#define CONFIGURATION_BONDS_FILE "configuration_bonds.tsv" ///< beside it

/// Write columns, of a row a bead by its id, as mf_data_table_write_in does. In a mixture a comment
/// tells how many rows each type has, "types: A 20 B 10". If there are bonds, `bonds_file` has a
/// row for each: the rows of its two beads, from 1 on.
/// @param[in] topology  NULL: there are no molecules
/// Fails: IO, NO_MEMORY. Tested: test_configuration.
enum status mf_configuration_write(const char *file, const char *bonds_file,
                                   const struct units *units, const struct composition *composition,
                                   const struct topology *topology,
                                   const struct data_column *columns, size_t count,
                                   size_t rows) MUST_USE;
