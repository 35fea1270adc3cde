// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the rounding of pair forces is relative to.
#pragma once

#include "forces/pair.h"

/// Σ (|F| + r |dF/dr|) on each particle, Σ |Φ| and Σ |r Φ'|.
struct pair_scales {
    double *force; ///< shape [count]
    double energy, virial;
    size_t near; ///< pairs within the cutoff of ω
};

/// Over all pairs of a law; friction counts at a relative velocity of 4, noise at its largest.
struct pair_scales pair_scales_find(const struct pair_law *law, const struct particles *particles);
void pair_scales_clear(struct pair_scales *scales);
