// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Writing of JSON.
///
/// A tree is built and then written whole. The first problem (no memory, a key given twice) is
/// remembered and reported by mf_json_write, so that building needs no checks. A number that is not
/// finite is written as null. Other numbers get the fewest digits of %.15g and %.17g that read back
/// to the same bits.
#pragma once

#include "base/fields.h"
#include "base/status.h"
#include "io/units_scale.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

struct json_writer;

struct json_writer *mf_json_writer_create(void);      ///< NULL if there is no memory
struct json_writer *mf_json_writer_create_list(void); ///< the tree is a list of objects
void mf_json_writer_free(struct json_writer *writer);

/// Enter a new object at `key` of the current object, or with `key` NULL a new last object of the
/// list; leave it with mf_json_end.
void mf_json_begin(struct json_writer *writer, const char *key);
/// Enter a new list of objects, which mf_json_begin without a key makes.
void mf_json_begin_list(struct json_writer *writer, const char *key);
void mf_json_end(struct json_writer *writer);

/// Say in which units quantities and fields are to be written, which is reduced until then.
void mf_json_writer_set_units(struct json_writer *writer, const struct units *units);

void mf_json_write_number(struct json_writer *writer, const char *key, double value);
/// A number of a reduced unit, as of a field table. Tested: test_units.
void mf_json_write_quantity(struct json_writer *writer, const char *key, const char *unit,
                            double value);
/// The same with its standard error, "…_error".
void mf_json_put_measured(struct json_writer *writer, const char *key, const char *unit,
                          double value, double error);
/// All digits are written, but mf_json_fields refuses 2^53 and beyond.
void mf_json_write_integer(struct json_writer *writer, const char *key, int64_t value);
void mf_json_write_flag(struct json_writer *writer, const char *key, bool value);
void mf_json_write_text(struct json_writer *writer, const char *key, const char *value);
void mf_json_write_quantities(struct json_writer *writer, const char *key, const char *unit,
                              const double *values, size_t count);
void mf_json_write_texts(struct json_writer *writer, const char *key, const char *const *texts,
                         size_t count);
/// A list of `rows` lists of `width` whole numbers each. @param[in] values  shape [rows, width]
void mf_json_write_rows(struct json_writer *writer, const char *key, const int *values, size_t rows,
                        size_t width);

/// Write every member that `fields` describes; FIELD_TEXT and FIELD_FILE that are empty, and
/// FIELD_LENGTHS that are all 0 and not required, are left out. Reading the result back gives the
/// same bits, except that a relative FIELD_FILE is written absolute, so that it names the same file
/// from any folder.
void mf_json_write_fields(struct json_writer *writer, const struct field *fields,
                          const void *parameters);

/// Write the tree to `file`, whole or not at all (output.h).
enum status mf_json_write(const struct json_writer *writer, const char *file) MUST_USE;

/// Print the tree to an open stream, which `name` names in messages. Fails: IO, NO_MEMORY.
enum status mf_json_write_stream(const struct json_writer *writer, FILE *stream,
                                 const char *name) MUST_USE;
