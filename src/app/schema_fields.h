// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Fields as properties of a JSON Schema: types, ranges, choices.
#pragma once

#include "app/cmd_describe.h"
#include "io/json_write.h"

/// All fields of a topic, as members of the "properties" that the writer is in; of those of one
/// name the first.
void mf_schema_fields_write(struct json_writer *writer, const struct topic *topic);

/// "required": the fields of a topic without a default, but not those of targets, which states may
/// share in part, nor numbers of beads and molecules, which "types" or "density" may say.
void mf_schema_fields_write_required(struct json_writer *writer, const struct topic *topic);

/// "enum": one of these, NULL-terminated.
void mf_schema_fields_write_list(struct json_writer *writer, const char *const *choices);
