// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"
#include "curves/shape.h"
#include "problem/group_kind.h"
#include "problem/parametrisation.h"

#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

// Curves ------------------------------------------------------------------------------------------

enum status mf_parametrisation_curves_init(const struct parametrisation *parametrisation,
                                           struct parametrisation_curves *curves) {
    *curves = (struct parametrisation_curves){0};
    for (int k = 0; k < INVERSE_PARAMETERS; k++)
        curves->parameter[k].error = NAN;
    for (int n = 0; n < INVERSE_MAX_NUMBERS; n++)
        curves->number[n].error = NAN;
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        const size_t points = mf_unknowns_points(&parametrisation->unknowns, kind);
        if (points == 0)
            continue;
        TRY_ARRAY(curves->value[kind], points);
        TRY_ARRAY(curves->error[kind], points);
        TRY_ARRAY(curves->flat[kind], INVERSE_FLAT * points);
    }
    return STATUS_OK;
}

void mf_parametrisation_curves_clear(struct parametrisation_curves *curves) {
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        mf_memory_free(curves->value[kind]);
        mf_memory_free(curves->error[kind]);
        mf_memory_free(curves->flat[kind]);
    }
    *curves = (struct parametrisation_curves){0};
}

void mf_parametrisation_curves_show(const struct parametrisation *parametrisation,
                                    const double *variables, struct parametrisation_curves *curves,
                                    struct inverse_step *step) {
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        if (curves->value[kind] == NULL)
            continue;
        mf_parametrisation_curve(parametrisation, kind, variables, curves->value[kind]);
        step->curve[kind] = curves->value[kind];
        step->curve_error[kind] = curves->error[kind];
        step->curve_flat[kind] = curves->flat[kind];
    }
    mf_parametrisation_parameters(parametrisation, variables, NULL, step->parameter);
    for (int k = 0; k < INVERSE_PARAMETERS; k++)
        step->parameter[k].error = curves->parameter[k].error;
    mf_parametrisation_numbers(parametrisation, variables, NULL, step->number);
    for (int n = 0; n < INVERSE_MAX_NUMBERS; n++)
        step->number[n].error = curves->number[n].error;
}

enum status mf_parametrisation_curves_bands(const struct parametrisation *parametrisation,
                                            const double *variables, const double *covariance,
                                            struct parametrisation_curves *curves) {
    for (int kind = 0; kind < UNKNOWNS; kind++)
        if (curves->error[kind])
            TRY(mf_parametrisation_band(parametrisation, kind, variables, covariance,
                                        curves->error[kind], curves->flat[kind]));
    mf_parametrisation_parameters(parametrisation, variables, covariance, curves->parameter);
    mf_parametrisation_numbers(parametrisation, variables, covariance, curves->number);
    return STATUS_OK;
}

size_t mf_parametrisation_curves_spans(const struct parametrisation *parametrisation,
                                       struct parametrisation_curves *curves,
                                       struct memory_span *spans) {
    size_t n = 0;
    spans[n++] = (struct memory_span){curves->parameter, sizeof curves->parameter};
    spans[n++] = (struct memory_span){curves->number, sizeof curves->number};
    for (int kind = 0; kind < UNKNOWNS; kind++) {
        const size_t bytes = mf_unknowns_points(&parametrisation->unknowns, kind) * sizeof(double);
        if (bytes == 0)
            continue;
        spans[n++] = (struct memory_span){curves->error[kind], bytes};
        spans[n++] = (struct memory_span){curves->flat[kind], INVERSE_FLAT * bytes};
    }
    return n;
}

// Coefficients of bonds ---------------------------------------------------------------------------

/// Sines and cosines of a dihedral, which goes round.
static void fill_waves(const struct bonded_grid *grid, size_t count, double *basis) {
    for (size_t k = 0; k < grid->known; k++) {
        const double phi = BONDED_RADIANS * mf_bonded_grid_place(grid, k);
        for (size_t n = 0; n < count; n++) {
            const double turns = (double)(n / 2 + 1);
            basis[k * count + n] = n % 2 ? sin(turns * phi) : cos(turns * phi);
        }
    }
}

/// B-splines from the first to the last known bin. The one that is left out at the end is the sum
/// of the others but for a constant; where the slope is left out, too, so is the first.
static enum status fill_splines(const struct bonded_grid *grid, size_t count, double *basis) {
    const size_t left_out = grid->is_level, all = count + left_out;
    OWNED double *place = NULL, *whole = NULL;
    TRY_ARRAY(place, grid->known);
    TRY_ARRAY(whole, grid->known * all);
    for (size_t k = 0; k < grid->known; k++)
        place[k] = (double)k / (double)(grid->known - 1);
    TRY(mf_shape_basis(mf_shapes[INVERSE_CURVE_BSPLINE], all, place, grid->known, whole));
    for (size_t k = 0; k < grid->known; k++)
        memcpy(basis + k * count, whole + k * all + left_out, count * sizeof *basis);
    return STATUS_OK;
}

/// Take off a function its part along another, x, by the target: Σ p x y/Σ p x² of it.
static void take_off(const struct bonded_grid *grid, size_t count, const double *x, double *y) {
    double products = 0, squares = 0;
    for (size_t k = 0; k < grid->known; k++) {
        const double p = grid->target[grid->first + k];
        products += p * x[k] * y[k * count];
        squares += p * x[k] * x[k];
    }
    for (size_t k = 0; k < grid->known; k++)
        y[k * count] -= products / squares * x[k];
}

enum status mf_parametrisation_bonded_basis(const struct bonded_grid *grid, size_t count,
                                            double *basis) {
    OWNED double *constant = NULL, *line = NULL;
    TRY_ARRAY(constant, grid->known);
    TRY_ARRAY(line, grid->known);
    for (size_t k = 0; k < grid->known; k++) {
        constant[k] = 1;
        line[k] = (double)k;
    }
    take_off(grid, 1, constant, line);
    if (mf_group_kind_is_periodic(grid->unknown->order))
        fill_waves(grid, count, basis);
    else
        TRY(fill_splines(grid, count, basis));
    for (size_t n = 0; n < count; n++) {
        take_off(grid, count, constant, basis + n);
        if (grid->is_level)
            take_off(grid, count, line, basis + n);
    }
    return STATUS_OK;
}

/// (k_B T σ/p)², of what was not seen that of what is hardly seen.
static void find_variances(const struct bonded_grid *grid, const double *target_error,
                           double *variance) {
    static const double min = 1e-12;
    double peak = 0;
    for (size_t k = 0; k < grid->known; k++)
        peak = fmax(peak, grid->target[grid->first + k]);
    for (size_t k = 0; k < grid->known; k++) {
        const double p = fmax(grid->target[grid->first + k], mf_bonded_distribution_seen * peak);
        const double error = target_error[grid->first + k];
        variance[k] = fmax(min, pow(grid->temperature * (isfinite(error) ? error : 0) / p, 2));
    }
}

enum status mf_parametrisation_bonded_rough(const struct bonded_grid *grid,
                                            const double *target_error, const double *basis,
                                            double *error) {
    static const double ridge = 1e-12;
    const size_t own = (size_t)grid->unknown->shape.coefficients, count = own + 1;
    OWNED double *normal = NULL, *row = NULL, *solved = NULL, *variance = NULL;
    TRY_ARRAY(normal, count * count);
    TRY_ARRAY(row, count);
    TRY_ARRAY(solved, count);
    TRY_ARRAY(variance, grid->known);
    find_variances(grid, target_error, variance);
    gsl_matrix_view factor = gsl_matrix_view_array(normal, count, count);
    const gsl_vector_const_view right = gsl_vector_const_view_array(row, count);
    gsl_vector_view left = gsl_vector_view_array(solved, count);
    for (int pass = 0; pass < 2; pass++) {
        for (size_t k = 0; k < grid->known; k++) {
            for (size_t a = 0; a < count; a++)
                row[a] = a < own ? basis[k * own + a] : 1;
            for (size_t a = 0; a < count && pass == 0; a++)
                for (size_t b = 0; b < count; b++)
                    normal[a * count + b] +=
                        row[a] * row[b] / variance[k] * (a == b ? 1 + ridge : 1);
            if (pass == 0)
                continue;
            gsl_linalg_cholesky_solve(&factor.matrix, &right.vector, &left.vector);
            double fitted = 0;
            for (size_t a = 0; a < count; a++)
                fitted += row[a] * solved[a];
            error[k] = sqrt(fmax(0, variance[k] - fitted));
        }
        if (pass == 0)
            gsl_linalg_cholesky_decomp1(&factor.matrix);
    }
    return STATUS_OK;
}

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
