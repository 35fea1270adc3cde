// SPDX-License-Identifier: GPL-3.0-or-later
//
// GSL goes through a whole matrix for each row of the other. Here as much of B as stays in the
// cache is done with; each number is summed in the same order.
#include "inversion/triangular.h"

#include "base/memory.h"
#include "base/simd.h"

#include <string.h>

enum { COLUMNS = 32, ROWS = 8 }; ///< of B at once

/// Of `count` columns of B, packed: shape [n, COLUMNS].
SIMD_CLONES_UNFUSED static void solve_columns(const gsl_matrix *l, double *b, size_t count) {
    for (size_t i = 0; i < l->size1; i++) {
        double *row = b + i * COLUMNS;
        const double own = gsl_matrix_get(l, i, i);
        for (size_t c = 0; c < count; c++)
            row[c] /= own;
        for (size_t k = i + 1; k < l->size1; k++) {
            const double factor = l->data[k * l->tda + i];
            double *to = b + k * COLUMNS;
            if (factor != 0)
                for (size_t c = 0; c < COLUMNS; c++)
                    to[c] -= factor * row[c];
        }
    }
}

enum status mf_triangular_left(const gsl_matrix *l, gsl_matrix *b) {
    double *packed = mf_memory_zeroed(l->size1 * COLUMNS, sizeof *packed);
    if (packed == NULL)
        return STATUS_NO_MEMORY;
    for (size_t first = 0; first < b->size2; first += COLUMNS) {
        const size_t left = b->size2 - first, count = left < COLUMNS ? left : COLUMNS;
        for (size_t i = 0; i < b->size1; i++)
            memcpy(packed + i * COLUMNS, b->data + i * b->tda + first, count * sizeof *packed);
        solve_columns(l, packed, count);
        for (size_t i = 0; i < b->size1; i++)
            memcpy(b->data + i * b->tda + first, packed + i * COLUMNS, count * sizeof *packed);
    }
    mf_memory_free(packed);
    return STATUS_OK;
}

/// y ← y − x·factor
SIMD_CLONES_UNFUSED static void subtract(const double *x, double factor, double *restrict y,
                                         size_t count) {
    for (size_t k = 0; k < count; k++)
        y[k] -= x[k] * factor;
}

void mf_triangular_right(const gsl_matrix *r, gsl_matrix *b) {
    const size_t n = r->size1;
    for (size_t first = 0; first < b->size1; first += ROWS) {
        const size_t end = first + ROWS < b->size1 ? first + ROWS : b->size1;
        for (size_t j = 0; j < n; j++) {
            const double *from = r->data + j * r->tda;
            for (size_t i = first; i < end; i++) {
                double *to = b->data + i * b->tda;
                const double factor = to[j] /= from[j];
                subtract(from + j + 1, factor, to + j + 1, n - j - 1);
            }
        }
    }
}
