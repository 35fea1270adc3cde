// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/reptation_draw.h"

void mf_reptation_draw_init(struct reptation_draw *draw, double low, double high,
                            const double *weight) {
    draw->low = low;
    draw->width = (high - low) / REPTATION_BINS;
    draw->below[0] = 0;
    for (int bin = 0; bin < REPTATION_BINS; bin++)
        draw->below[bin + 1] = draw->below[bin] + weight[bin];
    for (int bin = 1; bin <= REPTATION_BINS; bin++)
        draw->below[bin] /= draw->below[REPTATION_BINS];
}

double mf_reptation_draw_number(const struct reptation_draw *draw, double uniform) {
    int bin = 0, beyond = REPTATION_BINS;
    while (beyond - bin > 1) {
        const int middle = (bin + beyond) / 2;
        if (draw->below[middle] <= uniform)
            bin = middle;
        else
            beyond = middle;
    }
    const double share = (uniform - draw->below[bin]) / (draw->below[bin + 1] - draw->below[bin]);
    return draw->low + draw->width * (bin + share);
}

double mf_reptation_draw_density(const struct reptation_draw *draw, double q) {
    const double place = (q - draw->low) / draw->width;
    if (!(place >= 0 && place < REPTATION_BINS))
        return 0;
    const int bin = (int)place;
    return (draw->below[bin + 1] - draw->below[bin]) / draw->width;
}
