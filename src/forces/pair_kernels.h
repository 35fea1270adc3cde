// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The instances of the pair loop, by instruction set and precision.
#pragma once

#include "forces/pair.h"

#define PAIR_KERNEL_ARGUMENTS                                                                      \
    const struct pair_law *law, struct particles *particles, const struct neighbours *neighbours,  \
        int part, uint64_t step, struct pair_sums *sums

enum {
    /// Pairs evaluated together; always as many, so that loops are predictable. Measured on Zen 5,
    /// AVX-512: 64, 128, 256 and 512 make 3400, 3600, 3840 and 3790 steps/s of Lennard-Jones.
    PAIR_BATCH = 256,
};

/// What becomes of friction and noise.
enum pair_friction {
    PAIR_NO_FRICTION,
    PAIR_ADDS_FRICTION,  ///< to the forces
    PAIR_KEEPS_FRICTION, ///< for the integrator: struct friction
    PAIR_FRICTIONS
};

typedef void (*pair_kernel)(PAIR_KERNEL_ARGUMENTS);

/// Each adds the forces of the pairs of one part of the list to kernel_force, and their sums to
/// `sums` if it is not NULL.
struct pair_kernels {
    /// [dimensions − 2][has a potential][enum pair_friction][is a mixture]; a law without
    /// potential and friction has none.
    pair_kernel all[2][2][PAIR_FRICTIONS][2];
    pair_kernel held[2];              ///< pairs that those have held: many_body_steps.h
    size_t held_size, held_term_size; ///< bytes of a held batch, without and of each term
};

extern const struct pair_kernels mf_pair_portable, mf_pair_avx2, mf_pair_avx512;
extern const struct pair_kernels mf_pair_portable_double, mf_pair_avx2_double,
    mf_pair_avx512_double;

/// Bytes of a batch that is held for so many terms of local densities.
size_t mf_pair_held_size(enum pair_precision precision, int terms);
