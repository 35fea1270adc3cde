// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Strict JSON: the only file that knows cJSON.
///
/// Reading collects every fault of a file (unknown key with the nearest known one, wrong type, out
/// of range, missing, duplicate) and reports them together. A document is read through
/// `struct json_object` views; a view remembers which keys were asked for, so that whatever is
/// left over is an unknown key. Numbers must be finite; integers must be below 2^53, because 2^53
/// itself is what 2^53 + 1 reads as. At most 20 faults are reported in full.
#pragma once

#include "base/fields.h"
#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// @name Reading

struct json_document;

enum { JSON_PATH_SIZE = 256, JSON_MAX_KEYS = 64 };

/// One object of a document while it is read. Plain data; lives on the reader's stack.
struct json_object {
    struct json_document *document;
    const void *item;                 ///< NULL if the object is absent
    char path[JSON_PATH_SIZE];        ///< "scene.particles"; "" at the root
    const char *asked[JSON_MAX_KEYS]; ///< keys that the reader knows
    size_t asked_count;
};

/// Parse `file`. Malformed text is BAD_INPUT with file:line:column.
/// On success the caller owns *document (json_close).
enum status json_open(struct json_document **document, const char *file) MUST_USE;

/// View of the document's root, which must be an object.
struct json_object json_root(struct json_document *document);

/// View of the object at `key`; absent optional objects give a view with item NULL, from which
/// json_fields reads the defaults.
struct json_object json_child(struct json_object *parent, const char *key, bool required);

/// True if `key` is present, with any value. Counts as asked for.
bool json_has(struct json_object *object, const char *key);

/// Read the members described by `fields` into `parameters`, defaults where absent.
/// FIELD_FILE values are joined to the folder of the document's file unless absolute. An absent
/// object gives the defaults and no faults: that it is missing was json_child's to say.
void json_fields(struct json_object *object, const struct field *fields, void *parameters);

/// Read a required text such as the name of a law: NULL (and a fault) if absent or not a text.
/// `known` lists the allowed values, NULL-terminated, or is NULL; others are a fault that names
/// the nearest. With `fallback` not NULL the key is optional. The text lives with the document.
const char *json_choice(struct json_object *object, const char *key, const char *const *known,
                        const char *fallback);

/// Read an array of numbers into a new array from memory_zeroed; *count is 0 if it is absent.
enum status json_numbers(struct json_object *object, const char *key, double **values,
                         size_t *count) MUST_USE;

/// Record a fault of the object's own making; `key` may be NULL. The message is printed as
/// "file: path.key: message".
void json_fault(struct json_object *object, const char *key, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/// Record every key of the object that nobody asked for as unknown, with the nearest asked one.
void json_finish(struct json_object *object);

/// Number of faults so far.
size_t json_fault_count(const struct json_document *document);

/// Free the document. BAD_INPUT with all faults, one a line, if there were any.
enum status json_close(struct json_document *document) MUST_USE;

/// @name Writing
/// A tree is built and then written whole. The first problem (no memory, a number that is not
/// finite, a key given twice) is remembered and reported by json_write, so that building needs no
/// checks. Numbers get the fewest digits of %.15g and %.17g that read back to the same bits.

struct json_writer;

struct json_writer *json_writer_create(void); ///< NULL if there is no memory
void json_writer_free(struct json_writer *writer);

/// Enter a new object at `key` of the current object; leave it with json_end.
void json_begin(struct json_writer *writer, const char *key);
void json_end(struct json_writer *writer);

void json_put_number(struct json_writer *writer, const char *key, double value);
/// All digits are written, but json_fields refuses 2^53 and beyond.
void json_put_integer(struct json_writer *writer, const char *key, int64_t value);
void json_put_text(struct json_writer *writer, const char *key, const char *value);
void json_put_numbers(struct json_writer *writer, const char *key, const double *values,
                      size_t count);

/// Write every member that `fields` describes; FIELD_TEXT and FIELD_FILE that are empty, and
/// FIELD_LENGTHS that are all 0, are left out. Reading the result back gives the same bits, except
/// that a relative FIELD_FILE is written absolute, so that it names the same file from any folder.
void json_put_fields(struct json_writer *writer, const struct field *fields,
                     const void *parameters);

/// Write the tree to `file`, whole or not at all (output.h).
enum status json_write(const struct json_writer *writer, const char *file) MUST_USE;
