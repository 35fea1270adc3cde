// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How kernels tell pair types apart: for the pair loop and for Monte Carlo moves.
#pragma once

#include "base/lanes.h"
#include "forces/pair.h"

/// What tells pair types apart in a mixture.
struct pair_mixture {
    int types;
    int32_t first[COMPOSITION_MAX_TYPES]; ///< least id of each type
    /// For each pair type, in a record: intervals of Φ and of ω per length, length of one of Φ.
    REAL grid[COMPOSITION_MAX_PAIRS][4];
    int32_t potential_stride, omega_stride; ///< table_stride
    int32_t histogram_stride;               ///< of the histogram, from pair type to pair type
};

/// What the pairs of a mixture need to find their curves and bins.
LANES_INLINE struct pair_mixture pair_mixture_of(const struct pair_law *law) {
    const struct composition *composition = &law->composition;
    struct pair_mixture mixture = {.types = composition->types};
    for (int t = 1; t < composition->types; t++)
        mixture.first[t] = mixture.first[t - 1] + (int32_t)composition->count[t - 1];
    for (int p = 0; p < mf_composition_pairs(composition); p++) {
        if (law->potential) {
            mixture.grid[p][0] = (REAL)mf_table_inverse_spacing(law->potential, p);
            mixture.grid[p][2] = (REAL)(1 / mf_table_inverse_spacing(law->potential, p));
        }
        if (law->omega)
            mixture.grid[p][1] = (REAL)mf_table_inverse_spacing(law->omega, p);
    }
    mixture.potential_stride = law->potential ? table_stride(law->potential) : 0;
    mixture.omega_stride = law->omega ? table_stride(law->omega) : 0;
    if (law->histogram && law->histogram->pairs > 1)
        mixture.histogram_stride = (int32_t)law->histogram->bins;
    return mixture;
}

/// Types of particles. A comparison that holds is −1.
LANES_INLINE lanes_int pair_type(const struct pair_mixture *mixture, lanes_int id) {
    lanes_int type = lanes_all_int(0);
    for (int t = 1; t < mixture->types; t++)
        type -= id >= lanes_all_int(mixture->first[t]);
    return type;
}

/// Pair types of pairs of particles, numbered as by mf_composition_pair.
LANES_INLINE lanes_int pair_kind(const struct pair_mixture *mixture, lanes_int id_i,
                                 lanes_int id_j) {
    const int32_t twice = 2 * mixture->types - 1;
    const lanes_int a = pair_type(mixture, id_i), b = pair_type(mixture, id_j);
    const lanes_int low = lanes_min_int(a, b), high = lanes_max_int(a, b);
    return (low * (twice - low) >> 1) + high;
}
