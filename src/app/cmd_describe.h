// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What `mesofit describe` knows, for all that tell of it: every object of run and scene
/// files, by the field tables that read them.
#pragma once

#include "base/fields.h"
#include "base/status.h"

#include <stddef.h>
#include <stdio.h>

enum { DESCRIBE_MAX_TOPICS = 128, DESCRIBE_MAX_OBJECTS = 64, DESCRIBE_MAX_TABLES = 8 };

/// A thing with a name of its own: an object of a file, a law, an integrator, a method.
struct topic {
    const char *group, *name, *summary;
    const struct field *tables[DESCRIBE_MAX_TABLES]; ///< NULL-terminated
};

/// How an object inside another is written: itself, {"A": …, "B": …}, either, the second or a
/// topology, or lists of beads.
enum topic_form { TOPIC_ONE, TOPIC_NAMED, TOPIC_PARTS, TOPIC_MOLECULES, TOPIC_BEADS };

/// An object inside another, and the topic or group that says what stands in it.
struct topic_object {
    char key[64], help[256], topic[64];
    enum topic_form form;
};

/// All topics, those of a group together: fixed ones, one for each record in the lists, and one for
/// each table that several of these share, in the group "shared".
size_t mf_describe_topics(struct topic topics[DESCRIBE_MAX_TOPICS]);

/// The objects in what a topic is about; returns their number.
size_t mf_describe_objects(const char *topic, struct topic_object objects[DESCRIBE_MAX_OBJECTS]);

/// The first topic that is about nothing but `table`, or NULL: where a document prints it.
const struct topic *mf_describe_home(const struct topic *topics, size_t count,
                                     const struct field *table);

/// The whole reference: every subcommand with its options, every key of run and scene files.
/// Tested: test_reference.
void mf_reference_print_markdown(FILE *stream, const struct topic *topics, size_t count);
void mf_reference_print_man(FILE *stream, const struct topic *topics, size_t count);

/// A JSON Schema (draft 7) of run files, scene files and maps: by it editors complete keys and mark
/// what is unknown. What rests on other numbers of the file, or on its units, is left to the
/// program. Fails: NO_MEMORY, IO. Tested: test_schema (python/tests).
enum status mf_schema_print(FILE *stream, const struct topic *topics, size_t count) MUST_USE;
