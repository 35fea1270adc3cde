// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/cmd_describe.h"

#include "app/schema_fields.h"
#include "curves/bonded_kind.h"
#include "io/json_write.h"
#include "io/units_scale.h"
#include "observe/observable.h"
#include "problem/inverse.h"
#include "system/composition.h"

#include <string.h>

/// Where the topic or group of this name is defined.
static void write_reference(const struct schema *schema, const char *name) {
    char place[96];
    snprintf(place, sizeof place, "#/definitions/%s%s", schema->prefix, name);
    mf_json_write_text(schema->writer, "$ref", place);
}

/// Enter the definition of a topic or group.
static void begin_definition(const struct schema *schema, const char *name) {
    char key[96];
    snprintf(key, sizeof key, "%s%s", schema->prefix, name);
    mf_json_begin(schema->writer, key);
}

/// No key but those that are named.
static void close_keys(const struct schema *schema) {
    mf_json_write_flag(schema->writer, "additionalProperties", false);
}

/// No key but those of this one of a group; a state that has another one takes those away.
static void close_keys_of_member(const struct schema *schema) {
    if (!schema->is_patch) {
        close_keys(schema);
        return;
    }
    mf_json_begin(schema->writer, "additionalProperties");
    mf_json_write_text(schema->writer, "type", "null");
    mf_json_end(schema->writer);
}

// Objects -----------------------------------------------------------------------------------------

/// Which key of an object says which of a group it is; NULL: the keys themselves do.
static const char *chief_of(const char *group) {
    static const char *const chiefs[][2] = {{"conservative", "law"},    {"dissipative", "law"},
                                            {"weight", "law"},          {"energy", "law"},
                                            {"dynamics", "integrator"}, {"method", "name"}};
    for (size_t k = 0; k < sizeof chiefs / sizeof *chiefs; k++)
        if (strcmp(group, chiefs[k][0]) == 0)
            return chiefs[k][1];
    for (int order = 0; order < BONDED_KINDS; order++)
        if (strcmp(group, mf_bonded_kinds[order]->plural) == 0)
            return "law";
    return NULL;
}

/// How many members an object has whose keys are names.
static void write_counts(const struct schema *schema, int64_t fewest, int64_t most) {
    mf_json_write_integer(schema->writer, "minProperties", fewest);
    mf_json_write_integer(schema->writer, "maxProperties", most);
}

static void write_several(const struct schema *schema, const char *topic) {
    const bool are_states = strcmp(topic, "run") == 0;
    struct schema member = *schema;
    member.is_patch = schema->is_patch && !are_states; // no state is null
    mf_json_write_text(schema->writer, "type", "object");
    if (are_states)
        write_counts(schema, 1, INVERSE_MAX_STATES);
    mf_schema_begin_value(&member, "additionalProperties");
    write_reference(schema, topic);
    mf_schema_end_value(&member);
}

/// One, several by names, or either, as of the pair types of a mixture.
static void write_form(const struct schema *schema, const struct topic_object *object) {
    if (object->form == TOPIC_ONE || object->form == TOPIC_NAMED) {
        (object->form == TOPIC_ONE ? write_reference : write_several)(schema, object->topic);
        return;
    }
    mf_json_begin_list(schema->writer, "anyOf");
    mf_json_begin(schema->writer, NULL);
    write_reference(schema, object->form == TOPIC_MOLECULES ? "topology" : object->topic);
    mf_json_end(schema->writer);
    mf_json_begin(schema->writer, NULL);
    write_several(schema, object->topic);
    mf_json_write_integer(schema->writer, "minProperties", 1);
    mf_json_end(schema->writer);
    mf_json_end(schema->writer);
}

/// Lists of beads by the names of groups: {"backbone": [[1, 2], …]}.
static void write_beads(const struct schema *schema) {
    static const char *const levels[] = {"additionalProperties", "items", "items"};
    for (size_t k = 0; k < sizeof levels / sizeof *levels; k++) {
        mf_json_write_text(schema->writer, "type", k ? "array" : "object");
        mf_json_begin(schema->writer, levels[k]);
    }
    mf_json_write_text(schema->writer, "type", "integer");
    for (size_t k = 0; k < sizeof levels / sizeof *levels; k++)
        mf_json_end(schema->writer);
}

/// The target of this name if it takes the settings of its observable, too; else NULL.
static const struct observable *observable_of(const char *target) {
    struct observable_kind found;
    for (int kind = 0; (found = mf_observable_kind(kind)).observable; kind++)
        if (found.target->has_settings && strcmp(found.target->name, target) == 0)
            return found.observable;
    return NULL;
}

/// Such a target has a definition of its own.
static void find_settings(struct topic_object *object) {
    if (observable_of(object->key))
        snprintf(object->topic, sizeof object->topic, "%.40s-and-settings", object->key);
}

/// "units" of a file: the name of a system, its scale, or, in a scene, that of a reduced one.
static void write_units(const struct schema *schema, const char *of) {
    static const char *const topics[] = {"units", "scale"};
    const size_t count = strcmp(of, "scene") == 0 ? 2 : 1;
    mf_json_begin_list(schema->writer, "anyOf");
    mf_json_begin(schema->writer, NULL);
    mf_schema_fields_write_list(schema, mf_units_systems);
    mf_json_end(schema->writer);
    for (size_t k = 0; k < count; k++) {
        mf_json_begin(schema->writer, NULL);
        write_reference(schema, topics[k]);
        mf_json_end(schema->writer);
    }
    mf_json_end(schema->writer);
}

static void write_refused(const struct schema *schema, const char *key) {
    mf_json_write_flag(schema->writer, key, false);
}

/// "scene" of a run file: without what belongs at its top, or into a scene file alone.
static void write_scene_of_run(const struct schema *schema) {
    static const char *const keys[] = {"title", "seed", "measure"};
    mf_json_begin_list(schema->writer, "allOf");
    mf_json_begin(schema->writer, NULL);
    write_reference(schema, "scene");
    mf_json_end(schema->writer);
    mf_json_begin(schema->writer, NULL);
    mf_json_begin(schema->writer, "properties");
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++)
        write_refused(schema, keys[k]);
    for (size_t k = 0; mf_observables[k]; k++)
        write_refused(schema, mf_observables[k]->name);
    for (int level = 0; level < 3; level++)
        mf_json_end(schema->writer);
}

static void write_objects(const struct schema *schema, const char *topic) {
    struct topic_object objects[DESCRIBE_MAX_OBJECTS];
    const size_t count = mf_describe_objects(topic, objects);
    for (size_t k = 0; k < count; k++) {
        mf_schema_begin_value(schema, objects[k].key);
        mf_json_write_text(schema->writer, "description", objects[k].help);
        if (strcmp(topic, "target") == 0)
            find_settings(&objects[k]);
        if (strcmp(objects[k].key, "units") == 0)
            write_units(schema, topic);
        else if (strcmp(topic, "run") == 0 && strcmp(objects[k].key, "scene") == 0)
            write_scene_of_run(schema);
        else if (objects[k].form == TOPIC_BEADS)
            write_beads(schema);
        else
            write_form(schema, &objects[k]);
        mf_schema_end_value(schema);
    }
}

/// Keys that no field table has: values by names of the file's own.
static void write_by_name(const struct schema *schema, const char *key, const char *type) {
    mf_schema_begin_value(schema, key);
    mf_json_write_text(schema->writer, "type", "object");
    if (strcmp(type, "integer") == 0) // numbers of beads of a mixture
        write_counts(schema, 1, COMPOSITION_MAX_TYPES);
    mf_schema_begin_value(schema, "additionalProperties");
    mf_json_write_text(schema->writer, "type", type);
    mf_schema_end_value(schema);
    mf_schema_end_value(schema);
}

static void write_texts(const struct schema *schema, const char *key) {
    mf_schema_begin_value(schema, key);
    mf_json_write_text(schema->writer, "type", "array");
    mf_json_begin(schema->writer, "items");
    mf_json_write_text(schema->writer, "type", "string");
    mf_json_end(schema->writer);
    mf_schema_end_value(schema);
}

static void write_own_keys(const struct schema *schema, const char *topic) {
    if (strcmp(topic, "particles") == 0)
        write_by_name(schema, "types", "integer");
    if (strcmp(topic, "engine") == 0)
        write_by_name(schema, "types", "string");
    if (strcmp(topic, "map") == 0)
        write_by_name(schema, "masses", "number");
    if (strcmp(topic, "molecule") == 0 || strcmp(topic, "chain") == 0)
        write_texts(schema, "beads");
}

static void write_topic(const struct schema *schema, const struct topic *topic) {
    begin_definition(schema, topic->name);
    mf_json_write_text(schema->writer, "description", topic->summary);
    mf_json_write_text(schema->writer, "type", "object");
    mf_json_begin(schema->writer, "properties");
    mf_schema_fields_write(schema, topic);
    write_objects(schema, topic->name);
    write_own_keys(schema, topic->name);
    mf_json_end(schema->writer);
    mf_schema_fields_write_required(schema, topic);
    close_keys(schema);
    mf_json_end(schema->writer);
}

// Groups ------------------------------------------------------------------------------------------

/// If the key `chief` says that it is this one of a group, it has no other keys than this one.
static void write_member(const struct schema *schema, const char *chief,
                         const struct topic *topic) {
    mf_json_begin(schema->writer, NULL);
    mf_json_begin(schema->writer, "if");
    // A method without a name may have the keys of this one, but in a state that of the file.
    if (schema->is_patch || strcmp(topic->name, "auto") != 0)
        mf_json_write_texts(schema->writer, "required", &chief, 1);
    mf_json_begin(schema->writer, "properties");
    mf_json_begin(schema->writer, chief);
    mf_json_write_text(schema->writer, "const", topic->name);
    for (int level = 0; level < 3; level++)
        mf_json_end(schema->writer);
    mf_json_begin(schema->writer, "then");
    mf_json_write_text(schema->writer, "description", topic->summary);
    mf_json_begin(schema->writer, "properties");
    mf_json_begin(schema->writer, chief); // whose value is said once, for all
    mf_json_end(schema->writer);
    mf_schema_fields_write(schema, topic);
    write_objects(schema, topic->name);
    mf_json_end(schema->writer);
    mf_schema_fields_write_required(schema, topic);
    close_keys_of_member(schema);
    mf_json_end(schema->writer);
    mf_json_end(schema->writer);
}

static bool is_of(const struct topic *topic, const char *group) {
    return strcmp(topic->group, group) == 0;
}

/// The key that says which of a group it is, with all that there are.
static void write_chief(const struct schema *schema, const char *chief,
                        const struct topic *const *members, size_t count) {
    const char *names[DESCRIBE_MAX_TOPICS];
    mf_json_write_text(schema->writer, "type", "object");
    for (size_t k = 0; k < count; k++)
        names[k] = members[k]->name;
    // An integrator or a method is chosen by what the file has if it says none.
    if (!schema->is_patch && strcmp(chief, "integrator") != 0 && strcmp(chief, "name") != 0)
        mf_json_write_texts(schema->writer, "required", &chief, 1);
    mf_json_begin(schema->writer, "properties");
    mf_schema_begin_value(schema, chief);
    mf_json_write_texts(schema->writer, "enum", names, count);
    mf_schema_end_value(schema);
    mf_json_end(schema->writer);
}

static void write_chosen(const struct schema *schema, const char *group, const char *chief,
                         const struct topic *topics, size_t count) {
    static const struct topic none = {.name = "none", .summary = "none"};
    const struct topic *members[DESCRIBE_MAX_TOPICS];
    size_t n = 0;
    if (strcmp(chief, "law") == 0)
        members[n++] = &none;
    for (size_t k = 0; k < count && n < DESCRIBE_MAX_TOPICS; k++)
        if (is_of(&topics[k], group))
            members[n++] = &topics[k];
    begin_definition(schema, group);
    write_chief(schema, chief, members, n);
    mf_json_begin_list(schema->writer, "allOf");
    for (size_t k = 0; k < n; k++)
        write_member(schema, chief, members[k]);
    mf_json_end(schema->writer);
    mf_json_end(schema->writer);
}

/// Interactions, by their own names.
static void write_named(const struct schema *schema, const char *group, const struct topic *topics,
                        size_t count) {
    begin_definition(schema, group);
    mf_json_write_text(schema->writer, "type", "object");
    mf_json_begin(schema->writer, "properties");
    for (size_t k = 0; k < count; k++)
        if (is_of(&topics[k], group))
            write_topic(schema, &topics[k]);
    mf_json_end(schema->writer);
    close_keys(schema);
    mf_json_end(schema->writer);
}

static bool is_group(const char *group) {
    return chief_of(group) || strcmp(group, "interactions") == 0;
}

/// Targets with the settings of their observables.
static void write_targets(const struct schema *schema, const struct topic *topics, size_t count) {
    struct topic_object objects[DESCRIBE_MAX_OBJECTS];
    const size_t targets = mf_describe_objects("target", objects);
    for (size_t n = 0; n < targets; n++) {
        const struct observable *observable = observable_of(objects[n].key);
        for (size_t k = 0; observable && k < count; k++) {
            struct topic topic = topics[k];
            size_t t = 0;
            if (strcmp(topic.name, objects[n].topic) != 0)
                continue;
            while (topic.tables[t])
                t++;
            topic.tables[t] = observable->fields;
            find_settings(&objects[n]);
            topic.name = objects[n].topic;
            write_topic(schema, &topic);
            break;
        }
    }
}

static void write_definitions(const struct schema *schema, const struct topic *topics,
                              size_t count) {
    for (size_t k = 0; k < count; k++) {
        const char *const group = topics[k].group, *const chief = chief_of(group);
        if (!is_group(group))
            write_topic(schema, &topics[k]);
        else if (k > 0 && is_of(&topics[k - 1], group))
            continue;
        else if (chief)
            write_chosen(schema, group, chief, topics, count);
        else
            write_named(schema, group, topics, count);
    }
}

/// A file with states is made of parts that are whole in each state alone; one with a target is a
/// run file, one with beads a map.
static void write_root(struct json_writer *writer) {
    static const char *const files[][2] = {
        {"states", "patch-run"}, {"target", "run"}, {"beads", "map"}};
    const size_t count = sizeof files / sizeof *files;
    const struct schema schema = {.writer = writer, .prefix = ""};
    for (size_t k = 0; k < count; k++) {
        mf_json_begin(writer, "if");
        mf_json_write_texts(writer, "required", files[k], 1);
        mf_json_end(writer);
        mf_json_begin(writer, "then");
        write_reference(&schema, files[k][1]);
        mf_json_end(writer);
        mf_json_begin(writer, "else");
    }
    write_reference(&schema, "scene");
    for (size_t k = 0; k < count; k++)
        mf_json_end(writer);
}

enum status mf_schema_print(FILE *stream, const struct topic *topics, size_t count) {
    struct json_writer *writer = mf_json_writer_create();
    TRY(writer ? STATUS_OK : STATUS_NO_MEMORY);
    const struct schema schemas[] = {{.writer = writer, .prefix = ""},
                                     {.writer = writer, .prefix = "patch-", .is_patch = true}};
    mf_json_write_text(writer, "$schema", "http://json-schema.org/draft-07/schema#");
    mf_json_write_text(writer, "title", "run files, scene files and maps of mesofit");
    write_root(writer);
    mf_json_begin(writer, "definitions");
    for (size_t k = 0; k < sizeof schemas / sizeof *schemas; k++) {
        write_definitions(&schemas[k], topics, count);
        write_targets(&schemas[k], topics, count);
    }
    mf_json_end(writer);
    const enum status status = mf_json_write_stream(writer, stream, "schema");
    mf_json_writer_free(writer);
    return status;
}
