// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/schema_fields.h"

#include "system/attributes.h"

#include <float.h>
#include <math.h>
#include <string.h>

/// Limits are of reduced numbers, of which 0 is the same in all units.
static void write_range(struct json_writer *writer, const struct field *field) {
    const bool real = field->type == FIELD_NUMBER || field->type == FIELD_LENGTHS;
    const bool pure = field->unit == NULL || field->unit[0] == '\0' || !real;
    if (real && field->minimum == FIELD_ABOVE_ZERO)
        mf_json_write_number(writer, "exclusiveMinimum", 0);
    else if (field->minimum > -DBL_MAX && (pure || field->minimum == 0))
        mf_json_write_number(writer, "minimum", field->minimum);
    if (field->type == FIELD_SEED)
        mf_json_write_integer(writer, "maximum", (int64_t)FIELD_LARGEST_INTEGER - 1);
    else if (field->maximum < DBL_MAX && pure)
        mf_json_write_number(writer, "maximum", field->maximum);
}

void mf_schema_fields_write_list(struct json_writer *writer, const char *const *choices) {
    size_t count = 0;
    while (choices[count])
        count++;
    mf_json_write_texts(writer, "enum", choices, count);
}

/// A choice between yes and no may also be true or false.
static void write_choice(struct json_writer *writer, const struct field *field) {
    bool flag = false;
    for (size_t k = 0; field->choices[k]; k++)
        flag = flag || strcmp(field->choices[k], "yes") == 0;
    if (!flag) {
        mf_schema_fields_write_list(writer, field->choices);
        return;
    }
    mf_json_begin_list(writer, "anyOf");
    mf_json_begin(writer, NULL);
    mf_schema_fields_write_list(writer, field->choices);
    mf_json_end(writer);
    mf_json_begin(writer, NULL);
    mf_json_write_text(writer, "type", "boolean");
    mf_json_end(writer);
    mf_json_end(writer);
}

static void write_value(struct json_writer *writer, const struct field *field) {
    switch (field->type) {
    case FIELD_NUMBER:
    case FIELD_INTEGER:
    case FIELD_SEED:
        mf_json_write_text(writer, "type", field->type == FIELD_NUMBER ? "number" : "integer");
        write_range(writer, field);
        break;
    case FIELD_LENGTHS:
        mf_json_write_text(writer, "type", "array");
        mf_json_begin(writer, "items");
        mf_json_write_text(writer, "type", "number");
        write_range(writer, field);
        mf_json_end(writer);
        mf_json_write_integer(writer, "minItems", 2);
        mf_json_write_integer(writer, "maxItems", 3);
        break;
    case FIELD_TEXT:
    case FIELD_FILE:
        mf_json_write_text(writer, "type", "string");
        mf_json_write_integer(writer, "minLength", 1);
        break;
    case FIELD_CHOICE:
        write_choice(writer, field);
        break;
    case FIELD_CHOICES:
        mf_json_write_text(writer, "type", "array");
        mf_json_begin(writer, "items");
        mf_schema_fields_write_list(writer, field->choices);
        mf_json_end(writer);
        break;
    }
}

static void write_field(struct json_writer *writer, const struct field *field) {
    char help[512], fallback[64];
    const bool has_unit = field->unit && field->unit[0];
    mf_fields_default_text(field, fallback, sizeof fallback);
    snprintf(help, sizeof help, "%s%s%s%s; default: %s", field->help ? field->help : "",
             has_unit ? " [" : "", has_unit ? field->unit : "", has_unit ? "]" : "", fallback);
    mf_json_begin(writer, field->name);
    mf_json_write_text(writer, "description", help);
    // What is not known is null, as used.json says it.
    if (field->type == FIELD_NUMBER && isnan(field->initial)) {
        mf_json_begin_list(writer, "anyOf");
        mf_json_begin(writer, NULL);
        mf_json_write_text(writer, "type", "null");
        mf_json_end(writer);
        mf_json_begin(writer, NULL);
        write_value(writer, field);
        mf_json_end(writer);
        mf_json_end(writer);
    } else
        write_value(writer, field);
    mf_json_end(writer);
}

/// An attribute of beads: a number, {"minimum": …, "maximum": …}, or either by the names of types.
static void write_attribute(struct json_writer *writer, const struct field *field) {
    static const char *const types[] = {"number", "object", "null"};
    mf_json_begin(writer, field->name);
    mf_json_write_text(writer, "description", field->help);
    mf_json_write_texts(writer, "type", types, sizeof types / sizeof *types);
    write_range(writer, field);
    mf_json_begin(writer, "additionalProperties");
    mf_json_write_texts(writer, "type", types, 2);
    write_range(writer, field);
    mf_json_begin(writer, "additionalProperties");
    mf_json_write_text(writer, "type", "number");
    mf_json_end(writer);
    mf_json_end(writer);
    mf_json_end(writer);
}

static bool has_field(const struct topic *topic, size_t table, const char *name) {
    for (size_t t = 0; t < table; t++)
        for (const struct field *field = topic->tables[t]; field->name; field++)
            if (strcmp(field->name, name) == 0)
                return true;
    return false;
}

void mf_schema_fields_write(struct json_writer *writer, const struct topic *topic) {
    for (size_t t = 0; topic->tables[t]; t++)
        for (const struct field *field = topic->tables[t]; field->name; field++)
            if (has_field(topic, t, field->name))
                continue;
            else if (topic->tables[t] == mf_attributes_fields)
                write_attribute(writer, field);
            else
                write_field(writer, field);
}

void mf_schema_fields_write_required(struct json_writer *writer, const struct topic *topic) {
    enum { MOST = 16 };
    const char *names[MOST];
    size_t count = 0;
    for (size_t t = 0; topic->tables[t] && strcmp(topic->group, "target") != 0; t++)
        for (const struct field *field = topic->tables[t]; field->name && count < MOST; field++)
            if (field->required && strcmp(field->name, "count") != 0 &&
                !has_field(topic, t, field->name))
                names[count++] = field->name;
    if (count > 0)
        mf_json_write_texts(writer, "required", names, count);
}
