// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/force_work.h"

#include "inversion/imc_solve.h"

#include <math.h>

/// Nodes within which the force of bonded terms may bend by itself.
static const double bend = 8;

/// How many k_B T the force is within ℓ, of a node and those beside it.
static double steepness(const struct force_work *w, size_t n, size_t k, double length) {
    double sum = 0, terms = 0;
    for (size_t l = k > w->begin[n] ? k - 1 : k; l < w->begin[n + 1] && l <= k + 1; l++, terms++)
        sum += fabs(w->x[l] / w->scale[l]);
    return sum / terms * length / w->temperature;
}

/// Add the square of a row of so many numbers.
static void add_row(struct force_work *w, const size_t *column, const double *number,
                    size_t count) {
    for (size_t a = 0; a < count; a++)
        for (size_t b = 0; b < count; b++)
            *gsl_matrix_ptr(w->prior, column[a], column[b]) +=
                number[a] * number[b] / (w->scale[column[a]] * w->scale[column[b]]);
}

/// Second differences of the force within ℓ over what it is.
static void add_differences(struct force_work *w, size_t n) {
    const struct force_curve *const curve = &w->equations->curve[n];
    const size_t begin = w->begin[n], count = w->begin[n + 1] - begin;
    const bool circle = force_curve_is_circle(curve);
    const double length =
        curve->order == FORCES_OF_PAIRS ? mf_imc_smooth_length : bend * curve->width;
    for (size_t k = circle ? 0 : 1; count >= 3 && k + (circle ? 0 : 1) < count; k++) {
        const double factor = sqrt(w->strength[n]) * pow(length / curve->width, 2) * length /
                              w->temperature / (1 + steepness(w, n, begin + k, length));
        const size_t column[3] = {begin + (k + count - 1) % count, begin + k,
                                  begin + (k + 1) % count};
        add_row(w, column, (const double[3]){factor, -2 * factor, factor}, 3);
    }
}

/// U is the same all around a circle.
static void close_circle(struct force_work *w, size_t n) {
    static const double open = 1e-3; // k_B T
    size_t column[FORCES_MAX_NODES];
    double number[FORCES_MAX_NODES];
    const size_t count = w->begin[n + 1] - w->begin[n];
    for (size_t k = 0; k < count; k++) {
        column[k] = w->begin[n] + k;
        number[k] = w->equations->curve[n].width / (w->temperature * open);
    }
    add_row(w, column, number, count);
}

void mf_force_prior_fill(struct force_work *w) {
    gsl_matrix_set_zero(w->prior);
    for (size_t n = 0; n < w->equations->curves; n++) {
        add_differences(w, n);
        if (force_curve_is_circle(&w->equations->curve[n]))
            close_circle(w, n);
    }
}

double mf_force_prior_rank(const struct force_work *w, size_t n) {
    const size_t count = w->begin[n + 1] - w->begin[n];
    const double less = force_curve_is_circle(&w->equations->curve[n]) ? 1 : 2;
    return count >= 3 ? (double)count - less : 0;
}
