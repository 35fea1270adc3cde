// SPDX-License-Identifier: GPL-3.0-or-later
//
// JSON with a list of numbers for each column, all of their digits, so that a scene can begin with
// it. Companions, with which none can, stand in an object of their own. Printed at once: a tree of
// a million particles would not fit into the memory.
#include "base/memory.h"
#include "io/json.h"
#include "system/attributes.h"
#include "trajectory/snapshot.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// Writing -----------------------------------------------------------------------------------------

static void print_number(double value, FILE *stream) {
    char text[32];
    snprintf(text, sizeof text, "%.15g", value);
    if (strtod(text, NULL) != value)
        snprintf(text, sizeof text, "%.17g", value);
    fputs(isfinite(value) ? text : "null", stream);
}

static void print_list(const char *name, const double *values, size_t count, FILE *stream) {
    fprintf(stream, ",\n    \"%s\": [", name);
    for (size_t k = 0; k < count; k++) {
        fputs(k == 0 ? "" : ", ", stream);
        print_number(values[k], stream);
    }
    fputs("]", stream);
}

/// An object with a list for each column of particles begin … end − 1.
static void print_group(const char *name, const struct snapshot *snapshot, size_t begin, size_t end,
                        FILE *stream) {
    fprintf(stream, ",\n  \"%s\": {\n    \"type\": [", name);
    for (size_t k = begin; k < end; k++)
        fprintf(stream, "%s\"%s\"", k == begin ? "" : ", ", mf_snapshot_type_name(snapshot, k));
    fputs("]", stream);
    for (int n = 0; n < snapshot->columns; n++) {
        const struct snapshot_column *column = &snapshot->column[n];
        for (int c = 0; c < column->components && (begin < snapshot->own || column->shared); c++) {
            char component[SNAPSHOT_NAME_SIZE];
            mf_snapshot_component_name(column, c, component);
            print_list(component, column->values + (size_t)c * snapshot->count + begin, end - begin,
                       stream);
        }
    }
    fputs("\n  }", stream);
}

static void print(const struct snapshot *snapshot, FILE *stream) {
    fprintf(stream, "{\n  \"step\": %llu,\n  \"time\": ", (unsigned long long)snapshot->step);
    print_number(snapshot->time, stream);
    fprintf(stream, ",\n  \"count\": %zu,\n  \"box\": [", snapshot->own);
    for (int d = 0; d < snapshot->box.dimensions; d++) {
        fputs(d == 0 ? "" : ", ", stream);
        print_number(snapshot->box.length[d], stream);
    }
    fputs("]", stream);
    print_group("particles", snapshot, 0, snapshot->own, stream);
    if (snapshot->solvent_particles)
        print_group(snapshot->solvent_particles, snapshot, snapshot->own, snapshot->count, stream);
    fputs("\n}\n", stream);
}

const struct snapshot_format mf_snapshot_json = {.name = "json", .suffix = "json", .print = print};

// Reading -----------------------------------------------------------------------------------------

/// Positions, velocities and attributes.
enum { MAX_COLUMNS = 6 + ATTRIBUTES_NAMES, HEADER_SIZE = 16 * MAX_COLUMNS };

/// Names of the columns that the particles of a snapshot have, in the order of a placement file.
static size_t list_columns(struct json_object *particles, int dimensions,
                           const char *names[MAX_COLUMNS]) {
    static const char *const position[] = {"x", "y", "z"};
    static const char *const velocity[] = {"velocity_x", "velocity_y", "velocity_z"};
    size_t count = 0;
    for (int d = 0; d < dimensions; d++)
        names[count++] = position[d];
    for (int d = 0; d < dimensions && mf_json_has(particles, velocity[0]); d++)
        names[count++] = velocity[d];
    for (int k = 0; k < ATTRIBUTES_NAMES; k++)
        if (mf_json_has(particles, mf_attributes_fields[k].name))
            names[count++] = mf_attributes_fields[k].name;
    return count;
}

/// Columns of a table that is as long as a list.
static enum status begin_table(struct data_table *table, size_t rows, size_t columns) {
    table->rows = rows;
    table->columns = columns;
    TRY_ARRAY(table->values, rows * columns);
    TRY_ARRAY(table->line, rows);
    TRY_ARRAY(table->header, HEADER_SIZE);
    for (size_t k = 0; k < rows; k++)
        table->line[k] = k + 1;
    return STATUS_OK;
}

static enum status read_columns(struct data_table *table, struct json_object *particles,
                                int dimensions) {
    const char *names[MAX_COLUMNS];
    OWNED double *column = NULL;
    const size_t columns = list_columns(particles, dimensions, names);
    TRY(begin_table(table, (size_t)mf_json_count(particles, "x"), columns));
    TRY_ARRAY(column, table->rows);
    for (size_t c = 0; c < table->columns; c++) {
        strcat(strcat(table->header, names[c]), " ");
        mf_json_list_numbers(particles, names[c], column, table->rows);
        for (size_t k = 0; k < table->rows; k++)
            table->values[k * table->columns + c] = column[k];
    }
    return STATUS_OK;
}

/// The box of an initial file of the tutorial must be that of the scene; it lies about 0.
static bool has_box(struct json_object *system, const struct box *box) {
    struct json_object read = mf_json_child(system, "box", true);
    struct sides {
        double length[2];
    } sides = {{0}};
    const struct field fields[] = {
        {"Lx", FIELD_NUMBER, offsetof(struct sides, length[0]), .required = true, .minimum = 0,
         .maximum = DBL_MAX, .unit = "", .help = "width of the box"},
        {"Ly", FIELD_NUMBER, offsetof(struct sides, length[1]), .required = true, .minimum = 0,
         .maximum = DBL_MAX, .unit = "", .help = "height of the box"},
        FIELD_END,
    };
    mf_json_fields(&read, fields, &sides);
    if (read.item == NULL || mf_json_fault_count(system->document) > 0)
        return false;
    const bool same = box->dimensions == 2 && sides.length[0] == box->length[0] &&
                      sides.length[1] == box->length[1];
    if (!same)
        mf_json_fault(system, "box",
                      "is [%g, %g] here: the scene needs \"dimensions\": 2 and this \"box\"",
                      sides.length[0], sides.length[1]);
    return same;
}

/// "system" of an initial file as the tutorial on active Brownian particles of R. Sknepnek (2020)
/// writes it: a box about 0, and of each particle "r", its place, perhaps "n", its
/// direction, and "radius". Velocities and forces there are of no use to dynamics without inertia.
static enum status read_system(struct data_table *table, struct json_object *system,
                               const struct box *box) {
    const size_t rows = (size_t)mf_json_count(system, "particles");
    OWNED double *places = NULL, *directions = NULL, *radii = NULL;
    if (rows == 0)
        mf_json_fault(system, "particles", "expected a list of particles");
    if (rows == 0 || !has_box(system, box))
        return STATUS_OK;
    TRY_ARRAY(places, 2 * rows);
    TRY_ARRAY(directions, 2 * rows);
    TRY_ARRAY(radii, rows);
    if (!mf_json_list_members(system, "particles", "r", places, rows, 2)) {
        if (mf_json_fault_count(system->document) == 0)
            mf_json_fault(system, "particles", "expected \"r\" of each particle");
        return STATUS_OK;
    }
    const bool turned = mf_json_list_members(system, "particles", "n", directions, rows, 2);
    const bool sized = mf_json_list_members(system, "particles", "radius", radii, rows, 0);
    TRY(begin_table(table, rows, 2 + (size_t)sized + (size_t)turned));
    snprintf(table->header, HEADER_SIZE, "x y%s%s", sized ? " radius" : "",
             turned ? " orientation" : "");
    for (size_t k = 0; k < rows; k++) {
        double *row = table->values + k * table->columns;
        for (int d = 0; d < 2; d++)
            *row++ = places[2 * k + (size_t)d] + 0.5 * box->length[d];
        if (sized)
            *row++ = radii[k];
        if (turned)
            *row++ = atan2(directions[2 * k + 1], directions[2 * k]);
    }
    return STATUS_OK;
}

/// Types, which follow from the order of the particles, are those of the scene.
static enum status check_types(struct json_object *particles,
                               const struct composition *composition) {
    enum status status = STATUS_OK;
    const char **types = NULL;
    const size_t count = (size_t)mf_json_count(particles, "type");
    if (!composition_is_mixed(composition) || !mf_json_has(particles, "type") ||
        count != (size_t)mf_composition_particles(composition))
        return STATUS_OK;
    NEW_ARRAY(types, count);
    if (!mf_json_list_texts(particles, "type", types, count))
        goto done;
    for (size_t k = 0; k < count; k++) {
        const char *name = composition->name[mf_composition_type(composition, (uint32_t)k)];
        if (strcmp(types[k], name) == 0)
            continue;
        mf_json_fault(particles, "type",
                      "particle %zu is \"%s\" here and \"%s\" in the scene, whose \"types\" must "
                      "have the order of the file",
                      k, types[k], name);
        break;
    }
done:
    mf_memory_free(types);
    return status;
}

enum status mf_snapshot_read(struct data_table *table, const char *file, const struct box *box,
                             const struct composition *composition) {
    struct json_document *document;
    *table = (struct data_table){0};
    TRY(mf_json_open(&document, file));
    struct json_object root = mf_json_root(document);
    if (mf_json_is_object(&root, "system")) {
        struct json_object system = mf_json_child(&root, "system", true);
        const enum status read = mf_json_close(document, read_system(table, &system, box));
        if (read != STATUS_OK)
            mf_data_table_clear(table);
        return read;
    }
    struct json_object particles = mf_json_child(&root, "particles", true);
    enum status status = STATUS_OK;
    if (particles.item && mf_json_count(&particles, "x") == 0)
        mf_json_fault(&particles, "x", "expected a list of numbers");
    else if (particles.item)
        status = read_columns(table, &particles, box->dimensions);
    if (particles.item && status == STATUS_OK)
        status = check_types(&particles, composition);
    status = mf_json_close(document, status);
    if (status != STATUS_OK)
        mf_data_table_clear(table);
    return status;
}
