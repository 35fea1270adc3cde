// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_ramp.h"

/// Weight of |y|² beside the excess, as that of a step of bins [1/(k_B T)²].
static const double ridge = 0.01;

/// C d/k_B T in known bin a.
static double respond(const struct potential_grid *grid, const struct imc_system *system,
                      size_t a) {
    double sum = 0;
    for (size_t b = 0; b < grid->pairs_known; b++)
        sum += system->covariance[a * system->size + b] *
               mf_potential_grid_ramp(grid, grid->known_point[b]);
    return sum / system->temperature;
}

double mf_inversion_ramp_find(const struct potential_grid *grid, const struct imc_system *system) {
    const double held = ridge / (system->temperature * system->temperature);
    double product = 0, squares = 0;
    for (size_t a = 0; a < system->size; a++) {
        const double ramp = mf_potential_grid_ramp(grid, grid->known_point[a]);
        const double response = respond(grid, system, a);
        product += response * system->excess[a] / system->variance[a];
        squares += response * response / system->variance[a] + held * ramp * ramp;
    }
    return squares > 0 ? product / squares : 0;
}

void mf_inversion_ramp_take(const struct potential_grid *grid, const struct imc_system *system,
                            double amplitude, double *y, double *residual) {
    for (size_t a = 0; a < system->size; a++) {
        y[grid->known_point[a]] = amplitude * mf_potential_grid_ramp(grid, grid->known_point[a]);
        residual[a] = system->excess[a] - amplitude * respond(grid, system, a);
    }
}
