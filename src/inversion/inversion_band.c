// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion.h"

#include "inversion/principal.h"
#include "inversion/products.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

enum status mf_inversion_band_init(struct inversion_band *band, size_t known, size_t points) {
    enum status status = STATUS_OK;
    *band = (struct inversion_band){0};
    NEW_ARRAY(band->inverse, known * known);
    NEW_ARRAY(band->covariance, known * known);
    NEW_ARRAY(band->error, points);
    NEW_ARRAY(band->without_ramp, points);
    NEW_ARRAY(band->beside_ramp, known);
    NEW_ARRAY(band->flat, INVERSE_FLAT * points);
done:
    return status;
}

void mf_inversion_band_clear(struct inversion_band *band) {
    mf_memory_free(band->inverse);
    mf_memory_free(band->covariance);
    mf_memory_free(band->error);
    mf_memory_free(band->without_ramp);
    mf_memory_free(band->beside_ramp);
    mf_memory_free(band->flat);
    *band = (struct inversion_band){0};
}

size_t mf_inversion_band_spans(struct inversion_band *band, size_t points,
                               struct memory_span *span) {
    span[0] = (struct memory_span){band->error, points * sizeof(double)};
    span[1] = (struct memory_span){band->without_ramp, points * sizeof(double)};
    span[2] = (struct memory_span){band->flat, INVERSE_FLAT * points * sizeof(double)};
    span[3] = (struct memory_span){&band->ramp, sizeof band->ramp};
    span[4] = (struct memory_span){&band->drifts, sizeof band->drifts};
    return INVERSION_BAND_SPANS;
}

enum status mf_inversion_band_covariance(const struct imc_system *system, double birge,
                                         double *covariance, double *directions) {
    enum status status = STATUS_OK;
    const size_t size = system->size;
    const double unit = 1 / (system->temperature * system->temperature);
    gsl_matrix *prior = gsl_matrix_alloc(2 * size - 1, size);
    gsl_matrix *response = gsl_matrix_alloc(size, size), *known = gsl_matrix_calloc(size, size);
    gsl_matrix_view to = gsl_matrix_view_array(covariance, size, size);
    CHECK(prior && response && known ? STATUS_OK : STATUS_NO_MEMORY);
    CHECK(mf_imc_solve_rows(system, response, NULL));
    mf_imc_solve_prior(system, prior);
    CHECK(mf_products_gram(1 / birge, response, 0, known));
    gsl_matrix_memcpy(&to.matrix, known);
    CHECK(mf_products_gram(unit, prior, 1, &to.matrix));
    // Rounding may leave it not positive: then there is no band.
    if (gsl_linalg_cholesky_decomp1(&to.matrix) != GSL_SUCCESS ||
        gsl_linalg_cholesky_invert(&to.matrix) != GSL_SUCCESS)
        gsl_matrix_set_all(&to.matrix, GSL_NAN);
    // trace of F (F + prior)⁻¹; F has its lower triangle alone.
    *directions = 0;
    for (size_t a = 0; a < size; a++)
        for (size_t b = 0; b <= a; b++)
            *directions +=
                (a == b ? 1 : 2) * gsl_matrix_get(known, a, b) * covariance[a * size + b];
done:
    gsl_matrix_free(prior);
    gsl_matrix_free(response);
    gsl_matrix_free(known);
    return status;
}

/// Weights w of the best ramp, A = Σ w_a Φ_a, over the bins that are well known.
static void weigh_ramp(const struct inversion *inversion, double *weight) {
    const struct potential_grid *grid = inversion_grid(inversion);
    double squares = 0;
    for (size_t a = 0; a < grid->known; a++) {
        weight[a] = grid->well_known[a] ? mf_potential_grid_ramp(grid, grid->known_point[a]) : 0;
        squares += weight[a] * weight[a];
    }
    for (size_t a = 0; a < grid->pairs_known; a++)
        weight[a] /= squares;
}

/// out = M v; returns v·M v.
static double multiply(const double *matrix, size_t n, const double *v, double *out) {
    double product = 0;
    for (size_t a = 0; a < n; a++) {
        out[a] = 0;
        for (size_t b = 0; b < n; b++)
            out[a] += matrix[a * n + b] * v[b];
        product += v[a] * out[a];
    }
    return product;
}

/// out = Σ v; returns v·Σ v.
static double spread(const struct inversion *inversion, const double *v, double *out) {
    return multiply(inversion->course.band.covariance, inversion_grid(inversion)->known, v, out);
}

/// Σ ← Σ + factor u uᵀ.
void mf_inversion_band_add_square(struct inversion *inversion, double factor, const double *u) {
    const size_t n = inversion_grid(inversion)->known;
    for (size_t a = 0; a < n; a++)
        for (size_t b = 0; b < n; b++)
            inversion->course.band.covariance[a * n + b] += factor * u[a] * u[b];
}

enum status mf_inversion_band_add_prior(const struct inversion *inversion, struct imc_system system,
                                        gsl_matrix *normal, gsl_vector *asked) {
    enum status status = STATUS_OK;
    const struct inversion_course *course = &inversion->course;
    const size_t n = system.size, *point = inversion_grid(inversion)->known_point;
    const double unit = pow(system.temperature, -2);
    double *phi = NULL, *reference = NULL;
    gsl_matrix *prior = gsl_matrix_alloc(2 * n - 1, n);
    gsl_vector *left = gsl_vector_alloc(2 * n - 1);
    CHECK(prior && left ? STATUS_OK : STATUS_NO_MEMORY);
    NEW_ARRAY(phi, n);
    NEW_ARRAY(reference, n);
    for (size_t a = 0; a < n; a++) {
        phi[a] = course->phi[point[a]];
        reference[a] = course->reference[point[a]];
    }
    system.phi = phi;
    system.reference = reference;
    mf_imc_solve_prior(&system, prior);
    CHECK(mf_imc_solve_prior_excess(&system, prior, left));
    gsl_blas_dgemv(CblasTrans, unit, prior, left, 1, asked);
    if (normal)
        CHECK(mf_products_gram(unit, prior, 1, normal));
done:
    gsl_matrix_free(prior);
    gsl_vector_free(left);
    mf_memory_free(phi);
    mf_memory_free(reference);
    return status;
}

/// The most probable step, x = H⁻¹ [Bᵀ L⁻¹ excess − DᵀD (Φ − reference)] with W as large as Birge's
/// factor has it.
static enum status find_most_probable(const struct inversion *inversion,
                                      const struct imc_system *system, double birge, double *step) {
    enum status status = STATUS_OK;
    const size_t n = inversion_grid(inversion)->known;
    gsl_matrix *response = gsl_matrix_alloc(n, n);
    gsl_vector *excess = gsl_vector_alloc(n), *asked = gsl_vector_alloc(n);
    CHECK(response && excess && asked ? STATUS_OK : STATUS_NO_MEMORY);
    CHECK(mf_imc_solve_rows(system, response, excess));
    gsl_blas_dgemv(CblasTrans, 1 / birge, response, excess, 0, asked);
    CHECK(mf_inversion_band_add_prior(inversion, *system, NULL, asked));
    multiply(inversion->course.band.inverse, n, asked->data, step);
done:
    gsl_matrix_free(response);
    gsl_vector_free(excess);
    gsl_vector_free(asked);
    return status;
}

/// The step from here: the most probable one, unless the method has found it or steps by
/// coefficients.
static void find_step(const struct inversion *inversion, const double *most_probable,
                      double *step) {
    const struct potential_grid *grid = inversion_grid(inversion);
    const bool own =
        inversion->state->basis.count > 0 || (grid->groups > 0 && inversion->course.most_probable);
    for (size_t a = 0; a < grid->known; a++)
        step[a] = own ? inversion->course.step[grid->known_point[a]] : most_probable[a];
}

/// What this step would change of the number whose slope is v.
static struct inversion_band_drift find_drift(const struct inversion *inversion, const double *v,
                                              const double *step, double *scratch) {
    struct inversion_band_drift found = {0, sqrt(spread(inversion, v, scratch))};
    for (size_t a = 0; a < inversion_grid(inversion)->known; a++)
        found.drift += v[a] * step[a];
    return found;
}

static void find_drifts(struct inversion *inversion, const double *step, const double *weight,
                        double *scratch) {
    struct inversion_band_drifts *drifts = &inversion->course.band.drifts;
    drifts->ramp = find_drift(inversion, weight, step, scratch);
    for (size_t s = 0; s < inversion->states; s++)
        drifts->bulk[s] = find_drift(inversion, inversion->state[s].bulk.slope, step, scratch);
    inversion->course.band.ramp.drift = drifts->ramp.drift;
    inversion->course.band.ramp.bulk_drift = drifts->bulk[0].drift;
}

/// The way of A counts as an error, and near the targets so does that of the iteration before: as
/// steps scatter, the last may be small by chance. Σ ← Σ + (A/σ_A²)² Σw (Σw)ᵀ with the rms A, if
/// that is more.
static void add_drift(struct inversion *inversion, const double *weight, double *scratch) {
    const struct inversion_drifts *drifts = &inversion->course.progress.drifts;
    const double variance = spread(inversion, weight, scratch);
    double square = pow(inversion->course.band.drifts.ramp.drift, 2);
    if (drifts->near > 0)
        square =
            fmax(square,
                 0.5 * (square + pow(drifts->ramp[(drifts->near - 1) % INVERSION_MAX_DRIFTS], 2)));
    if (variance > 0) // without pairs there is no ramp
        mf_inversion_band_add_square(inversion, square / (variance * variance), scratch);
}

/// A pressure, or a density, with its error is met along u = H⁻¹p: Σ ← (1 − k pᵀ) Σ (1 − p kᵀ) +
/// σ_P² k kᵀ with k = u/(p·u). False if none is asked for, or it is among the equations.
/// @param[out] k  shape [known]
static bool meet_bulk(struct inversion *inversion, double *k) {
    const double *slope = inversion->state->bulk.slope;
    const size_t n = inversion_grid(inversion)->known;
    if (!mf_inversion_bulk_is_asked(inversion->state) || inversion->equations.reduced)
        return false;
    inversion->course.band.ramp.bulk_open = sqrt(spread(inversion, slope, k));
    const double noise =
        inversion->assessment.distance[mf_inversion_bulk_kind(inversion->state)].noise;
    const double along = multiply(inversion->course.band.inverse, n, slope, k);
    for (size_t a = 0; a < n; a++)
        k[a] /= along;
    mf_inversion_band_take_off(inversion->course.band.covariance, n, k, slope);
    mf_inversion_band_add_square(inversion, noise * noise, k);
    return true;
}

/// Standard errors, those of A, and those of Φ if A were known.
static void find_errors(struct inversion *inversion, const double *weight, double *scratch) {
    const struct potential_grid *grid = inversion_grid(inversion);
    struct inversion_band *band = &inversion->course.band;
    const size_t n = grid->known;
    const double ramp_variance = spread(inversion, weight, scratch);
    for (size_t a = 0; a < n; a++) {
        const double variance = band->covariance[a * n + a];
        const double of_ramp = ramp_variance > 0 ? scratch[a] * scratch[a] / ramp_variance : 0;
        const double min = mf_inversion_band_min_error(inversion, a);
        band->error[grid->known_point[a]] = variance >= 0 ? fmax(sqrt(variance), min) : NAN;
        const double left = fmin(variance, fmax(0, variance - of_ramp) + band->beside_ramp[a]);
        band->without_ramp[grid->known_point[a]] = variance >= 0 ? fmax(sqrt(left), min) : NAN;
    }
    for (size_t g = 0; g < grid->groups; g++) {
        mf_potential_grid_close(grid, g, band->error);
        mf_potential_grid_close(grid, g, band->without_ramp);
    }
    band->ramp.error = sqrt(ramp_variance);
    band->ramp.bulk = mf_inversion_bulk_ramp_slope(inversion->state);
    band->ramp.bins = (double)n;
}

/// Place of a flat direction at a point: those of pairs stand first, then those of groups.
static double *flat_at(const struct potential_grid *grid, const struct inversion_band *band,
                       size_t k, size_t point) {
    const size_t pairs = grid->pair_points;
    return point < pairs
               ? &band->flat[k * pairs + point]
               : &band->flat[INVERSE_FLAT * pairs + k * (grid->points - pairs) + (point - pairs)];
}

/// Widest principal components of the well-known bins, continued to the others.
static enum status find_flat(struct inversion *inversion) {
    enum status status = STATUS_OK;
    const struct potential_grid *grid = inversion_grid(inversion);
    const struct inversion_band *band = &inversion->course.band;
    const size_t n = grid->known;
    gsl_matrix *part = gsl_matrix_calloc(n, n), *vectors = gsl_matrix_alloc(n, INVERSE_FLAT);
    gsl_vector *values = gsl_vector_alloc(INVERSE_FLAT);
    CHECK(part && vectors && values ? STATUS_OK : STATUS_NO_MEMORY);
    for (size_t a = 0; a < n; a++)
        for (size_t b = 0; b < n; b++)
            if (grid->well_known[a] && grid->well_known[b])
                gsl_matrix_set(part, a, b, band->covariance[a * n + b]);
    CHECK(mf_principal_find(part, values, vectors));
    for (size_t k = 0; k < INVERSE_FLAT; k++)
        for (size_t a = 0; a < n; a++) {
            double sum = 0;
            for (size_t b = 0; b < n; b++)
                if (grid->well_known[b])
                    sum += band->covariance[a * n + b] * gsl_matrix_get(vectors, b, k);
            *flat_at(grid, band, k, grid->known_point[a]) = sum / sqrt(gsl_vector_get(values, k));
        }
done:
    gsl_matrix_free(part);
    gsl_matrix_free(vectors);
    gsl_vector_free(values);
    return status;
}

struct inversion_band_drift mf_inversion_band_farthest(const struct inversion *inversion) {
    const struct inversion_band_drift *bulk = inversion->course.band.drifts.bulk;
    size_t farthest = 0;
    for (size_t s = 1; s < inversion->states; s++)
        if (fabs(bulk[s].drift) * bulk[farthest].open > fabs(bulk[farthest].drift) * bulk[s].open)
            farthest = s;
    return bulk[farthest];
}

double mf_inversion_band_birge(const struct inversion_assessment *assessment) {
    return fmax(1, assessment->misfit);
}

double mf_inversion_band_prior(const struct inversion *inversion) {
    return mf_inversion_band_birge(&inversion->assessment) /
           pow(inversion->equations.system.temperature, 2);
}

/// Σ = H⁻¹ (TᵀV T/birge + prior) H⁻¹.
static enum status find_covariance(struct inversion *inversion, const struct imc_system *system,
                                   double birge) {
    enum status status = STATUS_OK;
    const size_t n = system->size;
    const double unit = pow(system->temperature, -2);
    gsl_matrix *prior = gsl_matrix_alloc(2 * n - 1, n), *half = gsl_matrix_alloc(n, n);
    gsl_matrix *middle = gsl_matrix_alloc(n, n);
    const gsl_matrix_const_view scatter =
        gsl_matrix_const_view_array(inversion->equations.scatter, n, n);
    const gsl_matrix_const_view inverse =
        gsl_matrix_const_view_array(inversion->course.band.inverse, n, n);
    gsl_matrix_view to = gsl_matrix_view_array(inversion->course.band.covariance, n, n);
    CHECK(prior && half && middle ? STATUS_OK : STATUS_NO_MEMORY);
    mf_imc_solve_prior(system, prior);
    gsl_matrix_memcpy(middle, &scatter.matrix);
    CHECK(mf_products_gram(unit, prior, 1 / birge, middle));
    CHECK(mf_products_symmetric(middle, &inverse.matrix, half));
    CHECK(mf_products_find(&inverse.matrix, half, &to.matrix));
done:
    gsl_matrix_free(prior);
    gsl_matrix_free(half);
    gsl_matrix_free(middle);
    return status;
}

/// H⁻¹ and Σ of the potential in bins, or of coefficients.
static enum status find_matrices(struct inversion *inversion, const struct imc_system *system,
                                 double birge) {
    struct inversion_band *band = &inversion->course.band;
    const size_t n = system->size;
    if (inversion->state->basis.count > 0) {
        TRY(mf_inversion_basis_covariance(inversion->state, band->covariance,
                                          &band->ramp.directions));
        memcpy(band->inverse, band->covariance, n * n * sizeof *band->inverse);
    } else {
        TRY(mf_inversion_band_covariance(system, birge, band->inverse, &band->ramp.directions));
        TRY(find_covariance(inversion, system, birge));
    }
    TRY(mf_inversion_band_take_conventions_off(inversion, band->inverse, NULL));
    return mf_inversion_band_take_conventions_off(inversion, band->covariance, NULL);
}

enum status mf_inversion_band_find(struct inversion *inversion) {
    enum status status = STATUS_OK;
    const struct potential_grid *grid = inversion_grid(inversion);
    struct inversion_band *band = &inversion->course.band;
    double *weight = NULL, *scratch = NULL, *step = NULL, *most_probable = NULL;
    const double birge = mf_inversion_band_birge(&inversion->assessment);
    struct imc_shape *shape = NULL;
    NEW_ARRAY(weight, grid->known);
    NEW_ARRAY(scratch, grid->known);
    NEW_ARRAY(step, grid->known);
    NEW_ARRAY(most_probable, grid->known);
    struct imc_system system = inversion->equations.system;
    NEW_ARRAY(shape, grid->blocks);
    mf_inversion_smooth_shapes(inversion, shape);
    system.shape = shape;
    CHECK(find_matrices(inversion, &system, birge));
    CHECK(find_most_probable(inversion, &system, birge, most_probable));
    weigh_ramp(inversion, weight);
    CHECK(mf_inversion_band_add_samples(inversion, birge, weight));
    find_step(inversion, most_probable, step);
    find_drifts(inversion, step, weight, scratch);
    add_drift(inversion, weight, scratch);
    const bool met = meet_bulk(inversion, scratch);
    const struct inversion_band_without without = {&system, birge, most_probable, weight,
                                                   met ? scratch : NULL};
    CHECK(mf_inversion_band_add_range(inversion, &without));
    if (!met)
        band->ramp.bulk_open = sqrt(spread(inversion, inversion->state->bulk.slope, scratch));
    find_errors(inversion, weight, scratch);
    if (!isnan(band->covariance[0]))
        CHECK(find_flat(inversion));
done:
    mf_memory_free(weight);
    mf_memory_free(scratch);
    mf_memory_free(shape);
    mf_memory_free(step);
    mf_memory_free(most_probable);
    return status;
}
