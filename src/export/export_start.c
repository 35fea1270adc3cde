// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/export_start.h"

#include "base/memory.h"
#include "export/export_columns.h"
#include "export/export_engine.h"
#include "system/whole_molecules.h"

#include <math.h>
#include <sys/stat.h>

/// The configuration that the result's simulation ended with, if it left one in this box, as the
/// start of another: the columns of configuration.tsv.
static enum status read_start(struct export_model *model, struct export_columns *columns,
                              struct simulation_start *start) {
    static const struct export_column wanted[] = {{"x", "lambda", true},
                                                  {"y", "lambda", true},
                                                  {"z", "lambda", false},
                                                  {"velocity_x", "lambda/tau", false},
                                                  {"velocity_y", "lambda/tau", false},
                                                  {"velocity_z", "lambda/tau", false},
                                                  {0}};
    const int dimensions = model->setup.box.dimensions;
    char path[OUTPUT_PATH_SIZE];
    struct stat found;
    *start = model->scene.start;
    snprintf(path, sizeof path, "%.3900s/configuration.tsv", model->folder);
    if (stat(path, &found) != 0 || isfinite(model->density)) // a frame of another box
        return STATUS_OK;
    TRY(mf_export_columns_read(columns, path, &model->scene.units, wanted));
    if (columns->rows != (size_t)model->setup.placement.count)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: %zu rows, not the %lld particles of used.json",
                              path, columns->rows, (long long)model->setup.placement.count);
    *start = (struct simulation_start){0};
    for (int d = 0; d < dimensions; d++) {
        start->position[d] = columns->values + (size_t)d * columns->rows;
        const double *velocity = columns->values + (size_t)(3 + d) * columns->rows;
        start->velocity[d] = isnan(velocity[0]) ? NULL : velocity;
    }
    model->setup.placement.kind = PLACEMENT_FILE;
    model->equilibrated = true;
    return STATUS_OK;
}

static int type_of(const struct export_model *model, uint32_t id) {
    return model->types > 1 ? mf_composition_type(&model->setup.composition, id) : 0;
}

/// Masses, which are alike within a type.
static enum status keep_masses(struct export_model *model, const struct particles *particles) {
    const double *mass = particles_masses(particles);
    for (int type = 0; type < model->types; type++)
        model->mass[type] = 1;
    for (size_t k = 0; mass && k < model->count; k++)
        model->mass[type_of(model, particles->id[k])] = mass[k];
    for (size_t k = 0; mass && k < model->count; k++)
        if (mass[k] != model->mass[type_of(model, particles->id[k])])
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: cannot be exported: masses differ within a type",
                                  model->folder);
    return STATUS_OK;
}

/// Positions and velocities by id.
static enum status keep_state(struct export_model *model, const struct particles *particles) {
    model->count = particles->count;
    for (int d = 0; d < 3; d++) {
        TRY_ARRAY(model->position[d], model->count);
        TRY_ARRAY(model->velocity[d], model->count);
        for (size_t k = 0; d < model->setup.box.dimensions && k < model->count; k++) {
            model->position[d][particles->id[k]] = particles->position[d][k];
            model->velocity[d][particles->id[k]] = particles->velocity[d][k];
        }
    }
    return keep_masses(model, particles);
}

/// In which image of the box each bead is, if molecules are whole and begin inside.
static enum status keep_images(struct export_model *model, const struct particles *particles) {
    const struct topology *topology = model->molecules ? &model->molecules->topology : NULL;
    struct whole_molecules whole = {0};
    enum status status = STATUS_OK;
    for (int d = 0; d < 3; d++)
        NEW_ARRAY(model->image[d], model->count);
    if (topology == NULL)
        return STATUS_OK;
    CHECK(mf_whole_molecules_init(&whole, topology));
    for (int k = 0; k < topology->kinds; k++)
        for (int64_t m = 0; m < topology->kind[k].count; m++) {
            mf_whole_molecules_make(&whole, particles, k, m);
            for (int bead = 0; bead < topology->kind[k].beads; bead++)
                for (int d = 0; d < model->setup.box.dimensions; d++) {
                    const uint32_t id = topology_id(&topology->kind[k], m, bead);
                    const uint32_t first = topology_id(&topology->kind[k], m, 0);
                    const double away = mf_export_place(model, d, first) + whole.place[bead][d] -
                                        whole.place[0][d] - mf_export_place(model, d, id);
                    model->image[d][id] = (int)lround(away / model->setup.box.length[d]);
                }
        }
done:
    mf_whole_molecules_clear(&whole);
    return status;
}

/// The largest densities of central beads, as of the pass that a simulation begins with.
static void keep_densities(struct export_model *model, const struct simulation *simulation) {
    const struct particles *particles = &simulation->particles;
    for (int n = 0; n < simulation->interactions; n++) {
        const struct interaction_use *use = &simulation->interaction[n];
        const struct many_body *law = use->choice.parameters;
        for (int t = 0; use->choice.kind == &mf_many_body && t < law->terms; t++) {
            const double *density = mf_many_body_density(use->state, t);
            for (size_t k = 0; k < particles->count; k++)
                if (law->term[t].central >> type_of(model, particles->id[k]) & 1)
                    model->densest[t] = fmax(model->densest[t], density[k]);
        }
    }
}

enum status mf_export_start_find(struct export_model *model) {
    enum status status = STATUS_OK;
    struct simulation_start start;
    struct simulation simulation = {0};
    struct export_columns columns = {0};
    CHECK(read_start(model, &columns, &start));
    status = mf_simulation_init(&simulation, &model->setup, &start);
    if (status != STATUS_OK)
        status = mf_status_prefix(status, "%s", model->folder);
    CHECK(status);
    CHECK(keep_state(model, &simulation.particles));
    keep_densities(model, &simulation);
    CHECK(keep_images(model, &simulation.particles));
done:
    mf_simulation_clear(&simulation);
    mf_export_columns_clear(&columns);
    return status;
}
