// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_ramp.h"

#include "inversion/inversion.h"

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

void mf_inversion_ramp_step(const struct inversion *inversion, const struct imc_system *system,
                            double *y, double *residual) {
    const struct potential_grid *grid = &inversion->grid;
    const double held = ridge / (system->temperature * system->temperature);
    double product = 0, squares = 0;
    for (size_t a = 0; a < system->size; a++) {
        const double ramp = mf_potential_grid_ramp(grid, grid->known_point[a]);
        residual[a] = respond(grid, system, a);
        product += residual[a] * system->excess[a] / system->variance[a];
        squares += residual[a] * residual[a] / system->variance[a] + held * ramp * ramp;
    }
    const double amplitude = squares > 0 ? product / squares : 0;
    for (size_t a = 0; a < system->size; a++) {
        y[grid->known_point[a]] = amplitude * mf_potential_grid_ramp(grid, grid->known_point[a]);
        residual[a] = system->excess[a] - amplitude * residual[a];
    }
}
