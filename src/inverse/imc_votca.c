// SPDX-License-Identifier: GPL-3.0-or-later
#include "inverse/imc_solve.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>
#include <math.h>

/// Eigenvalues of AᵀA + λ below this count as 0.
static const double least_eigenvalue = 1e-12;

/// By the singular values s of A: AᵀA + λ = V (s² + λ) Vᵀ. Its own eigenvalues are s² with the
/// square of A's condition: VOTCA's example came out with half the digits.
struct workspace {
    gsl_matrix *u;       ///< A = −C = U s Vᵀ, shape [size, size]
    gsl_matrix *v;       ///< columns divided by (s² + λ)/s
    gsl_matrix *inverse; ///< −(AᵀA + λ)⁻¹ Aᵀ
    gsl_vector *values, *work;
};

static void workspace_free(struct workspace *w) {
    gsl_matrix_free(w->u);
    gsl_matrix_free(w->v);
    gsl_matrix_free(w->inverse);
    gsl_vector_free(w->values);
    gsl_vector_free(w->work);
}

static enum status workspace_allocate(struct workspace *w, size_t n) {
    w->u = gsl_matrix_alloc(n, n);
    w->v = gsl_matrix_alloc(n, n);
    w->inverse = gsl_matrix_alloc(n, n);
    w->values = gsl_vector_alloc(n);
    w->work = gsl_vector_alloc(n);
    if (w->u && w->v && w->inverse && w->values && w->work)
        return STATUS_OK;
    return status_fail(STATUS_NO_MEMORY, "no memory for %zu linear equations", n);
}

static void invert(struct workspace *w, const struct imc_system *s, double strength) {
    for (size_t a = 0; a < s->size; a++)
        for (size_t b = 0; b < s->size; b++)
            gsl_matrix_set(w->u, a, b, -s->covariance[a * s->size + b]);
    gsl_linalg_SV_decomp(w->u, w->v, w->values, w->work);
    for (size_t k = 0; k < s->size; k++) {
        const double singular = gsl_vector_get(w->values, k);
        const double value = singular * singular + strength;
        gsl_vector_view column = gsl_matrix_column(w->v, k);
        gsl_vector_scale(&column.vector, value < least_eigenvalue ? 0 : singular / value);
    }
    gsl_blas_dgemm(CblasNoTrans, CblasTrans, -1, w->v, w->u, 0, w->inverse);
}

/// χ² by bin of what x leaves.
static double misfit(const struct imc_system *s, const double *x) {
    double sum = 0;
    for (size_t a = 0; a < s->size; a++) {
        double left = s->excess[a];
        for (size_t b = 0; b < s->size; b++)
            left -= s->covariance[a * s->size + b] * x[b] / s->temperature;
        sum += left * left / s->variance[a];
    }
    return sum / (double)s->size;
}

enum status imc_votca(const struct imc_system *system, double strength, double *x, double *x_error,
                      struct imc_solution *solution) {
    enum status status = STATUS_OK;
    struct workspace w = {0};
    CHECK(workspace_allocate(&w, system->size));
    invert(&w, system, strength);
    for (size_t k = 0; k < system->size; k++) {
        double sum = 0, squares = 0;
        for (size_t a = 0; a < system->size; a++) {
            const double slope = system->temperature * gsl_matrix_get(w.inverse, k, a);
            sum += slope * system->excess[a];
            squares += slope * slope * system->variance[a];
        }
        x[k] = sum;
        if (x_error)
            x_error[k] = sqrt(squares);
    }
    *solution = (struct imc_solution){.strength = strength, .misfit = misfit(system, x)};
done:
    workspace_free(&w);
    return status;
}
