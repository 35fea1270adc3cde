// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimise/cmaes.h"

#include "base/memory.h"
#include "base/rng.h"

#include <gsl/gsl_eigen.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct cmaes_workspace {
    gsl_eigen_symmv_workspace *eigen;
    gsl_matrix *matrix, *vectors;
    gsl_vector *values;
    double *mean_step; ///< Σ w y, shape [variables]
    double *white;     ///< C^−½ of some step, shape [variables]
};

static enum status workspace_init(struct cmaes_workspace *w, size_t variables) {
    enum status status = STATUS_OK;
    w->eigen = gsl_eigen_symmv_alloc(variables);
    w->matrix = gsl_matrix_alloc(variables, variables);
    w->vectors = gsl_matrix_alloc(variables, variables);
    w->values = gsl_vector_alloc(variables);
    NEW_ARRAY(w->mean_step, variables);
    NEW_ARRAY(w->white, variables);
    if (w->eigen == NULL || w->matrix == NULL || w->vectors == NULL || w->values == NULL)
        status = mf_status_fail(STATUS_NO_MEMORY, "out of memory for %zu variables", variables);
done:
    return status;
}

enum status mf_cmaes_init(struct cmaes_distribution *d, size_t variables) {
    *d = (struct cmaes_distribution){.variables = variables};
    TRY_ARRAY(d->mean, variables);
    TRY_ARRAY(d->path_sigma, variables);
    TRY_ARRAY(d->path, variables);
    TRY_ARRAY(d->covariance, variables * variables);
    TRY_ARRAY(d->axes, variables * variables);
    TRY_ARRAY(d->lengths, variables);
    TRY_ARRAY(d->scratch, 1);
    return workspace_init(d->scratch, variables);
}

void mf_cmaes_clear(struct cmaes_distribution *d) {
    if (d->scratch) {
        if (d->scratch->eigen)
            gsl_eigen_symmv_free(d->scratch->eigen);
        gsl_matrix_free(d->scratch->matrix);
        gsl_matrix_free(d->scratch->vectors);
        gsl_vector_free(d->scratch->values);
        mf_memory_free(d->scratch->mean_step);
        mf_memory_free(d->scratch->white);
    }
    mf_memory_free(d->scratch);
    mf_memory_free(d->mean);
    mf_memory_free(d->path_sigma);
    mf_memory_free(d->path);
    mf_memory_free(d->covariance);
    mf_memory_free(d->axes);
    mf_memory_free(d->lengths);
    *d = (struct cmaes_distribution){0};
}

void mf_cmaes_begin(struct cmaes_distribution *d, double sigma) {
    const size_t n = d->variables;
    d->moments = (struct cmaes_moments){.sigma = sigma};
    memset(d->path_sigma, 0, n * sizeof(double));
    memset(d->path, 0, n * sizeof(double));
    memset(d->covariance, 0, n * n * sizeof(double));
    memset(d->axes, 0, n * n * sizeof(double));
    for (size_t k = 0; k < n; k++)
        d->covariance[k * n + k] = d->axes[k * n + k] = d->lengths[k] = 1;
}

void mf_cmaes_sample(const struct cmaes_distribution *d, uint64_t seed, uint32_t round,
                     uint32_t row, double *step) {
    const size_t n = d->variables;
    double normal[4];
    memset(step, 0, n * sizeof *step);
    for (size_t axis = 0; axis < n; axis++) {
        if (axis % 4 == 0)
            mf_rng_normal4(mf_rng_philox(seed, RNG_SELECTION, round, row, (uint32_t)(axis / 4)),
                           normal);
        const double length = d->lengths[axis] * normal[axis % 4];
        for (size_t k = 0; k < n; k++)
            step[k] += d->axes[k * n + axis] * length;
    }
}

// Update ------------------------------------------------------------------------------------------

struct ranked {
    double error;
    size_t row;
    double positive, negative; ///< weights of its rank
};

static int compare_ranked(const void *a, const void *b) {
    const struct ranked *x = a, *y = b;
    if (x->error != y->error)
        return x->error < y->error ? -1 : 1;
    return x->row < y->row ? -1 : 1;
}

/// Ranks of equal errors share their weights.
static void share_weights(struct ranked *ranked, size_t count) {
    for (size_t begin = 0, end = 0; begin < count; begin = end) {
        double positive = 0, negative = 0;
        for (; end < count && ranked[end].error == ranked[begin].error; end++) {
            positive += ranked[end].positive;
            negative += ranked[end].negative;
        }
        for (size_t k = begin; k < end; k++) {
            ranked[k].positive = positive / (double)(end - begin);
            ranked[k].negative = negative / (double)(end - begin);
        }
    }
}

static void rank(struct ranked *ranked, const struct cmaes_strategy *s, const double *errors) {
    for (size_t k = 0; k < s->population; k++)
        ranked[k] = (struct ranked){.error = errors[k], .row = k};
    qsort(ranked, s->population, sizeof *ranked, compare_ranked);
    for (size_t k = 0; k < s->population; k++) {
        ranked[k].positive = fmax(s->weights[k], 0);
        ranked[k].negative = fmin(s->weights[k], 0);
    }
    share_weights(ranked, s->population);
}

/// C^−½ y = B D^−1 Bᵀ y into `white`; its squared length.
static double whiten(const struct cmaes_distribution *d, const double *step, double *white) {
    const size_t n = d->variables;
    double squares = 0;
    memset(white, 0, n * sizeof *white);
    for (size_t axis = 0; axis < n; axis++) {
        double along = 0;
        for (size_t k = 0; k < n; k++)
            along += d->axes[k * n + axis] * step[k];
        along /= d->lengths[axis];
        squares += along * along;
        for (size_t k = 0; k < n; k++)
            white[k] += d->axes[k * n + axis] * along;
    }
    return squares;
}

/// Mean of the better half's steps (eq. 41) and the way of the mean (eq. 42).
static void move_mean(struct cmaes_distribution *d, const struct cmaes_strategy *s,
                      const struct ranked *ranked, const double *steps) {
    double *mean_step = d->scratch->mean_step;
    memset(mean_step, 0, d->variables * sizeof *mean_step);
    for (size_t k = 0; k < s->population; k++)
        for (size_t variable = 0; variable < d->variables; variable++)
            mean_step[variable] +=
                ranked[k].positive * steps[ranked[k].row * d->variables + variable];
    for (size_t variable = 0; variable < d->variables; variable++)
        d->mean[variable] += d->moments.sigma * mean_step[variable];
}

/// Both evolution paths (eq. 43, 45). Returns p_σ's length, and whether p_c went along (h_σ).
static double follow_paths(struct cmaes_distribution *d, const struct cmaes_strategy *s,
                           bool *goes_on) {
    const double n = (double)d->variables;
    const double take = sqrt(s->path_sigma * (2 - s->path_sigma) * s->effective);
    double squares = 0;
    whiten(d, d->scratch->mean_step, d->scratch->white);
    for (size_t k = 0; k < d->variables; k++) {
        d->path_sigma[k] = (1 - s->path_sigma) * d->path_sigma[k] + take * d->scratch->white[k];
        squares += d->path_sigma[k] * d->path_sigma[k];
    }
    const double memory = 1 - pow(1 - s->path_sigma, 2.0 * (double)(d->moments.updates + 1));
    *goes_on = sqrt(squares / memory) < (1.4 + 2 / (n + 1)) * s->length;
    const double along = *goes_on ? sqrt(s->path * (2 - s->path) * s->effective) : 0;
    for (size_t k = 0; k < d->variables; k++)
        d->path[k] = (1 - s->path) * d->path[k] + along * d->scratch->mean_step[k];
    return sqrt(squares);
}

/// C += factor v vᵀ, the lower triangle alone.
static void add_square(struct cmaes_distribution *d, double factor, const double *vector) {
    for (size_t i = 0; i < d->variables; i++)
        for (size_t j = 0; j <= i; j++)
            d->covariance[i * d->variables + j] += factor * vector[i] * vector[j];
}

/// Eq. 46, 47.
static void reshape(struct cmaes_distribution *d, const struct cmaes_strategy *s,
                    const struct ranked *ranked, const double *steps, bool goes_on) {
    const double lost = goes_on ? 0 : s->path * (2 - s->path);
    const double keep = 1 + s->rank_one * lost - s->rank_one - s->rank_mu * s->weights_sum;
    for (size_t k = 0; k < d->variables * d->variables; k++)
        d->covariance[k] *= keep;
    add_square(d, s->rank_one, d->path);
    for (size_t k = 0; k < s->population; k++) {
        const double *step = steps + ranked[k].row * d->variables;
        double weight = ranked[k].positive;
        if (ranked[k].negative < 0)
            weight +=
                ranked[k].negative * (double)d->variables / whiten(d, step, d->scratch->white);
        add_square(d, s->rank_mu * weight, step);
    }
    for (size_t i = 0; i < d->variables; i++)
        for (size_t j = i + 1; j < d->variables; j++)
            d->covariance[i * d->variables + j] = d->covariance[j * d->variables + i];
}

/// Axes and lengths of C, every few rounds: between them it changes by less than a tenth.
static void decompose(struct cmaes_distribution *d, const struct cmaes_strategy *s) {
    const double every = 0.1 / ((double)d->variables * (s->rank_one + s->rank_mu));
    if ((double)(d->moments.updates - d->moments.decomposed) <= every)
        return;
    const size_t n = d->variables;
    struct cmaes_workspace *w = d->scratch;
    d->moments.decomposed = d->moments.updates;
    memcpy(w->matrix->data, d->covariance, n * n * sizeof(double));
    gsl_eigen_symmv(w->matrix, w->values, w->vectors, w->eigen);
    const double largest = gsl_vector_max(w->values);
    for (size_t k = 0; k < n; k++) // rounding can make the least eigenvalue negative
        d->lengths[k] = sqrt(fmax(gsl_vector_get(w->values, k), 1e-16 * largest));
    memcpy(d->axes, w->vectors->data, n * n * sizeof(double));
}

enum status mf_cmaes_update(struct cmaes_distribution *d, const struct cmaes_strategy *s,
                            const double *steps, const double *errors) {
    bool goes_on;
    struct ranked *ranked = mf_memory_zeroed(s->population, sizeof *ranked);
    if (ranked == NULL)
        return STATUS_NO_MEMORY;
    rank(ranked, s, errors);
    move_mean(d, s, ranked, steps);
    const double length = follow_paths(d, s, &goes_on);
    reshape(d, s, ranked, steps, goes_on);
    d->moments.sigma *= exp(fmin(1, s->path_sigma / s->damping * (length / s->length - 1)));
    d->moments.updates++;
    decompose(d, s);
    mf_memory_free(ranked);
    return STATUS_OK;
}

double mf_cmaes_deviation(const struct cmaes_distribution *d, size_t variable) {
    return d->moments.sigma * sqrt(d->covariance[variable * d->variables + variable]);
}

double mf_cmaes_axis_ratio(const struct cmaes_distribution *d) {
    double min = d->lengths[0], max = d->lengths[0];
    for (size_t k = 1; k < d->variables; k++) {
        min = fmin(min, d->lengths[k]);
        max = fmax(max, d->lengths[k]);
    }
    return max / min;
}
