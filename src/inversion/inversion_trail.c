// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_trail.h"

enum status mf_inversion_trail_init(struct inversion_trail *trail, size_t capacity, size_t bins,
                                    size_t singular_values) {
    enum status status = STATUS_OK;
    *trail = (struct inversion_trail){
        .capacity = capacity, .bins = bins, .singular_values = singular_values};
    NEW_ARRAY(trail->excess, capacity * bins);
    if (singular_values == 0)
        return STATUS_OK;
    NEW_ARRAY(trail->singular, capacity * singular_values);
    NEW_ARRAY(trail->used, singular_values);
done:
    return status;
}

void mf_inversion_trail_clear(struct inversion_trail *trail) {
    mf_memory_free(trail->excess);
    mf_memory_free(trail->singular);
    mf_memory_free(trail->used);
    *trail = (struct inversion_trail){0};
}

void mf_inversion_trail_take(const struct inversion_trail *trail, struct imc_system *system) {
    if (trail->singular_values == 0)
        return;
    system->singular = trail->singular + trail->iterations * trail->singular_values;
    system->used = trail->used;
}

void mf_inversion_trail_add(struct inversion_trail *trail, const double *counts,
                            const double *target_counts) {
    double *excess = trail->excess + trail->iterations++ * trail->bins;
    for (size_t bin = 0; bin < trail->bins; bin++)
        excess[bin] = counts[bin] - target_counts[bin];
}

size_t mf_inversion_trail_spans(struct inversion_trail *trail, struct memory_span *span) {
    const size_t rows = trail->capacity, size = trail->singular_values;
    size_t n = 0;
    span[n++] = (struct memory_span){&trail->iterations, sizeof trail->iterations};
    span[n++] = (struct memory_span){trail->excess, rows * trail->bins * sizeof(double)};
    if (size == 0)
        return n;
    span[n++] = (struct memory_span){trail->singular, rows * size * sizeof(double)};
    span[n++] = (struct memory_span){trail->used, size * sizeof(double)};
    return n;
}
