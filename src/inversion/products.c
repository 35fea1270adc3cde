// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/products.h"

#include "base/memory.h"
#include "base/simd.h"

#include <string.h>

/// Rows of a product with itself that are summed together, and columns of another product.
enum { BLOCK = 32, COLUMNS = 32 };

/// sum[i − first, j] = Σ_k a_ki a_kj for rows first … end − 1 and j ≤ i, in the order of k.
static void add_rows(const gsl_matrix *a, size_t first, size_t end, double *sum) {
    const size_t n = a->size2;
    for (size_t k = 0; k < a->size1; k++) {
        const double *row = a->data + k * a->tda;
        for (size_t i = first; i < end; i++) {
            const double factor = row[i];
            double *to = sum + (i - first) * n;
            if (factor == 0)
                continue;
            for (size_t j = 0; j <= i; j++)
                to[j] += factor * row[j];
        }
    }
}

enum status mf_products_gram(double alpha, const gsl_matrix *a, double beta, gsl_matrix *c) {
    const size_t n = a->size2;
    double *sum = mf_memory_zeroed(BLOCK * n, sizeof *sum);
    if (sum == NULL)
        return STATUS_NO_MEMORY;
    for (size_t first = 0; first < n; first += BLOCK) {
        const size_t end = first + BLOCK < n ? first + BLOCK : n;
        memset(sum, 0, BLOCK * n * sizeof *sum);
        add_rows(a, first, end, sum);
        for (size_t i = first; i < end; i++)
            for (size_t j = 0; j <= i; j++) {
                double *value = gsl_matrix_ptr(c, i, j);
                *value = (beta == 0 ? 0 : beta * *value) + alpha * sum[(i - first) * n + j];
            }
    }
    mf_memory_free(sum);
    return STATUS_OK;
}

/// Columns of B, packed.
struct columns {
    double *from; ///< shape [rows of B, COLUMNS]; the last ones may hold what is not read
    size_t first, count;
};

/// sum += Σ_k a_k b_k, over rows k of B.
SIMD_CLONES_UNFUSED static void add_products(const double *a, const double *b, size_t count,
                                             double *sum) {
    double own[COLUMNS];
    memcpy(own, sum, sizeof own);
    for (size_t k = 0; k < count; k++)
        if (a[k] != 0)
            for (size_t c = 0; c < COLUMNS; c++)
                own[c] += a[k] * b[k * COLUMNS + c];
    memcpy(sum, own, sizeof own);
}

static void add_row(const double *a, size_t row, size_t rows, const struct columns *b,
                    double *sum) {
    (void)row;
    add_products(a, b->from, rows, sum);
}

/// The diagonal first, then all before it together, then what is behind it.
static void add_symmetric_row(const double *a, size_t row, size_t rows, const struct columns *b,
                              double *sum) {
    double before[COLUMNS] = {0};
    add_products(a + row, b->from + row * COLUMNS, 1, sum);
    add_products(a, b->from, row, before);
    for (size_t c = 0; c < COLUMNS; c++)
        sum[c] += before[c];
    add_products(a + row + 1, b->from + (row + 1) * COLUMNS, rows - row - 1, sum);
}

static enum status multiply(const gsl_matrix *a, const gsl_matrix *b, gsl_matrix *c,
                            void (*add)(const double *, size_t, size_t, const struct columns *,
                                        double *)) {
    struct columns columns = {.from = mf_memory_zeroed(b->size1 * COLUMNS, sizeof(double))};
    if (columns.from == NULL)
        return STATUS_NO_MEMORY;
    for (; columns.first < b->size2; columns.first += COLUMNS) {
        const size_t left = b->size2 - columns.first;
        columns.count = left < COLUMNS ? left : COLUMNS;
        for (size_t k = 0; k < b->size1; k++)
            memcpy(columns.from + k * COLUMNS, b->data + k * b->tda + columns.first,
                   columns.count * sizeof(double));
        for (size_t i = 0; i < a->size1; i++) {
            double sum[COLUMNS] = {0};
            add(a->data + i * a->tda, i, a->size2, &columns, sum);
            memcpy(c->data + i * c->tda + columns.first, sum, columns.count * sizeof *sum);
        }
    }
    mf_memory_free(columns.from);
    return STATUS_OK;
}

enum status mf_products_find(const gsl_matrix *a, const gsl_matrix *b, gsl_matrix *c) {
    return multiply(a, b, c, add_row);
}

enum status mf_products_symmetric(gsl_matrix *a, const gsl_matrix *b, gsl_matrix *c) {
    for (size_t i = 0; i < a->size1; i++)
        for (size_t j = 0; j < i; j++)
            gsl_matrix_set(a, j, i, gsl_matrix_get(a, i, j));
    return multiply(a, b, c, add_symmetric_row);
}
