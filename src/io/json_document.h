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
