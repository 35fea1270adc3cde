// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/kirkwood_buff.h"

#include <math.h>

/// ∫_0^r 4π s² u(s/L) ds.
static double weight_below(double r, double range) {
    const double x = r / range, x3 = x * x * x;
    return 4 * M_PI * range * range * range * x3 *
           (1.0 / 3 + x3 * (-23.0 / 48 + x * (3.0 / 28 + x * 9.0 / 64)));
}

struct kirkwood_buff mf_kirkwood_buff_integrate(const struct rdf_bins *bins, const double *g,
                                                const double *error, const struct box *box,
                                                size_t count, double inside) {
    const double range = mf_rdf_bins_range(bins);
    const double volume = mf_box_volume(box);
    const double density = (double)count / volume, all = weight_below(range, range);
    double below = weight_below(mf_rdf_bins_edge(bins, 0), range), sum = inside - below,
           squares = 0;
    for (size_t k = 0; k < bins->count; k++) {
        const double above = weight_below(mf_rdf_bins_edge(bins, k + 1), range);
        const double own_error = isfinite(error[k]) ? error[k] : 0;
        sum += (g[k] - 1) * (above - below);
        squares += pow((above - below) * own_error, 2);
        below = above;
    }
    const double integral = sum / (1 - all / volume);
    const double integral_error = sqrt(squares) / (1 - all / volume);
    return (struct kirkwood_buff){.integral = integral,
                                  .integral_error = integral_error,
                                  .compressibility = 1 + density * integral,
                                  .compressibility_error = density * integral_error};
}
