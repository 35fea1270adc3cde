// SPDX-License-Identifier: GPL-3.0-or-later
//
// What of a potential is a convention, and has no error.
#include "inversion/inversion.h"

#include <string.h>

void mf_inversion_band_take_off(double *covariance, size_t n, const double *v, const double *l) {
    for (int side = 0; side < 2; side++)
        for (size_t b = 0; b < n; b++) {
            const size_t along = side ? n : 1, across = side ? 1 : n;
            double part = 0;
            for (size_t a = 0; a < n; a++)
                part += l[a] * covariance[a * across + b * along];
            for (size_t a = 0; a < n; a++)
                covariance[a * across + b * along] -= part * v[a];
        }
}

void mf_inversion_band_take_off_curve(double *x, size_t n, const double *v, const double *l) {
    double part = 0;
    for (size_t a = 0; a < n; a++)
        part += l[a] * x[a];
    for (size_t a = 0; a < n; a++)
        x[a] -= part * v[a];
}

/// One of them, off both.
static void take_one_off(double *covariance, double *x, size_t n, const double *v,
                         const double *l) {
    if (covariance)
        mf_inversion_band_take_off(covariance, n, v, l);
    if (x)
        mf_inversion_band_take_off_curve(x, n, v, l);
}

enum status mf_inversion_band_take_conventions_off(const struct inversion *inversion,
                                                   double *covariance, double *x) {
    const struct potential_grid *grid = inversion_grid(inversion);
    OWNED double *constant = NULL, *mean = NULL;
    size_t first = grid->pairs_known;
    TRY_ARRAY(constant, grid->known);
    TRY_ARRAY(mean, grid->known);
    for (size_t g = 0; g < grid->groups; first += grid->group[g++].own.known) {
        const struct bonded_grid *own = &grid->group[g].own;
        const double sum = mf_bonded_grid_mean(own) * (double)own->known;
        memset(constant, 0, grid->known * sizeof *constant);
        memset(mean, 0, grid->known * sizeof *mean);
        for (size_t a = 0; a < own->known; a++) {
            constant[first + a] = 1;
            mean[first + a] = own->target[own->first + a] / sum;
        }
        take_one_off(covariance, x, grid->known, constant, mean);
    }
    if (grid->shared.change)
        take_one_off(covariance, x, grid->known, grid->shared.change, grid->shared.weight);
    return STATUS_OK;
}
