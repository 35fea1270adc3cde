// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a value of a parsed document is, apart from where it stands. Items are those of
/// cJSON. Tested: test_json.
#pragma once

#include "base/status.h"

#include <stddef.h>

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
