// SPDX-License-Identifier: GPL-3.0-or-later
//
// The only switch between the instances of move_loop.h.
#include "base/simd.h"
#include "move_kernels.h"

/// Kernels for the instruction set in use.
static const struct move_kernels *choose(void) {
    switch (simd_used()) {
#if SIMD_X86
    case SIMD_AVX512:
        return &move_avx512;
    case SIMD_AVX2:
        return &move_avx2;
#endif
    default:
        return &move_portable;
    }
}

double move_energy_change(const struct particles *particles, const struct neighbours *neighbours,
                          const struct table *potential, size_t particle, const int32_t to[3]) {
    return choose()->energy_change(particles, neighbours, potential, particle, to);
}

void move_count_pairs(const struct particles *particles, const struct neighbours *neighbours,
                      const struct table *potential, const struct pair_histogram *histogram,
                      struct pair_sums *sums) {
    choose()->count_pairs(particles, neighbours, potential, histogram, sums);
}
