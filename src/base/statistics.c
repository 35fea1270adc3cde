// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/statistics.h"

#include <math.h>

void statistics_add(struct running_mean *running, double value) {
    running->count += 1;
    const double deviation = value - running->mean;
    running->mean += deviation / running->count;
    running->squares += deviation * (value - running->mean);
}

double statistics_standard_error(const struct running_mean *running) {
    if (running->count < 2)
        return 0;
    return sqrt(running->squares / (running->count - 1) / running->count);
}
