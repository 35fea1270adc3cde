// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/parametrisation_bonded.h"

#include "base/memory.h"
#include "curves/shape.h"
#include "problem/group_kind.h"

#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

/// Sines and cosines of a dihedral, which goes round.
static void fill_waves(const struct bonded_grid *grid, size_t count, double *basis) {
    for (size_t k = 0; k < grid->known; k++) {
        const double phi = BONDED_RADIANS * mf_bonded_grid_place(grid, k);
        for (size_t n = 0; n < count; n++) {
            const double turns = (double)(n / 2 + 1);
            basis[k * count + n] = n % 2 ? sin(turns * phi) : cos(turns * phi);
        }
    }
}

/// B-splines from the first to the last known bin. The one that is left out at the end is the sum
/// of the others but for a constant; where the slope is left out, too, so is the first.
static enum status fill_splines(const struct bonded_grid *grid, size_t count, double *basis) {
    const size_t left_out = grid->is_level, all = count + left_out;
    OWNED double *place = NULL, *whole = NULL;
    TRY_ARRAY(place, grid->known);
    TRY_ARRAY(whole, grid->known * all);
    for (size_t k = 0; k < grid->known; k++)
        place[k] = (double)k / (double)(grid->known - 1);
    TRY(mf_shape_basis(mf_shapes[INVERSE_CURVE_BSPLINE], all, place, grid->known, whole));
    for (size_t k = 0; k < grid->known; k++)
        memcpy(basis + k * count, whole + k * all + left_out, count * sizeof *basis);
    return STATUS_OK;
}

/// Take off a function its part along another, x, by the target: Σ p x y/Σ p x² of it.
static void take_off(const struct bonded_grid *grid, size_t count, const double *x, double *y) {
    double products = 0, squares = 0;
    for (size_t k = 0; k < grid->known; k++) {
        const double p = grid->target[grid->first + k];
        products += p * x[k] * y[k * count];
        squares += p * x[k] * x[k];
    }
    for (size_t k = 0; k < grid->known; k++)
        y[k * count] -= products / squares * x[k];
}

enum status mf_parametrisation_bonded_basis(const struct bonded_grid *grid, size_t count,
                                            double *basis) {
    OWNED double *constant = NULL, *line = NULL;
    TRY_ARRAY(constant, grid->known);
    TRY_ARRAY(line, grid->known);
    for (size_t k = 0; k < grid->known; k++) {
        constant[k] = 1;
        line[k] = (double)k;
    }
    take_off(grid, 1, constant, line);
    if (mf_group_kind_is_periodic(grid->unknown->order))
        fill_waves(grid, count, basis);
    else
        TRY(fill_splines(grid, count, basis));
    for (size_t n = 0; n < count; n++) {
        take_off(grid, count, constant, basis + n);
        if (grid->is_level)
            take_off(grid, count, line, basis + n);
    }
    return STATUS_OK;
}

/// (k_B T σ/p)², of what was not seen that of what is hardly seen.
static void find_variances(const struct bonded_grid *grid, const double *target_error,
                           double *variance) {
    static const double min = 1e-12;
    double peak = 0;
    for (size_t k = 0; k < grid->known; k++)
        peak = fmax(peak, grid->target[grid->first + k]);
    for (size_t k = 0; k < grid->known; k++) {
        const double p = fmax(grid->target[grid->first + k], mf_bonded_distribution_seen * peak);
        const double error = target_error[grid->first + k];
        variance[k] = fmax(min, pow(grid->temperature * (isfinite(error) ? error : 0) / p, 2));
    }
}

enum status mf_parametrisation_bonded_rough(const struct bonded_grid *grid,
                                            const double *target_error, const double *basis,
                                            double *error) {
    static const double ridge = 1e-12;
    const size_t own = (size_t)grid->unknown->shape.coefficients, count = own + 1;
    OWNED double *normal = NULL, *row = NULL, *solved = NULL, *variance = NULL;
    TRY_ARRAY(normal, count * count);
    TRY_ARRAY(row, count);
    TRY_ARRAY(solved, count);
    TRY_ARRAY(variance, grid->known);
    find_variances(grid, target_error, variance);
    gsl_matrix_view factor = gsl_matrix_view_array(normal, count, count);
    const gsl_vector_const_view right = gsl_vector_const_view_array(row, count);
    gsl_vector_view left = gsl_vector_view_array(solved, count);
    for (int pass = 0; pass < 2; pass++) {
        for (size_t k = 0; k < grid->known; k++) {
            for (size_t a = 0; a < count; a++)
                row[a] = a < own ? basis[k * own + a] : 1;
            for (size_t a = 0; a < count && pass == 0; a++)
                for (size_t b = 0; b < count; b++)
                    normal[a * count + b] +=
                        row[a] * row[b] / variance[k] * (a == b ? 1 + ridge : 1);
            if (pass == 0)
                continue;
            gsl_linalg_cholesky_solve(&factor.matrix, &right.vector, &left.vector);
            double fitted = 0;
            for (size_t a = 0; a < count; a++)
                fitted += row[a] * solved[a];
            error[k] = sqrt(fmax(0, variance[k] - fitted));
        }
        if (pass == 0)
            gsl_linalg_cholesky_decomp1(&factor.matrix);
    }
    return STATUS_OK;
}
