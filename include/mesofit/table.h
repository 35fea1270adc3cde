/* SPDX-License-Identifier: GPL-3.0-or-later */
/** @file Numbers in memory, where a scene or a run file names a file. */
#ifndef MESOFIT_TABLE_H
#define MESOFIT_TABLE_H

#include <stddef.h>

/** Rows of numbers that stand for a file: {"file": "g"} reads the table called "g". Borrowed for
 * the call that gets it. */
struct mesofit_table {
    const char *name;
    size_t rows, columns;
    const double *values; /**< shape [rows, columns], row-major */
};

#endif
