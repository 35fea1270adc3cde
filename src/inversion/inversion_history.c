// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_history.h"

#include <math.h>

enum status mf_inversion_history_init(struct inversion_history *history, size_t capacity,
                                      size_t bins) {
    enum status status = STATUS_OK;
    *history = (struct inversion_history){.capacity = capacity, .bins = bins};
    NEW_ARRAY(history->excess, capacity * bins);
done:
    return status;
}

void mf_inversion_history_clear(struct inversion_history *history) {
    mf_memory_free(history->excess);
    *history = (struct inversion_history){0};
}

void mf_inversion_history_add(struct inversion_history *history, const double *counts,
                              const double *target_counts, const double *unit) {
    double *excess = history->excess + history->iterations++ * history->bins;
    for (size_t bin = 0; bin < history->bins; bin++)
        excess[bin] = isinf(unit[bin]) ? 0 : counts[bin] - target_counts[bin];
}

size_t mf_inversion_history_spans(struct inversion_history *history, struct memory_span *span) {
    span[0] = (struct memory_span){&history->iterations, sizeof history->iterations};
    span[1] =
        (struct memory_span){history->excess, history->capacity * history->bins * sizeof(double)};
    return 2;
}
