// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_noise.h"

#include "inversion/inversion_equations.h"
#include "inversion/inversion_state.h"
#include "problem/group_kind.h"

#include "inversion/products.h"
#include "inversion/triangular.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

/// The target of a block of the grid.
static const struct target *target_of(const struct inversion_state *state, size_t block) {
    const struct potential_grid *grid = &state->grid;
    const int kind =
        block < grid->pairs
            ? TARGET_RDF
            : mf_group_kind_target(grid->group[block - grid->pairs].own.unknown->order);
    return &state->problem->targets.target[kind];
}

/// The variances that have the correlations of C: those of the samples, and of the target if its
/// errors are of samples.
static void fill_variances(const struct inversion_state *state, enum inversion_noise_kind kind,
                           double *v) {
    const struct potential_grid *grid = &state->grid;
    for (size_t block = 0, a = 0; block < grid->blocks; block++) {
        const bool own = kind == INVERSION_NOISE_OF_BINS ||
                         target_of(state, block)->errors_of == TARGET_ERRORS_OF_BINS;
        for (const size_t end = a + grid->known_of[block]; a < end; a++)
            v[a * grid->known + a] =
                fmax(0, state->variance[a] - (own ? mf_inversion_target_variance(state, a) : 0));
    }
}

/// What has the correlations of C.
static void fill_samples(const struct inversion_state *state, enum inversion_noise_kind kind,
                         double *v) {
    const size_t known = state->grid.known;
    const bool *seen = state->grid.seen;
    const double *c = state->response.covariance;
    const double independent = state->response.independent;
    const double counts = independent / (independent + (double)state->response.functions);
    fill_variances(state, kind, v);
    for (size_t a = 0; a < known; a++)
        for (size_t b = 0; b < a; b++) {
            const double own = c[a * known + a] * c[b * known + b];
            v[a * known + b] =
                own > 0 && seen[a] && seen[b]
                    ? counts * c[a * known + b] * sqrt(v[a * known + a] * v[b * known + b] / own)
                    : 0;
        }
}

/// What is each bin's own beside it.
static void add_own(const struct inversion_state *state, const double *more, double *v) {
    const size_t known = state->grid.known;
    for (size_t a = 0; a < known; a++)
        v[a * known + a] = state->variance[a] + (more ? more[a] : 0);
}

/// u uᵀ of each pair type, u the error of its factor.
static void add_common(const struct inversion_state *state, double *v) {
    const struct potential_grid *grid = &state->grid;
    const double *u = state->target.common;
    for (size_t block = 0, first = 0; u && block < grid->blocks; first += grid->known_of[block++])
        for (size_t a = first; a < first + grid->known_of[block]; a++)
            for (size_t b = first; b <= a; b++)
                if (grid->seen[a] && grid->seen[b])
                    v[a * grid->known + b] += u[a] * u[b];
}

/// Where rounding has left V without a factor: that of its diagonal.
static void take_diagonal(const struct inversion_state *state, const double *more, double *factor) {
    const size_t known = state->grid.known;
    memset(factor, 0, known * known * sizeof *factor);
    add_own(state, more, factor);
    for (size_t a = 0; a < known; a++)
        factor[a * known + a] = sqrt(factor[a * known + a]);
}

void mf_inversion_noise_find(const struct inversion_state *state, enum inversion_noise_kind kind,
                             const double *more, double *factor) {
    const size_t known = state->grid.known;
    gsl_matrix_view v = gsl_matrix_view_array(factor, known, known);
    fill_samples(state, kind, factor);
    add_own(state, more, factor);
    add_common(state, factor);
    if (gsl_linalg_cholesky_decomp1(&v.matrix) != GSL_SUCCESS)
        take_diagonal(state, more, factor);
    for (size_t a = 0; a < known; a++)
        memset(factor + a * known + a + 1, 0, (known - a - 1) * sizeof *factor);
}

enum inversion_noise_kind mf_inversion_noise_of_band(const struct inversion_state *state,
                                                     enum inversion_noise_kind chosen) {
    for (size_t block = 0; block < state->grid.blocks; block++)
        if (target_of(state, block)->errors_of != TARGET_ERRORS_OF_SAMPLES)
            return INVERSION_NOISE_OF_BINS;
    return chosen;
}

/// C P⁻¹ C: what the prior of steps allows of the excess; k_B T cancels.
static enum status fill_allowed(const struct inversion_state *state, gsl_matrix *allowed) {
    enum status status = STATUS_OK;
    const size_t known = state->grid.known;
    const struct imc_system system = mf_inversion_equations_of(state);
    const gsl_matrix_const_view response =
        gsl_matrix_const_view_array(system.covariance, known, known);
    gsl_matrix *rows = gsl_matrix_alloc(2 * known - 1, known);
    gsl_matrix *half = gsl_matrix_alloc(known, known), *prior = gsl_matrix_alloc(known, known);
    CHECK(rows && half && prior ? STATUS_OK : STATUS_NO_MEMORY);
    mf_imc_solve_prior(&system, rows);
    CHECK(mf_products_gram(1, rows, 0, prior));
    gsl_linalg_cholesky_decomp1(prior);
    gsl_matrix_transpose_memcpy(half, &response.matrix);
    CHECK(mf_triangular_left(prior, half));
    CHECK(mf_products_gram(1, half, 0, allowed));
done:
    gsl_matrix_free(rows);
    gsl_matrix_free(half);
    gsl_matrix_free(prior);
    return status;
}

/// −2 ln of the likelihood of the excess, but for a constant; infinite where rounding leaves no
/// factor.
static enum status measure(const struct inversion_state *state, const gsl_matrix *allowed,
                           enum inversion_noise_kind kind, double *unlikely) {
    enum status status = STATUS_OK;
    const size_t known = state->grid.known;
    gsl_matrix *noise = gsl_matrix_alloc(known, known), *all = gsl_matrix_alloc(known, known);
    gsl_vector *excess = gsl_vector_alloc(known);
    CHECK(noise && all && excess ? STATUS_OK : STATUS_NO_MEMORY);
    mf_inversion_noise_find(state, kind, NULL, noise->data);
    gsl_matrix_memcpy(all, allowed);
    gsl_blas_dsyrk(CblasLower, CblasNoTrans, 1, noise, 1, all);
    *unlikely = INFINITY;
    if (gsl_linalg_cholesky_decomp1(all) != GSL_SUCCESS)
        goto done;
    for (size_t a = 0; a < known; a++)
        gsl_vector_set(excess, a, state->grid.seen[a] ? state->excess[a] : 0);
    gsl_blas_dtrsv(CblasLower, CblasNoTrans, CblasNonUnit, all, excess);
    *unlikely = pow(gsl_blas_dnrm2(excess), 2);
    for (size_t a = 0; a < known; a++)
        *unlikely += 2 * log(gsl_matrix_get(all, a, a));
done:
    gsl_matrix_free(noise);
    gsl_matrix_free(all);
    gsl_vector_free(excess);
    return status;
}

enum status mf_inversion_noise_choose(const struct inversion_state *state,
                                      enum inversion_noise_kind *kind) {
    enum status status = STATUS_OK;
    double samples, bins;
    gsl_matrix *allowed = gsl_matrix_alloc(state->grid.known, state->grid.known);
    CHECK(allowed ? STATUS_OK : STATUS_NO_MEMORY);
    CHECK(fill_allowed(state, allowed));
    CHECK(measure(state, allowed, INVERSION_NOISE_OF_SAMPLES, &samples));
    CHECK(measure(state, allowed, INVERSION_NOISE_OF_BINS, &bins));
    *kind = samples <= bins ? INVERSION_NOISE_OF_SAMPLES : INVERSION_NOISE_OF_BINS;
done:
    gsl_matrix_free(allowed);
    return status;
}
