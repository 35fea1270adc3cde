// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/force_solve.h"

#include "base/memory.h"
#include "inversion/force_work.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

/// Rounds: the noise is that of the forces found before, as steep as these.
enum { ROUNDS = 4 };

static void work_clear(struct force_work *w) {
    mf_memory_free(w->place);
    mf_memory_free(w->begin);
    mf_memory_free(w->scale);
    mf_memory_free(w->x);
    mf_memory_free(w->noise);
    gsl_matrix_free(w->gram);
    gsl_matrix_free(w->vectors);
    gsl_matrix_free(w->prior);
    gsl_matrix_free(w->matrix);
    gsl_vector_free(w->product);
    gsl_vector_free(w->values);
    gsl_vector_free(w->weighed);
    gsl_vector_free(w->found);
}

// The equations -----------------------------------------------------------------------------------

/// The nodes of a curve from the first to the last that have been seen; all of a circle; none if it
/// is left out.
static void find_known(struct force_work *w, const struct force_curve *curve) {
    size_t begin = curve->first, end = curve->left_out ? begin : curve->first + curve->nodes;
    while (begin < end && !(force_work_gram(w->equations, begin, begin) > 0))
        begin++;
    while (end > begin && !(force_work_gram(w->equations, end - 1, end - 1) > 0))
        end--;
    if (begin < end && force_curve_is_circle(curve)) {
        begin = curve->first;
        end = begin + curve->nodes;
    }
    for (size_t k = begin; k < end; k++)
        w->place[w->count++] = k;
}

static enum status allocate(struct force_work *w) {
    const size_t n = w->count;
    TRY_ARRAY(w->scale, n);
    TRY_ARRAY(w->x, n);
    TRY_ARRAY(w->noise, n);
    w->gram = gsl_matrix_alloc(n, n);
    w->vectors = gsl_matrix_alloc(n, n);
    w->prior = gsl_matrix_alloc(n, n);
    w->matrix = gsl_matrix_alloc(n, n);
    w->product = gsl_vector_alloc(n);
    w->values = gsl_vector_alloc(n);
    w->weighed = gsl_vector_alloc(n);
    w->found = gsl_vector_alloc(n);
    if (w->gram && w->vectors && w->prior && w->matrix && w->product && w->values && w->weighed &&
        w->found)
        return STATUS_OK;
    return mf_status_fail(STATUS_NO_MEMORY, "no memory for %zu linear equations", n);
}

static void fill(struct force_work *w) {
    static const double unseen = 1e-3; // nodes between others
    double largest = 0;
    for (size_t k = 0; k < w->count; k++) {
        w->scale[k] = sqrt(force_work_gram(w->equations, w->place[k], w->place[k]));
        largest = fmax(largest, w->scale[k]);
    }
    for (size_t k = 0; k < w->count; k++)
        w->scale[k] = w->scale[k] > 0 ? w->scale[k] : unseen * largest;
    for (size_t k = 0; k < w->count; k++) {
        const double b =
            force_work_total(w->equations, w->equations->product, w->place[k], w->equations->size);
        gsl_vector_set(w->product, k, b / w->scale[k]);
        for (size_t l = 0; l < w->count; l++)
            gsl_matrix_set(w->gram, k, l,
                           force_work_gram(w->equations, w->place[k], w->place[l]) /
                               (w->scale[k] * w->scale[l]));
    }
}

static enum status diagonalise(struct force_work *w) {
    gsl_eigen_symmv_workspace *space = gsl_eigen_symmv_alloc(w->count);
    if (space == NULL)
        return mf_status_fail(STATUS_NO_MEMORY, "no memory for %zu linear equations", w->count);
    gsl_matrix_memcpy(w->matrix, w->gram);
    gsl_eigen_symmv(w->matrix, w->values, w->vectors, space);
    gsl_eigen_symmv_sort(w->values, w->vectors, GSL_EIGEN_SORT_VAL_DESC);
    gsl_eigen_symmv_free(space);
    return STATUS_OK;
}

static enum status prepare(struct force_work *w) {
    const struct force_equations *const equations = w->equations;
    TRY_ARRAY(w->place, equations->size);
    TRY_ARRAY(w->begin, equations->curves + 1);
    for (size_t n = 0; n < equations->curves; n++) {
        w->begin[n] = w->count;
        find_known(w, &equations->curve[n]);
    }
    w->begin[equations->curves] = w->count;
    if (w->count == 0)
        return mf_status_fail(STATUS_BAD_INPUT, "the forces are those of no pair and no term");
    TRY(allocate(w));
    fill(w);
    return diagonalise(w);
}

// Posterior ---------------------------------------------------------------------------------------

/// Gᵀ V⁻¹ G into `matrix`, and Gᵀ V⁻¹ b.
static void weigh(struct force_work *w) {
    gsl_blas_dgemv(CblasTrans, 1, w->vectors, w->product, 0, w->found);
    gsl_matrix *const rows = w->prior; // filled later
    for (size_t k = 0; k < w->count; k++) {
        const double value = gsl_vector_get(w->values, k);
        const double weight = force_work_is_determined(w, k) ? 1 / w->noise[k] : 0;
        gsl_vector_set(w->found, k, gsl_vector_get(w->found, k) * weight);
        for (size_t a = 0; a < w->count; a++)
            gsl_matrix_set(rows, a, k,
                           gsl_matrix_get(w->vectors, a, k) * sqrt(fmax(0, value) * weight));
    }
    gsl_blas_dgemv(CblasNoTrans, 1, w->vectors, w->found, 0, w->weighed);
    gsl_blas_dsyrk(CblasLower, CblasNoTrans, 1, rows, 0, w->gram);
}

/// The posterior of the present strengths: its Cholesky factor in `matrix`, its mean in `found`.
static enum status find_posterior(struct force_work *w) {
    static const double jitter = 1e-13; // of rounding
    mf_force_prior_fill(w);
    gsl_matrix_memcpy(w->matrix, w->gram);
    gsl_matrix_add(w->matrix, w->prior);
    for (size_t k = 0; k < w->count; k++)
        *gsl_matrix_ptr(w->matrix, k, k) *= 1 + jitter;
    if (gsl_linalg_cholesky_decomp1(w->matrix) != 0)
        return mf_status_fail(STATUS_BAD_INPUT, "the equations of the forces are singular: measure "
                                                "more frames");
    gsl_vector_memcpy(w->found, w->weighed);
    gsl_linalg_cholesky_svx(w->matrix, w->found);
    return STATUS_OK;
}

/// Twice the logarithm of the evidence, but for what is common.
static enum status find_evidence(struct force_work *w, double *evidence) {
    TRY(find_posterior(w));
    gsl_blas_ddot(w->weighed, w->found, evidence);
    for (size_t k = 0; k < w->count; k++)
        *evidence -= 2 * log(gsl_matrix_get(w->matrix, k, k));
    for (size_t n = 0; n < w->equations->curves; n++)
        *evidence += mf_force_prior_rank(w, n) * log(w->strength[n]);
    return STATUS_OK;
}

/// Set the strength of a curve; of all pairs at once.
static void set_strength(struct force_work *w, size_t curve, double strength) {
    const bool pairs = w->equations->curve[curve].order == FORCES_OF_PAIRS;
    for (size_t n = 0; n < w->equations->curves; n++)
        if (n == curve || (pairs && w->equations->curve[n].order == FORCES_OF_PAIRS))
            w->strength[n] = strength;
}

/// The most probable strength of a curve: by steps of its logarithm that are halved.
static enum status choose_strength(struct force_work *w, size_t curve) {
    static const double least = -8, most = 8, first = 2, last = 0.2;
    double best, at = log10(w->strength[curve]);
    TRY(find_evidence(w, &best));
    for (double step = first; step > last; step *= 0.5)
        for (int sign = -1; sign <= 1; sign += 2)
            for (bool better = true; better;) {
                const double next = fmin(most, fmax(least, at + sign * step));
                double evidence;
                set_strength(w, curve, pow(10, next));
                TRY(find_evidence(w, &evidence));
                better = evidence > best && next != at;
                at = better ? next : at;
                best = better ? evidence : best;
            }
    set_strength(w, curve, pow(10, at));
    return STATUS_OK;
}

static enum status choose_strengths(struct force_work *w) {
    for (size_t n = 0; n < w->equations->curves; n++)
        if (w->equations->curve[n].order != FORCES_OF_PAIRS || n == 0)
            TRY(choose_strength(w, n));
    return STATUS_OK;
}

/// Forces by the noise of those before.
static enum status improve(struct force_work *w) {
    weigh(w);
    TRY(choose_strengths(w));
    TRY(find_posterior(w));
    for (size_t k = 0; k < w->count; k++)
        w->x[k] = gsl_vector_get(w->found, k);
    return STATUS_OK;
}

/// To begin with, along directions that all see.
static void begin_forces(struct force_work *w) {
    static const double enough = 1e-6;
    gsl_blas_dgemv(CblasTrans, 1, w->vectors, w->product, 0, w->weighed);
    for (size_t k = 0; k < w->count; k++) {
        const double value = gsl_vector_get(w->values, k);
        const bool seen = value > enough * gsl_vector_get(w->values, 0);
        gsl_vector_set(w->weighed, k, seen ? gsl_vector_get(w->weighed, k) / value : 0);
    }
    gsl_blas_dgemv(CblasNoTrans, 1, w->vectors, w->weighed, 0, w->found);
    for (size_t k = 0; k < w->count; k++)
        w->x[k] = gsl_vector_get(w->found, k);
    for (size_t n = 0; n < w->equations->curves; n++)
        w->strength[n] = 1;
}

// Results -----------------------------------------------------------------------------------------

/// Share of unknown k in the coarse ones: every other node of its curve, and the last.
static void find_coarse(const struct force_work *w, size_t n, size_t k, size_t column[2],
                        double share[2]) {
    const size_t begin = w->begin[n], end = w->begin[n + 1], own = k - begin;
    const bool kept = own % 2 == 0 || k + 1 == end;
    column[0] = kept ? k : k - 1;
    column[1] = kept ? k : k + 1;
    share[0] = kept ? 1 : 0.5 * w->scale[k] / w->scale[column[0]];
    share[1] = kept ? 0 : 0.5 * w->scale[k] / w->scale[column[1]];
}

/// The posterior with every other node: (Pᵀ M P) y = Pᵀ h, with x = P y and y among the unknowns.
static enum status solve_coarse(struct force_work *w, double *coarse) {
    static const double ridge = 1e-12;
    enum status status = STATUS_OK;
    const size_t n = w->count;
    gsl_matrix *p = gsl_matrix_calloc(n, n), *half = gsl_matrix_alloc(n, n);
    CHECK(p && half ? STATUS_OK
                    : mf_status_fail(STATUS_NO_MEMORY, "no memory for %zu linear equations", n));
    for (size_t curve = 0; curve < w->equations->curves; curve++)
        for (size_t k = w->begin[curve]; k < w->begin[curve + 1]; k++) {
            size_t column[2];
            double share[2];
            find_coarse(w, curve, k, column, share);
            for (int s = 0; s < 2; s++)
                *gsl_matrix_ptr(p, k, column[s]) += share[s];
        }
    gsl_matrix_memcpy(w->matrix, w->gram);
    gsl_matrix_add(w->matrix, w->prior);
    gsl_blas_dsymm(CblasLeft, CblasLower, 1, w->matrix, p, 0, half);
    gsl_blas_dgemm(CblasTrans, CblasNoTrans, 1, p, half, 0, w->matrix);
    gsl_blas_dgemv(CblasTrans, 1, p, w->weighed, 0, w->found);
    const double rounding = ridge * gsl_matrix_max(w->gram);
    for (size_t k = 0; k < n; k++) // 1 of a node that is left out
        *gsl_matrix_ptr(w->matrix, k, k) += gsl_matrix_get(w->matrix, k, k) == 0 ? 1 : rounding;
    CHECK(gsl_linalg_cholesky_decomp1(w->matrix) == 0
              ? STATUS_OK
              : mf_status_fail(STATUS_BAD_INPUT, "the equations of the forces are singular"));
    gsl_vector_memcpy(w->values, w->found);
    gsl_linalg_cholesky_svx(w->matrix, w->values);
    gsl_blas_dgemv(CblasNoTrans, 1, p, w->values, 0, w->found);
    for (size_t k = 0; k < n; k++)
        coarse[w->place[k]] = gsl_vector_get(w->found, k) / w->scale[k];
done:
    gsl_matrix_free(p);
    gsl_matrix_free(half);
    return status;
}

static enum status keep(struct force_work *w, struct force_solution *solution) {
    gsl_linalg_cholesky_invert(w->matrix);
    solution->directions = 0;
    for (size_t a = 0; a < w->count; a++) {
        const size_t k = w->place[a];
        solution->known[k] = true;
        solution->value[k] = w->x[a] / w->scale[a];
        for (size_t b = 0; b < w->count; b++) {
            const double covariance = gsl_matrix_get(w->matrix, a, b);
            const double inform = gsl_matrix_get(w->gram, a > b ? a : b, a > b ? b : a);
            solution->covariance[k * solution->size + w->place[b]] =
                covariance / (w->scale[a] * w->scale[b]);
            solution->directions += covariance * inform;
        }
    }
    solution->explained = mf_force_equations_share(w->equations, solution->value);
    return solve_coarse(w, solution->coarse);
}

static enum status solve(struct force_work *w, struct force_solution *solution) {
    TRY(prepare(w));
    begin_forces(w);
    for (int round = 0; round < ROUNDS; round++) {
        TRY(mf_force_noise_find(w));
        TRY(improve(w));
    }
    return keep(w, solution);
}

enum status mf_force_solve(const struct force_equations *equations, double temperature,
                           struct force_solution *solution) {
    enum status status = STATUS_OK;
    struct force_work w = {.equations = equations, .temperature = temperature};
    const size_t size = equations->size;
    *solution = (struct force_solution){.size = size};
    if (equations->each == 0 || equations->frames / equations->each < FORCE_SOLVE_BLOCKS)
        CHECK(mf_status_fail(STATUS_BAD_INPUT,
                             "%zu frames with forces tell no errors: measure more of them",
                             equations->frames));
    NEW_ARRAY(solution->known, size);
    NEW_ARRAY(solution->value, size);
    NEW_ARRAY(solution->coarse, size);
    NEW_ARRAY(solution->covariance, size * size);
    CHECK(solve(&w, solution));
done:
    work_clear(&w);
    if (status != STATUS_OK)
        mf_force_solution_clear(solution);
    return status;
}

void mf_force_solution_clear(struct force_solution *solution) {
    mf_memory_free(solution->known);
    mf_memory_free(solution->value);
    mf_memory_free(solution->coarse);
    mf_memory_free(solution->covariance);
    *solution = (struct force_solution){0};
}

/// Beyond all its nodes a force goes on along the line of the last two, as in the equations: what
/// this adds to a constant one, ∫ of its slope, for q so many nodes beyond.
static void add_line(double *weight, size_t upper, size_t lower, double h, double beyond) {
    weight[upper] += 0.5 * h * beyond * beyond;
    weight[lower] -= 0.5 * h * beyond * beyond;
}

/// Add `sign` times the weights of ∫ of the force from the first known node to q.
static void add_integral(const struct force_solution *solution, const struct force_curve *curve,
                         double q, double sign, double *weight) {
    const bool circle = force_curve_is_circle(curve);
    const bool line = curve->order != FORCES_OF_PAIRS && !circle;
    const double h = sign * curve->width;
    size_t begin = 0, last = curve->nodes - 1;
    while (begin < last && !solution->known[curve->first + begin])
        begin++;
    while (last > begin && !solution->known[curve->first + last])
        last--;
    last += circle;
    double at = (q - curve->low) / curve->width - (double)begin;
    if (line && begin == 0 && at < 0)
        add_line(weight, curve->first + 1, curve->first, h, at);
    double *node = weight + curve->first + begin;
    for (size_t k = begin; k < last && at > 0; k++, at--) {
        const double t = fmin(at, 1);
        *node++ += h * (t - 0.5 * t * t);
        node = k + 1 == curve->nodes ? weight + curve->first : node;
        *node += h * 0.5 * t * t;
        if (at <= 1)
            return;
    }
    if (line && last + 1 == curve->nodes && at > 0)
        add_line(weight, curve->first + last, curve->first + last - 1, h, at);
    *node += h * at;
}

void mf_force_solution_integral(const struct force_solution *solution,
                                const struct force_curve *curve, double from, double to,
                                double *weight) {
    add_integral(solution, curve, to, 1, weight);
    add_integral(solution, curve, from, -1, weight);
}
