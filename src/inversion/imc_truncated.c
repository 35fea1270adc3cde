// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"
#include "inversion/imc_solve.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>
#include <math.h>

/// Singular values below this part of the largest are rounding.
static const double least_share = 1e-10;

struct workspace {
    gsl_matrix *u, *v;           ///< B = U s Vᵀ, shape [size, size]
    gsl_vector *values, *weight; ///< s; and of the SVD, then Uᵀ b
    double *free, *meet; ///< shape [size]: Σ v_k (u_k · b)/s_k and Σ v_k (v_k · p)/s_k²
};

static void workspace_free(struct workspace *w) {
    gsl_matrix_free(w->u);
    gsl_matrix_free(w->v);
    gsl_vector_free(w->values);
    gsl_vector_free(w->weight);
    mf_memory_free(w->free);
    mf_memory_free(w->meet);
}

static enum status workspace_allocate(struct workspace *w, size_t n) {
    enum status status = STATUS_OK;
    w->u = gsl_matrix_alloc(n, n);
    w->v = gsl_matrix_alloc(n, n);
    w->values = gsl_vector_alloc(n);
    w->weight = gsl_vector_alloc(n);
    CHECK(w->u && w->v && w->values && w->weight ? STATUS_OK : STATUS_NO_MEMORY);
    NEW_ARRAY(w->free, n);
    NEW_ARRAY(w->meet, n);
done:
    return status;
}

static void decompose(struct workspace *w, const struct imc_system *s) {
    mf_imc_solve_response(s, w->u);
    gsl_linalg_SV_decomp(w->u, w->v, w->values, w->weight);
    for (size_t k = 0; k < s->size; k++) {
        double product = 0;
        for (size_t a = 0; a < s->size; a++)
            product += gsl_matrix_get(w->u, a, k) * s->excess[a] / sqrt(s->variance[a]);
        gsl_vector_set(w->weight, k, product);
    }
}

/// Singular values above a share of the largest.
static size_t count_above(const struct workspace *w, double share) {
    size_t count = 0;
    while (count < w->values->size && gsl_vector_get(w->values, count) > 0 &&
           gsl_vector_get(w->values, count) > share * gsl_vector_get(w->values, 0))
        count++;
    return count;
}

/// Go on from k to k + 1 singular values.
static void add_direction(struct workspace *w, const struct imc_system *s, size_t k) {
    const double value = gsl_vector_get(w->values, k);
    double along = 0;
    for (size_t a = 0; s->constraint && a < s->size; a++)
        along += gsl_matrix_get(w->v, a, k) * s->constraint[a];
    for (size_t a = 0; a < s->size; a++) {
        const double v = gsl_matrix_get(w->v, a, k);
        w->free[a] += v * gsl_vector_get(w->weight, k) / value;
        w->meet[a] += v * along / (value * value);
    }
}

/// x by the directions so far; returns its misfit.
static double finish(const struct workspace *w, const struct imc_system *s, double *x) {
    for (size_t a = 0; a < s->size; a++)
        x[a] = w->free[a];
    if (s->constraint)
        mf_imc_solve_meet(s, w->meet, x);
    return mf_imc_solve_misfit(s, x);
}

/// By the first directions, `most` or as many of them as bring the misfit down to `enough`.
static void solve(struct workspace *w, const struct imc_system *s, size_t most, double enough,
                  double *x, struct imc_solution *solution) {
    size_t count = 0;
    for (size_t a = 0; a < s->size; a++)
        w->free[a] = w->meet[a] = 0;
    solution->misfit = finish(w, s, x);
    while (count < most && (solution->misfit > enough || (s->constraint && count == 0))) {
        add_direction(w, s, count++);
        solution->misfit = finish(w, s, x);
    }
    solution->directions = (double)count;
    solution->strength =
        count > 0 ? gsl_vector_get(w->values, count - 1) / gsl_vector_get(w->values, 0) : 1;
}

enum status mf_imc_truncated(const struct imc_system *system, double strength, double *x,
                             struct imc_solution *solution) {
    enum status status = STATUS_OK;
    struct workspace w = {0};
    CHECK(workspace_allocate(&w, system->size));
    decompose(&w, system);
    const size_t most = count_above(&w, fmax(strength, least_share));
    solve(&w, system, most, -1, x, solution);
    if (strength > 0)
        solution->strength = strength;
    else
        solve(&w, system, most, mf_imc_solve_discrepancy(solution->misfit), x, solution);
    for (size_t k = 0; system->singular && k < system->size; k++) {
        system->singular[k] = gsl_vector_get(w.values, k);
        system->used[k] = (double)k < solution->directions;
    }
done:
    workspace_free(&w);
    return status;
}
