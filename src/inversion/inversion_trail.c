// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_trail.h"

enum status mf_inversion_trail_init(struct inversion_trail *trail, size_t capacity, size_t bins) {
    enum status status = STATUS_OK;
    *trail = (struct inversion_trail){.capacity = capacity, .bins = bins};
    NEW_ARRAY(trail->excess, capacity * bins);
done:
    return status;
}

void mf_inversion_trail_clear(struct inversion_trail *trail) {
    mf_memory_free(trail->excess);
    *trail = (struct inversion_trail){0};
}

void mf_inversion_trail_add(struct inversion_trail *trail, const double *counts,
                            const double *target_counts) {
    double *excess = trail->excess + trail->iterations++ * trail->bins;
    for (size_t bin = 0; bin < trail->bins; bin++)
        excess[bin] = counts[bin] - target_counts[bin];
}

size_t mf_inversion_trail_spans(struct inversion_trail *trail, struct memory_span *span) {
    span[0] = (struct memory_span){&trail->iterations, sizeof trail->iterations};
    span[1] = (struct memory_span){trail->excess, trail->capacity * trail->bins * sizeof(double)};
    return 2;
}
