// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/ornstein_zernike.h"

#include "base/memory.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

/// The transform back is periodic in r with twice so many ranges.
static const double ranges = 6;

/// The solution is good enough when h is met within this, rms over the cells.
static const double tolerance = 1e-6;

enum { MAX_STEPS = 40, MAX_HALVINGS = 12 };

double mf_ornstein_zernike_ball(double q, double edge) {
    const double x = q * edge;
    if (x < 1e-2) // the difference cancels; the series is exact to 1e-13 there
        return 4 * M_PI / 3 * edge * edge * edge * (1 - x * x / 10 + x * x * x * x / 280);
    return 4 * M_PI * (sin(x) - x * cos(x)) / (q * q * q);
}

enum status mf_ornstein_zernike_init(struct ornstein_zernike *oz, const double *edge, size_t cells,
                                     double density) {
    enum status status = STATUS_OK;
    const double range = edge[cells], spacing = M_PI / (ranges * range);
    *oz = (struct ornstein_zernike){
        .cells = cells, .waves = (size_t)(ranges * (double)cells), .density = density};
    NEW_ARRAY(oz->edge, cells + 1);
    NEW_ARRAY(oz->volume, cells);
    NEW_ARRAY(oz->transform, oz->waves * cells);
    NEW_ARRAY(oz->weight, oz->waves);
    NEW_ARRAY(oz->c, cells);
    memcpy(oz->edge, edge, (cells + 1) * sizeof *edge);
    for (size_t k = 0; k < cells; k++)
        oz->volume[k] = 4 * M_PI / 3 * (pow(edge[k + 1], 3) - pow(edge[k], 3));
    for (size_t n = 0; n < oz->waves; n++) {
        const double q = (double)(n + 1) * spacing;
        oz->weight[n] = q * q * spacing / (2 * M_PI * M_PI);
        for (size_t k = 0; k < cells; k++)
            oz->transform[n * cells + k] =
                mf_ornstein_zernike_ball(q, edge[k + 1]) - mf_ornstein_zernike_ball(q, edge[k]);
    }
done:
    return status;
}

void mf_ornstein_zernike_clear(struct ornstein_zernike *oz) {
    mf_memory_free(oz->edge);
    mf_memory_free(oz->volume);
    mf_memory_free(oz->transform);
    mf_memory_free(oz->weight);
    mf_memory_free(oz->c);
    *oz = (struct ornstein_zernike){0};
}

/// ĉ at a wave.
static double transform_at(const struct ornstein_zernike *oz, const double *c, size_t wave) {
    double sum = 0;
    for (size_t k = 0; k < oz->cells; k++)
        sum += oz->transform[wave * oz->cells + k] * c[k];
    return sum;
}

/// What is left of the equations, times the cells' volumes: volume (h − c) less the integral of the
/// indirect correlations, whose transform is ρĉ²/(1 − ρĉ). Infinite where some structure factor
/// 1/(1 − ρĉ) is not positive. Returns the rms of the error of h; `squares` are S² − 1, or NULL.
static double find_rest(const struct ornstein_zernike *oz, const double *h, const double *c,
                        double *rest, double *squares) {
    double sum = 0, volume = 0;
    for (size_t k = 0; k < oz->cells; k++)
        rest[k] = oz->volume[k] * (h[k] - c[k]);
    for (size_t n = 0; n < oz->waves; n++) {
        const double transform = transform_at(oz, c, n), inverse = 1 - oz->density * transform;
        if (!(inverse > 0))
            return INFINITY;
        const double indirect = oz->density * transform * transform / inverse;
        for (size_t k = 0; k < oz->cells; k++)
            rest[k] -= oz->weight[n] * oz->transform[n * oz->cells + k] * indirect;
        if (squares)
            squares[n] = 1 / (inverse * inverse) - 1;
    }
    for (size_t k = 0; k < oz->cells; k++) {
        sum += rest[k] * rest[k] / oz->volume[k];
        volume += oz->volume[k];
    }
    return sqrt(sum / volume);
}

/// The Newton step: (volume + Fᵀ w (S² − 1) F) step = rest.
static bool find_step(const struct ornstein_zernike *oz, const double *squares, const double *rest,
                      double *scaled, double *jacobian, double *step) {
    const size_t cells = oz->cells, waves = oz->waves;
    memset(jacobian, 0, cells * cells * sizeof *jacobian);
    for (size_t n = 0; n < waves; n++)
        for (size_t k = 0; k < cells; k++)
            scaled[n * cells + k] = oz->weight[n] * squares[n] * oz->transform[n * cells + k];
    gsl_matrix_const_view f = gsl_matrix_const_view_array(oz->transform, waves, cells);
    gsl_matrix_const_view wf = gsl_matrix_const_view_array(scaled, waves, cells);
    gsl_matrix_view j = gsl_matrix_view_array(jacobian, cells, cells);
    gsl_blas_dgemm(CblasTrans, CblasNoTrans, 1, &f.matrix, &wf.matrix, 0, &j.matrix);
    for (size_t k = 0; k < cells; k++)
        jacobian[k * cells + k] += oz->volume[k];
    memcpy(step, rest, cells * sizeof *step);
    gsl_vector_view x = gsl_vector_view_array(step, cells);
    return gsl_linalg_cholesky_decomp1(&j.matrix) == GSL_SUCCESS &&
           gsl_linalg_cholesky_svx(&j.matrix, &x.vector) == GSL_SUCCESS;
}

/// Where c makes some structure factor negative, smaller c do not.
static void shrink(struct ornstein_zernike *oz, const double *h, double *rest) {
    while (isinf(find_rest(oz, h, oz->c, rest, NULL)))
        for (size_t k = 0; k < oz->cells; k++)
            oz->c[k] *= 0.8;
}

enum status mf_ornstein_zernike_solve(struct ornstein_zernike *oz, const double *h,
                                      double *compressibility) {
    enum status status = STATUS_OK;
    const size_t cells = oz->cells;
    double *rest = NULL, *squares = NULL, *scaled = NULL, *jacobian = NULL, *step = NULL;
    double *next = NULL;
    NEW_ARRAY(rest, cells);
    NEW_ARRAY(step, cells);
    NEW_ARRAY(next, cells);
    NEW_ARRAY(squares, oz->waves);
    NEW_ARRAY(scaled, oz->waves * cells);
    NEW_ARRAY(jacobian, cells * cells);
    *compressibility = NAN;
    shrink(oz, h, rest);
    double error = find_rest(oz, h, oz->c, rest, squares);
    for (int n = 0; n < MAX_STEPS && error > tolerance; n++) {
        if (!find_step(oz, squares, rest, scaled, jacobian, step))
            goto done;
        double share = 1, here = INFINITY;
        for (int half = 0; half < MAX_HALVINGS && !(here < error); half++, share *= 0.5) {
            for (size_t k = 0; k < cells; k++)
                next[k] = oz->c[k] + share * step[k];
            here = find_rest(oz, h, next, rest, squares);
        }
        if (!(here < error))
            goto done;
        memcpy(oz->c, next, cells * sizeof *next);
        error = here;
    }
    if (error <= tolerance) {
        double sum = 0;
        for (size_t k = 0; k < cells; k++)
            sum += oz->volume[k] * oz->c[k];
        *compressibility = 1 / (1 - oz->density * sum);
    }
done:
    mf_memory_free(rest);
    mf_memory_free(step);
    mf_memory_free(next);
    mf_memory_free(squares);
    mf_memory_free(scaled);
    mf_memory_free(jacobian);
    return status;
}
