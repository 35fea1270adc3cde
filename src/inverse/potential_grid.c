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

bool potential_grid_well_known(const struct inverse_problem *problem, size_t bin) {
    return problem->goals.goal[GOAL_RDF].value[bin] > 0.1;
}

double potential_grid_ramp(const struct potential_grid *grid, size_t point) {
    return 1 - grid->r[point] / grid->r[grid->points - 1];
}

/// Places in a bin at which its mean is taken.
enum { PLACES = 8 };

/// Mean of −r Φ'(r) over the shell of a bin.
static double shell_virial(const struct table *table, const struct rdf_bins *bins, size_t bin,
                           int dimensions) {
    double sum = 0, volume = 0;
    for (int k = 0; k < PLACES; k++) {
        const double r = rdf_bins_edge(bins, bin) + (k + 0.5) / PLACES * bins->width;
        const double shell = pow(r, dimensions - 1);
        double slope;
        table_evaluate(table, r, NULL, &slope, NULL);
        sum -= shell * r * slope;
        volume += shell;
    }
    return sum / volume;
}

/// Add `factor` times the virials of the bins by a table that is `change` higher at one point.
static enum status add_virials(const struct potential_grid *grid, const struct rdf_bins *bins,
                               int dimensions, const double *phi, size_t point, double change,
                               double factor, double *changed, double *virial) {
    struct table table;
    for (size_t k = 0; k < grid->points; k++)
        changed[k] = phi[k];
    changed[point] += change;
    potential_grid_complete(grid, changed);
    TRY(potential_grid_table(grid, changed, &table));
    for (size_t a = 0; a < bins->count; a++)
        virial[a * grid->known] += factor * shell_virial(&table, bins, a, dimensions);
    table_clear(&table);
    return STATUS_OK;
}

enum status potential_grid_virials(const struct potential_grid *grid, const struct rdf_bins *bins,
                                   int dimensions, const double *phi, double *virial) {
    // The table is linear in its values but for the kink of the core: any small step will do.
    const double change = 1e-3;
    enum status status = STATUS_OK;
    double *changed = NULL;
    NEW_ARRAY(changed, grid->points);
    for (size_t k = 0; k < bins->count * grid->known; k++)
        virial[k] = 0;
    for (size_t b = 0; b < grid->known; b++)
        for (int sign = -1; sign <= 1; sign += 2)
            CHECK(add_virials(grid, bins, dimensions, phi, grid->core + b, sign * change,
                              sign / (2 * change), changed, virial + b));
done:
    memory_free(changed);
    return status;
}
