// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/omega_grid.h"

#include <math.h>

void mf_omega_grid_init(struct omega_grid *grid, double inner_cutoff, double cutoff) {
    *grid = (struct omega_grid){.inner_cutoff = inner_cutoff, .cutoff = cutoff};
    for (int k = 0; k < OMEGA_POINTS; k++)
        grid->r[k] = inner_cutoff + (cutoff - inner_cutoff) * k / (OMEGA_POINTS - 1);
}

double mf_omega_grid_value(const struct omega_grid *grid, const double *omega, double r) {
    if (r < grid->inner_cutoff || r >= grid->cutoff)
        return 0;
    const double place =
        (r - grid->inner_cutoff) / (grid->cutoff - grid->inner_cutoff) * (OMEGA_POINTS - 1);
    const int k = (int)fmin(place, OMEGA_POINTS - 2);
    return omega[k] + (place - k) * (omega[k + 1] - omega[k]);
}

/// A friction weight on its grid as a curve, for mf_table_init_omega.
struct points {
    const struct omega_grid *grid;
    const double *omega;
};

static double value(const void *parameters, double r) {
    const struct points *points = parameters;
    return mf_omega_grid_value(points->grid, points->omega, r);
}

static double cutoff(const void *parameters) {
    return ((const struct points *)parameters)->grid->cutoff;
}

enum status mf_omega_grid_table(const struct omega_grid *grid, const double *omega,
                                struct table *table) {
    static const struct curve_family family = {
        .name = "points", .size = sizeof(struct points), .value = value, .cutoff = cutoff};
    struct points points = {grid, omega};
    const struct curve curve = {&family, &points};
    return mf_table_init_omega(table, &curve);
}
