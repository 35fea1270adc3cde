// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/comoments.h"

#include <string.h>

enum status mf_comoments_init(struct comoments *moments, size_t size) {
    enum status status = STATUS_OK;
    *moments = (struct comoments){.size = size};
    NEW_ARRAY(moments->mean, size);
    NEW_ARRAY(moments->comoment, size * size);
    NEW_ARRAY(moments->scratch, size);
done:
    if (status != STATUS_OK)
        mf_comoments_clear(moments);
    return status;
}

void mf_comoments_clear(struct comoments *moments) {
    mf_memory_free(moments->mean);
    mf_memory_free(moments->comoment);
    mf_memory_free(moments->scratch);
    *moments = (struct comoments){0};
}

void mf_comoments_reset(struct comoments *moments) {
    moments->count = 0;
    memset(moments->mean, 0, moments->size * sizeof *moments->mean);
    memset(moments->comoment, 0, moments->size * moments->size * sizeof *moments->comoment);
}

size_t mf_comoments_spans(struct comoments *moments, struct memory_span *spans) {
    const size_t n = moments->size;
    spans[0] = (struct memory_span){&moments->count, sizeof moments->count};
    spans[1] = (struct memory_span){moments->mean, n * sizeof *moments->mean};
    spans[2] = (struct memory_span){moments->comoment, n * n * sizeof *moments->comoment};
    return 3;
}

/// comoment += weight · d dᵀ with d in `scratch`.
static void add_outer_product(struct comoments *moments, double weight) {
    const size_t n = moments->size;
    const double *d = moments->scratch;
    for (size_t a = 0; a < n; a++) {
        const double factor = weight * d[a];
        double *row = moments->comoment + a * n;
        for (size_t b = 0; b < n; b++)
            row[b] += factor * d[b];
    }
}

void mf_comoments_add(struct comoments *moments, const double *x) {
    const double before = moments->count;
    moments->count += 1;
    for (size_t a = 0; a < moments->size; a++) {
        moments->scratch[a] = x[a] - moments->mean[a];
        moments->mean[a] += moments->scratch[a] / moments->count;
    }
    add_outer_product(moments, before / moments->count);
}

void mf_comoments_merge(struct comoments *moments, const struct comoments *other) {
    if (other->count == 0)
        return;
    const double before = moments->count;
    moments->count += other->count;
    const double fraction = other->count / moments->count;
    for (size_t a = 0; a < moments->size; a++) {
        moments->scratch[a] = other->mean[a] - moments->mean[a];
        moments->mean[a] += fraction * moments->scratch[a];
    }
    for (size_t k = 0; k < moments->size * moments->size; k++)
        moments->comoment[k] += other->comoment[k];
    add_outer_product(moments, before * fraction);
}

double mf_comoments_covariance(const struct comoments *moments, size_t a, size_t b) {
    if (moments->count < 1)
        return 0;
    return moments->comoment[a * moments->size + b] / moments->count;
}
