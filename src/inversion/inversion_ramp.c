// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_ramp.h"

#include "inversion/inversion.h"

#include <gsl/gsl_linalg.h>

/// Weight of |y|² beside the excess, as that of a step of bins [1/(k_B T)²].
static const double ridge = 0.01;

/// The ramp of a pair type in known bin b, 0 in those of others.
static double ramp_of(const struct potential_grid *grid, size_t pair, size_t b) {
    const size_t point = grid->known_point[b];
    return b < grid->pairs_known && point / (grid->bins + 1) == pair
               ? 1 - grid->r[point] / grid->r[pair * (grid->bins + 1) + grid->bins]
               : 0;
}

/// C d/k_B T of each ramp d, shape [pairs, known].
static void fill_responses(const struct potential_grid *grid, const struct imc_system *system,
                           double *response) {
    for (size_t pair = 0; pair < grid->pairs; pair++)
        for (size_t a = 0; a < system->size; a++) {
            double sum = 0;
            for (size_t b = 0; b < grid->pairs_known; b++)
                sum += system->covariance[a * system->size + b] * ramp_of(grid, pair, b);
            response[pair * system->size + a] = sum / system->temperature;
        }
}

/// The normal equations of the amplitudes.
static void fill_equations(const struct potential_grid *grid, const struct imc_system *system,
                           const double *response, double *normal, double *right) {
    const size_t pairs = grid->pairs, known = system->size;
    const double held = ridge / (system->temperature * system->temperature);
    for (size_t p = 0; p < pairs; p++) {
        for (size_t a = 0; a < known; a++)
            right[p] += response[p * known + a] * system->excess[a] / system->variance[a];
        for (size_t q = 0; q < pairs; q++)
            for (size_t a = 0; a < known; a++)
                normal[p * pairs + q] +=
                    response[p * known + a] * response[q * known + a] / system->variance[a] +
                    held * ramp_of(grid, p, a) * ramp_of(grid, q, a);
    }
}

enum status mf_inversion_ramp_step(const struct inversion *inversion,
                                   const struct imc_system *system, double *y, double *residual) {
    enum status status = STATUS_OK;
    const struct potential_grid *grid = &inversion->grid;
    const size_t pairs = grid->pairs, known = system->size;
    double *response = NULL, *normal = NULL, *amplitude = NULL;
    NEW_ARRAY(response, pairs * known);
    NEW_ARRAY(normal, pairs * pairs);
    NEW_ARRAY(amplitude, pairs);
    fill_responses(grid, system, response);
    fill_equations(grid, system, response, normal, amplitude);
    gsl_matrix_view matrix = gsl_matrix_view_array(normal, pairs, pairs);
    gsl_vector_view vector = gsl_vector_view_array(amplitude, pairs);
    // The ridge keeps it positive but for rounding: then there is no such part.
    if (gsl_linalg_cholesky_decomp1(&matrix.matrix) != GSL_SUCCESS ||
        gsl_linalg_cholesky_svx(&matrix.matrix, &vector.vector) != GSL_SUCCESS)
        gsl_vector_set_zero(&vector.vector);
    for (size_t a = 0; a < known; a++) {
        residual[a] = system->excess[a];
        for (size_t p = 0; p < pairs; p++) {
            y[grid->known_point[a]] += amplitude[p] * ramp_of(grid, p, a);
            residual[a] -= amplitude[p] * response[p * known + a];
        }
    }
done:
    mf_memory_free(response);
    mf_memory_free(normal);
    mf_memory_free(amplitude);
    return status;
}
