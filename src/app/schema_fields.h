// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Fields as properties of a JSON Schema: types, ranges, choices.
#pragma once

#include "app/cmd_describe.h"
#include "io/json_write.h"

/// What is being written: the definitions of whole files, or those of files with states. A state is
/// a merge patch of the rest of its file (RFC 7396): neither need have what the other has, and null
/// takes a key away.
struct schema {
    struct json_writer *writer;
    const char *prefix; ///< of the names of its definitions
    bool is_patch;
};

/// Enter what a key may be, beside null in a patch; leave it with mf_schema_end_value.
void mf_schema_begin_value(const struct schema *schema, const char *key);
void mf_schema_end_value(const struct schema *schema);

/// All fields of a topic, as members of the "properties" that the writer is in; of those of one
/// name the first.
void mf_schema_fields_write(const struct schema *schema, const struct topic *topic);

/// "required": the fields of a topic without a default, but not those of targets, which states may
/// share in part, nor numbers of beads and molecules, which "types" or "density" may say.
void mf_schema_fields_write_required(const struct schema *schema, const struct topic *topic);

/// "enum": one of these, NULL-terminated.
void mf_schema_fields_write_list(const struct schema *schema, const char *const *choices);
