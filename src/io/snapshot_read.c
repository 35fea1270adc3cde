// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"
#include "io/json_list.h"
#include "io/snapshot.h"
#include "system/attributes.h"

#include <string.h>

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

static enum status read_columns(struct data_table *table, struct json_object *particles,
                                int dimensions) {
    const char *names[MAX_COLUMNS];
    OWNED double *column = NULL;
    table->columns = list_columns(particles, dimensions, names);
    table->rows = (size_t)mf_json_count(particles, "x");
    TRY_ARRAY(table->values, table->rows * table->columns);
    TRY_ARRAY(table->line, table->rows);
    TRY_ARRAY(table->header, HEADER_SIZE);
    TRY_ARRAY(column, table->rows);
    for (size_t c = 0; c < table->columns; c++) {
        strcat(strcat(table->header, names[c]), " ");
        mf_json_list_numbers(particles, names[c], column, table->rows);
        for (size_t k = 0; k < table->rows; k++)
            table->values[k * table->columns + c] = column[k];
    }
    for (size_t k = 0; k < table->rows; k++)
        table->line[k] = k + 1;
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

enum status mf_snapshot_read(struct data_table *table, const char *file, int dimensions,
                             const struct composition *composition) {
    struct json_document *document;
    *table = (struct data_table){0};
    TRY(mf_json_open(&document, file));
    struct json_object root = mf_json_root(document);
    struct json_object particles = mf_json_child(&root, "particles", true);
    enum status status = STATUS_OK;
    if (particles.item && mf_json_count(&particles, "x") == 0)
        mf_json_fault(&particles, "x", "expected a list of numbers");
    else if (particles.item)
        status = read_columns(table, &particles, dimensions);
    if (particles.item && status == STATUS_OK)
        status = check_types(&particles, composition);
    status = mf_json_close(document, status);
    if (status != STATUS_OK)
        mf_data_table_clear(table);
    return status;
}
