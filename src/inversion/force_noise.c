// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/force_work.h"

#include "base/memory.h"

#include <gsl/gsl_blas.h>
#include <math.h>

static double entry_of(const double *packed, size_t k, size_t l) {
    return k >= l ? packed[k * (k + 1) / 2 + l] : packed[l * (l + 1) / 2 + k];
}

/// b − G c of a block, in the scale of the whole.
static void find_score(const struct force_work *w, size_t block, gsl_vector *score) {
    const struct force_equations *const e = w->equations;
    const double *const gram = e->gram + block * force_equations_entries(e);
    const double *const product = e->product + block * e->size;
    for (size_t k = 0; k < w->count; k++) {
        double left = product[w->place[k]];
        for (size_t l = 0; l < w->count; l++)
            left -= entry_of(gram, w->place[k], w->place[l]) * w->x[l] / w->scale[l];
        gsl_vector_set(score, k, left / w->scale[k]);
    }
}

/// Means over neighbouring directions.
static void smooth_noise(struct force_work *w, const double *single) {
    enum { NEIGHBOURS = 8 };
    for (size_t k = 0; k < w->count; k++) {
        double sum = 0, terms = 0;
        const size_t begin = k > NEIGHBOURS ? k - NEIGHBOURS : 0;
        for (size_t l = begin; l < w->count && l <= k + NEIGHBOURS; l++)
            if (force_work_is_determined(w, l)) {
                sum += single[l];
                terms++;
            }
        w->noise[k] = terms > 0 ? sum / terms : INFINITY;
    }
}

/// Variances of b of the whole along eigenvectors by those of the whole blocks.
enum status mf_force_noise_find(struct force_work *w) {
    const struct force_equations *const e = w->equations;
    const size_t blocks = e->frames / e->each;
    OWNED double *single = NULL, *along = NULL;
    TRY_ARRAY(single, w->count);
    TRY_ARRAY(along, blocks * w->count);
    for (size_t b = 0; b < blocks; b++) {
        gsl_vector_view part = gsl_vector_view_array(along + b * w->count, w->count);
        find_score(w, b, w->found);
        gsl_blas_dgemv(CblasTrans, 1, w->vectors, w->found, 0, &part.vector);
    }
    for (size_t k = 0; k < w->count; k++) {
        double mean = 0, squares = 0;
        for (size_t b = 0; b < blocks; b++)
            mean += along[b * w->count + k] / (double)blocks;
        for (size_t b = 0; b < blocks; b++)
            squares += pow(along[b * w->count + k] - mean, 2);
        single[k] = squares / (double)(blocks - 1) * (double)e->frames / (double)e->each /
                    gsl_vector_get(w->values, k);
    }
    smooth_noise(w, single);
    return STATUS_OK;
}
