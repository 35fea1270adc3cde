// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/result_distance.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char ending[] = "_rmse";

/// The target that a field is the distance from: the length of its name, or 0.
static size_t target_of(const struct field *field) {
    const size_t length = strlen(field->name), end = sizeof ending - 1;
    return length > end && strcmp(field->name + length - end, ending) == 0 ? length - end : 0;
}

static double number_at(const struct result_summary *summary, const struct field *field) {
    double value;
    memcpy(&value, (const char *)summary + field->offset, sizeof value);
    return value;
}

/// The noise beside a distance in the table of fields.
static const struct field *noise_beside(const struct field *rmse) {
    const struct field *noise = rmse;
    while (strncmp(noise->name, rmse->name, target_of(rmse)) != 0 ||
           strcmp(noise->name + target_of(rmse), "_noise") != 0)
        noise++;
    return noise;
}

void mf_result_distance_find(struct result_summary *summary) {
    double sum = 0, largest = 0;
    size_t count = 0;
    summary->error_over_noise = NAN;
    summary->worst[0] = '\0';
    for (const struct field *field = mf_result_summary_fields; field->name; field++) {
        if (target_of(field) == 0)
            continue;
        const double ratio = number_at(summary, field) / number_at(summary, noise_beside(field));
        if (!isfinite(ratio))
            continue;
        sum += ratio * ratio;
        count++;
        if (ratio < largest)
            continue;
        largest = ratio;
        snprintf(summary->worst, sizeof summary->worst, "%.*s %.2g", (int)target_of(field),
                 field->name, ratio);
    }
    if (count > 0)
        summary->error_over_noise = sqrt(sum / (double)count);
}
