// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/export_grid.h"

#include "base/memory.h"

#include <math.h>

/// Row k with x between it and the next, of rows equally far apart in x.
static size_t row_below(const struct export_grid *grid, double share, size_t intervals,
                        double *fraction) {
    const double place = fmin(fmax(share, 0), 1) * (double)intervals;
    const size_t last = grid->rows > 1 ? grid->rows - 2 : 0;
    const size_t k = (size_t)place < last ? (size_t)place : last;
    *fraction = place - (double)k;
    return k;
}

static double square_place(const struct export_grid *grid, size_t row) {
    const double low = grid->first * grid->first, high = grid->last * grid->last;
    return sqrt(low + (high - low) * (double)row / (double)(grid->rows - 1));
}

static enum status square_prepare(struct export_grid *grid) {
    grid->force[0] = grid->force[1] * grid->r[0] / grid->r[1];
    return STATUS_OK;
}

static void square_value(const struct export_grid *grid, double r, double *phi, double *force) {
    const double low = grid->first * grid->first, high = grid->last * grid->last;
    double f;
    const size_t k = row_below(grid, (r * r - low) / (high - low), grid->rows - 1, &f);
    const double here = grid->force[k] / grid->r[k], next = grid->force[k + 1] / grid->r[k + 1];
    *phi = grid->phi[k] + f * (grid->phi[k + 1] - grid->phi[k]);
    *force = r * (here + f * (next - here));
}

static double even_place(const struct export_grid *grid, size_t row) {
    return grid->first + (grid->last - grid->first) * (double)row / (double)(grid->rows - 1);
}

static size_t even_row(const struct export_grid *grid, double r, double *fraction) {
    return row_below(grid, (r - grid->first) / (grid->last - grid->first), grid->rows - 1,
                     fraction);
}

static void linear_value(const struct export_grid *grid, double r, double *phi, double *force) {
    double f;
    const size_t k = even_row(grid, r, &f);
    *phi = grid->phi[k] + f * (grid->phi[k + 1] - grid->phi[k]);
    *force = grid->force[k] + f * (grid->force[k + 1] - grid->force[k]);
}

static double open_place(const struct export_grid *grid, size_t row) {
    return grid->first + (grid->last - grid->first) * (double)row / (double)grid->rows;
}

/// The row after the last is 0.
static void open_value(const struct export_grid *grid, double r, double *phi, double *force) {
    const double place =
        fmin((r - grid->first) / (grid->last - grid->first), 1) * (double)grid->rows;
    const size_t k = place < (double)(grid->rows - 1) ? (size_t)place : grid->rows - 1;
    const double f = place - (double)k;
    const bool within = k + 1 < grid->rows;
    *phi = grid->phi[k] + f * ((within ? grid->phi[k + 1] : 0) - grid->phi[k]);
    *force = grid->force[k] + f * ((within ? grid->force[k + 1] : 0) - grid->force[k]);
}

/// Second derivatives of the natural cubic spline through Φ.
static enum status spline_prepare(struct export_grid *grid) {
    const size_t n = grid->rows;
    const double h = (grid->last - grid->first) / (double)(n - 1);
    OWNED double *upper = NULL;
    TRY_ARRAY(grid->second, n);
    TRY_ARRAY(upper, n);
    for (size_t k = 1; k + 1 < n; k++) {
        const double pivot = 4 - upper[k - 1];
        const double bend = grid->phi[k + 1] - 2 * grid->phi[k] + grid->phi[k - 1];
        upper[k] = 1 / pivot;
        grid->second[k] = (6 * bend / (h * h) - grid->second[k - 1]) / pivot;
    }
    for (size_t k = n - 1; k-- > 1;)
        grid->second[k] -= upper[k] * grid->second[k + 1];
    return STATUS_OK;
}

static void spline_value(const struct export_grid *grid, double r, double *phi, double *force) {
    const double h = (grid->last - grid->first) / (double)(grid->rows - 1);
    double b;
    const size_t k = even_row(grid, r, &b);
    const double a = 1 - b, *s = grid->second;
    *phi = a * grid->phi[k] + b * grid->phi[k + 1] +
           ((a * a * a - a) * s[k] + (b * b * b - b) * s[k + 1]) * h * h / 6;
    *force = (grid->phi[k] - grid->phi[k + 1]) / h +
             ((3 * a * a - 1) * s[k] - (3 * b * b - 1) * s[k + 1]) * h / 6;
}

static void hermite_value(const struct export_grid *grid, double r, double *phi, double *force) {
    const double h = (grid->last - grid->first) / (double)(grid->rows - 1);
    double f;
    const size_t k = even_row(grid, r, &f);
    const double y = grid->phi[k], slope = -h * grid->force[k];
    const double rise = grid->phi[k + 1] - y, next = -h * grid->force[k + 1];
    const double c2 = 3 * rise - 2 * slope - next, c3 = slope + next - 2 * rise;
    *phi = y + f * (slope + f * (c2 + f * c3));
    *force = -(slope + f * (2 * c2 + 3 * f * c3)) / h;
}

/// Rows from one spacing on, the last four after the cutoff.
static double quadratic_place(const struct export_grid *grid, size_t row) {
    return grid->last * (double)(row + 1) / (double)(grid->rows - 4);
}

/// Newton's and Gregory's formula of three rows: the mean of two straight lines.
static double through_three(const double y[3], double f) {
    const double first = y[0] + (y[1] - y[0]) * f, second = y[1] + (y[2] - y[1]) * (f - 1);
    return first + (second - first) * f * 0.5;
}

static void quadratic_value(const struct export_grid *grid, double r, double *phi, double *force) {
    const double place = r / grid->last * (double)(grid->rows - 4);
    const size_t row = place < 1 ? 0 : (size_t)place - 1;
    double virial[3];
    for (size_t n = 0; n < 3; n++)
        virial[n] = grid->r[row + n] * grid->force[row + n];
    *phi = through_three(grid->phi + row, place - (double)(row + 1));
    *force = through_three(virial, place - (double)(row + 1)) / r;
}

const struct export_interpolation mf_export_grid_square = {
    "linear in r^2 of phi and of force/r", 1e-4, // LAMMPS stops at pairs nearer than the first row
    square_place, square_prepare, square_value};
const struct export_interpolation mf_export_grid_linear = {"linear in r of phi and of the force", 0,
                                                           even_place, NULL, linear_value};
const struct export_interpolation mf_export_grid_open = {
    "linear in r of phi and of the force, without the last row", 0, open_place, NULL, open_value};
const struct export_interpolation mf_export_grid_spline = {
    "natural cubic spline of phi", 0, even_place, spline_prepare, spline_value};
const struct export_interpolation mf_export_grid_hermite = {
    "cubic in r by phi and the force at both ends", 0, even_place, NULL, hermite_value};
const struct export_interpolation mf_export_grid_quadratic = {
    "quadratic in r of phi and of r force", 0, quadratic_place, NULL, quadratic_value};

static double cutoff_of(const struct table *table, int pair) {
    const double cutoff = table_cutoff(table, pair);
    return cutoff > 0 ? cutoff : table->cutoff;
}

/// Φ and F of a row. Where the grid ends at the cutoff, rows there and after it go on straight, as
/// the force may end with a jump.
static void read_row(struct export_grid *grid, const struct table *table, int pair, size_t row) {
    static const double rounding = 1e-9;
    const double cutoff = cutoff_of(table, pair), r = grid->r[row];
    const bool ends = fabs(grid->last - cutoff) < rounding * cutoff;
    const double inside = ends ? fmin(r, cutoff * (1 - rounding)) : r;
    double slope;
    mf_table_evaluate_pair(table, pair, inside, &grid->phi[row], &slope, NULL);
    grid->phi[row] += slope * (r - inside);
    grid->force[row] = -slope;
}

enum status mf_export_grid_make(struct export_grid *grid,
                                const struct export_interpolation *interpolation,
                                const struct table *table, int pair, double last, size_t rows) {
    enum status status = STATUS_OK;
    *grid = (struct export_grid){.rows = rows};
    grid->last = last > 0 ? last : cutoff_of(table, pair);
    grid->first = interpolation->first * grid->last;
    NEW_ARRAY(grid->r, rows);
    NEW_ARRAY(grid->phi, rows);
    NEW_ARRAY(grid->force, rows);
    for (size_t k = 0; k < rows; k++) {
        grid->r[k] = interpolation->place(grid, k);
        read_row(grid, table, pair, k);
    }
    if (interpolation->prepare)
        CHECK(interpolation->prepare(grid));
done:
    if (status != STATUS_OK)
        mf_export_grid_clear(grid);
    return status;
}

void mf_export_grid_clear(struct export_grid *grid) {
    mf_memory_free(grid->r);
    mf_memory_free(grid->phi);
    mf_memory_free(grid->force);
    mf_memory_free(grid->second);
    *grid = (struct export_grid){0};
}

enum { SAMPLES = 200000 };

static double sample_place(double from, double to, int k) {
    return from + (to - from) * (k + 0.5) / SAMPLES;
}

/// The nearest distance from which on Φ is never more than EXPORT_ACCESSIBLE k_B T above its least
/// value.
static double find_accessible(const struct table *table, int pair, double cutoff,
                              double temperature) {
    double min = 0, phi;
    for (int k = 0; k < SAMPLES; k++) {
        mf_table_evaluate_pair(table, pair, sample_place(0, cutoff, k), &phi, NULL, NULL);
        min = fmin(min, phi);
    }
    for (int k = SAMPLES - 1; k >= 0; k--) {
        const double r = sample_place(0, cutoff, k);
        mf_table_evaluate_pair(table, pair, r, &phi, NULL, NULL);
        if (phi - min > EXPORT_ACCESSIBLE * temperature)
            return fmax(r, EXPORT_NEAREST * cutoff);
    }
    return EXPORT_NEAREST * cutoff;
}

struct export_error mf_export_grid_error(const struct export_grid *grid,
                                         const struct export_interpolation *interpolation,
                                         const struct table *table, int pair, double temperature) {
    // Where a longer table goes on after the cutoff, a jump of the force there takes two rows.
    const double end = cutoff_of(table, pair),
                 row = grid->r[grid->rows - 1] - grid->r[grid->rows - 2];
    const double cutoff = grid->last > end * (1 + 1e-6) ? end - 2 * row : end;
    // Where no row is at the cutoff, the force falls from the last row to 0, jump or not.
    const double last_force = grid->r[grid->rows - 1];
    struct export_error error = {.from = find_accessible(table, pair, cutoff, temperature)};
    for (int k = 0; k < SAMPLES; k++) {
        const double r = sample_place(error.from, cutoff, k);
        double phi, slope, read_phi, read_force;
        mf_table_evaluate_pair(table, pair, r, &phi, &slope, NULL);
        interpolation->value(grid, r, &read_phi, &read_force);
        error.phi = fmax(error.phi, fabs(read_phi - phi) / temperature);
        if (r <= last_force)
            error.force = fmax(error.force, fabs(read_force + slope));
        error.largest_force = fmax(error.largest_force, fabs(slope));
    }
    if (error.largest_force > 0)
        error.force /= error.largest_force;
    return error;
}

static bool is_good(const struct export_error *error) {
    return error->phi < EXPORT_PHI_BOUND && error->force < EXPORT_FORCE_BOUND;
}

/// The tables with so many rows, and their worst errors.
static enum status make_all(struct export_grids *grids,
                            const struct export_interpolation *interpolation,
                            const struct export_model *model, double last, size_t rows) {
    grids->error = (struct export_error){0};
    for (int n = 0; n < grids->curves * grids->pairs; n++) {
        const int curve = n / grids->pairs, pair = n % grids->pairs;
        const struct table *table = mf_export_model_potential(model, (enum export_curve)curve);
        struct export_grid *grid = &grids->grid[curve][pair];
        mf_export_grid_clear(grid);
        TRY(mf_export_grid_make(grid, interpolation, table, pair, last, rows));
        const struct export_error error =
            mf_export_grid_error(grid, interpolation, table, pair, model->setup.temperature);
        grids->error.phi = fmax(grids->error.phi, error.phi);
        grids->error.force = fmax(grids->error.force, error.force);
        grids->error.from = n == 0 ? error.from : fmin(grids->error.from, error.from);
        grids->error.largest_force = fmax(grids->error.largest_force, error.largest_force);
    }
    return STATUS_OK;
}

enum status mf_export_grids_make(struct export_grids *grids,
                                 const struct export_interpolation *interpolation,
                                 const struct export_model *model, bool bands, double last) {
    static const size_t rows[] = {1001, 2001, 5001, 10001, 20001, 50001, 100001, 200001, 500001};
    enum status status = STATUS_OK;
    *grids = (struct export_grids){.curves = bands ? EXPORT_CURVES : 1,
                                   .pairs = mf_export_model_pairs(model)};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        CHECK(make_all(grids, interpolation, model, last, rows[k]));
        if (is_good(&grids->error))
            return STATUS_OK;
    }
    status = mf_status_fail(STATUS_BAD_INPUT,
                            "%s: a table of %zu rows, %s, is still wrong by %.2g k_B T and %.2g of "
                            "the largest force",
                            model->folder, grids->grid[0][0].rows, interpolation->summary,
                            grids->error.phi, grids->error.force);
done:
    mf_export_grids_clear(grids);
    return status;
}

void mf_export_grids_clear(struct export_grids *grids) {
    for (int n = 0; n < EXPORT_CURVES * COMPOSITION_MAX_PAIRS; n++)
        mf_export_grid_clear(&grids->grid[n / COMPOSITION_MAX_PAIRS][n % COMPOSITION_MAX_PAIRS]);
    *grids = (struct export_grids){0};
}
