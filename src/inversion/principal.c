// SPDX-License-Identifier: GPL-3.0-or-later
//
// Simultaneous iteration: H. Rutishauser, Numer. Math. 13, 4 (1969). A few vectors more than are
// wanted are multiplied by the matrix, made orthogonal, and turned into the eigenvectors of the
// matrix among them.
#include "inversion/principal.h"

#include "base/memory.h"
#include "inversion/products.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>

enum { MORE = 6, MOST_ROUNDS = 200 };
static const double exact = 1e-11;

/// Work space: orthogonal vectors Q, their images, the matrix among them.
struct iteration {
    size_t n, count;
    gsl_matrix *q, *image, *among, *turn;
    gsl_vector *value, *scratch;
    gsl_eigen_symmv_workspace *work;
};

static void iteration_free(struct iteration *own) {
    gsl_matrix_free(own->q);
    gsl_matrix_free(own->image);
    gsl_matrix_free(own->among);
    gsl_matrix_free(own->turn);
    gsl_vector_free(own->value);
    gsl_vector_free(own->scratch);
    gsl_eigen_symmv_free(own->work);
}

static bool iteration_allocate(struct iteration *own, size_t n, size_t count) {
    *own = (struct iteration){.n = n,
                              .count = count,
                              .q = gsl_matrix_alloc(n, count),
                              .image = gsl_matrix_alloc(n, count),
                              .among = gsl_matrix_alloc(count, count),
                              .turn = gsl_matrix_alloc(count, count),
                              .value = gsl_vector_calloc(count),
                              .scratch = gsl_vector_alloc(count),
                              .work = gsl_eigen_symmv_alloc(count)};
    return own->q && own->image && own->among && own->turn && own->value && own->scratch &&
           own->work;
}

/// Images of vectors of chance, which miss no direction.
static enum status begin(const gsl_matrix *matrix, struct iteration *own) {
    uint32_t number = 1;
    for (size_t k = 0; k < own->n; k++)
        for (size_t c = 0; c < own->count; c++) {
            number = number * 1664525u + 1013904223u;
            gsl_matrix_set(own->q, k, c, number * 0x1p-32 - 0.5);
        }
    return mf_products_find(matrix, own->q, own->image);
}

/// Q ← orthogonal vectors that span the images; those that are none any more are any others.
static void make_orthogonal(struct iteration *own) {
    gsl_linalg_QR_decomp(own->image, own->scratch);
    for (size_t c = 0; c < own->count; c++) {
        gsl_vector_view column = gsl_matrix_column(own->q, c);
        gsl_vector_set_basis(&column.vector, c);
        gsl_linalg_QR_Qvec(own->image, own->scratch, &column.vector);
    }
}

/// How the vectors of Q are turned into the eigenvectors of the matrix among them. Returns the
/// largest change of the first `wanted` values, relative to the last of them.
static double turn(struct iteration *own, size_t wanted) {
    double change = 0;
    gsl_blas_dgemm(CblasTrans, CblasNoTrans, 1, own->q, own->image, 0, own->among);
    gsl_vector_memcpy(own->scratch, own->value);
    gsl_eigen_symmv(own->among, own->value, own->turn, own->work);
    gsl_eigen_symmv_sort(own->value, own->turn, GSL_EIGEN_SORT_VAL_DESC);
    for (size_t c = 0; c < wanted; c++)
        change =
            fmax(change, fabs(gsl_vector_get(own->value, c) - gsl_vector_get(own->scratch, c)));
    return change / fabs(gsl_vector_get(own->value, wanted - 1));
}

enum status mf_principal_find(const gsl_matrix *matrix, gsl_vector *values, gsl_matrix *vectors) {
    enum status status = STATUS_OK;
    struct iteration own;
    const size_t n = matrix->size1, wanted = values->size;
    const bool there = iteration_allocate(&own, n, wanted + MORE < n ? wanted + MORE : n);
    CHECK(there ? STATUS_OK : STATUS_NO_MEMORY);
    CHECK(begin(matrix, &own));
    double change = INFINITY;
    for (int round = 0; round < MOST_ROUNDS && change > exact; round++) {
        make_orthogonal(&own);
        CHECK(mf_products_find(matrix, own.q, own.image));
        change = turn(&own, wanted);
    }
    gsl_vector_const_view first = gsl_vector_const_subvector(own.value, 0, wanted);
    gsl_matrix_const_view turned = gsl_matrix_const_submatrix(own.turn, 0, 0, own.count, wanted);
    gsl_vector_memcpy(values, &first.vector);
    gsl_blas_dgemm(CblasNoTrans, CblasNoTrans, 1, own.q, &turned.matrix, 0, vectors);
done:
    iteration_free(&own);
    return status;
}
