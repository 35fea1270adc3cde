// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_covariance.h"

#include "base/memory.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_bspline.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

/// Cubic splines, of which a block with more bins has so many at least: of ten intervals. What g
/// hardly sees is what C makes of it last, a hundredth of what single pairs make, and the estimate
/// of the whole error does not ask for that.
enum { ORDER = 4, MIN_FUNCTIONS = 13 };

/// Bins to a function, from one choice to the next.
static const double coarser = 1.25;

/// C in units of sqrt(⟨S_a⟩ ⟨S_b⟩), and the functions of all blocks: columns of Q, orthonormal.
struct workspace {
    const struct inversion_covariance_blocks *blocks;
    double independent;
    gsl_vector *unit; ///< sqrt(⟨S⟩)
    gsl_matrix *c;
    gsl_matrix *q; ///< of each block, in its rows and its own first columns
    size_t *count; ///< functions of each block
};

static void workspace_free(struct workspace *w) {
    gsl_vector_free(w->unit);
    gsl_matrix_free(w->c);
    gsl_matrix_free(w->q);
    mf_memory_free(w->count);
}

static size_t largest_block(const struct inversion_covariance_blocks *blocks) {
    size_t largest = 1;
    for (size_t b = 0; b < blocks->blocks; b++)
        largest = blocks->size[b] > largest ? blocks->size[b] : largest;
    return largest;
}

static enum status workspace_init(struct workspace *w, const double *sampled, const double *mean) {
    enum status status = STATUS_OK;
    const size_t bins = w->blocks->bins;
    w->unit = gsl_vector_alloc(bins);
    w->c = gsl_matrix_alloc(bins, bins);
    w->q = gsl_matrix_calloc(bins, largest_block(w->blocks));
    CHECK(w->unit && w->c && w->q ? STATUS_OK : STATUS_NO_MEMORY);
    NEW_ARRAY(w->count, w->blocks->blocks);
    for (size_t a = 0; a < bins; a++)
        gsl_vector_set(w->unit, a, sqrt(fmax(0, mean[a])));
    for (size_t a = 0; a < bins; a++)
        for (size_t b = 0; b < bins; b++) {
            const double unit = gsl_vector_get(w->unit, a) * gsl_vector_get(w->unit, b);
            // An empty bin is as single pairs have it, and asks for no functions.
            gsl_matrix_set(w->c, a, b, unit > 0 ? sampled[a * bins + b] / unit : a == b);
        }
done:
    return status;
}

/// sqrt(⟨S⟩) times `count` B-splines over the bins of a block, orthonormal; those of all bins where
/// there are as many.
/// @param[in]  unit  sqrt(⟨S⟩) of the block
/// @param[out] q     shape [bins, count]
static enum status fill_functions(const gsl_vector *unit, gsl_matrix *q) {
    enum status status = STATUS_OK;
    const size_t bins = q->size1, count = q->size2;
    gsl_matrix *spline = NULL;
    gsl_vector *value = NULL, *reflect = NULL;
    gsl_bspline_workspace *splines = NULL;
    gsl_matrix_set_identity(q);
    if (count == bins)
        return STATUS_OK;
    spline = gsl_matrix_alloc(bins, count);
    value = gsl_vector_alloc(count);
    reflect = gsl_vector_alloc(count);
    splines = gsl_bspline_alloc(ORDER, count + 2 - ORDER);
    CHECK(spline && value && reflect && splines ? STATUS_OK : STATUS_NO_MEMORY);
    gsl_bspline_knots_uniform(0, (double)bins, splines);
    for (size_t a = 0; a < bins; a++) {
        gsl_bspline_eval((double)a + 0.5, value, splines);
        gsl_vector_scale(value, gsl_vector_get(unit, a));
        gsl_matrix_set_row(spline, a, value);
    }
    gsl_linalg_QR_decomp(spline, reflect);
    for (size_t k = 0; k < count; k++) {
        gsl_vector_view column = gsl_matrix_column(q, k);
        gsl_linalg_QR_Qvec(spline, reflect, &column.vector);
    }
done:
    gsl_matrix_free(spline);
    gsl_vector_free(value);
    gsl_vector_free(reflect);
    gsl_bspline_free(splines);
    return status;
}

/// to = Q_aᵀ C_ab Q_b of two blocks; `half` is scratch.
static void project(const gsl_matrix *qa, const gsl_matrix *c, const gsl_matrix *qb,
                    gsl_matrix *half, gsl_matrix *to) {
    gsl_blas_dgemm(CblasNoTrans, CblasNoTrans, 1, c, qb, 0, half);
    gsl_blas_dgemm(CblasTrans, CblasNoTrans, 1, qa, half, 0, to);
}

/// The estimated square of the error of a block, but for what all choices have in common.
static double estimate(const gsl_matrix *projected, double independent) {
    double followed = 0, squares = 0, trace = 0;
    for (size_t k = 0; k < projected->size1; k++) {
        trace += gsl_matrix_get(projected, k, k);
        for (size_t l = 0; l < projected->size2; l++) {
            const double c = gsl_matrix_get(projected, k, l);
            followed += pow(c - (k == l), 2);
            squares += c * c;
        }
    }
    return 2 * (trace * trace + squares) / independent - followed;
}

/// Try one number of functions of a block.
static enum status try_functions(const struct workspace *w, size_t first, size_t bins,
                                 gsl_matrix *q, double *found) {
    enum status status = STATUS_OK;
    const gsl_matrix_const_view c = gsl_matrix_const_submatrix(w->c, first, first, bins, bins);
    const gsl_vector_const_view unit = gsl_vector_const_subvector(w->unit, first, bins);
    gsl_matrix *half = NULL, *projected = NULL;
    CHECK(fill_functions(&unit.vector, q));
    if (q->size2 == bins) { // all of C, without two products of bins³
        *found = estimate(&c.matrix, w->independent);
        return STATUS_OK;
    }
    half = gsl_matrix_alloc(bins, q->size2);
    projected = gsl_matrix_alloc(q->size2, q->size2);
    CHECK(half && projected ? STATUS_OK : STATUS_NO_MEMORY);
    project(q, &c.matrix, q, half, projected);
    *found = estimate(projected, w->independent);
done:
    gsl_matrix_free(half);
    gsl_matrix_free(projected);
    return status;
}

/// The functions of one block: as many as have the smallest error.
static enum status choose_functions(struct workspace *w, size_t block, size_t first) {
    enum status status = STATUS_OK;
    const size_t bins = w->blocks->size[block];
    gsl_matrix *q = NULL;
    double best = INFINITY;
    for (double spacing = 1; bins > 0; spacing *= coarser) {
        const size_t count = (size_t)ceil((double)bins / spacing);
        double found;
        if (count < MIN_FUNCTIONS && w->count[block] > 0)
            break;
        gsl_matrix_free(q);
        q = gsl_matrix_alloc(bins, count);
        CHECK(q ? STATUS_OK : STATUS_NO_MEMORY);
        CHECK(try_functions(w, first, bins, q, &found));
        if (!(found < best) && w->count[block] > 0)
            continue;
        best = found;
        w->count[block] = count;
        gsl_matrix_view to = gsl_matrix_submatrix(w->q, first, 0, bins, count);
        gsl_matrix_memcpy(&to.matrix, q);
    }
done:
    gsl_matrix_free(q);
    return status;
}

/// Block a, b of C ← Q_a (Q_aᵀ C_ab Q_b) Q_bᵀ, and 1 − Q Qᵀ beside it where both are one.
static enum status smooth_block(struct workspace *w, size_t a, size_t first, size_t b,
                                size_t other) {
    enum status status = STATUS_OK;
    const size_t rows = w->blocks->size[a], columns = w->blocks->size[b];
    const size_t own = w->count[a], others = w->count[b];
    gsl_matrix *half = NULL, *projected = NULL;
    if (rows == 0 || columns == 0)
        return STATUS_OK;
    const gsl_matrix_const_view qa = gsl_matrix_const_submatrix(w->q, first, 0, rows, own);
    const gsl_matrix_const_view qb = gsl_matrix_const_submatrix(w->q, other, 0, columns, others);
    gsl_matrix_view c = gsl_matrix_submatrix(w->c, first, other, rows, columns);
    half = gsl_matrix_alloc(rows, others);
    projected = gsl_matrix_alloc(own, others);
    CHECK(half && projected ? STATUS_OK : STATUS_NO_MEMORY);
    project(&qa.matrix, &c.matrix, &qb.matrix, half, projected);
    gsl_blas_dgemm(CblasNoTrans, CblasNoTrans, 1, &qa.matrix, projected, 0, half);
    gsl_blas_dgemm(CblasNoTrans, CblasTrans, 1, half, &qb.matrix, 0, &c.matrix);
done:
    gsl_matrix_free(half);
    gsl_matrix_free(projected);
    return status;
}

static enum status smooth(struct workspace *w) {
    const struct inversion_covariance_blocks *blocks = w->blocks;
    for (size_t a = 0, first = 0; a < blocks->blocks; first += blocks->size[a++])
        for (size_t b = 0, other = 0; b < blocks->blocks; other += blocks->size[b++])
            TRY(smooth_block(w, a, first, b, other));
    return STATUS_OK;
}

/// C ← C + 1 − Q Qᵀ: what the functions do not follow is that of single pairs.
static void add_single(struct workspace *w) {
    const struct inversion_covariance_blocks *blocks = w->blocks;
    for (size_t block = 0, first = 0; block < blocks->blocks; first += blocks->size[block++]) {
        const size_t bins = blocks->size[block];
        if (bins == 0)
            continue;
        const gsl_matrix_const_view q =
            gsl_matrix_const_submatrix(w->q, first, 0, bins, w->count[block]);
        gsl_matrix_view c = gsl_matrix_submatrix(w->c, first, first, bins, bins);
        gsl_blas_dgemm(CblasNoTrans, CblasTrans, -1, &q.matrix, &q.matrix, 1, &c.matrix);
        gsl_matrix_add_diagonal(&c.matrix, 1);
    }
}

/// c ← s Q Qᵀ c in units of sqrt(⟨S⟩), s = 1 − noise/|Qᵀ c|² or 0.
static void smooth_density(const struct workspace *w,
                           const struct inversion_covariance_density *density) {
    const struct inversion_covariance_blocks *blocks = w->blocks;
    for (size_t block = 0, first = 0; block < blocks->blocks; first += blocks->size[block++]) {
        const double noise = (double)w->count[block] * density->variance / w->independent;
        const size_t last = first + blocks->size[block];
        double squares = 0;
        for (size_t a = first; a < last; a++)
            density->covariance[a] = 0;
        for (size_t k = 0; k < w->count[block]; k++) {
            double part = 0;
            for (size_t a = first; a < last; a++) {
                const double unit = gsl_vector_get(w->unit, a);
                part += unit > 0 ? gsl_matrix_get(w->q, a, k) * density->sampled[a] / unit : 0;
            }
            squares += part * part;
            for (size_t a = first; a < last; a++)
                density->covariance[a] += part * gsl_matrix_get(w->q, a, k);
        }
        const double share = squares > noise ? 1 - noise / squares : 0;
        for (size_t a = first; a < last; a++)
            density->covariance[a] *= share * gsl_vector_get(w->unit, a);
    }
}

enum status mf_inversion_covariance_find(const struct inversion_covariance_blocks *blocks,
                                         const double *sampled, const double *mean,
                                         double independent, double *covariance, double *shared,
                                         size_t *functions,
                                         const struct inversion_covariance_density *density) {
    enum status status = STATUS_OK;
    struct workspace w = {.blocks = blocks, .independent = independent};
    const size_t bins = blocks->bins;
    *functions = 0;
    CHECK(workspace_init(&w, sampled, mean));
    for (size_t block = 0, first = 0; block < blocks->blocks; first += blocks->size[block++]) {
        CHECK(choose_functions(&w, block, first));
        *functions += w.count[block];
    }
    CHECK(smooth(&w));
    if (density)
        smooth_density(&w, density);
    for (size_t a = 0; a < bins; a++)
        shared[a] = gsl_matrix_get(w.c, a, a) * pow(gsl_vector_get(w.unit, a), 2);
    add_single(&w);
    for (size_t a = 0; a < bins; a++)
        for (size_t b = 0; b < bins; b++)
            covariance[a * bins + b] =
                gsl_matrix_get(w.c, a, b) * gsl_vector_get(w.unit, a) * gsl_vector_get(w.unit, b);
done:
    workspace_free(&w);
    return status;
}
