// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The instances of the pair loop, by instruction set and precision.
#pragma once

#include "forces/pair.h"

#define PAIR_KERNEL_ARGUMENTS                                                                      \
    const struct pair_law *law, struct particles *particles, const struct neighbours *neighbours,  \
        int part, uint64_t step, struct pair_sums *sums

/// What becomes of friction and noise.
enum pair_friction {
    PAIR_NO_FRICTION,
    PAIR_ADDS_FRICTION,  ///< to the forces
    PAIR_KEEPS_FRICTION, ///< for the integrator: struct friction
    PAIR_FRICTIONS
};

typedef void (*pair_kernel)(PAIR_KERNEL_ARGUMENTS);

/// Adds the forces of the pairs of one part of the list to kernel_force, and their sums to `sums`
/// if it is not NULL. [dimensions − 2][has a potential][enum pair_friction][is a mixture]; a
/// law without potential and friction has none.
typedef const pair_kernel pair_kernels[2][2][PAIR_FRICTIONS][2];

extern pair_kernels mf_pair_portable, mf_pair_avx2, mf_pair_avx512;
extern pair_kernels mf_pair_portable_double, mf_pair_avx2_double, mf_pair_avx512_double;
