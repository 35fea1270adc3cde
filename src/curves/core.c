// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/core.h"

#include <math.h>

void mf_core_fill(const double *r, double *phi, size_t known, double slope, double stiffness) {
    const double steepness = fmax(0, -slope);
    for (size_t k = 0; k < known; k++) {
        const double depth = r[known] - r[k];
        phi[k] = phi[known] + depth * (steepness + 0.5 * stiffness * depth);
    }
}
