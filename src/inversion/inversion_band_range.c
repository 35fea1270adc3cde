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

/// What lies beyond a range, over what its last fifth does, is the square of so many times the
/// share of the slope: of that of a law twice; a fit comes to its end with some two thirds of it,
/// as it makes up for what is cut off (screened Coulomb and star polymers).
static const double of_slope = 3;

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
    return share > 0 ? fmin(1, pow(of_slope * share, 2)) : 0; // of no bins, NaN, none
}

/// What is left of each outer bin: of those of a potential that ends before them 0.
/// @param[out] left  shape [known]
static void find_left(const struct inversion *inversion, const double *step, bool *outer,
                      double *left) {
    const struct potential_grid *grid = inversion_grid(inversion);
    const double range = range_of(inversion);
    for (size_t a = 0; a < grid->known; a++)
        outer[a] = a < grid->pairs_known && grid->r[grid->known_point[a]] > shorter * range;
    for (size_t pair = 0, first = 0; pair < grid->pairs; first += grid->known_of[pair++]) {
        const size_t end = first + grid->known_of[pair];
        const double beyond = find_beyond(inversion, step, first, end, outer);
        for (size_t a = first; a < end; a++)
            left[a] = (1 - beyond) * most_probable(inversion, step, a);
    }
}

/// The step that the equations ask for if the outer bins take that of them which leads to what is
/// left; false if rounding leaves none.
/// @param[in,out] normal  with its lower triangle; its factor
/// @param[in,out] x       what the equations ask for; the step of all
static bool solve_with_outer(const struct inversion *inversion, const bool *outer,
                             const double *left, gsl_matrix *normal, gsl_vector *x) {
    const size_t n = x->size, *point = inversion_grid(inversion)->known_point;
    const double *phi = inversion->course.phi;
    for (size_t a = 0; a < n; a++)
        for (size_t b = 0; b < n; b++)
            if (!outer[a] && outer[b])
                *gsl_vector_ptr(x, a) -= gsl_matrix_get(normal, a > b ? a : b, a > b ? b : a) *
                                         (left[b] - phi[point[b]]);
    for (size_t a = 0; a < n; a++) {
        if (outer[a])
            gsl_vector_set(x, a, left[a] - phi[point[a]]);
        for (size_t b = 0; b <= a; b++)
            if (outer[a] || outer[b])
                gsl_matrix_set(normal, a, b, a == b);
    }
    if (gsl_linalg_cholesky_decomp1(normal) != GSL_SUCCESS)
        return false;
    gsl_linalg_cholesky_svx(normal, x);
    return true;
}

/// The change of Φ without conventions, and whether there is one.
static enum status find_change(const struct inversion *inversion,
                               const struct inversion_band_without *without, gsl_vector *change,
                               bool *found) {
    enum status status = STATUS_OK;
    const size_t n = change->size;
    gsl_matrix *normal = gsl_matrix_alloc(n, n);
    bool *outer = NULL;
    double *left = NULL;
    CHECK(normal ? STATUS_OK : STATUS_NO_MEMORY);
    NEW_ARRAY(outer, n);
    NEW_ARRAY(left, n);
    find_left(inversion, without->step, outer, left);
    CHECK(mf_inversion_equations_without(&inversion->equations, without->birge, outer, normal,
                                         change));
    CHECK(mf_inversion_band_add_prior(inversion, *without->system, normal, change));
    *found = solve_with_outer(inversion, outer, left, normal, change);
    for (size_t a = 0; a < n; a++)
        *gsl_vector_ptr(change, a) -= without->step[a];
    CHECK(mf_inversion_band_take_conventions_off(inversion, NULL, change->data));
done:
    gsl_matrix_free(normal);
    mf_memory_free(outer);
    mf_memory_free(left);
    return status;
}

/// Σ w of the bins first … end − 1 alone; returns w·Σ w.
static double spread(const struct inversion *inversion, const double *weight, size_t first,
                     size_t end, double *with) {
    const size_t n = inversion_grid(inversion)->known;
    const double *covariance = inversion->course.band.covariance;
    double sum = 0;
    for (size_t a = 0; a < n; a++) {
        with[a] = 0;
        for (size_t b = first; b < end; b++)
            with[a] += covariance[a * n + b] * weight[b];
        sum += a >= first && a < end ? weight[a] * with[a] : 0;
    }
    return sum;
}

static double along(const double *weight, const double *change, size_t first, size_t end) {
    double sum = 0;
    for (size_t a = first; a < end; a++)
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
    const double bulk = along(slope, changes->row[0], 0, n);
    mf_inversion_band_take_off_curve(changes->row[0], n, k, slope);
    for (size_t a = 0; a < n; a++)
        changes->row[1][a] = bulk * k[a];
}

/// The share of the squares of the changes that is more than errors, in Σ already, make of the ramp
/// of a pair type: the largest of all.
static double find_share(const struct inversion *inversion, const double *weight,
                         const struct changes *changes, double *scratch) {
    const struct potential_grid *grid = inversion_grid(inversion);
    double share = 0;
    for (size_t pair = 0, first = 0; pair < grid->pairs; first += grid->known_of[pair++]) {
        const size_t end = first + grid->known_of[pair];
        const double variance = spread(inversion, weight, first, end, scratch);
        double squares = 0;
        for (int k = 0; k < 2; k++)
            squares += pow(along(weight, changes->row[k], first, end), 2);
        if (squares > variance)
            share = fmax(share, 1 - variance / squares);
    }
    return share;
}

/// Add the changes to Σ. What of them is not the move of Φ along A, as the data have it, is left if
/// A is known.
static void add_changes(struct inversion *inversion, const double *weight,
                        const struct changes *changes, double *scratch) {
    struct inversion_band *band = &inversion->course.band;
    const size_t n = inversion_grid(inversion)->known;
    const double share = find_share(inversion, weight, changes, scratch);
    if (!(share > 0))
        return;
    const double variance = spread(inversion, weight, 0, n, scratch);
    band->ramp.bulk_range =
        sqrt(share) * fabs(along(inversion->state->bulk.slope, changes->row[0], 0, n));
    for (int k = 0; k < 2; k++) {
        const double *change = changes->row[k], part = along(weight, change, 0, n) / variance;
        for (size_t a = 0; a < n; a++)
            band->beside_ramp[a] += share * pow(change[a] - part * scratch[a], 2);
    }
    for (int k = 0; k < 2; k++)
        mf_inversion_band_add_square(inversion, share, changes->row[k]);
}

enum status mf_inversion_band_add_range(struct inversion *inversion,
                                        const struct inversion_band_without *without) {
    enum status status = STATUS_OK;
    const struct potential_grid *grid = inversion_grid(inversion);
    gsl_vector *change = gsl_vector_calloc(grid->known), *more = gsl_vector_calloc(grid->known);
    double *scratch = NULL;
    bool found;
    inversion->course.band.ramp.bulk_range = 0;
    memset(inversion->course.band.beside_ramp, 0, grid->known * sizeof(double));
    if (grid->pairs == 0 || inversion->state->basis.count > 0)
        goto done;
    CHECK(change && more ? STATUS_OK : STATUS_NO_MEMORY);
    NEW_ARRAY(scratch, grid->known);
    CHECK(find_change(inversion, without, change, &found));
    struct changes changes = {{change->data, more->data}};
    meet(inversion, without->meet, &changes);
    if (found)
        add_changes(inversion, without->weight, &changes, scratch);
done:
    gsl_vector_free(change);
    gsl_vector_free(more);
    mf_memory_free(scratch);
    return status;
}
