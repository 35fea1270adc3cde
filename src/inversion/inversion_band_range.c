// SPDX-License-Identifier: GPL-3.0-or-later
//
// The error that the range of a potential of pairs adds to its band.
#include "inversion/inversion.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

/// A shorter range, in that of the fit.
static const double shorter = 0.8;

/// Which bins of pairs lie beyond the shorter range.
static void mark_outer(const struct potential_grid *grid, const struct rdf_bins *bins,
                       bool *outer) {
    const double range = bins->low + (double)bins->count * bins->width;
    for (size_t a = 0; a < grid->known; a++)
        outer[a] = a < grid->pairs_known && grid->r[grid->known_point[a]] > shorter * range;
}

/// Where Φ of the outer bins becomes 0, the step of the others that the equations then ask for;
/// false if rounding leaves none.
/// @param[in,out] normal  with its lower triangle; its factor
/// @param[in,out] x       what the equations ask for; the step of all
static bool solve_with_zeros(const struct inversion *inversion, const bool *outer,
                             gsl_matrix *normal, gsl_vector *x) {
    const size_t n = x->size, *point = inversion_grid(inversion)->known_point;
    const double *phi = inversion->course.phi;
    for (size_t a = 0; a < n; a++)
        for (size_t b = 0; b < a; b++) {
            const double both = gsl_matrix_get(normal, a, b);
            if (outer[b] && !outer[a])
                *gsl_vector_ptr(x, a) += both * phi[point[b]];
            if (outer[a] && !outer[b])
                *gsl_vector_ptr(x, b) += both * phi[point[a]];
            if (outer[a] || outer[b])
                gsl_matrix_set(normal, a, b, 0);
        }
    for (size_t a = 0; a < n; a++)
        if (outer[a]) {
            gsl_matrix_set(normal, a, a, 1);
            gsl_vector_set(x, a, -phi[point[a]]);
        }
    if (gsl_linalg_cholesky_decomp1(normal) != GSL_SUCCESS)
        return false;
    gsl_linalg_cholesky_svx(normal, x);
    return true;
}

/// Add the change of Φ to Σ: the share of it that is more than the error of A, in Σ already, makes.
/// What of it is not the move of Φ along A, as the data have it, is left if A is known.
/// @param[in,out] change  what is left
static enum status add_change(struct inversion *inversion, const double *weight,
                              gsl_vector *change) {
    struct inversion_band *band = &inversion->course.band;
    const size_t n = change->size;
    const gsl_matrix_const_view covariance = gsl_matrix_const_view_array(band->covariance, n, n);
    const gsl_vector_const_view w = gsl_vector_const_view_array(weight, n);
    double variance, along;
    gsl_vector *with = gsl_vector_alloc(n);
    if (with == NULL)
        return STATUS_NO_MEMORY;
    gsl_blas_dgemv(CblasNoTrans, 1, &covariance.matrix, &w.vector, 0, with);
    gsl_blas_ddot(&w.vector, with, &variance);
    gsl_blas_ddot(&w.vector, change, &along);
    if (along * along > variance) {
        const double share = 1 - variance / (along * along);
        mf_inversion_band_add_square(inversion, share, change->data);
        gsl_blas_daxpy(-along / variance, with, change);
        for (size_t a = 0; a < n; a++)
            band->beside_ramp[a] = share * pow(gsl_vector_get(change, a), 2);
    }
    gsl_vector_free(with);
    return STATUS_OK;
}

enum status mf_inversion_band_add_range(struct inversion *inversion,
                                        const struct imc_system *system, double birge,
                                        const double *step, const double *weight) {
    enum status status = STATUS_OK;
    const struct potential_grid *grid = inversion_grid(inversion);
    gsl_matrix *normal = gsl_matrix_alloc(grid->known, grid->known);
    gsl_vector *change = gsl_vector_alloc(grid->known);
    bool *outer = NULL;
    memset(inversion->course.band.beside_ramp, 0, grid->known * sizeof(double));
    if (grid->pairs == 0 || inversion->state->basis.count > 0)
        goto done;
    CHECK(normal && change ? STATUS_OK : STATUS_NO_MEMORY);
    NEW_ARRAY(outer, grid->known);
    mark_outer(grid, &inversion->problem->targets.bins, outer);
    CHECK(mf_inversion_equations_without(&inversion->equations, birge, outer, normal, change));
    CHECK(mf_inversion_band_add_prior(inversion, *system, normal, change));
    if (!solve_with_zeros(inversion, outer, normal, change))
        goto done;
    for (size_t a = 0; a < grid->known; a++)
        *gsl_vector_ptr(change, a) -= step[a];
    CHECK(add_change(inversion, weight, change));
    CHECK(mf_inversion_band_take_conventions_off(inversion, inversion->course.band.covariance));
done:
    gsl_matrix_free(normal);
    gsl_vector_free(change);
    mf_memory_free(outer);
    return status;
}
