// SPDX-License-Identifier: GPL-3.0-or-later
//
// The error that the range of potentials of pairs adds to their band.
#include "inversion/inversion.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

/// A shorter range, in that of the fit.
static const double shorter = 0.8;

/// The share s of the height of the last fifth that the slope of a law at its end makes is so many
/// times that of a fit's potential, which makes up for what is cut off (screened Coulomb and star
/// polymers); what is larger cannot be told.
static const double of_slope = 1.5, most = 0.7;

/// What lies beyond a range moves the pressure by s/(1 − s) times this, over what the last fifth
/// does.
static const double beyond_of_share = 1.5;

static double range_of(const struct inversion *inversion) {
    const struct rdf_bins *bins = &inversion->problem->targets.bins;
    return bins->low + (double)bins->count * bins->width;
}

/// The most probable potential at a known bin.
static double most_probable(const struct inversion *inversion, const double *step, size_t a) {
    return inversion->course.phi[inversion_grid(inversion)->known_point[a]] + step[a];
}

/// How much of what its last fifth does to a curve lies beyond its end, by its slope there: that of
/// a d + b d², fitted to the bins first … end − 1 that are outer, d from the end.
static double find_beyond(const struct inversion *inversion, const double *step, size_t first,
                          size_t end, const bool *outer) {
    const double range = range_of(inversion), fifth = (1 - shorter) * range;
    double s2 = 0, s3 = 0, s4 = 0, y1 = 0, y2 = 0;
    for (size_t k = first; k < end; k++) {
        const double d =
            range - inversion_grid(inversion)->r[inversion_grid(inversion)->known_point[k]];
        const double y = most_probable(inversion, step, k);
        if (!outer[k])
            continue;
        s2 += d * d;
        s3 += d * d * d;
        s4 += d * d * d * d;
        y1 += d * y;
        y2 += d * d * y;
    }
    const double slope = y1 * s4 - y2 * s3, bend = y2 * s2 - y1 * s3; // times s2 s4 − s3²
    const double share = slope / (slope + bend * fifth);
    if (!(share > 0)) // of no bins, NaN, none
        return 0;
    const double whole = fmin(most, of_slope * share);
    return beyond_of_share * whole / (1 - whole);
}

/// The bins beyond the shorter range, and how much of each is to be gone; of others 0.
/// @param[out] outer, gone  shape [known]
static void find_gone(const struct inversion *inversion, const double *step, bool *outer,
                      double *gone) {
    const struct potential_grid *grid = inversion_grid(inversion);
    const double range = range_of(inversion);
    for (size_t a = 0; a < grid->known; a++)
        outer[a] = a < grid->pairs_known && grid->r[grid->known_point[a]] > shorter * range;
    for (size_t pair = 0, first = 0; pair < grid->pairs; first += grid->known_of[pair++]) {
        const size_t end = first + grid->known_of[pair];
        const double beyond = find_beyond(inversion, step, first, end, outer);
        for (size_t a = first; a < end; a++)
            gone[a] = outer[a] ? beyond : 0;
    }
}

/// A symmetric matrix of which the lower triangle is known.
static double symmetric(const gsl_matrix *matrix, size_t a, size_t b) {
    return gsl_matrix_get(matrix, a > b ? a : b, a > b ? b : a);
}

/// Leave of the equations those of the inner bins alone, and factor them; false if rounding leaves
/// none.
static bool factor_inner(const bool *outer, gsl_matrix *normal) {
    for (size_t a = 0; a < normal->size1; a++)
        for (size_t b = 0; b <= a; b++)
            if (outer[a] || outer[b])
                gsl_matrix_set(normal, a, b, a == b);
    return gsl_linalg_cholesky_decomp1(normal) == GSL_SUCCESS;
}

/// What the equations make of the inner bins if the outer ones change by −gone Φ.
/// @param[out] x  the change
static void solve_inner(const struct inversion *inversion, const double *step, const bool *outer,
                        const double *gone, const gsl_matrix *all, const gsl_matrix *inner,
                        gsl_vector *x) {
    gsl_vector_set_zero(x);
    for (size_t b = 0; b < x->size; b++) {
        const double change = -gone[b] * most_probable(inversion, step, b);
        for (size_t a = 0; outer[b] && a < x->size; a++)
            if (!outer[a])
                *gsl_vector_ptr(x, a) -= symmetric(all, a, b) * change;
        if (outer[b])
            gsl_vector_set(x, b, change);
    }
    gsl_linalg_cholesky_svx(inner, x);
}

/// The variance that the errors of the outer bins make of the change of a pair type's ramp: a
/// change e of them changes it by Σ_o e_o (w_o − Σ_i H_oi y_i), H y = w among the inner bins.
/// @param[in,out] y  w of the pair type; scratch
static double find_noise(const struct inversion *inversion, const bool *outer, const double *gone,
                         const gsl_matrix *all, const gsl_matrix *inner, gsl_vector *y) {
    const size_t n = y->size;
    const double *covariance = inversion->course.band.covariance;
    double sum = 0;
    gsl_linalg_cholesky_svx(inner, y); // leaves w in the outer bins
    for (size_t o = 0; o < n; o++)
        for (size_t i = 0; outer[o] && i < n; i++)
            if (!outer[i])
                *gsl_vector_ptr(y, o) -= symmetric(all, o, i) * gsl_vector_get(y, i);
    for (size_t a = 0; a < n; a++)
        for (size_t b = 0; outer[a] && b < n; b++)
            if (outer[b])
                sum += gone[a] * gone[b] * gsl_vector_get(y, a) * gsl_vector_get(y, b) *
                       covariance[a * n + b];
    return sum;
}

/// The share of the squares of the change that is more than errors, in Σ already, make of the ramp
/// of a pair type: the largest of all.
static double find_share(const struct inversion *inversion, const double *weight, const bool *outer,
                         const double *gone, const gsl_matrix *all, const gsl_matrix *inner,
                         const gsl_vector *change, gsl_vector *y) {
    const struct potential_grid *grid = inversion_grid(inversion);
    double share = 0;
    for (size_t pair = 0, first = 0; pair < grid->pairs; first += grid->known_of[pair++]) {
        double ramp = 0;
        gsl_vector_set_zero(y);
        for (size_t a = first; a < first + grid->known_of[pair]; a++) {
            gsl_vector_set(y, a, weight[a]);
            ramp += weight[a] * gsl_vector_get(change, a);
        }
        const double noise = find_noise(inversion, outer, gone, all, inner, y);
        if (ramp * ramp > noise)
            share = fmax(share, 1 - noise / (ramp * ramp));
    }
    return share;
}

/// The change of Φ without conventions, beyond noise; 0: there is none.
static enum status find_change(const struct inversion *inversion,
                               const struct inversion_band_without *without, gsl_vector *change) {
    enum status status = STATUS_OK;
    const size_t n = change->size;
    gsl_matrix *all = gsl_matrix_alloc(n, n), *inner = gsl_matrix_alloc(n, n);
    gsl_vector *y = gsl_vector_alloc(n);
    bool *outer = NULL;
    double *gone = NULL, share = 0;
    CHECK(all && inner && y ? STATUS_OK : STATUS_NO_MEMORY);
    NEW_ARRAY(outer, n);
    NEW_ARRAY(gone, n);
    find_gone(inversion, without->step, outer, gone);
    CHECK(mf_inversion_equations_without(&inversion->equations, without->birge, outer, all, y));
    CHECK(mf_inversion_band_add_prior(inversion, *without->system, all, y));
    gsl_matrix_memcpy(inner, all);
    if (factor_inner(outer, inner)) {
        solve_inner(inversion, without->step, outer, gone, all, inner, change);
        share = find_share(inversion, without->weight, outer, gone, all, inner, change, y);
    }
    gsl_vector_scale(change, sqrt(share));
    CHECK(mf_inversion_band_take_conventions_off(inversion, NULL, change->data));
done:
    gsl_matrix_free(all);
    gsl_matrix_free(inner);
    gsl_vector_free(y);
    mf_memory_free(outer);
    mf_memory_free(gone);
    return status;
}

static double along(const double *weight, const double *change, size_t n) {
    double sum = 0;
    for (size_t a = 0; a < n; a++)
        sum += weight[a] * change[a];
    return sum;
}

/// What the range may change: δ, and where a pressure is met, what makes up for that of what lies
/// beyond the range, else 0.
struct changes {
    double *row[2]; ///< of shape [known]
};

/// The pressure that δ changes is met, and may be as much off.
static void meet(const struct inversion *inversion, const double *k, struct changes *changes) {
    const double *slope = inversion->state->bulk.slope;
    const size_t n = inversion_grid(inversion)->known;
    if (k == NULL)
        return;
    const double bulk = along(slope, changes->row[0], n);
    mf_inversion_band_take_off_curve(changes->row[0], n, k, slope);
    for (size_t a = 0; a < n; a++)
        changes->row[1][a] = bulk * k[a];
}

/// Add the changes to Σ. What of them is not the move of Φ along A, as the data have it, is left if
/// A is known.
static void add_changes(struct inversion *inversion, const double *weight,
                        const struct changes *changes, double *scratch) {
    struct inversion_band *band = &inversion->course.band;
    const size_t n = inversion_grid(inversion)->known;
    const double variance = mf_inversion_band_spread(inversion, weight, scratch);
    band->ramp.bulk_range = fabs(along(inversion->state->bulk.slope, changes->row[0], n));
    for (int k = 0; k < 2; k++) {
        const double *change = changes->row[k];
        const double part = variance > 0 ? along(weight, change, n) / variance : 0;
        for (size_t a = 0; a < n; a++)
            band->beside_ramp[a] += pow(change[a] - part * scratch[a], 2);
    }
    for (int k = 0; k < 2; k++)
        mf_inversion_band_add_square(inversion, 1, changes->row[k]);
}

enum status mf_inversion_band_add_range(struct inversion *inversion,
                                        const struct inversion_band_without *without) {
    enum status status = STATUS_OK;
    const struct potential_grid *grid = inversion_grid(inversion);
    gsl_vector *change = gsl_vector_calloc(grid->known), *more = gsl_vector_calloc(grid->known);
    double *scratch = NULL;
    inversion->course.band.ramp.bulk_range = 0;
    memset(inversion->course.band.beside_ramp, 0, grid->known * sizeof(double));
    if (grid->pairs == 0 || inversion->state->basis.count > 0)
        goto done;
    CHECK(change && more ? STATUS_OK : STATUS_NO_MEMORY);
    NEW_ARRAY(scratch, grid->known);
    CHECK(find_change(inversion, without, change));
    struct changes changes = {{change->data, more->data}};
    meet(inversion, without->meet, &changes);
    add_changes(inversion, without->weight, &changes, scratch);
done:
    gsl_vector_free(change);
    gsl_vector_free(more);
    mf_memory_free(scratch);
    return status;
}
