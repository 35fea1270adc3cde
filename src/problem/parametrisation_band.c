// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/parametrisation.h"

#include "problem/parametrisation_bonded.h"

#include <math.h>
#include <string.h>

/// How the curve changes with each variable, shape [points, variables of it].
static enum status find_slopes(const struct parametrisation *parametrisation,
                               enum unknown_kind kind, const double *variables, double *slopes) {
    const double *range = parametrisation->range + parametrisation->first[kind];
    const size_t count = mf_parametrisation_variables(parametrisation, kind),
                 points = mf_unknowns_points(&parametrisation->unknowns, kind);
    OWNED double *moved = NULL, *curve = NULL;
    if (parametrisation->basis[kind]) {
        for (size_t k = 0; k < points * count; k++)
            slopes[k] = parametrisation->basis[kind][k] * range[k % count];
        return STATUS_OK;
    }
    TRY_ARRAY(moved, parametrisation->variables);
    TRY_ARRAY(curve, 2 * points);
    for (size_t n = 0; n < count; n++) {
        static const double step = 1e-3;
        for (int side = 0; side < 2; side++) {
            memcpy(moved, variables, parametrisation->variables * sizeof *variables);
            moved[parametrisation->first[kind] + n] += side ? step : -step;
            mf_parametrisation_curve(parametrisation, kind, moved, curve + (size_t)side * points);
        }
        for (size_t k = 0; k < points; k++)
            slopes[k * count + n] = (curve[points + k] - curve[k]) / (2 * step);
    }
    return STATUS_OK;
}

/// Make a vector's length 1, upwards where it is largest; returns what it was.
static double normalise(size_t count, double *vector) {
    double sum = 0, largest = 0;
    for (size_t k = 0; k < count; k++) {
        sum += vector[k] * vector[k];
        largest = fabs(vector[k]) > fabs(largest) ? vector[k] : largest;
    }
    const double length = sqrt(sum), factor = length > 0 ? copysign(1 / length, largest) : 0;
    for (size_t k = 0; k < count; k++)
        vector[k] *= factor;
    return length;
}

/// Take the part along `axis`, of any length, out of a vector.
static void remove_component(const double *axis, size_t count, double *vector) {
    double product = 0, square = 0;
    for (size_t k = 0; k < count; k++) {
        product += axis[k] * vector[k];
        square += axis[k] * axis[k];
    }
    for (size_t k = 0; k < count && square > 0; k++)
        vector[k] -= product / square * axis[k];
}

/// to = Σ of slopes and a vector of variables or, transposed, of points.
static void multiply(const double *slopes, size_t points, size_t count, const double *from,
                     double *to, bool transposed) {
    memset(to, 0, (transposed ? count : points) * sizeof *to);
    for (size_t k = 0; k < points; k++)
        for (size_t n = 0; n < count; n++)
            to[transposed ? n : k] += slopes[k * count + n] * from[transposed ? k : n];
}

/// Rounds of the power iteration, which only needs to tell the widest directions from the rest.
enum { POWER_ROUNDS = 200 };

/// Widest principal component of the curve's errors S C Sᵀ that is orthogonal to the `before` ones,
/// by power iteration; its length is one standard error.
static enum status find_flat(const double *slopes, const double *covariance, size_t points,
                             size_t count, const double *before, size_t before_count,
                             double *flat) {
    OWNED double *variable = NULL, *moved = NULL;
    double length = 0;
    TRY_ARRAY(variable, count);
    TRY_ARRAY(moved, count);
    for (size_t k = 0; k < points; k++)
        flat[k] = 1 + 0.1 * sin((double)(k * (before_count + 1)));
    for (int round = 0; round < POWER_ROUNDS; round++) {
        for (size_t n = 0; n < before_count; n++)
            remove_component(before + n * points, points, flat);
        length = normalise(points, flat);
        multiply(slopes, points, count, flat, variable, true);
        multiply(covariance, count, count, variable, moved, false);
        multiply(slopes, points, count, moved, flat, false);
    }
    for (size_t n = 0; n < before_count; n++)
        remove_component(before + n * points, points, flat);
    length = normalise(points, flat);
    for (size_t k = 0; k < points; k++)
        flat[k] *= sqrt(length);
    return STATUS_OK;
}

/// Errors of the points that follow the variables, from the slopes and the covariance of these
/// variables.
static void find_errors(const double *slopes, const double *covariance, size_t points, size_t count,
                        double *error) {
    for (size_t k = 0; k < points; k++) {
        const double *row = slopes + k * count;
        double sum = 0;
        for (size_t a = 0; a < count; a++)
            for (size_t b = 0; b < count; b++)
                sum += row[a] * row[b] * covariance[a * count + b];
        error[k] = sqrt(fmax(0, sum));
    }
}

/// A core is set: it has no error. Nor has what goes on beyond what a group's target knows.
static void clear_core(const struct parametrisation *parametrisation, enum unknown_kind kind,
                       double *values) {
    for (size_t k = 0; k < mf_unknowns_points(&parametrisation->unknowns, kind); k++)
        if ((kind == UNKNOWN_POTENTIAL &&
             mf_potential_grid_in_core(&parametrisation->unknowns.potential, k)) ||
            (kind == UNKNOWN_BONDED && !mf_unknowns_fits(&parametrisation->unknowns, kind, k)))
            values[k] = NAN;
}

/// The noise of the targets in the base of the groups.
static enum status add_rough(const struct parametrisation *parametrisation, double *error) {
    const struct potential_grid *grid = &parametrisation->unknowns.potential;
    const struct targets *targets = &parametrisation->unknowns.problem->targets;
    OWNED double *basis = NULL, *rough = NULL;
    for (size_t g = 0; g < grid->groups; g++) {
        const struct bonded_grid *own = &grid->group[g].own;
        const int kind = mf_bonded_distribution_kind(own->unknown->order);
        double *at = error + mf_unknowns_part(&parametrisation->unknowns, UNKNOWN_BONDED, g).first +
                     own->below;
        mf_memory_free(basis);
        mf_memory_free(rough);
        basis = rough = NULL;
        TRY_ARRAY(basis, own->known * (size_t)own->unknown->shape.coefficients);
        TRY_ARRAY(rough, own->known);
        TRY(mf_parametrisation_bonded_basis(own, (size_t)own->unknown->shape.coefficients, basis));
        TRY(mf_parametrisation_bonded_rough(own, targets->target[kind].error + own->unknown->first,
                                            basis, rough));
        for (size_t k = 0; k < own->known; k++)
            at[k] = hypot(at[k], rough[k]);
    }
    return STATUS_OK;
}

enum status mf_parametrisation_band(const struct parametrisation *parametrisation,
                                    enum unknown_kind kind, const double *variables,
                                    const double *covariance, double *error, double *flat) {
    const size_t count = mf_parametrisation_variables(parametrisation, kind),
                 at = parametrisation->first[kind];
    const size_t points = mf_unknowns_points(&parametrisation->unknowns, kind);
    OWNED double *slopes = NULL, *own = NULL;
    for (size_t k = 0; k < points; k++)
        error[k] = NAN;
    for (size_t k = 0; k < INVERSE_FLAT * points; k++)
        flat[k] = NAN;
    if (covariance == NULL)
        return STATUS_OK;
    TRY_ARRAY(slopes, points * count);
    TRY_ARRAY(own, count * count);
    for (size_t a = 0; a < count; a++)
        for (size_t b = 0; b < count; b++)
            own[a * count + b] = covariance[(at + a) * parametrisation->variables + at + b];
    TRY(find_slopes(parametrisation, kind, variables, slopes));
    find_errors(slopes, own, points, count, error);
    if (kind == UNKNOWN_BONDED)
        TRY(add_rough(parametrisation, error));
    for (size_t n = 0; n < INVERSE_FLAT; n++)
        TRY(find_flat(slopes, own, points, count, flat, n, flat + n * points));
    clear_core(parametrisation, kind, error);
    for (size_t n = 0; n < INVERSE_FLAT; n++)
        clear_core(parametrisation, kind, flat + n * points);
    return STATUS_OK;
}
