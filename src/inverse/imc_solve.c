// SPDX-License-Identifier: GPL-3.0-or-later
#include "inverse/imc_solve.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>
#include <math.h>

/// Distance over which the potential may bend freely [λ]: features of liquids are wider.
static const double smooth_length = 0.1;

/// Weight of |x|² beside the curvature: settles directions that are smooth and unseen.
static const double ridge = 0.01;

/// Share of χ² that is left to the noise where some of the excess cannot be removed at all.
static const double noise_share = 0.5;

/// Work space of one solve. Least squares by QR of the rows of the equations, over those of the
/// prior: the normal equations square the condition, and for a singular C gave standard errors of
/// 0.
struct workspace {
    size_t size;
    gsl_matrix *rows;    ///< B = W^½ C / k_B T, then D and sqrt(ρ): shape [3 size − 1, size]
    gsl_vector *rhs;     ///< b = W^½ excess, then zeros
    gsl_matrix *factor;  ///< QR of `rows` at one strength
    gsl_vector *reflect; ///< of the Householder vectors
    gsl_vector *x, *residual;
};

static void workspace_free(struct workspace *w) {
    gsl_matrix_free(w->rows);
    gsl_matrix_free(w->factor);
    gsl_vector_free(w->rhs);
    gsl_vector_free(w->reflect);
    gsl_vector_free(w->x);
    gsl_vector_free(w->residual);
}

static enum status workspace_allocate(struct workspace *w, size_t n) {
    w->size = n;
    w->rows = gsl_matrix_calloc(3 * n - 1, n);
    w->factor = gsl_matrix_alloc(3 * n - 1, n);
    w->rhs = gsl_vector_calloc(3 * n - 1);
    w->reflect = gsl_vector_alloc(n);
    w->x = gsl_vector_alloc(n);
    w->residual = gsl_vector_alloc(3 * n - 1);
    if (w->rows && w->factor && w->rhs && w->reflect && w->x && w->residual)
        return STATUS_OK;
    return status_fail(STATUS_NO_MEMORY, "no memory for %zu linear equations", n);
}

static void fill_equations(struct workspace *w, const struct imc_system *s) {
    for (size_t a = 0; a < s->size; a++) {
        const double weight = 1 / sqrt(s->variance[a]);
        gsl_vector_set(w->rhs, a, weight * s->excess[a]);
        for (size_t b = 0; b < s->size; b++)
            gsl_matrix_set(w->rows, a, b, weight * s->covariance[a * s->size + b] / s->temperature);
    }
}

/// Row k of D is (x_{k−1} − 2 x_k + x_{k+1}) (ℓ/h)², with x = 0 past the end.
static void fill_prior(struct workspace *w, const struct imc_system *s) {
    const size_t n = s->size;
    const double scale = pow(smooth_length / s->spacing, 2);
    for (size_t k = 1; k < n; k++) {
        gsl_matrix_set(w->rows, n + k - 1, k - 1, scale);
        gsl_matrix_set(w->rows, n + k - 1, k, -2 * scale);
        if (k + 1 < n)
            gsl_matrix_set(w->rows, n + k - 1, k + 1, scale);
    }
    for (size_t k = 0; k < n; k++)
        gsl_matrix_set(w->rows, 2 * n - 1 + k, k, sqrt(ridge));
}

/// Sum of squares of the rows begin … end − 1.
static double square_rows(const gsl_matrix *rows, size_t begin, size_t end) {
    double sum = 0;
    for (size_t a = begin; a < end; a++)
        for (size_t b = 0; b < rows->size2; b++)
            sum += gsl_matrix_get(rows, a, b) * gsl_matrix_get(rows, a, b);
    return sum;
}

/// Solve for x at one strength; returns χ² / size of what is left.
static double solve_at(struct workspace *w, double strength) {
    const size_t n = w->size;
    gsl_matrix_memcpy(w->factor, w->rows);
    gsl_matrix_view prior = gsl_matrix_submatrix(w->factor, n, 0, 2 * n - 1, n);
    gsl_matrix_scale(&prior.matrix, sqrt(strength));
    gsl_linalg_QR_decomp(w->factor, w->reflect);
    gsl_linalg_QR_lssolve(w->factor, w->reflect, w->rhs, w->x, w->residual);
    gsl_vector_view left = gsl_vector_subvector(w->residual, 0, n);
    const double norm = gsl_blas_dnrm2(&left.vector);
    return norm * norm / (double)n;
}

/// Largest strength whose misfit is within the noise, by bisection of its logarithm. What not even
/// the weakest strength removes counts as no more than noise is left of: to follow it down would
/// make the potential large in directions that do not matter.
static double find_strength(struct workspace *w) {
    const size_t n = w->size;
    const double unit = square_rows(w->rows, 0, n) / square_rows(w->rows, n, 3 * n - 1);
    double low = -12, high = 6;
    const double wanted = fmax(1, solve_at(w, unit * pow(10, low)) + noise_share);
    for (int k = 0; k < 40; k++) {
        const double middle = 0.5 * (low + high);
        if (solve_at(w, unit * pow(10, middle)) > wanted)
            high = middle;
        else
            low = middle;
    }
    return unit * pow(10, low);
}

/// Standard errors: x is linear in b, whose elements are independent with variance 1.
static void find_errors(struct workspace *w, double *x_error) {
    for (size_t k = 0; k < w->size; k++)
        x_error[k] = 0;
    for (size_t a = 0; a < w->size; a++) {
        gsl_vector_set_basis(w->rhs, a);
        gsl_linalg_QR_lssolve(w->factor, w->reflect, w->rhs, w->x, w->residual);
        for (size_t k = 0; k < w->size; k++)
            x_error[k] += gsl_vector_get(w->x, k) * gsl_vector_get(w->x, k);
    }
    for (size_t k = 0; k < w->size; k++)
        x_error[k] = sqrt(x_error[k]);
}

enum status imc_solve(const struct imc_system *system, double strength, double *x, double *x_error,
                      struct imc_solution *solution) {
    enum status status = STATUS_OK;
    struct workspace w = {0};
    CHECK(workspace_allocate(&w, system->size));
    fill_equations(&w, system);
    fill_prior(&w, system);
    solution->strength = strength > 0 ? strength : find_strength(&w);
    solution->misfit = solve_at(&w, solution->strength);
    for (size_t k = 0; k < system->size; k++)
        x[k] = gsl_vector_get(w.x, k);
    if (x_error)
        find_errors(&w, x_error);
done:
    workspace_free(&w);
    return status;
}
