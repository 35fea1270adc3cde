// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Tables of LAMMPS in a text: rows that are numbered, after a line that says how many there
/// are.
#pragma once

#include <stdbool.h>
#include <stddef.h>

enum data_lammps_kind {
    DATA_LAMMPS_NONE,
    DATA_LAMMPS_LAW,     ///< "N 98 R 2.3 12.0": a section of pair_style, bond_style, … table
    DATA_LAMMPS_AVERAGE, ///< "60000 500": a step and rows, of fix ave/time in mode vector
};

/// Put blanks in place of the numbers of rows, and of the line of an average, so that r and its
/// values are left. Nothing changes where rows are not numbered from 1 to what the line says.
/// @param[out] again  line, from 1, at which another section begins, or 0
/// Tested: test_data_table.
enum data_lammps_kind mf_data_lammps_strip(char *text, size_t *again);
