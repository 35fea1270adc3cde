// SPDX-License-Identifier: GPL-3.0-or-later
#include "inverse/inversion.h"

#include "base/statistics.h"

#include <math.h>

/// d V of the Monte Carlo system.
static double virial_unit(const struct inversion *inversion) {
    double volume = inversion->box.dimensions;
    for (int d = 0; d < inversion->box.dimensions; d++)
        volume *= inversion->box.length[d];
    return volume;
}

/// Scatter of the virial's mean.
static double virial_error(const struct replicas *replicas, double inefficiency) {
    const size_t virial = replicas->bins;
    struct running_mean chains = {0};
    for (size_t k = 0; k < replicas->count; k++)
        statistics_add(&chains, replicas->member[k].counts.mean[virial]);
    const double sampled = comoments_covariance(&replicas->counts, virial, virial) * inefficiency /
                           replicas->counts.count;
    return fmax(statistics_standard_error(&chains), sqrt(sampled));
}

void inversion_pressure_measure(struct inversion *inversion) {
    const struct replicas *replicas = &inversion->replicas;
    const double unit = virial_unit(inversion), mean = replicas->counts.mean[replicas->bins];
    const double ideal = (double)inversion->particles * inversion->problem->scene.temperature;
    inversion->pressure.value = (inversion->box.dimensions * ideal + mean) / unit;
    inversion->pressure.error = virial_error(replicas, inversion->inefficiency) / unit;
}

enum status inversion_pressure_slopes(struct inversion *inversion) {
    enum status status = STATUS_OK;
    const struct potential_grid *grid = &inversion->grid;
    const struct rdf_bins *bins = &inversion->problem->goals.bins;
    const struct comoments *counts = &inversion->replicas.counts;
    double *virial = NULL;
    NEW_ARRAY(virial, bins->count * grid->known);
    CHECK(potential_grid_virials(grid, bins, inversion->box.dimensions, inversion->phi, virial));
    for (size_t b = 0; b < grid->known; b++) {
        double slope = -comoments_covariance(counts, bins->count, grid->core + b) /
                       inversion->problem->scene.temperature;
        for (size_t a = 0; a < bins->count; a++)
            slope += counts->mean[a] * virial[a * grid->known + b];
        inversion->pressure.slope[b] = slope / virial_unit(inversion);
    }
done:
    memory_free(virial);
    return status;
}

double inversion_pressure_ramp_slope(const struct inversion *inversion) {
    const struct potential_grid *grid = &inversion->grid;
    double slope = 0;
    for (size_t b = 0; b < grid->known; b++)
        slope += inversion->pressure.slope[b] * potential_grid_ramp(grid, grid->core + b);
    return slope;
}

void inversion_pressure_add_ramp(const struct inversion *inversion, double *step) {
    const struct potential_grid *grid = &inversion->grid;
    const struct goals *goals = &inversion->problem->goals;
    if (!goals_ask(goals, GOAL_PRESSURE))
        return;
    double missing = *goals->goal[GOAL_PRESSURE].value - inversion->pressure.value;
    for (size_t b = 0; b < grid->known; b++)
        missing -= inversion->pressure.slope[b] * step[grid->core + b];
    const double amplitude = missing / inversion_pressure_ramp_slope(inversion);
    for (size_t k = grid->core; k < grid->core + grid->known; k++)
        step[k] += amplitude * potential_grid_ramp(grid, k);
}
