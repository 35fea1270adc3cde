// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/export_density.h"

#include "base/memory.h"
#include "io/output.h"

#include <math.h>

const struct many_body *mf_export_densities_of(const struct export_model *model) {
    return mf_many_body_find(model->setup.interaction, model->setup.interactions);
}

/// Value and slope of what is tabulated.
typedef void curve_value(const struct many_body_term *term, double x, double *value, double *slope);

static void energy_at(const struct many_body_term *term, double density, double *value,
                      double *slope) {
    *value = mf_density_energy_value(&term->energy, density, slope);
}

static void weight_at(const struct many_body_term *term, double r, double *value, double *slope) {
    mf_weight_evaluate(&term->weight, r, value, slope);
}

/// Slopes as LAMMPS takes them from the values: of four rows about each, of two at the ends.
static void find_slopes(struct export_grid *grid) {
    const size_t n = grid->rows;
    const double h = (grid->last - grid->first) / (double)(n - 1);
    const double *f = grid->phi;
    for (size_t k = 2; k + 2 < n; k++)
        grid->force[k] = -(f[k - 2] - f[k + 2] + 8 * (f[k + 1] - f[k - 1])) / (12 * h);
    grid->force[0] = (f[0] - f[1]) / h;
    grid->force[1] = (f[0] - f[2]) / (2 * h);
    grid->force[n - 2] = (f[n - 3] - f[n - 1]) / (2 * h);
    grid->force[n - 1] = (f[n - 2] - f[n - 1]) / h;
}

/// Rows from 0 on of which the last BEYOND are behind `end`, where the slopes are those of two
/// rows.
/// @param[in] stops  the curve does at `end`: what is behind goes on as its parabola there
static enum status make_grid(struct export_grid *grid, const struct many_body_term *term,
                             curve_value *curve, double end, bool stops, size_t rows) {
    enum { BEYOND = 2 };
    const double h = end / (double)(rows - 1 - BEYOND);
    mf_export_grid_clear(grid);
    *grid = (struct export_grid){.rows = rows, .last = h * (double)(rows - 1)};
    TRY_ARRAY(grid->r, rows);
    TRY_ARRAY(grid->phi, rows);
    TRY_ARRAY(grid->force, rows);
    for (size_t k = 0; k < rows; k++) {
        double slope;
        double *f = grid->phi + k;
        grid->r[k] = h * (double)k;
        if (stops && k + BEYOND >= rows)
            *f = 3 * f[-1] - 3 * f[-2] + f[-3];
        else
            curve(term, grid->r[k], f, &slope);
    }
    find_slopes(grid);
    return STATUS_OK;
}

/// What LAMMPS reads of a table between two places beside its curve: the value, and the slope over
/// the largest one up to `usual`.
static struct export_error find_error(const struct export_grid *grid,
                                      const struct many_body_term *term, curve_value *curve,
                                      const double between[2], double usual) {
    enum { SAMPLES = 200000 };
    struct export_error error = {0};
    double largest_of_all = 0;
    for (int k = 0; k < SAMPLES; k++) {
        const double x = between[0] + (between[1] - between[0]) * k / SAMPLES;
        double value, slope, read, force;
        curve(term, x, &value, &slope);
        mf_export_grid_hermite.value(grid, x, &read, &force);
        error.phi = fmax(error.phi, fabs(read - value));
        error.force = fmax(error.force, fabs(force + slope));
        largest_of_all = fmax(largest_of_all, fabs(slope));
        if (x <= usual)
            error.largest_force = fmax(error.largest_force, fabs(slope));
    }
    if (!(error.largest_force > 0))
        error.largest_force = largest_of_all;
    if (error.largest_force > 0)
        error.force /= error.largest_force;
    return error;
}

static const size_t row_numbers[] = {2001, 5001, 10001, 20001, 50001, 100001, 200001};
enum { ROW_NUMBERS = sizeof row_numbers / sizeof *row_numbers };

/// The mean of w within its cutoff; negative: w is below 0 somewhere.
static double mean_weight(const struct export_grid *grid, int dimensions) {
    const size_t rows = grid->rows - 2; // to the cutoff
    double sum = 0, norm = 0, largest = 0;
    for (size_t k = 0; k < rows; k++) {
        const double shell = dimensions == 2 ? grid->r[k] : grid->r[k] * grid->r[k];
        largest = fmax(largest, fabs(grid->phi[k]));
        if (grid->phi[k] < -1e-9 * largest)
            return -1;
        sum += grid->phi[k] * shell;
        norm += shell;
    }
    return sum / norm;
}

/// w, of as many rows as it needs.
static enum status find_weight(struct export_density *table, const struct export_model *model,
                               const struct many_body_term *of) {
    const double cutoff = weight_cutoff(&of->weight);
    const double between[] = {EXPORT_NEAREST * cutoff, cutoff * (1 - 1e-9)};
    struct export_error error = {0};
    for (int n = 0; n < ROW_NUMBERS; n++) {
        TRY(make_grid(&table->weight, of, weight_at, cutoff, true, row_numbers[n]));
        error = find_error(&table->weight, of, weight_at, between, cutoff);
        if (error.force < EXPORT_SLOPE_BOUND &&
            error.phi < EXPORT_SLOPE_BOUND * error.largest_force * cutoff)
            break;
    }
    if (mean_weight(&table->weight, model->setup.box.dimensions) < 0)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: cannot be exported: many_body.%s.weight is below 0 somewhere, "
                              "and densities of LAMMPS begin at 0",
                              model->folder, of->name);
    if (!(error.force < EXPORT_SLOPE_BOUND))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: cannot be exported: a table of many_body.%s.weight with %zu "
                              "rows is still wrong by %.2g of the largest slope: make it smoother",
                              model->folder, of->name, table->weight.rows, error.force);
    return STATUS_OK;
}

/// f up to where it is asked for and to the end of its own table, beyond which both go on straight.
static enum status find_energy(struct export_density *table, const struct export_model *model,
                               int term, struct export_error *error) {
    const struct many_body_term *of = &mf_export_densities_of(model)->term[term];
    const double temperature = model->setup.temperature, densest = model->densest[term];
    const double mean = mean_weight(&table->weight, model->setup.box.dimensions);
    table->high = fmax(EXPORT_DENSITY_LEAST * mean, EXPORT_DENSITY_ROOM * densest);
    if (of->energy.tabulated)
        table->high = fmax(table->high, of->energy.high);
    const double between[] = {EXPORT_DENSITY_FIRST * table->high, table->high};
    for (int n = 0; n < ROW_NUMBERS; n++) {
        TRY(make_grid(&table->energy, of, energy_at, table->high, false, row_numbers[n]));
        *error = find_error(&table->energy, of, energy_at, between, fmax(mean, densest));
        error->phi /= temperature;
        if (error->phi < EXPORT_PHI_BOUND && error->force < EXPORT_SLOPE_BOUND)
            return STATUS_OK;
    }
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "%s: cannot be exported: a table of many_body.%s.energy with %zu rows is "
        "still wrong by %.2g k_B T and %.2g of the largest slope: make it smoother",
        model->folder, of->name, table->energy.rows, error->phi, error->force);
}

enum status mf_export_densities_make(struct export_densities *densities,
                                     const struct export_model *model) {
    const struct many_body *law = mf_export_densities_of(model);
    struct export_error error = {0};
    *densities = (struct export_densities){.terms = law ? law->terms : 0};
    if (law == NULL)
        return STATUS_OK;
    for (int t = 0; t < law->terms; t++) {
        TRY(find_weight(&densities->table[t], model, &law->term[t]));
        TRY(find_energy(&densities->table[t], model, t, &error));
        densities->error.phi = fmax(densities->error.phi, error.phi);
        densities->error.force = fmax(densities->error.force, error.force);
    }
    return STATUS_OK;
}

double mf_export_density_unit(const struct export_model *model, int term, double length) {
    const struct curve *weight = &model->scene.many_body.weight[term];
    return mf_weight_is_normalised(weight) ? pow(length, -model->setup.box.dimensions) : 1;
}

void mf_export_densities_print(const struct export_densities *densities,
                               const struct export_model *model, const struct export_units *units,
                               const char *prefix, FILE *stream) {
    for (int t = 0; t < densities->terms; t++) {
        const struct export_density *table = &densities->table[t];
        const double unit = mf_export_density_unit(model, t, units->length);
        fprintf(stream, "%smany_body  f of %s in %zu rows for rho from 0 to %.4g", prefix,
                mf_export_densities_of(model)->term[t].name, table->energy.rows,
                table->high * unit);
        if (mf_weight_is_normalised(&model->scene.many_body.weight[t]))
            fprintf(stream, " 1/%s^%d", units->length_name, model->setup.box.dimensions);
        fprintf(stream, ", beyond which it goes on straight; the start has %.3g at most\n",
                model->densest[t] * unit);
    }
}

void mf_export_densities_clear(struct export_densities *densities) {
    for (int t = 0; t < densities->terms; t++) {
        mf_export_grid_clear(&densities->table[t].energy);
        mf_export_grid_clear(&densities->table[t].weight);
    }
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
