// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/export_friction.h"

#include "export/export_columns.h"
#include "problem/omega_grid.h"

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
