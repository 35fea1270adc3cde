// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The instances of the bodies in move_loop.h, by instruction set.
#pragma once

#include "dynamics/move.h"

struct move_kernels {
    double (*energy_change)(const struct pair_law *law, const struct particles *particles,
                            size_t particle, const int32_t *list, size_t count,
                            const int32_t to[3]);
    double (*type_change)(const struct pair_law *law, const struct particles *particles,
                          size_t particle, size_t other, const int32_t *list, size_t count);
    void (*count_pairs)(const struct pair_law *law, const struct particles *particles,
                        const struct neighbours *neighbours, struct pair_sums *sums);
};

/// By dimensions − 2 and whether the beads are a mixture.
extern const struct move_kernels mf_move_portable[2][2], mf_move_avx2[2][2], mf_move_avx512[2][2];
