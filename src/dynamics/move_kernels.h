// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The instances of the bodies in move_loop.h, by instruction set.
#pragma once

#include "dynamics/move.h"

struct move_kernels {
    double (*energy_change)(const struct particles *particles, const struct neighbours *neighbours,
                            const struct table *potential, size_t particle, const int32_t to[3]);
    void (*count_pairs)(const struct particles *particles, const struct neighbours *neighbours,
                        const struct table *potential, const struct pair_histogram *histogram,
                        struct pair_sums *sums);
};

extern const struct move_kernels move_portable, move_avx2, move_avx512;
