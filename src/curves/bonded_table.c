// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/bonded_table.h"

#include "base/memory.h"
#include "base/simd.h"

#include <gsl/gsl_spline.h>
#include <math.h>

/// Of the grid that is read in the place of the points: more than tables have.
enum { INTERVALS = 2048 };

/// Hermite's cubic between two points of the grid, where t goes from 0 to 1.
/// Beyond the ends the curve goes on as a straight line. The energy of NaN is NaN.
/// @param[in,out] energy  the places on the grid, from 0 on, and then the energies
SIMD_CLONES static void evaluate_places(const struct bonded_table *p, size_t count,
                                        double *restrict energy, double *restrict slope) {
    const double last = p->intervals, max = last - 1, inverse = 1 / p->spacing;
    const double(*restrict point)[2] = (const double(*)[2])p->point;
    for (size_t n = 0; n < count; n++) {
        const double place = energy[n], above = place > 0 ? place : 0;
        const double inside = above < last ? above : last, beyond = place - inside;
        const int k = (int)(inside < max ? inside : max);
        const double t = inside - k, u = 1 - t;
        const double a = point[k][0], b = point[k + 1][0];
        const double da = point[k][1], db = point[k + 1][1];
        const double rise = 6 * t * u * (b - a) + u * (1 - 3 * t) * da + t * (1 - 3 * u) * db;
        energy[n] = a + t * t * (3 - 2 * t) * (b - a) + t * u * (u * da - t * db) + rise * beyond;
        slope[n] = rise * inverse;
    }
}

void mf_bonded_table_evaluate(const void *parameters, size_t count, const double *q, double *energy,
                              double *slope) {
    const struct bonded_table *p = parameters;
    const double inverse = 1 / p->spacing, last = p->intervals;
    for (size_t n = 0; n < count; n++)
        energy[n] = (q[n] - p->first) * inverse;
    for (size_t n = 0; n < count && p->periodic; n++)
        energy[n] -= last * floor(energy[n] / last);
    evaluate_places(p, count, energy, slope);
}

double mf_bonded_table_rest(const void *parameters) {
    return ((const struct bonded_table *)parameters)->rest;
}

void mf_bonded_table_clear(void *parameters) {
    mf_memory_free(((struct bonded_table *)parameters)->point);
}

static enum status check_points(const struct bonded_kind *kind, const double *q,
                                const double *energy, size_t count) {
    static const double rounding = 1e-6;
    if (count < 4)
        return mf_status_fail(STATUS_BAD_INPUT, "a table needs at least 4 points, not %zu", count);
    for (size_t k = 1; k < count; k++)
        if (!(q[k] > q[k - 1]))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "the first column does not increase at point %zu", k + 1);
    const double span = q[count - 1] - q[0];
    if (kind->periodic && fabs(span - 360) > 360 * rounding)
        return mf_status_fail(STATUS_BAD_INPUT, "%s %s's table spans 360 degrees, not %g",
                              kind->article, kind->name, span);
    if (kind->periodic && fabs(energy[count - 1] - energy[0]) > rounding * (1 + fabs(energy[0])))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "the ends of %s %s's table are the same angle and have the "
                              "energies %g and %g",
                              kind->article, kind->name, energy[0], energy[count - 1]);
    if (kind->is_length || kind->periodic)
        return STATUS_OK;
    if (q[count - 1] < 7) // 2 pi, and no angle of a molecule
        return mf_status_fail(STATUS_BAD_INPUT,
                              "the angles end at %g, as if in radians; they are in degrees",
                              q[count - 1]);
    if (q[0] < kind->low || q[count - 1] > kind->high * (1 + rounding))
        return mf_status_fail(STATUS_BAD_INPUT, "%s are %g to %g degrees, not %g to %g",
                              kind->plural, kind->low, kind->high, q[0], q[count - 1]);
    return STATUS_OK;
}

/// The grid of a spline whose q is in `unit` of the curve's.
static void fill_grid(struct bonded_table *p, const gsl_spline *spline, double unit) {
    const double first = spline->x[0], last = spline->x[spline->size - 1];
    double min = INFINITY;
    p->first = unit * first;
    p->spacing = unit * (last - first) / INTERVALS;
    p->intervals = INTERVALS;
    for (int k = 0; k <= INTERVALS; k++) {
        const double q = fmin(first + (last - first) * k / INTERVALS, last);
        p->point[k][0] = gsl_spline_eval(spline, q, NULL);
        p->point[k][1] = gsl_spline_eval_deriv(spline, q, NULL) * (last - first) / INTERVALS;
        if (p->point[k][0] < min)
            p->rest = unit * q;
        min = fmin(min, p->point[k][0]);
    }
}

enum status mf_bonded_table_set_points(struct bonded_curve *curve, const double *q,
                                       const double *energy, size_t count) {
    enum status status = STATUS_OK;
    struct bonded_table *p = curve->parameters;
    gsl_spline *spline = NULL;
    double *values = NULL;
    const struct bonded_kind *kind = mf_bonded_kind_of_table(curve->law);
    TRY(check_points(kind, q, energy, count));
    p->periodic = kind->periodic;
    NEW_ARRAY(values, count);
    for (size_t k = 0; k < count; k++)
        values[k] = p->periodic && k + 1 == count ? energy[0] : energy[k];
    NEW_ARRAY(p->point, INTERVALS + 1);
    spline =
        gsl_spline_alloc(p->periodic ? gsl_interp_cspline_periodic : gsl_interp_cspline, count);
    if (spline == NULL || gsl_spline_init(spline, q, values, count) != 0)
        CHECK(mf_status_fail(STATUS_NO_MEMORY, "no memory for a table of %zu points", count));
    fill_grid(p, spline, kind->scale);
done:
    gsl_spline_free(spline);
    mf_memory_free(values);
    return status;
}

/// The least energy of the curve between points k and k + 1.
static double least_between(const struct bonded_curve *curve, const double *q, size_t k,
                            double unit) {
    enum { PLACES = 32 };
    double least = INFINITY;
    for (int n = 1; n < PLACES; n++) {
        double energy;
        mf_bonded_value(curve, unit * (q[k] + (q[k + 1] - q[k]) * n / PLACES), &energy, NULL);
        least = fmin(least, energy);
    }
    return least;
}

enum status mf_bonded_table_check_wells(const struct bonded_curve *curve, const double *q,
                                        const double *energy, size_t count) {
    static const double little = 1, accessible = 10;
    const double unit = mf_bonded_kind_of_table(curve->law)->scale;
    double min = INFINITY;
    for (size_t k = 0; k < count; k++)
        min = fmin(min, energy[k]);
    for (size_t k = 0; k + 1 < count; k++) {
        const double left = k > 0 ? fabs(energy[k] - energy[k - 1]) : 0;
        const double right = k + 2 < count ? fabs(energy[k + 2] - energy[k + 1]) : 0;
        const double allowed = fmax(little, fabs(energy[k + 1] - energy[k]) + fmin(left, right));
        const double least = least_between(curve, q, k, unit);
        if (least >= fmin(energy[k], energy[k + 1]) - allowed || least > min + accessible)
            continue;
        return mf_status_fail(STATUS_BAD_INPUT,
                              "between rows %zu and %zu of numbers, of %.4g and %.4g" STATUS_ENERGY
                              ", the cubic spline through them has a well of %.4g" STATUS_ENERGY
                              ", as beside a step: write smaller steps of the energy there, or "
                              "leave out the rows behind it",
                              k + 1, k + 2, energy[k], energy[k + 1], least);
    }
    return STATUS_OK;
}
