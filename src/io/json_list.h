// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Lists in a parsed document. Items are those of cJSON. Tested: test_json.
#pragma once

#include "io/json.h"

/// A list of at least one choice of a field as a set, a bit each; false and a fault otherwise.
bool mf_json_list_choices(struct json_object *object, const struct field *field, const void *item,
                          int *chosen);

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
