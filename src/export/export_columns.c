// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/export_columns.h"

#include "base/memory.h"
#include "io/data_table.h"
#include "problem/omega_grid.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/// One column into `values`, shape [rows].
static enum status take_column(const struct data_table *table, const char *file,
                               const struct units *units, const struct export_column *column,
                               double *values) {
    char unit[DATA_UNIT_SIZE] = "";
    double factor = 1;
    const size_t place = mf_data_table_find(table, column->name);
    if (place == 0 && column->required)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: no column called %s", file, column->name);
    if (place > 0 && !mf_data_table_unit(table, place - 1, unit))
        return mf_status_fail(STATUS_BAD_INPUT, "%s: the line of names says no unit of %s: \"%s\"",
                              file, column->name, table->header);
    if (place > 0 && strcmp(unit, column->unit) != 0) {
        if (!mf_units_known(units))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: %s is in \"%s\", but used.json has no units", file,
                                  column->name, unit);
        if (mf_units_from(units, unit, column->unit, &factor) != STATUS_OK)
            return mf_status_prefix(STATUS_BAD_INPUT, "%s: %s", file, column->name);
    }
    for (size_t k = 0; k < table->rows; k++)
        values[k] = place == 0 ? NAN : factor * table->values[k * table->columns + place - 1];
    return STATUS_OK;
}

enum status mf_export_columns_read(struct export_columns *columns, const char *file,
                                   const struct units *units, const struct export_column *wanted) {
    enum status status = STATUS_OK;
    struct data_table table = {0};
    size_t count = 0, required = 0;
    *columns = (struct export_columns){0};
    for (; wanted[count].name; count++)
        required += wanted[count].required;
    CHECK(mf_data_table_read(&table, file, required));
    columns->rows = table.rows;
    NEW_ARRAY(columns->values, count * table.rows);
    for (size_t c = 0; c < count; c++)
        CHECK(take_column(&table, file, units, &wanted[c], columns->values + c * table.rows));
done:
    mf_data_table_clear(&table);
    if (status != STATUS_OK)
        mf_export_columns_clear(columns);
    return status;
}

void mf_export_columns_clear(struct export_columns *columns) {
    mf_memory_free(columns->values);
    *columns = (struct export_columns){0};
}

// Friction ----------------------------------------------------------------------------------------

/// A fitted friction weight, one for all pairs.
static enum status read_omega(const struct export_model *model, const char *name,
                              struct table *table) {
    static const struct export_column wanted[] = {
        {"r", "lambda", true}, {"omega", "sqrt(mu/tau)", true}, {0}};
    enum status status = STATUS_OK;
    struct omega_grid grid;
    struct export_columns points;
    char path[OUTPUT_PATH_SIZE];
    snprintf(path, sizeof path, "%.3900s/%.120s.tsv", model->folder, name);
    TRY(mf_export_columns_read(&points, path, &model->scene.units, wanted));
    const double *r = points.values, *omega = r + points.rows;
    if (points.rows != OMEGA_POINTS || !(r[0] < r[points.rows - 1]))
        status = mf_status_fail(STATUS_BAD_INPUT, "%s: not %d rows with increasing r", path,
                                OMEGA_POINTS);
    CHECK(status);
    mf_omega_grid_init(&grid, r[0], r[points.rows - 1]);
    CHECK(mf_omega_grid_table(&grid, omega, table));
done:
    mf_export_columns_clear(&points);
    return status;
}

/// Modes whose weight was left to the fit.
static enum status read_modes(struct export_model *model) {
    struct pair_memory_law *law = &model->setup.memory;
    for (int m = 0; m < law->modes; m++) {
        char name[SCENE_MEMORY_NAME_SIZE + 16];
        if (law->mode[m].omega)
            continue;
        snprintf(name, sizeof name, "memory_%s", model->scene.memory.name[m]);
        TRY(read_omega(model, name, &model->memory[m]));
        law->mode[m].omega = &model->memory[m];
    }
    return STATUS_OK;
}

enum status mf_export_friction_find(struct export_model *model, int unknown) {
    struct simulation_setup *setup = &model->setup;
    if (unknown & SCENE_FITS_OMEGA) {
        TRY(read_omega(model, "omega", &model->omega));
        setup->omega = &model->omega;
    }
    if (unknown & SCENE_FITS_TRANSVERSE) {
        TRY(read_omega(model, "omega_transverse", &model->across));
        setup->memory.transverse = &model->across;
    }
    TRY(read_modes(model));
    model->own_omega = setup->omega;
    model->own_memory = setup->memory;
    model->remembers = setup->memory.modes > 0;
    if (model->remembers) {
        setup->omega = NULL;
        setup->memory = (struct pair_memory_law){0};
    }
    return STATUS_OK;
}

void mf_export_friction_clear(struct export_model *model) {
    mf_table_clear(&model->omega);
    mf_table_clear(&model->across);
    for (int m = 0; m < PAIR_MEMORY_MAX_MODES; m++)
        mf_table_clear(&model->memory[m]);
}
