// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/export_density.h"

#include "base/memory.h"
#include "io/output.h"

#include <math.h>

/// Rows before ρ = 0 and after the largest density: what is wrong at an end is wrong by 0.27 of it
/// at the next row.
enum { MARGIN = 32 };

const struct many_body *mf_export_densities_of(const struct export_model *model) {
    return mf_many_body_find(model->setup.interaction, model->setup.interactions);
}

static enum status check_weights(const struct export_model *model) {
    const struct many_body *law = mf_export_densities_of(model);
    for (int t = 0; t < law->terms; t++) {
        const struct curve_family *family = model->scene.many_body.weight[t].family;
        if (family != &mf_weight_sanyal_shell)
            return mf_status_fail(
                STATUS_BAD_INPUT,
                "%s: cannot be exported: many_body.%s: LAMMPS's local/density has "
                "the weight \"%s\" alone, not \"%s\": simulate or fit with that",
                model->folder, law->term[t].name, mf_weight_sanyal_shell.name, family->name);
    }
    return STATUS_OK;
}

/// f, and below ρ = 0, where no bead is, the parabola that f has there: a spline follows that.
static double value_of(const struct density_energy *energy, double density, double spacing) {
    double slope, next;
    if (density >= 0)
        return mf_density_energy_value(energy, density, &slope);
    const double value = mf_density_energy_value(energy, 0, &slope);
    mf_density_energy_value(energy, spacing, &next);
    return value + density * (slope + 0.5 * density * (next - slope) / spacing);
}

/// Second derivatives of the cubic spline through the rows whose slopes at both ends are 0.
static enum status clamp(struct export_grid *grid) {
    const size_t n = grid->rows;
    const double h = (grid->last - grid->first) / (double)(n - 1);
    const double *f = grid->phi;
    OWNED double *upper = NULL;
    TRY_ARRAY(upper, n);
    for (size_t k = 0; k < n; k++) {
        const double rise = k + 1 < n ? f[k + 1] - f[k] : 0, before = k > 0 ? f[k] - f[k - 1] : 0;
        const double pivot = k == 0 ? 2 : k + 1 == n ? 2 - upper[k - 1] : 4 - upper[k - 1];
        upper[k] = 1 / pivot;
        grid->second[k] =
            (6 * (rise - before) / (h * h) - (k > 0 ? grid->second[k - 1] : 0)) / pivot;
    }
    for (size_t k = n - 1; k-- > 0;)
        grid->second[k] -= upper[k] * grid->second[k + 1];
    return STATUS_OK;
}

static enum status make_table(struct export_density *table, const struct density_energy *energy,
                              size_t rows) {
    struct export_grid *grid = &table->grid;
    const double spacing = table->high / (double)(rows - 1 - 2 * MARGIN);
    mf_export_grid_clear(grid);
    *grid = (struct export_grid){
        .rows = rows, .first = -MARGIN * spacing, .last = table->high + MARGIN * spacing};
    TRY_ARRAY(grid->r, rows);
    TRY_ARRAY(grid->phi, rows);
    TRY_ARRAY(grid->second, rows);
    for (size_t k = 0; k < rows; k++) {
        grid->r[k] = grid->first + spacing * (double)k;
        grid->phi[k] = value_of(energy, grid->r[k], spacing);
    }
    return clamp(grid);
}

/// What LAMMPS reads of a table beside f, as struct export_densities has it.
/// @param[in] densest  of the configuration
static struct export_error find_error(const struct export_density *table,
                                      const struct density_energy *energy, double densest,
                                      double temperature) {
    enum { SAMPLES = 200000 };
    const double usual = fmax(1, densest);
    struct export_error error = {0};
    double largest = 0, largest_of_all = 0;
    for (int k = 0; k < SAMPLES; k++) {
        const double density = table->high * k / SAMPLES;
        double slope, read, force;
        const double value = mf_density_energy_value(energy, density, &slope);
        mf_export_grid_spline.value(&table->grid, density, &read, &force);
        error.phi = fmax(error.phi, fabs(read - value) / temperature);
        error.force = fmax(error.force, fabs(force + slope));
        largest_of_all = fmax(largest_of_all, fabs(slope));
        if (density <= usual)
            largest = fmax(largest, fabs(slope));
    }
    error.largest_force = largest > 0 ? largest : largest_of_all;
    if (error.largest_force > 0)
        error.force /= error.largest_force;
    return error;
}

/// The table of a term, of as many rows as it needs.
static enum status find_table(struct export_density *table, const struct export_model *model,
                              int term, struct export_error *error) {
    static const size_t rows[] = {1001, 2001, 5001, 10001, 20001, 50001, 100001, 200001};
    const struct many_body_term *of = &mf_export_densities_of(model)->term[term];
    table->high = fmax(EXPORT_DENSITY_LEAST, EXPORT_DENSITY_ROOM * model->densest[term]);
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        TRY(make_table(table, &of->energy, rows[k]));
        *error = find_error(table, &of->energy, model->densest[term], model->setup.temperature);
        if (error->phi < EXPORT_PHI_BOUND && error->force < EXPORT_FORCE_BOUND)
            return STATUS_OK;
    }
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "%s: cannot be exported: a table of many_body.%s.energy with %zu rows is "
        "still wrong by %.2g k_B T and %.2g of the largest slope: make it smoother",
        model->folder, of->name, table->grid.rows, error->phi, error->force);
}

enum status mf_export_densities_make(struct export_densities *densities,
                                     const struct export_model *model) {
    const struct many_body *law = mf_export_densities_of(model);
    struct export_error error;
    *densities = (struct export_densities){.terms = law ? law->terms : 0};
    if (law == NULL)
        return STATUS_OK;
    TRY(check_weights(model));
    for (int t = 0; t < law->terms; t++) {
        TRY(find_table(&densities->table[t], model, t, &error));
        densities->error.phi = fmax(densities->error.phi, error.phi);
        densities->error.force = fmax(densities->error.force, error.force);
    }
    return STATUS_OK;
}

void mf_export_densities_print(const struct export_densities *densities,
                               const struct export_model *model, const char *prefix, FILE *stream) {
    for (int t = 0; t < densities->terms; t++) {
        const struct export_density *table = &densities->table[t];
        fprintf(stream,
                "%smany_body  f of %s in %zu rows for rho from 0 to %.4g; the start has %.3g at "
                "most, and beyond %.4g LAMMPS takes the slope to be 0\n",
                prefix, mf_export_densities_of(model)->term[t].name, table->grid.rows, table->high,
                model->densest[t], table->grid.last);
    }
}

void mf_export_densities_clear(struct export_densities *densities) {
    for (int t = 0; t < densities->terms; t++)
        mf_export_grid_clear(&densities->table[t].grid);
    *densities = (struct export_densities){0};
}

enum status mf_export_densities_read(struct export_model *model) {
    struct scene_many_body *many_body = &model->scene.many_body;
    for (int t = 0; many_body->law && t < many_body->law->terms; t++) {
        char path[OUTPUT_PATH_SIZE];
        if (!scene_many_body_is_fitted(many_body, t))
            continue;
        snprintf(path, sizeof path, "%.3800s/many_body_%s.tsv", model->folder,
                 many_body->law->term[t].name);
        TRY(mf_scene_many_body_give_energy(many_body, t, path, &model->scene.units));
    }
    return STATUS_OK;
}
