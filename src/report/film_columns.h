// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Columns of numbers in the file of a snapshot, whatever its format.
#pragma once

#include "base/status.h"

#include <stddef.h>

/// A snapshot that is open.
struct film_columns {
    const char *file; ///< borrowed
    char *text;       ///< of a VTP file
    struct json_document *document;
    double time, box[3];
    size_t count; ///< particles, of all kinds
};

/// Fails: BAD_INPUT if it is no snapshot of this program, IO, NO_MEMORY.
enum status mf_film_columns_open(struct film_columns *columns, const char *file) MUST_USE;

/// The numbers of this name, `width` a particle, as a new array to be freed, shape [count, width];
/// what the file has not is 0. *values is NULL if no particle has them.
/// Fails: BAD_INPUT, NO_MEMORY.
enum status mf_film_columns_take(struct film_columns *columns, const char *name, size_t width,
                                 double **values) MUST_USE;

/// `status` is what became of reading it: returned, unless the file turns out to have faults.
enum status mf_film_columns_close(struct film_columns *columns, enum status status) MUST_USE;
