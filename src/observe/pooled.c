// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/pooled.h"

#include <math.h>
#include <string.h>

void mf_pooled_add(const struct observable_values *values, const double *value, const double *error,
                   size_t count) {
    for (size_t k = 0; k < values->count; k++) {
        values->value[k] += value[k] / (double)count;
        values->error[k] = hypot(values->error[k], error[k] / (double)count);
    }
}

void mf_pooled_join(const struct observable_values *values, const struct pooled_curve *replicas,
                    size_t count) {
    const double inside = (double)count * fmax(0, replicas->blocks - 1),
                 between = (double)count - 1;
    for (size_t k = 0; k < count; k++)
        mf_pooled_add(values, replicas[k].value, replicas[k].error, count);
    if (values->freedom)
        *values->freedom = inside + between;
    if (count < 2)
        return;
    for (size_t k = 0; k < values->count; k++) {
        double *error = &values->error[k], squares = 0;
        for (size_t n = 0; n < count; n++)
            squares += pow(replicas[n].value[k] - values->value[k], 2);
        const double scatter = squares / ((double)count * between);
        const double own = inside > 0 ? inside * *error * *error : 0; // of one block not known
        *error = sqrt((own + between * scatter) / (inside + between));
    }
}

void mf_pooled_set(const struct observable_values *values, const double *value,
                   const double *error) {
    memcpy(values->value, value, values->count * sizeof *value);
    memcpy(values->error, error, values->count * sizeof *error);
}

enum status mf_pooled_result(const struct observable *observable, const void *const *states,
                             size_t count, const struct observable_values *values) {
    OWNED struct observable_values *own = NULL;
    OWNED struct pooled_curve *replicas = NULL;
    OWNED double *memory = NULL;
    size_t targets = 0, numbers = 0;
    if (observable->result_of_all)
        return observable->result_of_all(states, count, values);
    for (; observable->targets[targets].name; targets++)
        numbers += 2 * values[targets].count;
    TRY_ARRAY(own, targets);
    TRY_ARRAY(replicas, targets * count);
    TRY_ARRAY(memory, numbers * count + 1);
    for (size_t k = 0; k < count; k++) {
        double *at = memory + k * numbers, blocks = 0;
        for (size_t n = 0; n < targets; n++) {
            own[n] = values[n];
            own[n].value = at;
            own[n].error = at + own[n].count;
            at += 2 * own[n].count;
        }
        TRY(observable->result(states[k], own, &blocks));
        for (size_t n = 0; n < targets; n++)
            replicas[n * count + k] = (struct pooled_curve){own[n].value, own[n].error, blocks};
    }
    for (size_t n = 0; n < targets; n++)
        mf_pooled_join(&values[n], replicas + n * count, count);
    return STATUS_OK;
}
