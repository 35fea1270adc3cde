// SPDX-License-Identifier: GPL-3.0-or-later
#include "defaults/fit_choice.h"

#include "curves/formula.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void mf_fit_choice_note(const struct fit_choice *c, const char *format, ...) {
    va_list arguments;
    if (c->choices->count == FIT_MAX_CHOICES)
        return;
    va_start(arguments, format);
    vsnprintf(c->choices->line[c->choices->count++], FIT_CHOICE_SIZE, format, arguments);
    va_end(arguments);
}

struct json_object mf_fit_choice_object(const struct json_object *root, const char *path) {
    char name[JSON_PATH_SIZE], *rest;
    struct json_object object = *root;
    snprintf(name, sizeof name, "%s", path);
    for (char *key = strtok_r(name, ".", &rest); key; key = strtok_r(NULL, ".", &rest)) {
        // Another thing than an object there is left to the reader.
        object = mf_json_is_object(&object, key) ? mf_json_child(&object, key, false)
                                                 : (struct json_object){.document = root->document};
        object.asked_count = 0;
    }
    return object;
}

bool mf_fit_choice_lacks(const struct json_object *root, const char *path, const char *key) {
    struct json_object object = mf_fit_choice_object(root, path);
    return !mf_json_has(&object, key);
}

const char *mf_fit_choice_text(const struct fit_choice *choice, const char *unit, double value,
                               char text[FIT_CHOICE_TEXT_SIZE]) {
    const struct units *units = &choice->read->scene.units;
    char name[UNITS_NAME_SIZE];
    const struct units *physical = units->system == UNITS_REDUCED ? NULL : units;
    mf_units_name(physical, unit, name);
    snprintf(text, FIT_CHOICE_TEXT_SIZE, "%.4g%s%s", value * mf_units_factor(physical, unit),
             name[0] ? " " : "", name);
    return text;
}

/// A writer inside the objects of a path, in units of the file, NULL where it has none.
static struct json_writer *writer_at(const char *path, const struct units *units) {
    char name[JSON_PATH_SIZE], *rest;
    struct json_writer *writer = mf_json_writer_create();
    if (writer && units && units->system != UNITS_REDUCED)
        mf_json_writer_set_units(writer, units);
    snprintf(name, sizeof name, "%s", path);
    for (char *key = strtok_r(name, ".", &rest); writer && key; key = strtok_r(NULL, ".", &rest))
        mf_json_begin(writer, key);
    return writer;
}

static enum status insert(struct json_writer *writer, const struct json_object *root) {
    const enum status status = writer ? mf_json_write_into(writer, root) : STATUS_NO_MEMORY;
    mf_json_writer_free(writer);
    return status;
}

enum status mf_fit_choice_give_text(const struct json_object *root, const char *path,
                                    const char *key, const char *text) {
    struct json_writer *writer = writer_at(path, NULL);
    if (writer)
        mf_json_write_text(writer, key, text);
    return insert(writer, root);
}

enum status mf_fit_choice_give_number(const struct json_object *root, const char *path,
                                      const char *key, double value) {
    struct json_writer *writer = writer_at(path, NULL);
    if (writer)
        mf_json_write_number(writer, key, value);
    return insert(writer, root);
}

/// The nearest number that a file may have there: a choice that the reader would refuse is none.
static double nearest_allowed(const struct fit_choice *choice, const char *path,
                              const struct field *field, double value) {
    const double allowed = fmin(fmax(value, field->minimum), field->maximum);
    char wanted[FIT_CHOICE_TEXT_SIZE], text[FIT_CHOICE_TEXT_SIZE];
    if (allowed != value)
        mf_fit_choice_note(choice, "%s.%s: %s, as near as it may be to %s", path, field->name,
                           mf_fit_choice_text(choice, field->unit, allowed, text),
                           mf_fit_choice_text(choice, field->unit, value, wanted));
    return allowed;
}

enum status mf_fit_choice_give(const struct fit_choice *choice, const char *path,
                               const struct field *fields, const char *key, double value) {
    struct json_writer *writer = writer_at(path, &choice->read->scene.units);
    struct field own[2] = {{.name = key}, FIELD_END};
    while (strcmp(fields->name, key) != 0)
        fields++;
    own[0] = *fields;
    own[0].offset = 0;
    value = nearest_allowed(choice, path, own, value);
    const int64_t whole = (int64_t)value;
    if (writer)
        mf_json_write_fields(writer, own,
                             own->type == FIELD_INTEGER ? (const void *)&whole : (void *)&value);
    return insert(writer, choice->root);
}

enum status mf_fit_choice_give_empty(const struct json_object *root, const char *path) {
    return insert(writer_at(path, NULL), root);
}

enum status mf_fit_choice_give_omega(const struct fit_choice *c, const char *path, double sigma,
                                     double cutoff) {
    const struct curve_family *family = &mf_formula_power_omega;
    TRY(mf_fit_choice_give_text(c->root, path, "law", family->name));
    TRY(mf_fit_choice_give(c, path, family->fields, "sigma", sigma));
    return mf_fit_choice_give(c, path, family->fields, "cutoff", cutoff);
}
