// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Strict reading of JSON.
///
/// It collects every fault of a file (unknown key with the nearest known one, wrong type, out
/// of range, missing, duplicate) and reports them together. A document is read through
/// `struct json_object` views; a view remembers which keys were asked for, so that whatever is
/// left over is an unknown key. Numbers must be finite; integers must be below 2^53, because 2^53
/// itself is what 2^53 + 1 reads as. At most 20 faults are reported in full.
#pragma once

#include "base/fields.h"
#include "base/status.h"
#include "io/input.h"
#include "io/units_scale.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct json_document;

enum { JSON_PATH_SIZE = 256, JSON_MAX_KEYS = 128, JSON_MAX_MEMBERS = 1000, JSON_DEEPEST = 64 };

/// One object of a document while it is read. Plain data; lives on the reader's stack.
struct json_object {
    struct json_document *document;
    const void *item;                 ///< NULL if the object is absent
    char path[JSON_PATH_SIZE];        ///< "scene.particles"; "" at the root
    const char *asked[JSON_MAX_KEYS]; ///< keys that the reader knows
    size_t asked_count;
    const char *refused[JSON_MAX_KEYS]; ///< keys that are there and are refused with a reason
    size_t refused_count;
};

/// Parse `file`. Malformed text is BAD_INPUT with file:line:column; more than JSON_MAX_MEMBERS
/// keys in an object, or JSON_DEEPEST objects and arrays one in the other, are BAD_INPUT.
/// On success the caller owns *document (mf_json_close).
enum status mf_json_open(struct json_document **document, const char *file) MUST_USE;

/// The same of a text that was made of `file`.
enum status mf_json_open_text(struct json_document **document, const char *file,
                              const char *text) MUST_USE;

/// Put the document's own file into `inputs`, and from now on every file that a FIELD_FILE names.
/// Both live as long as the document. Fails: NO_MEMORY. Tested: test_json.
enum status mf_json_collect_files(struct json_document *document,
                                  struct input_files *inputs) MUST_USE;

/// Say in which units the numbers of the document are, which is reduced until then. Tested:
/// test_units.
void mf_json_set_units(struct json_document *document, const struct units *units);

/// In which units the numbers of the object are.
const struct units *mf_json_units(const struct json_object *object);

/// What is said beside a file, by the command line or by a caller of the library: one member of one
/// of its objects.
struct json_word {
    const char *object; ///< path, "scene.particles", of what is made if it is missing; NULL: root
    const char *key;
    const char *text, *json; ///< a text, or a value in JSON; both NULL: numbers
    size_t count;            ///< of `values`; 0: it is the number `value`
    double value;
    const double *values;
};

/// Put words into the document, before its root is viewed. Fails: NO_MEMORY; BAD_INPUT if the file
/// says one of them, too, or if there is no value in the JSON. Tested: test_json_words,
/// cli/test_fit_target, test_library.
enum status mf_json_add(struct json_document *document, const struct json_word *words,
                        size_t count) MUST_USE;

/// Make the document what member number n of its object `key` makes of it: that object goes, and
/// the member is merged into the rest (RFC 7396, JSON Merge Patch). Before its root is viewed.
/// Fails: NO_MEMORY; BAD_INPUT if the member is no object. Tested: test_json.
enum status mf_json_take_variant(struct json_document *document, const char *key,
                                 size_t n) MUST_USE;

/// View of the document's root, which must be an object.
struct json_object mf_json_root(struct json_document *document);

/// View of the object at `key`; absent optional objects give a view with item NULL, from which
/// mf_json_fields reads the defaults.
struct json_object mf_json_child(struct json_object *parent, const char *key, bool required);

/// The same of an object whose chief key, as "law", may be all that somebody has written of it: the
/// fault then says {"law": …}. Tested: test_json.
struct json_object mf_json_child_of(struct json_object *parent, const char *key, bool required,
                                    const char *chief);

/// True if `key` is present, with any value. Counts as asked for.
bool mf_json_has(struct json_object *object, const char *key);

/// Whether an object stands at `key`. Counts as nothing. Tested: test_json.
bool mf_json_is_object(const struct json_object *object, const char *key);

/// Whether anything stands at `key`. Counts as nothing.
bool mf_json_is_member(const struct json_object *object, const char *key);

/// How many items the array at `key` has; 0 if there is none. Counts as nothing. Tested: test_json.
int mf_json_count(const struct json_object *object, const char *key);

/// The key of member number n of an object whose keys the file chooses, or NULL beyond the last.
/// The text lives with the document. Counts as nothing: the reader asks for the keys that it takes.
const char *mf_json_key(const struct json_object *object, size_t n);

/// Refuse a key of an earlier version, if it is present, with the reason; but not one that says
/// what is so now, as in what earlier versions have written. Several in a document are one fault.
/// @param[in] fixed  the text or the number that it must be, or NULL if it can be none
/// Tested: test_json, test_json_retired.
void mf_json_retired(struct json_object *object, const char *old, const char *fixed,
                     const char *reason);

/// Refuse a key that has no place here, if it is present, with the reason. Tested: test_json.
void mf_json_refuse(struct json_object *object, const char *key, const char *reason);

/// The number, or the list of up to `max` numbers, at `key` as they stand there; 0 if there are
/// none. Counts as nothing, and faults are left to the reader. Tested: test_units.
int mf_json_numbers(const struct json_object *object, const char *key, double *values, int max);

/// Read the members described by `fields` into `parameters`, defaults where absent. Numbers of the
/// document's units become numbers of the fields' (mf_units_factor); defaults and ranges are those
/// of the fields, and messages are in the units of the document. FIELD_FILE values are joined to
/// the folder of the document's file unless absolute. An absent object gives the defaults and no
/// faults: that it is missing was mf_json_child's to say. null, as mf_json_write_number writes what
/// is not known, is allowed for numbers whose default is NAN.
/// Returns the fields that the object has, as bits of mf_fields_bit. Tested: test_json_words.
uint64_t mf_json_fields(struct json_object *object, const struct field *fields, void *parameters);

/// Of a law: lengths and times that `object` leaves to their defaults are faults where the program
/// chooses the unit of length (units.chosen), which follows the density, so that the law would,
/// too. Tested: test_units_files.
void mf_json_fields_need_scale(struct json_object *object, const struct field *fields);

/// Read a required text such as the name of a law: NULL (and a fault) if absent or not a text.
/// `known` lists the allowed values, NULL-terminated, or is NULL; others are a fault that names
/// the nearest. With `fallback` not NULL the key is optional. The text lives with the document.
const char *mf_json_choice(struct json_object *object, const char *key, const char *const *known,
                           const char *fallback);

/// How many of the document's units a reduced `unit` is, for messages: mf_units_factor.
double mf_json_factor(const struct json_object *object, const char *unit);

/// The allowed range of a field in the document's units, "above 0 nm", for messages.
void mf_json_range_text(const struct json_object *object, const struct field *field, char *text,
                        size_t size);

/// Record a fault of the object's own making; `key` may be NULL. The message is printed as
/// "file: path.key: message".
void mf_json_fault(struct json_object *object, const char *key, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/// Record every key of the object that nobody asked for as unknown, with the nearest asked one; if
/// that was missing, one line tells of both.
void mf_json_finish(struct json_object *object);

/// Number of faults so far.
size_t mf_json_fault_count(const struct json_document *document);

/// Free the document. `status` is what became of reading it: returned if it is NO_MEMORY, and if
/// there was no fault. Else BAD_INPUT with all faults, one a line.
enum status mf_json_close(struct json_document *document, enum status status) MUST_USE;

/// @name Lists. Tested: test_json
/// The list of `count` finite numbers at `key`; false and a fault if there is none.
/// @param[out] values  shape [count]
bool mf_json_list_numbers(struct json_object *object, const char *key, double *values,
                          size_t count);

/// The list of `count` texts at `key`; false and a fault if there is none.
/// @param[out] texts  shape [count], borrowed from the document
bool mf_json_list_texts(struct json_object *object, const char *key, const char **texts,
                        size_t count);

/// The list of `rows` lists of `width` whole numbers each at `key`; false and a fault if there is
/// none.
/// @param[out] values  shape [rows, width]
bool mf_json_list_rows(struct json_object *object, const char *key, int *values, size_t rows,
                       size_t width);

/// What each of the `rows` objects of the list at `key` has at `member`: a list of `width` finite
/// numbers, or for a width of 0 a number. False without a fault if the first object has no such
/// member, with one if another has not.
/// @param[out] values  shape [rows, width], or [rows]
bool mf_json_list_members(struct json_object *object, const char *key, const char *member,
                          double *values, size_t rows, size_t width);

/// Text number `n` of the list at `key`, or the text there as number 0; NULL if there is none.
/// Counts as nothing, and faults are left to the reader. Tested: test_units.
const char *mf_json_list_text(const struct json_object *object, const char *key, size_t n);
