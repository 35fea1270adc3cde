// SPDX-License-Identifier: GPL-3.0-or-later
#include "surrogate_rows.h"

#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Ridge of the least squares for J in units of the rows' spread, so that a direction in which they
/// do not differ has no slope.
static const double ridge = 1e-3;

static int by_distance(const void *a, const void *b) {
    const struct surrogate_near *p = a, *q = b;
    if (p->distance != q->distance)
        return p->distance < q->distance ? -1 : 1;
    return p->row < q->row ? -1 : 1;
}

void mf_surrogate_clear_rows(struct surrogate_work *work) {
    void *arrays[] = {work->near,     work->weight,  work->design, work->normal, work->model,
                      work->residual, work->scatter, work->spread, work->term,   work->hessian,
                      work->miss,     work->scale,   work->delta};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++)
        mf_memory_free(arrays[k]);
}

static enum status work_init(struct surrogate_work *work, const struct surrogate *surrogate,
                             size_t kept, size_t rows) {
    const size_t terms = surrogate->variables + 1;
    *work = (struct surrogate_work){.surrogate = surrogate, .rows = rows, .terms = terms};
    TRY_ARRAY(work->near, kept);
    TRY_ARRAY(work->weight, rows);
    TRY_ARRAY(work->design, rows * terms);
    TRY_ARRAY(work->normal, terms * terms);
    TRY_ARRAY(work->model, surrogate->features * terms);
    TRY_ARRAY(work->residual, rows * surrogate->features);
    TRY_ARRAY(work->scatter, surrogate->features);
    TRY_ARRAY(work->spread, terms * terms);
    TRY_ARRAY(work->term, terms);
    TRY_ARRAY(work->hessian, surrogate->variables * surrogate->variables);
    TRY_ARRAY(work->miss, surrogate->features);
    TRY_ARRAY(work->scale, surrogate->features);
    TRY_ARRAY(work->delta, surrogate->variables);
    return STATUS_OK;
}

/// exp(−d²/2h²) with h the distance of the middle row.
static double near_weight(const struct surrogate_work *work, size_t row) {
    const double width = fmax(work->near[work->rows / 2].distance, 1e-300);
    return exp(-0.5 * work->near[row].distance / width);
}

/// The rows nearest to the centre, weighted by exp(−d²/2h²) with h the distance of the middle one.
static void choose_rows(struct surrogate_work *work, const double *centre, size_t kept) {
    const struct surrogate *s = work->surrogate;
    for (size_t k = 0; k < kept; k++) {
        double sum = 0;
        for (size_t n = 0; n < s->variables; n++) {
            const double difference = s->x[k * s->variables + n] - centre[n];
            sum += difference * difference;
        }
        work->near[k] = (struct surrogate_near){sum, k};
    }
    qsort(work->near, kept, sizeof *work->near, by_distance);
    for (size_t k = 0; k < work->rows; k++) {
        const double *x = s->x + work->near[k].row * s->variables;
        work->weight[k] = near_weight(work, k);
        work->design[k * work->terms] = 1;
        for (size_t n = 0; n < s->variables; n++)
            work->design[k * work->terms + n + 1] = x[n] - centre[n];
    }
}

/// Cholesky factor of the weighted normal matrix with its ridge.
static void factor(struct surrogate_work *work) {
    const size_t terms = work->terms;
    for (size_t k = 0; k < work->rows; k++) {
        const double *d = work->design + k * terms;
        for (size_t a = 0; a < terms; a++)
            for (size_t b = 0; b < terms; b++)
                work->normal[a * terms + b] += work->weight[k] * d[a] * d[b];
    }
    double trace = 0;
    for (size_t a = 1; a < terms; a++)
        trace += work->normal[a * terms + a] / (double)(terms - 1);
    for (size_t a = 1; a < terms; a++)
        work->normal[a * terms + a] += ridge * trace + 1e-300;
    gsl_matrix_view view = gsl_matrix_view_array(work->normal, terms, terms);
    gsl_linalg_cholesky_decomp1(&view.matrix);
}

/// y_c and J of every feature, and how the rows scatter about them.
static void fit_features(struct surrogate_work *work) {
    const struct surrogate *s = work->surrogate;
    const size_t terms = work->terms;
    gsl_matrix_view factor = gsl_matrix_view_array(work->normal, terms, terms);
    double weights = 0, squares = 0;
    for (size_t k = 0; k < work->rows; k++) {
        weights += work->weight[k];
        squares += work->weight[k] * work->weight[k];
    }
    // Rows that the weights are worth, less the terms that were fitted to them.
    work->freedom = fmax(1, weights * weights / squares - (double)terms);
    for (size_t j = 0; j < s->features; j++) {
        double *model = work->model + j * terms;
        for (size_t k = 0; k < work->rows; k++)
            for (size_t a = 0; a < terms; a++)
                model[a] += work->weight[k] * work->design[k * terms + a] *
                            s->y[work->near[k].row * s->features + j];
        gsl_vector_view view = gsl_vector_view_array(model, terms);
        gsl_linalg_cholesky_svx(&factor.matrix, &view.vector);
        for (size_t k = 0; k < work->rows; k++) {
            double residual = s->y[work->near[k].row * s->features + j];
            for (size_t a = 0; a < terms; a++)
                residual -= work->design[k * terms + a] * model[a];
            work->residual[k * s->features + j] = residual;
            work->scatter[j] += work->weight[k] * residual * residual / weights *
                                (work->freedom + (double)terms) / work->freedom;
        }
    }
}

void mf_surrogate_add_outer(double *covariance, const double *delta, size_t size, double share) {
    for (size_t a = 0; a < size; a++)
        for (size_t b = 0; b < size; b++)
            covariance[a * size + b] += share * delta[a] * delta[b];
}

/// How the noise of the rows makes y_c and J of a feature vary: N⁻¹ (Σ w² d dᵀ) N⁻¹ with the normal
/// matrix N.
static void find_spread(struct surrogate_work *work) {
    const size_t terms = work->terms;
    gsl_matrix_view factor = gsl_matrix_view_array(work->normal, terms, terms);
    gsl_vector_view view = gsl_vector_view_array(work->term, terms);
    for (size_t k = 0; k < work->rows; k++) {
        for (size_t a = 0; a < terms; a++)
            work->term[a] = work->weight[k] * work->design[k * terms + a];
        gsl_linalg_cholesky_svx(&factor.matrix, &view.vector);
        mf_surrogate_add_outer(work->spread, work->term, terms, 1);
    }
}

/// Rms of what the model misses of a row, in errors of the target.
static double miss_of(const struct surrogate_work *work, size_t row) {
    const struct surrogate *s = work->surrogate;
    double sum = 0;
    for (size_t j = 0; j < s->features; j++)
        sum += work->residual[row * s->features + j] * work->residual[row * s->features + j] /
               (s->target_error[j] * s->target_error[j] + 1e-8);
    return sqrt(sum / (double)s->features);
}

static int by_size(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/// Weights of rows that the model misses by more than twice as much as the middle one fall as the
/// inverse square, as if all missed as much: a few candidates far away, where a liquid is none,
/// would drown the others (P. J. Huber, Robust Statistics (1981)).
static enum status reduce_outlier_weights(struct surrogate_work *work) {
    static const double usual = 2;
    OWNED double *miss = NULL, *sorted = NULL;
    TRY_ARRAY(miss, work->rows);
    TRY_ARRAY(sorted, work->rows);
    for (size_t k = 0; k < work->rows; k++)
        miss[k] = sorted[k] = miss_of(work, k);
    qsort(sorted, work->rows, sizeof *sorted, by_size);
    for (size_t k = 0; k < work->rows; k++)
        work->weight[k] *= fmin(1, pow(usual * sorted[work->rows / 2] / fmax(miss[k], 1e-300), 2));
    return STATUS_OK;
}

static void reset_fit(struct surrogate_work *work) {
    const size_t terms = work->terms, features = work->surrogate->features;
    memset(work->normal, 0, terms * terms * sizeof *work->normal);
    memset(work->spread, 0, terms * terms * sizeof *work->spread);
    memset(work->model, 0, features * terms * sizeof *work->model);
    memset(work->scatter, 0, features * sizeof *work->scatter);
}

static void fit_weighted(struct surrogate_work *work) {
    factor(work);
    find_spread(work);
    fit_features(work);
}

enum status mf_surrogate_fit_rows(struct surrogate_work *work, const struct surrogate *surrogate,
                                  const double *centre, size_t kept, size_t rows, bool robust) {
    enum { ROUNDS = 5 };
    TRY(work_init(work, surrogate, kept, rows));
    choose_rows(work, centre, kept);
    fit_weighted(work);
    for (int round = 0; robust && round < ROUNDS; round++) {
        for (size_t k = 0; k < rows; k++)
            work->weight[k] = near_weight(work, k);
        TRY(reduce_outlier_weights(work));
        reset_fit(work);
        fit_weighted(work);
    }
    for (size_t j = 0; j < surrogate->features; j++)
        work->miss[j] = surrogate->target[j] - work->model[j * work->terms];
    return STATUS_OK;
}
