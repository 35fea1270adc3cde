// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Tables of VOTCA: rows "x y flag" or "x y error flag", in nm and kJ/mol.
///
/// The flag is i (in the range of the data), o (outside: continued) or u (undefined). What stands
/// before the first i and after the last is left out, since what VOTCA continued there is not
/// measured; an o or u between them is a fault. Rows "x y" without any flag are all in range.
#pragma once

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>

struct votca_table {
    size_t rows;
    double *x, *y, *error; ///< shape [rows]; error 0 if the file has none
    size_t *line;          ///< shape [rows]: line number in the file, for messages
    bool has_error;
};

/// Fails: IO; BAD_INPUT with file:line; NO_MEMORY. Tested: test_votca.
enum status mf_votca_read(struct votca_table *table, const char *file) MUST_USE;
void mf_votca_clear(struct votca_table *table);

/// What a file's units are in numbers of its writer: 1 of x in nm, 1 of y in kJ/mol.
struct votca_scale {
    double x, y;
};

/// Write rows "x y flag": o before row `first`, i from there on. Fails: IO.
enum status mf_votca_write(const char *file, const double *x, const double *y,
                           struct votca_scale scale, size_t rows, size_t first) MUST_USE;
