// SPDX-License-Identifier: GPL-3.0-or-later
#include "surrogate_rows.h"

#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Rows of a fit for each variable, at least and at most, and besides.
enum { ROWS_PER_GENE = 3, MOST_ROWS_PER_GENE = 10, MORE_ROWS = 10 };

/// Standard deviation of a variable that the target leaves open: uniform in [0, 1].
static const double prior_width = 0.28867513459481287;

/// Standard error below which a feature is not believed.
static const double least_error = 1e-4;

enum status mf_surrogate_init(struct surrogate *surrogate, size_t variables, size_t features,
                              size_t capacity, const double *target, const double *target_error) {
    enum status status = STATUS_OK;
    *surrogate = (struct surrogate){.variables = variables,
                                    .features = features,
                                    .capacity = capacity,
                                    .exact = features,
                                    .target = target,
                                    .target_error = target_error};
    NEW_ARRAY(surrogate->x, capacity * variables);
    NEW_ARRAY(surrogate->y, capacity * features);
done:
    return status;
}

void mf_surrogate_clear(struct surrogate *surrogate) {
    mf_memory_free(surrogate->x);
    mf_memory_free(surrogate->y);
    *surrogate = (struct surrogate){0};
}

void mf_surrogate_add(struct surrogate *surrogate, const double *variables,
                      const double *features) {
    const size_t row = surrogate->rows.added++ % surrogate->capacity;
    memcpy(surrogate->x + row * surrogate->variables, variables,
           surrogate->variables * sizeof *variables);
    memcpy(surrogate->y + row * surrogate->features, features,
           surrogate->features * sizeof *features);
}

size_t mf_surrogate_least_rows(size_t variables) {
    return ROWS_PER_GENE * variables + MORE_ROWS;
}

/// Weight of a feature in the fit of the target.
static double feature_weight(const struct surrogate_work *work, size_t j) {
    const double target = work->surrogate->target_error[j];
    return 1 / (work->scatter[j] + target * target + least_error * least_error);
}

/// Cholesky factor of H = Jᵀ W J + damping.
static void factor_hessian(const struct surrogate_work *work, double damping) {
    const struct surrogate *s = work->surrogate;
    const size_t variables = s->variables;
    double *hessian = work->hessian;
    memset(hessian, 0, variables * variables * sizeof *hessian);
    for (size_t j = 0; j < s->features; j++) {
        const double *slope = work->model + j * work->terms + 1;
        const double weight = feature_weight(work, j);
        for (size_t a = 0; a < variables; a++)
            for (size_t b = 0; b < variables; b++)
                hessian[a * variables + b] += weight * slope[a] * slope[b];
    }
    for (size_t a = 0; a < variables; a++)
        hessian[a * variables + a] += damping;
    gsl_matrix_view view = gsl_matrix_view_array(hessian, variables, variables);
    gsl_linalg_cholesky_decomp1(&view.matrix);
}

/// delta = H⁻¹ delta.
static void divide(const struct surrogate_work *work, double *delta) {
    const size_t variables = work->surrogate->variables;
    gsl_matrix_view factor = gsl_matrix_view_array(work->hessian, variables, variables);
    gsl_vector_view view = gsl_vector_view_array(delta, variables);
    gsl_linalg_cholesky_svx(&factor.matrix, &view.vector);
}

/// δ = H⁻¹ Jᵀ W v for a vector of features, times `scale` of each feature if given.
static void solve(const struct surrogate_work *work, const double *v, const double *scale) {
    const struct surrogate *s = work->surrogate;
    double *delta = work->delta;
    memset(delta, 0, s->variables * sizeof *delta);
    for (size_t j = 0; j < s->features; j++) {
        const double *slope = work->model + j * work->terms + 1;
        const double term = feature_weight(work, j) * v[j] * (scale ? scale[j] : 1);
        for (size_t a = 0; a < s->variables; a++)
            delta[a] += slope[a] * term;
    }
    divide(work, delta);
}

/// Variance of the model's features at `delta` from the centre over that of a row: it grows with
/// the distance, since the slopes have errors too.
static double leverage(const struct surrogate_work *work, const double *delta) {
    double sum = 0;
    work->term[0] = 1;
    memcpy(work->term + 1, delta, (work->terms - 1) * sizeof *delta);
    for (size_t a = 0; a < work->terms; a++)
        for (size_t b = 0; b < work->terms; b++)
            sum += work->term[a] * work->spread[a * work->terms + b] * work->term[b];
    return sum;
}

/// What the noise of the target and that of the model where the solution lies do to it. The
/// target's noise is taken to be correlated as that of the simulations is, which the residuals
/// show, with the standard errors that it has.
static void add_noise(const struct surrogate_work *work, double *covariance) {
    const struct surrogate *s = work->surrogate;
    const double lever = leverage(work, work->delta);
    double weights = 0;
    for (size_t k = 0; k < work->rows; k++)
        weights += work->weight[k];
    for (size_t j = 0; j < s->features; j++)
        work->scale[j] = s->target_error[j] / sqrt(work->scatter[j] + least_error * least_error);
    for (size_t k = 0; k < work->rows; k++) {
        const double *residual = work->residual + k * s->features;
        const double share =
            work->weight[k] / weights * (work->freedom + (double)work->terms) / work->freedom;
        solve(work, residual, work->scale);
        mf_surrogate_add_outer(covariance, work->delta, s->variables, share);
        solve(work, residual, NULL);
        mf_surrogate_add_outer(covariance, work->delta, s->variables, share * lever);
    }
}

/// to = Λ from, Λ = Σ_j w_j σ_j² spread: so much do slopes of noise alone add to Jᵀ W J.
static void attenuate(const struct surrogate_work *work, const double *from, double *to) {
    double noise = 0;
    for (size_t j = 0; j < work->surrogate->features; j++)
        noise += feature_weight(work, j) * work->scatter[j];
    for (size_t a = 0; a + 1 < work->terms; a++) {
        to[a] = 0;
        for (size_t b = 0; b + 1 < work->terms; b++)
            to[a] += noise * work->spread[(a + 1) * work->terms + b + 1] * from[b];
    }
}

/// What the data say nothing of is as wide as the prior: H⁻¹/s² of a variable is held back by it,
/// and H⁻¹ Λ by the noise of the slopes (attenuation: W. A. Fuller, Measurement Error Models
/// (1987), section 1.1), without which a variable that has no effect would pass for one that is
/// known. How much of a step that is comes first; the share's share, H⁻¹ Λ H⁻¹ Λ, counts as not
/// known.
static void add_open(const struct surrogate_work *work, double *covariance) {
    const size_t variables = work->surrogate->variables;
    double *held = work->term, *delta = work->delta;
    attenuate(work, delta, held);
    divide(work, held);
    mf_surrogate_add_outer(covariance, held, variables, 1);
    for (size_t a = 0; a < variables; a++) {
        memset(delta, 0, variables * sizeof *delta);
        delta[a] = 1;
        attenuate(work, delta, held);
        divide(work, held);
        attenuate(work, held, delta);
        delta[a] += 1 / (prior_width * prior_width);
        divide(work, delta);
        mf_surrogate_add_outer(covariance, delta, variables, prior_width * prior_width);
    }
}

static double rms(const double *values, size_t count) {
    double sum = 0;
    for (size_t k = 0; k < count; k++)
        sum += values[k] * values[k];
    return sqrt(sum / (double)count);
}

/// Move δ to where `share` of what the exact feature misses is made up for, at the least cost:
/// δ ← δ + H⁻¹J_e (share (t_e − y_ce) − J_e δ)/(J_e H⁻¹J_e).
static void meet_exactly(const struct surrogate_work *work, double share) {
    const struct surrogate *s = work->surrogate;
    if (s->exact >= s->features)
        return;
    const double *slope = work->model + s->exact * work->terms + 1;
    double *direction = work->term, response = 0, missing = share * work->miss[s->exact];
    memcpy(direction, slope, s->variables * sizeof *direction);
    divide(work, direction);
    for (size_t a = 0; a < s->variables; a++) {
        response += slope[a] * direction[a];
        missing -= slope[a] * work->delta[a];
    }
    for (size_t a = 0; response > 0 && a < s->variables; a++)
        work->delta[a] += direction[a] * missing / response;
}

/// The step to where the target is met best, damped until it stays within the reach; of what the
/// exact feature misses it then makes up for less and less.
static void take_step(const struct surrogate_work *work, double reach) {
    double damping = 1 / (prior_width * prior_width), share = 1;
    do {
        factor_hessian(work, damping);
        solve(work, work->miss, NULL);
        meet_exactly(work, share);
        damping *= 2;
        share *= 0.7;
    } while (rms(work->delta, work->surrogate->variables) > reach);
}

/// No variable is less known than by the prior: C becomes (C⁻¹ + 1/s²)⁻¹ = s² − s² (C + s²)⁻¹ s².
static void bound(double *scratch, double *covariance, size_t variables) {
    const double width = prior_width * prior_width;
    memcpy(scratch, covariance, variables * variables * sizeof *scratch);
    for (size_t a = 0; a < variables; a++)
        scratch[a * variables + a] += width;
    gsl_matrix_view view = gsl_matrix_view_array(scratch, variables, variables);
    gsl_linalg_cholesky_decomp1(&view.matrix);
    gsl_linalg_cholesky_invert(&view.matrix);
    for (size_t a = 0; a < variables; a++)
        for (size_t b = 0; b < variables; b++)
            covariance[a * variables + b] =
                (a == b ? width : 0) - width * scratch[a * variables + b] * width;
}

/// Where the target is met best, by the rows near the centre.
static enum status find_best(const struct surrogate *surrogate, const double *centre, size_t kept,
                             double reach, struct surrogate_model *model) {
    struct surrogate_work work = {0};
    const size_t most = MOST_ROWS_PER_GENE * surrogate->variables + MORE_ROWS;
    enum status status =
        mf_surrogate_fit_rows(&work, surrogate, centre, kept, kept < most ? kept : most);
    if (status == STATUS_OK) {
        take_step(&work, reach);
        for (size_t n = 0; n < surrogate->variables; n++)
            model->best[n] = fmin(1, fmax(0, centre[n] + work.delta[n]));
    }
    mf_surrogate_clear_rows(&work);
    return status;
}

/// How well it is known, by all rows: those of a region that has become narrow do not differ by
/// more than their noise, and would say nothing of slopes.
static enum status find_covariance(const struct surrogate *surrogate, const double *centre,
                                   size_t kept, struct surrogate_model *model) {
    struct surrogate_work work = {0};
    enum status status = mf_surrogate_fit_rows(&work, surrogate, centre, kept, kept);
    if (status == STATUS_OK) {
        factor_hessian(&work, 1 / (prior_width * prior_width));
        solve(&work, work.miss, NULL);
        add_noise(&work, model->covariance);
        solve(&work, work.miss, NULL);
        add_open(&work, model->covariance);
        bound(work.hessian, model->covariance, surrogate->variables);
    }
    mf_surrogate_clear_rows(&work);
    return status;
}

enum status mf_surrogate_fit(const struct surrogate *surrogate, const double *centre, double reach,
                             struct surrogate_model *model, bool *known) {
    enum status status = STATUS_OK;
    const size_t variables = surrogate->variables, added = (size_t)surrogate->rows.added;
    const size_t kept = added < surrogate->capacity ? added : surrogate->capacity;
    *model = (struct surrogate_model){.variables = variables};
    *known = kept >= mf_surrogate_least_rows(variables);
    if (!*known)
        return STATUS_OK;
    NEW_ARRAY(model->best, variables);
    NEW_ARRAY(model->covariance, variables * variables);
    CHECK(find_best(surrogate, centre, kept, reach, model));
    CHECK(find_covariance(surrogate, centre, kept, model));
done:
    return status;
}

void mf_surrogate_model_clear(struct surrogate_model *model) {
    mf_memory_free(model->best);
    mf_memory_free(model->covariance);
    *model = (struct surrogate_model){0};
}

size_t mf_surrogate_spans(struct surrogate *surrogate, struct memory_span *spans) {
    const size_t capacity = surrogate->capacity;
    spans[0] = (struct memory_span){&surrogate->rows, sizeof surrogate->rows};
    spans[1] = (struct memory_span){surrogate->x, capacity * surrogate->variables * sizeof(double)};
    spans[2] = (struct memory_span){surrogate->y, capacity * surrogate->features * sizeof(double)};
    return SURROGATE_SPANS;
}
