// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/pooled.h"

#include <math.h>

void mf_pooled_add(const struct observable_values *values, const double *value, const double *error,
                   size_t count) {
    for (size_t k = 0; k < values->count; k++) {
        values->value[k] += value[k] / (double)count;
        values->error[k] = hypot(values->error[k], error[k] / (double)count);
    }
}

void mf_pooled_join(const struct observable_values *values, const struct pooled_curve *replicas,
                    size_t count) {
    for (size_t k = 0; k < count; k++)
        mf_pooled_add(values, replicas[k].value, replicas[k].error, count);
    if (count < 2)
        return;
    const double inside = (double)count * fmax(0, replicas->blocks - 1),
                 between = (double)count - 1;
    for (size_t k = 0; k < values->count; k++) {
        double *error = &values->error[k], squares = 0;
        for (size_t n = 0; n < count; n++)
            squares += pow(replicas[n].value[k] - values->value[k], 2);
        const double scatter = squares / ((double)count * between);
        *error = sqrt((inside * *error * *error + between * scatter) / (inside + between));
    }
}
