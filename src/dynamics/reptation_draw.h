// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Numbers of a density that is constant in each bin: what reptation proposes as the length
/// and the angle of a new bond. It need only be near exp(−U/k_B T): weights make up for the rest.
#pragma once

#include "curves/bonded_law.h"

enum { REPTATION_BINS = 256 };

struct reptation_draw {
    double low, width;                ///< of the bins
    double below[REPTATION_BINS + 1]; ///< probability of all bins before
};

/// Of any weights of the bins, shape [REPTATION_BINS].
void mf_reptation_draw_init(struct reptation_draw *draw, double low, double high,
                            const double *weight);

/// The number for a uniform one in (0, 1). Tested: test_reptation.
double mf_reptation_draw_number(const struct reptation_draw *draw, double uniform);

/// Its density; 0 where no number comes from. Tested: test_reptation.
double mf_reptation_draw_density(const struct reptation_draw *draw, double q);
