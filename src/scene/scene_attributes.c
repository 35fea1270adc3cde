// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/scene_parts.h"

#include <math.h>

/// A number, or {"minimum": …, "maximum": …}.
static void read_range(struct json_object *parent, const char *key, const struct field *kind,
                       struct attributes_range *range) {
    struct field fields[] = {*kind, *kind, FIELD_END};
    for (int k = 0; k < 2; k++) {
        fields[k].required = true;
        fields[k].initial = 0;
        fields[k].help = "mass of a particle";
    }
    fields[0].offset = offsetof(struct attributes_range, minimum);
    fields[1].offset = offsetof(struct attributes_range, maximum);
    if (!mf_json_is_object(parent, key)) {
        fields[0].name = key;
        fields[1] = (struct field)FIELD_END;
        mf_json_fields(parent, fields, range);
        range->maximum = range->minimum;
        return;
    }
    struct json_object own = mf_json_child(parent, key, true);
    fields[0].name = "minimum";
    fields[1].name = "maximum";
    const size_t faults = mf_json_fault_count(own.document);
    mf_json_fields(&own, fields, range);
    mf_json_finish(&own);
    if (mf_json_fault_count(own.document) == faults && range->minimum > range->maximum)
        mf_json_fault(&own, "maximum", "%g is below the minimum of %g",
                      range->maximum * mf_json_factor(&own, kind->unit),
                      range->minimum * mf_json_factor(&own, kind->unit));
}

/// {"A": …, "B": …}, a range or number for each type that has a name.
static void read_types(struct json_object *particles, const struct field *kind,
                       const struct composition *composition, struct attributes_source *source) {
    if (composition->name[0][0] == '\0') {
        mf_json_fault(particles, kind->name,
                      "the particles have no types: write a number, or {\"minimum\": …, "
                      "\"maximum\": …}");
        return;
    }
    struct json_object own = mf_json_child(particles, kind->name, true);
    source->ranges = composition->types;
    for (int type = 0; type < composition->types; type++)
        read_range(&own, composition->name[type], kind, &source->range[type]);
    mf_json_finish(&own);
}

static bool is_by_type(const struct json_object *particles, const struct field *kind) {
    struct json_object parent = *particles; // looks, and asks for nothing
    struct json_object own = mf_json_child(&parent, kind->name, false);
    return !mf_json_has(&own, "minimum") && !mf_json_has(&own, "maximum");
}

/// In physical units the mass of a bead is a matter of μ: where all have that, none has its own.
static void clear_common_mass(struct attributes_source *mass) {
    static const double rounding = 1e-12;
    const struct attributes_range span = mf_attributes_span(mass);
    if (fabs(span.minimum - 1) < rounding && fabs(span.maximum - 1) < rounding)
        *mass = (struct attributes_source){0};
}

void mf_scene_attributes_read(struct scene *scene, struct json_object *particles) {
    const struct composition *composition = &scene->setup.composition;
    for (int k = 0; k < ATTRIBUTES_NAMES; k++) {
        const struct field *kind = &mf_attributes_fields[k];
        struct attributes_source *source = &scene->setup.attribute[k];
        if (!mf_json_has(particles, kind->name))
            continue;
        if (composition->types == 0 && mf_json_is_object(particles, kind->name))
            continue; // the fault is one of the types
        if (mf_json_is_object(particles, kind->name) && is_by_type(particles, kind)) {
            read_types(particles, kind, composition, source);
            continue;
        }
        source->ranges = 1;
        read_range(particles, kind->name, kind, &source->range[0]);
    }
    if (mf_units_are_physical(mf_json_units(particles)))
        clear_common_mass(&scene->setup.attribute[ATTRIBUTES_MASS]);
}

/// The name of a column in the line of names, units in brackets aside.
static const char *name_of(const struct data_table *table, size_t column, size_t *length) {
    static const char gaps[] = " \t,;";
    const char *name = table->header + strspn(table->header, gaps);
    while (column-- > 0) {
        name += strcspn(name, gaps);
        name += strspn(name, gaps);
    }
    *length = strcspn(name, " \t,;[");
    return name;
}

bool mf_scene_attributes_column_name(const struct data_table *table, size_t column, char *name,
                                     size_t size) {
    size_t length, beyond;
    const char *begin = name_of(table, column, &length);
    name_of(table, table->columns, &beyond);
    snprintf(name, size, "%.*s", (int)fmin((double)length, (double)size), begin);
    return length > 0 && beyond == 0; // else the line is no list of names
}

/// The attribute that a column is called by; ATTRIBUTES_NAMES if it is none.
static int attribute_of(const struct data_table *table, size_t column) {
    size_t length;
    const char *name = name_of(table, column, &length);
    int k = 0;
    while (k < ATTRIBUTES_NAMES && (strlen(mf_attributes_fields[k].name) != length ||
                                    strncmp(mf_attributes_fields[k].name, name, length) != 0))
        k++;
    return k;
}

enum status mf_scene_attributes_convert(struct data_table *table, const char *file, size_t column,
                                        const struct units *units) {
    const int number = attribute_of(table, column);
    return mf_data_table_convert(table, file, column, mf_attributes_fields[number].unit, units);
}

size_t mf_scene_attributes_first_column(const struct data_table *table) {
    size_t first = table->columns;
    while (first > 0 && attribute_of(table, first - 1) != ATTRIBUTES_NAMES)
        first--;
    return first;
}

void mf_scene_attributes_column(struct scene *scene, struct json_object *particles,
                                const struct data_table *table, size_t column,
                                const double *values) {
    const char *file = scene->setup.placement.file;
    const int number = attribute_of(table, column);
    const struct field *kind = &mf_attributes_fields[number];
    struct attributes_source *source = &scene->setup.attribute[number];
    if (source->ranges > 0)
        mf_json_fault(particles, kind->name, "is given in %s, too", file);
    *source = (struct attributes_source){
        .ranges = 1, .range = {{values[0], values[0]}}, .column = values};
    for (size_t row = 0; row < table->rows; row++) {
        char range[64 + UNITS_NAME_SIZE];
        source->range[0].minimum = fmin(source->range[0].minimum, values[row]);
        source->range[0].maximum = fmax(source->range[0].maximum, values[row]);
        if (values[row] >= kind->minimum && values[row] <= kind->maximum)
            continue;
        mf_json_range_text(particles, kind, range, sizeof range);
        mf_json_fault(particles, "file", "%s:%zu: the %s %g is out of range; allowed: %s", file,
                      table->line[row], kind->name,
                      values[row] * mf_json_factor(particles, kind->unit), range);
        return;
    }
}

static void write_range(struct json_writer *writer, const char *key, const char *unit,
                        const struct attributes_range *range) {
    if (range->minimum == range->maximum) {
        mf_json_write_quantity(writer, key, unit, range->minimum);
        return;
    }
    mf_json_begin(writer, key);
    mf_json_write_quantity(writer, "minimum", unit, range->minimum);
    mf_json_write_quantity(writer, "maximum", unit, range->maximum);
    mf_json_end(writer);
}

void mf_scene_attributes_write(const struct scene *scene, struct json_writer *writer) {
    for (int k = 0; k < ATTRIBUTES_NAMES; k++) {
        const struct attributes_source *source = &scene->setup.attribute[k];
        const char *name = mf_attributes_fields[k].name, *unit = mf_attributes_fields[k].unit;
        if (source->ranges == 0 || source->column)
            continue;
        if (source->ranges == 1) {
            write_range(writer, name, unit, &source->range[0]);
            continue;
        }
        mf_json_begin(writer, name);
        for (int type = 0; type < source->ranges; type++)
            write_range(writer, scene->setup.composition.name[type], unit, &source->range[type]);
        mf_json_end(writer);
    }
}
