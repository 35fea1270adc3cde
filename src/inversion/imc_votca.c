// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"
#include "inversion/imc_solve.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>
#include <stdbool.h>

/// Eigenvalues of AᵀA + λ below this count as 0.
static const double least_eigenvalue = 1e-12;

/// By the singular values s of A: AᵀA + λ = V (s² + λ) Vᵀ. Its own eigenvalues are s² with the
/// square of A's condition: VOTCA's example came out with half the digits.
struct workspace {
    gsl_matrix *u;       ///< A = −C = U s Vᵀ, shape [size, size]
    gsl_matrix *v;       ///< columns divided by (s² + λ)/s
    gsl_matrix *inverse; ///< −(AᵀA + λ)⁻¹ Aᵀ
    gsl_vector *values, *work;
    gsl_vector *share; ///< s²/(s² + λ), 0 where left out
};

static void workspace_free(struct workspace *w) {
    gsl_matrix_free(w->u);
    gsl_matrix_free(w->v);
    gsl_matrix_free(w->inverse);
    gsl_vector_free(w->values);
    gsl_vector_free(w->work);
    gsl_vector_free(w->share);
}

static enum status workspace_allocate(struct workspace *w, size_t n) {
    w->u = gsl_matrix_alloc(n, n);
    w->v = gsl_matrix_alloc(n, n);
    w->inverse = gsl_matrix_alloc(n, n);
    w->values = gsl_vector_alloc(n);
    w->work = gsl_vector_alloc(n);
    w->share = gsl_vector_alloc(n);
    if (w->u && w->v && w->inverse && w->values && w->work && w->share)
        return STATUS_OK;
    return mf_status_fail(STATUS_NO_MEMORY, "no memory for %zu linear equations", n);
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
        const bool left_out = value < least_eigenvalue;
        gsl_vector_scale(&column.vector, left_out ? 0 : singular / value);
        gsl_vector_set(w->share, k, left_out ? 0 : singular * singular / value);
    }
    gsl_blas_dgemm(CblasNoTrans, CblasTrans, -1, w->v, w->u, 0, w->inverse);
}

/// u = (AᵀA + λ)⁻¹ p, from the columns of v, which are v_k s/(s² + λ) by now.
static enum status meet(const struct workspace *w, const struct imc_system *system, double *x) {
    enum status status = STATUS_OK;
    const size_t n = system->size;
    double *u = NULL;
    NEW_ARRAY(u, n);
    for (size_t k = 0; k < n; k++) {
        const double share = gsl_vector_get(w->share, k);
        double product = 0;
        for (size_t a = 0; share > 0 && a < n; a++)
            product += gsl_matrix_get(w->v, a, k) * system->constraint[a];
        for (size_t a = 0; share > 0 && a < n; a++)
            u[a] += gsl_matrix_get(w->v, a, k) * product / share;
    }
    mf_imc_solve_meet(system, u, x);
done:
    mf_memory_free(u);
    return status;
}

enum status mf_imc_votca(const struct imc_system *system, double strength, double *x,
                         struct imc_solution *solution) {
    enum status status = STATUS_OK;
    struct workspace w = {0};
    CHECK(workspace_allocate(&w, system->size));
    invert(&w, system, strength);
    *solution = (struct imc_solution){.strength = strength};
    for (size_t k = 0; k < system->size; k++) {
        x[k] = 0;
        for (size_t a = 0; a < system->size; a++)
            x[k] += system->temperature * gsl_matrix_get(w.inverse, k, a) * system->excess[a];
        solution->directions += gsl_vector_get(w.share, k);
    }
    for (size_t k = 0; system->singular && k < system->size; k++) {
        system->singular[k] = gsl_vector_get(w.values, k);
        system->used[k] = gsl_vector_get(w.share, k);
    }
    if (system->constraint)
        CHECK(meet(&w, system, x));
    solution->misfit = mf_imc_solve_misfit(system, x);
done:
    workspace_free(&w);
    return status;
}
