// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/schema_fields.h"

#include "system/attributes.h"

#include <float.h>
#include <math.h>
#include <string.h>

void mf_schema_begin_value(const struct schema *schema, const char *key) {
    mf_json_begin(schema->writer, key);
    if (!schema->is_patch)
        return;
    mf_json_begin(schema->writer, "if");
    mf_json_write_text(schema->writer, "type", "null");
    mf_json_end(schema->writer);
    mf_json_begin(schema->writer, "else");
}

void mf_schema_end_value(const struct schema *schema) {
    if (schema->is_patch)
        mf_json_end(schema->writer);
    mf_json_end(schema->writer);
}

/// Limits are of reduced numbers, of which 0 is the same in all units.
static void write_range(const struct schema *schema, const struct field *field) {
    const bool real = field->type == FIELD_NUMBER || field->type == FIELD_LENGTHS;
    const bool pure = field->unit == NULL || field->unit[0] == '\0' || !real;
    if (real && field->minimum == FIELD_ABOVE_ZERO)
        mf_json_write_number(schema->writer, "exclusiveMinimum", 0);
    else if (field->minimum > -DBL_MAX && (pure || field->minimum == 0))
        mf_json_write_number(schema->writer, "minimum", field->minimum);
    if (field->type == FIELD_SEED)
        mf_json_write_integer(schema->writer, "maximum", (int64_t)FIELD_LARGEST_INTEGER - 1);
    else if (field->maximum < DBL_MAX && pure)
        mf_json_write_number(schema->writer, "maximum", field->maximum);
}

void mf_schema_fields_write_list(const struct schema *schema, const char *const *choices) {
    size_t count = 0;
    while (choices[count])
        count++;
    mf_json_write_texts(schema->writer, "enum", choices, count);
}

/// A choice between yes and no may also be true or false.
static void write_choice(const struct schema *schema, const struct field *field) {
    bool flag = false;
    for (size_t k = 0; field->choices[k]; k++)
        flag = flag || strcmp(field->choices[k], "yes") == 0;
    if (!flag) {
        mf_schema_fields_write_list(schema, field->choices);
        return;
    }
    mf_json_begin_list(schema->writer, "anyOf");
    mf_json_begin(schema->writer, NULL);
    mf_schema_fields_write_list(schema, field->choices);
    mf_json_end(schema->writer);
    mf_json_begin(schema->writer, NULL);
    mf_json_write_text(schema->writer, "type", "boolean");
    mf_json_end(schema->writer);
    mf_json_end(schema->writer);
}

static void write_value(const struct schema *schema, const struct field *field) {
    switch (field->type) {
    case FIELD_NUMBER:
    case FIELD_INTEGER:
    case FIELD_SEED:
        mf_json_write_text(schema->writer, "type",
                           field->type == FIELD_NUMBER ? "number" : "integer");
        write_range(schema, field);
        break;
    case FIELD_LENGTHS:
        mf_json_write_text(schema->writer, "type", "array");
        mf_json_begin(schema->writer, "items");
        mf_json_write_text(schema->writer, "type", "number");
        write_range(schema, field);
        mf_json_end(schema->writer);
        mf_json_write_integer(schema->writer, "minItems", 2);
        mf_json_write_integer(schema->writer, "maxItems", 3);
        break;
    case FIELD_TEXT:
    case FIELD_FILE:
        mf_json_write_text(schema->writer, "type", "string");
        mf_json_write_integer(schema->writer, "minLength", 1);
        break;
    case FIELD_CHOICE:
        write_choice(schema, field);
        break;
    case FIELD_CHOICES:
        mf_json_write_text(schema->writer, "type", "array");
        mf_json_begin(schema->writer, "items");
        mf_schema_fields_write_list(schema, field->choices);
        mf_json_end(schema->writer);
        break;
    }
}

static void write_field(const struct schema *schema, const struct field *field) {
    char help[512], fallback[64];
    const bool has_unit = field->unit && field->unit[0];
    mf_fields_default_text(field, fallback, sizeof fallback);
    snprintf(help, sizeof help, "%s%s%s%s; default: %s", field->help ? field->help : "",
             has_unit ? " [" : "", has_unit ? field->unit : "", has_unit ? "]" : "", fallback);
    mf_schema_begin_value(schema, field->name);
    mf_json_write_text(schema->writer, "description", help);
    // What is not known is null, as used.json says it.
    if (field->type == FIELD_NUMBER && isnan(field->initial)) {
        mf_json_begin_list(schema->writer, "anyOf");
        mf_json_begin(schema->writer, NULL);
        mf_json_write_text(schema->writer, "type", "null");
        mf_json_end(schema->writer);
        mf_json_begin(schema->writer, NULL);
        write_value(schema, field);
        mf_json_end(schema->writer);
        mf_json_end(schema->writer);
    } else
        write_value(schema, field);
    mf_schema_end_value(schema);
}

/// An attribute of beads: a number, {"minimum": …, "maximum": …}, or either by the names of types.
static void write_attribute(const struct schema *schema, const struct field *field) {
    static const char *const types[] = {"number", "object", "null"};
    mf_schema_begin_value(schema, field->name);
    mf_json_write_text(schema->writer, "description", field->help);
    mf_json_write_texts(schema->writer, "type", types, sizeof types / sizeof *types);
    write_range(schema, field);
    mf_json_begin(schema->writer, "additionalProperties");
    mf_json_write_texts(schema->writer, "type", types, 2);
    write_range(schema, field);
    mf_json_begin(schema->writer, "additionalProperties");
    mf_json_write_text(schema->writer, "type", "number");
    mf_json_end(schema->writer);
    mf_json_end(schema->writer);
    mf_schema_end_value(schema);
}

static bool has_field(const struct topic *topic, size_t table, const char *name) {
    for (size_t t = 0; t < table; t++)
        for (const struct field *field = topic->tables[t]; field->name; field++)
            if (strcmp(field->name, name) == 0)
                return true;
    return false;
}

void mf_schema_fields_write(const struct schema *schema, const struct topic *topic) {
    for (size_t t = 0; topic->tables[t]; t++)
        for (const struct field *field = topic->tables[t]; field->name; field++)
            if (has_field(topic, t, field->name))
                continue;
            else if (topic->tables[t] == mf_attributes_fields)
                write_attribute(schema, field);
            else
                write_field(schema, field);
}

void mf_schema_fields_write_required(const struct schema *schema, const struct topic *topic) {
    enum { MOST = 16 };
    const char *names[MOST];
    size_t count = 0;
    for (size_t t = 0; topic->tables[t] && strcmp(topic->group, "target") != 0; t++)
        for (const struct field *field = topic->tables[t]; field->name && count < MOST; field++)
            if (field->required && strcmp(field->name, "count") != 0 &&
                !has_field(topic, t, field->name))
                names[count++] = field->name;
    if (count > 0 && !schema->is_patch)
        mf_json_write_texts(schema->writer, "required", names, count);
}
