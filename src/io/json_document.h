// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What json.c and json_fields.c share of a document. Items are those of cJSON.
#pragma once

#include "io/faults.h"
#include "io/json.h"

struct cJSON;

enum { JSON_LINE_SIZE = 4096 };

struct json_document {
    struct cJSON *root;
    char *file;
    struct input_files *inputs; ///< files that it names, or NULL: nobody wants to know
    struct units units;         ///< in which its numbers are
    struct faults faults;
    char retired[JSON_LINE_SIZE / 4]; ///< keys of an earlier version so far, "a, b.c", or ""
};

/// Remember that the reader knows `key`, and find it.
const void *mf_json_get(struct json_object *object, const char *key);

/// Whether what stands at `key`, or the key itself, is UTF-8, as cJSON does not ask; or false and a
/// fault.
bool mf_json_is_encoded(struct json_object *object, const char *key, const char *text);

/// Record that another type was expected at `key`.
void mf_json_fault_type(struct json_object *object, const char *key, const char *expected,
                        const void *item);

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
