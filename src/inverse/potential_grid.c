// SPDX-License-Identifier: GPL-3.0-or-later
#include "inverse/potential_grid.h"

#include "base/memory.h"
#include "curves/core.h"
#include "curves/sampled.h"

#include <math.h>

enum status potential_grid_init(struct potential_grid *grid,
                                const struct inverse_problem *problem) {
    enum status status = STATUS_OK;
    const struct rdf_bins *bins = &problem->goals.bins;
    *grid = (struct potential_grid){.stiffness = problem->core_stiffness};
    while (grid->core < bins->count &&
           problem->goals.goal[GOAL_RDF].value[grid->core] <= problem->core_threshold)
        grid->core++;
    if (grid->core + 3 > bins->count)
        return status_fail(STATUS_BAD_INPUT, "the target is nowhere above %g",
                           problem->core_threshold);
    grid->known = bins->count - grid->core;
    grid->points = bins->count + 1;
    NEW_ARRAY(grid->r, grid->points);
    for (size_t k = 0; k < bins->count; k++)
        grid->r[k] = rdf_bins_centre(bins, k);
    grid->r[bins->count] = rdf_bins_range(bins);
done:
    return status;
}

void potential_grid_clear(struct potential_grid *grid) {
    memory_free(grid->r);
    *grid = (struct potential_grid){0};
}

void potential_grid_complete(const struct potential_grid *grid, double *phi) {
    const size_t first = grid->core;
    const double slope = (phi[first + 1] - phi[first]) / (grid->r[first + 1] - grid->r[first]);
    core_fill(grid->r, phi, first, slope, grid->stiffness);
    phi[grid->points - 1] = 0;
}

enum status potential_grid_table(const struct potential_grid *grid, const double *phi,
                                 struct table *table) {
    struct curve curve;
    TRY(sampled_create(&curve, grid->r, phi, grid->points));
    const enum status status = table_init_potential(table, &curve);
    curve_clear(&curve);
    return status;
}

void potential_grid_start(const struct potential_grid *grid, const struct inverse_problem *problem,
                          double *phi) {
    const struct curve *start = problem->unknown[UNKNOWN_POTENTIAL].start;
    for (size_t k = grid->core; k + 1 < grid->points; k++) {
        // A bin without pairs beyond the core is as high as one with the threshold's few.
        const double g = fmax(problem->goals.goal[GOAL_RDF].value[k], problem->core_threshold);
        phi[k] = start ? curve_value(start, grid->r[k]) : -problem->scene.temperature * log(g);
    }
    potential_grid_complete(grid, phi);
}
