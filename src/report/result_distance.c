// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/result_distance.h"

#include <math.h>
#include <stdio.h>

void mf_result_distance_find(struct result_summary *summary) {
    double sum = 0, largest = 0;
    size_t count = 0;
    summary->error_over_noise = NAN;
    summary->worst[0] = '\0';
    for (int kind = 0; mf_targets_name(kind); kind++) {
        const double ratio = summary->distance[kind].rmse / summary->distance[kind].noise;
        if (!isfinite(ratio))
            continue;
        sum += ratio * ratio;
        count++;
        if (ratio < largest)
            continue;
        largest = ratio;
        snprintf(summary->worst, sizeof summary->worst, "%s %.2g", mf_targets_name(kind), ratio);
    }
    if (count > 0)
        summary->error_over_noise = sqrt(sum / (double)count);
}
