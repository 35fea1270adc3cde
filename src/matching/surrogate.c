// SPDX-License-Identifier: GPL-3.0-or-later
#include "surrogate_rows.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Rows of a fit for each variable, at least and at most, and besides.
enum { ROWS_PER_GENE = 3, MAX_ROWS_PER_GENE = 10, MORE_ROWS = 10 };

/// Standard deviation of a variable that the target leaves open: uniform in [0, 1].
static const double prior_width = 0.28867513459481287;

/// Standard error below which a feature is not believed.
static const double min_error = 1e-4;

enum status mf_surrogate_init(struct surrogate *surrogate, size_t variables, size_t features,
                              size_t capacity, const double *target, const double *target_error,
                              const double *excess) {
    *surrogate = (struct surrogate){.variables = variables,
                                    .features = features,
                                    .capacity = capacity,
                                    .exact = features,
                                    .target = target,
                                    .target_error = target_error,
                                    .excess = excess};
    TRY_ARRAY(surrogate->x, capacity * variables);
    TRY_ARRAY(surrogate->y, capacity * features);
    return STATUS_OK;
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

size_t mf_surrogate_min_rows(size_t variables) {
    return ROWS_PER_GENE * variables + MORE_ROWS;
}

/// Weight of a feature in the fit of the target.
static double feature_weight(const struct surrogate_work *work, size_t j) {
    const double target = work->surrogate->target_error[j];
    return 1 / (work->scatter[j] + target * target + work->surrogate->excess[j] +
                min_error * min_error);
}

/// H = Jᵀ W J + damping.
static void find_hessian(const struct surrogate_work *work, double damping, double *hessian) {
    const struct surrogate *s = work->surrogate;
    const size_t variables = s->variables;
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
}

/// Its Cholesky factor.
static void factor_hessian(const struct surrogate_work *work, double damping) {
    const size_t variables = work->surrogate->variables;
    double *hessian = work->hessian;
    find_hessian(work, damping, hessian);
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
        work->scale[j] = s->target_error[j] / sqrt(work->scatter[j] + min_error * min_error);
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

/// H⁻¹/s² of a variable is held back by the prior.
static void add_held(const struct surrogate_work *work, double *covariance) {
    const size_t variables = work->surrogate->variables;
    double *delta = work->delta;
    for (size_t a = 0; a < variables; a++) {
        memset(delta, 0, variables * sizeof *delta);
        delta[a] = 1 / (prior_width * prior_width);
        divide(work, delta);
        mf_surrogate_add_outer(covariance, delta, variables, prior_width * prior_width);
    }
}

/// Directions v of the variables by how far the slopes stand above their noise, H v = μ Λ v and
/// vᵀΛv = 1, where Λ = Σ_j w_j σ_j² spread is what slopes of noise alone add to Jᵀ W J.
struct directions {
    size_t count;
    gsl_matrix *hessian, *noise, *vector; ///< the last in columns
    gsl_vector *value;                    ///< μ
    double *factor;                       ///< shape [count]: scratch
    double *mapping;                      ///< shape [count, count]: Σ factor v vᵀΛ
    double *product;                      ///< shape [count, count]: scratch
};

static void clear_directions(struct directions *d) {
    gsl_matrix_free(d->hessian);
    gsl_matrix_free(d->noise);
    gsl_matrix_free(d->vector);
    gsl_vector_free(d->value);
    mf_memory_free(d->factor);
    mf_memory_free(d->mapping);
    mf_memory_free(d->product);
}

/// Λ, and next to nothing in directions in which the rows do not differ, so that it has a factor.
static void fill_noise(const struct surrogate_work *work, gsl_matrix *matrix) {
    static const double nothing = 1e-12;
    const size_t variables = work->surrogate->variables;
    double noise = 0, trace = 1;
    for (size_t j = 0; j < work->surrogate->features; j++)
        noise += feature_weight(work, j) * work->scatter[j];
    for (size_t a = 0; a < variables; a++)
        trace += noise * work->spread[(a + 1) * (work->terms + 1)];
    for (size_t a = 0; a < variables; a++)
        for (size_t b = 0; b < variables; b++)
            gsl_matrix_set(matrix, a, b,
                           noise * work->spread[(a + 1) * work->terms + b + 1] +
                               (a == b ? nothing * trace : 0));
}

static enum status find_directions(const struct surrogate_work *work, struct directions *d) {
    enum status status = STATUS_OK;
    const size_t n = work->surrogate->variables;
    *d = (struct directions){.count = n,
                             .hessian = gsl_matrix_alloc(n, n),
                             .noise = gsl_matrix_alloc(n, n),
                             .vector = gsl_matrix_alloc(n, n),
                             .value = gsl_vector_alloc(n)};
    gsl_eigen_gensymmv_workspace *eigen = gsl_eigen_gensymmv_alloc(n);
    CHECK(d->hessian && d->noise && d->vector && d->value && eigen ? STATUS_OK : STATUS_NO_MEMORY);
    NEW_ARRAY(d->factor, n);
    NEW_ARRAY(d->mapping, n * n);
    NEW_ARRAY(d->product, n * n);
    find_hessian(work, 1 / (prior_width * prior_width), d->product);
    for (size_t k = 0; k < n * n; k++)
        gsl_matrix_set(d->hessian, k / n, k % n, d->product[k]);
    fill_noise(work, d->noise);
    gsl_eigen_gensymmv(d->hessian, d->noise, d->value, d->vector, eigen);
    fill_noise(work, d->noise);      // which the above has made something else of
    for (size_t v = 0; v < n; v++) { // to the length that vᵀΛv = 1 asks for
        double square = 0;
        for (size_t a = 0; a < n; a++)
            for (size_t b = 0; b < n; b++)
                square += gsl_matrix_get(d->vector, a, v) * gsl_matrix_get(d->noise, a, b) *
                          gsl_matrix_get(d->vector, b, v);
        for (size_t a = 0; a < n; a++)
            gsl_matrix_set(d->vector, a, v, gsl_matrix_get(d->vector, a, v) / sqrt(square));
    }
done:
    if (eigen)
        gsl_eigen_gensymmv_free(eigen);
    return status;
}

/// The mapping of its factors.
static void map(struct directions *d) {
    const size_t n = d->count;
    memset(d->mapping, 0, n * n * sizeof *d->mapping);
    for (size_t v = 0; v < n; v++)
        for (size_t b = 0; b < n; b++) {
            double share = 0;
            for (size_t c = 0; c < n; c++)
                share += gsl_matrix_get(d->vector, c, v) * gsl_matrix_get(d->noise, c, b);
            for (size_t a = 0; a < n; a++)
                d->mapping[a * n + b] += d->factor[v] * gsl_matrix_get(d->vector, a, v) * share;
        }
}

/// C ← M C Mᵀ.
static void transform(const struct directions *d, double *covariance) {
    const size_t n = d->count;
    memset(d->product, 0, n * n * sizeof *d->product);
    for (size_t a = 0; a < n; a++)
        for (size_t b = 0; b < n; b++)
            for (size_t c = 0; c < n; c++)
                d->product[a * n + b] += d->mapping[a * n + c] * covariance[c * n + b];
    memset(covariance, 0, n * n * sizeof *covariance);
    for (size_t a = 0; a < n; a++)
        for (size_t b = 0; b < n; b++)
            for (size_t c = 0; c < n; c++)
                covariance[a * n + b] += d->product[a * n + c] * d->mapping[b * n + c];
}

/// Slopes with noise make H too large by Λ, and with it steps and their errors too small: W. A.
/// Fuller, Measurement Error Models (1987), section 1.2. In a direction in which they stand well
/// above it, errors grow by μ/(μ − margin); one in which they do not is as wide as the prior.
static enum status correct(const struct surrogate_work *work, double *covariance) {
    static const double margin = 2, min_share = 0.1;
    enum status status = STATUS_OK;
    struct directions d;
    const size_t n = work->surrogate->variables;
    CHECK(find_directions(work, &d));
    for (size_t v = 0; v < n; v++) {
        const double share = 1 - margin / gsl_vector_get(d.value, v);
        d.factor[v] = share > min_share ? 1 / share : 1;
    }
    map(&d);
    transform(&d, covariance);
    for (size_t v = 0; v < n; v++)
        d.factor[v] = 1 - margin / gsl_vector_get(d.value, v) > min_share ? 0 : 1;
    map(&d);
    for (size_t a = 0; a < n; a++)
        for (size_t b = 0; b < n; b++)
            for (size_t c = 0; c < n; c++)
                covariance[a * n + b] +=
                    prior_width * prior_width * d.mapping[a * n + c] * d.mapping[b * n + c];
done:
    clear_directions(&d);
    return status;
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

/// The step to where the target is met best, damped until it stays within the reach together with
/// what is held; of what the exact feature misses it then makes up for less and less.
static void take_damped_step(const struct surrogate_work *work, const double *held, double reach) {
    const size_t variables = work->surrogate->variables;
    double damping = 1 / (prior_width * prior_width), share = 1;
    do {
        factor_hessian(work, damping);
        solve(work, work->miss, NULL);
        meet_exactly(work, share);
        for (size_t a = 0; a < variables; a++)
            work->delta[a] += held[a];
        damping *= 2;
        share *= 0.7;
    } while (rms(work->delta, variables) > reach && damping < 1e300);
}

/// Hold the variable that is farthest beyond a bound at that bound: the others have what is then
/// missed to make up for. False if there is none.
static bool hold_one(const struct surrogate_work *work, const double *centre, double *held) {
    const struct surrogate *s = work->surrogate;
    size_t farthest = 0;
    double max = 0, bound = 0;
    for (size_t a = 0; a < s->variables; a++) {
        const double place = centre[a] + work->delta[a], inside = fmin(1, fmax(0, place));
        if (fabs(place - inside) <= max + 1e-12)
            continue;
        max = fabs(place - inside);
        bound = inside;
        farthest = a;
    }
    if (max == 0)
        return false;
    const double step = bound - centre[farthest];
    held[farthest] = step;
    for (size_t j = 0; j < s->features; j++) {
        double *slope = work->model + j * work->terms + 1 + farthest;
        work->miss[j] -= *slope * step;
        *slope = 0;
    }
    return true;
}

/// The best step within the reach and the bounds of the variables.
static void take_step(const struct surrogate_work *work, const double *centre, double *held,
                      double reach) {
    do
        take_damped_step(work, held, reach);
    while (hold_one(work, centre, held));
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
    double *held = NULL;
    const size_t max = MAX_ROWS_PER_GENE * surrogate->variables + MORE_ROWS;
    enum status status =
        mf_surrogate_fit_rows(&work, surrogate, centre, kept, kept < max ? kept : max, false);
    CHECK(status);
    NEW_ARRAY(held, surrogate->variables);
    take_step(&work, centre, held, reach);
    for (size_t n = 0; n < surrogate->variables; n++)
        model->best[n] = fmin(1, fmax(0, centre[n] + work.delta[n]));
done:
    mf_memory_free(held);
    mf_surrogate_clear_rows(&work);
    return status;
}

/// How well it is known, by all rows: those of a region that has become narrow do not differ by
/// more than their noise, and would say nothing of slopes.
static enum status find_covariance(const struct surrogate *surrogate, const double *centre,
                                   size_t kept, struct surrogate_model *model) {
    struct surrogate_work work = {0};
    enum status status = mf_surrogate_fit_rows(&work, surrogate, centre, kept, kept, true);
    if (status == STATUS_OK) {
        factor_hessian(&work, 1 / (prior_width * prior_width));
        solve(&work, work.miss, NULL);
        add_noise(&work, model->covariance);
        status = correct(&work, model->covariance);
        add_held(&work, model->covariance);
        bound(work.hessian, model->covariance, surrogate->variables);
    }
    mf_surrogate_clear_rows(&work);
    return status;
}

enum status mf_surrogate_fit(const struct surrogate *surrogate, const double *centre, double reach,
                             struct surrogate_model *model, bool *known) {
    const size_t variables = surrogate->variables, added = (size_t)surrogate->rows.added;
    const size_t kept = added < surrogate->capacity ? added : surrogate->capacity;
    *model = (struct surrogate_model){.variables = variables};
    *known = kept >= mf_surrogate_min_rows(variables);
    if (!*known)
        return STATUS_OK;
    TRY_ARRAY(model->best, variables);
    TRY_ARRAY(model->covariance, variables * variables);
    TRY(find_best(surrogate, centre, kept, reach, model));
    return find_covariance(surrogate, centre, kept, model);
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
