// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/gram.h"

#include "base/memory.h"

#include <string.h>

/// Rows of C that are summed together, so that they stay in the cache.
enum { BLOCK = 32 };

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

enum status mf_gram(double alpha, const gsl_matrix *a, double beta, gsl_matrix *c) {
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
