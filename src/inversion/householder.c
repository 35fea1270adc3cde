// SPDX-License-Identifier: GPL-3.0-or-later
//
// GSL reflects all columns by one reflection after the other, and so goes through the whole matrix
// for each of them. Here a few columns, which stay in the cache, are reflected by all; each number
// is summed in the same order. What is 0 in a reflection changes nothing, and is left out: a prior
// is nearly empty.
#include "inversion/householder.h"

#include "base/memory.h"
#include "base/simd.h"

#include <gsl/gsl_linalg.h>

/// Columns of a panel: four registers of AVX2.
enum { LANE = 4, LANES = 4, PANEL = LANE * LANES };
typedef double lane __attribute__((vector_size(sizeof(double) * LANE)));

struct row {
    lane lane[LANES];
};

/// Reflections that are taken from the matrix at once: those of a cache line.
enum { AT_ONCE = 8 };

/// A few columns of a matrix, and the vectors that reflect them, from their second numbers on.
struct panel {
    size_t rows, first, columns; ///< of the matrix; its first column
    struct row *row;
    double *v; ///< shape [AT_ONCE, rows]
};

/// 1 − τ v vᵀ applied to the rows `first` and later, and to the columns `from` and later; v begins
/// with 1.
SIMD_CLONES_UNFUSED static void reflect_panel(const struct panel *panel, const double *v,
                                              size_t first, size_t from, double tau) {
    struct row *row = panel->row, sum = row[first];
    for (size_t k = first + 1; k < panel->rows; k++)
        if (v[k] != 0)
            for (int l = 0; l < LANES; l++)
                sum.lane[l] += v[k] * row[k].lane[l];
    for (size_t c = 0; c < from; c++)
        sum.lane[c / LANE][c % LANE] = 0;
    for (int l = 0; l < LANES; l++)
        row[first].lane[l] += sum.lane[l] * -tau;
    for (size_t k = first + 1; k < panel->rows; k++)
        if (v[k] != 0)
            for (int l = 0; l < LANES; l++)
                row[k].lane[l] += sum.lane[l] * (-tau * v[k]);
}

static double *number(const struct panel *panel, size_t row, size_t column) {
    return (double *)&panel->row[row] + column;
}

/// By what the columns before the panel's have left in the matrix.
static void reflect_by_earlier(const struct panel *panel, const gsl_matrix *a,
                               const gsl_vector *reflect) {
    for (size_t i = 0; i < panel->first; i += AT_ONCE) {
        for (size_t k = i + 1; k < panel->rows; k++)
            for (size_t n = 0; n < AT_ONCE; n++)
                panel->v[n * panel->rows + k] = a->data[k * a->tda + i + n];
        for (size_t n = 0; n < AT_ONCE; n++)
            reflect_panel(panel, panel->v + n * panel->rows, i + n, 0,
                          gsl_vector_get(reflect, i + n));
    }
}

/// Find the reflections of the panel's own columns.
static void reflect_by_own(const struct panel *panel, gsl_vector *reflect) {
    for (size_t c = 0; c < panel->columns; c++) {
        const size_t i = panel->first + c;
        gsl_vector_view column =
            gsl_vector_view_array_with_stride(number(panel, i, c), PANEL, panel->rows - i);
        const double tau = gsl_linalg_householder_transform(&column.vector);
        for (size_t k = i + 1; k < panel->rows; k++)
            panel->v[k] = *number(panel, k, c);
        reflect_panel(panel, panel->v, i, c + 1, tau);
        gsl_vector_set(reflect, i, tau);
    }
}

static void take(const gsl_matrix *a, struct panel *panel) {
    for (size_t k = 0; k < panel->rows; k++)
        for (size_t c = 0; c < panel->columns; c++)
            *number(panel, k, c) = gsl_matrix_get(a, k, panel->first + c);
}

static void put_back(const struct panel *panel, gsl_matrix *a) {
    for (size_t k = 0; k < panel->rows; k++)
        for (size_t c = 0; c < panel->columns; c++)
            gsl_matrix_set(a, k, panel->first + c, *number(panel, k, c));
}

enum status mf_householder_factor(gsl_matrix *a, gsl_vector *reflect) {
    enum status status = STATUS_OK;
    struct panel panel = {.rows = a->size1};
    NEW_ARRAY(panel.row, panel.rows);
    NEW_ARRAY(panel.v, AT_ONCE * panel.rows);
    for (; panel.first < a->size2; panel.first += PANEL) {
        const size_t left = a->size2 - panel.first;
        panel.columns = left < PANEL ? left : PANEL;
        take(a, &panel);
        reflect_by_earlier(&panel, a, reflect);
        reflect_by_own(&panel, reflect);
        put_back(&panel, a);
    }
done:
    mf_memory_free(panel.row);
    mf_memory_free(panel.v);
    return status;
}
