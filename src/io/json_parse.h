// SPDX-License-Identifier: GPL-3.0-or-later
/// @file From a text to cJSON's tree, or to the words that say what is wrong with the text.
#pragma once

#include <stddef.h>
#include "base/status.h"

struct cJSON;

/// Parse one JSON value with nothing after it. What cJSON reads beyond RFC 8259 (01, 1., -.5, line
/// breaks in texts) keeps its value and is let through; what it would cut without a word, a text at
/// an escaped NUL, is refused.
/// @param[out] root  to be freed with cJSON_Delete; NULL on failure
/// Fails: NO_MEMORY; BAD_INPUT with "file:line:column: expected …, found …". Tested:
/// test_json_parse.
enum status mf_json_parse(const char *file, const char *text, struct cJSON **root) MUST_USE;

/// "the text "imc"", "the number 3", "an array", in words for a fault.
void mf_json_item_describe(const void *item, char *text, size_t size);

/// What somebody who wrote a text or a number in the place of an object may have meant,
/// ": write {"law": "power"}"; "" for other items, or without a chief key of the object (NULL).
void mf_json_item_complete(const void *item, const char *chief, char *text, size_t size);

/// BAD_INPUT if an object in it has more than JSON_MAX_MEMBERS keys: cJSON looks for a key from
/// the first member on, so that what is read of an object, and the search for keys that stand
/// twice, takes as long as the square of their number. Or if it is nested more than JSON_DEEPEST
/// deep, since readers recurse.
enum status mf_json_item_check(const char *file, const void *item) MUST_USE;
