// SPDX-License-Identifier: GPL-3.0-or-later
//
// The only switch between the instances of move_loop.h.
#include "base/simd.h"
#include "move_kernels.h"

/// Kernels for the instruction set in use.
static const struct move_kernels *choose(const struct pair_law *law,
                                         const struct particles *particles) {
    const int flat = particles->box.dimensions == 2,
              mixed = composition_is_mixed(&law->composition);
    switch (mf_simd_used()) {
#if SIMD_X86
    case SIMD_AVX512:
        return &mf_move_avx512[!flat][mixed];
    case SIMD_AVX2:
        return &mf_move_avx2[!flat][mixed];
#endif
    default:
        return &mf_move_portable[!flat][mixed];
    }
}

double mf_move_energy_change(const struct pair_law *law, const struct particles *particles,
                             size_t particle, const int32_t *list, size_t count,
                             const int32_t to[3]) {
    return choose(law, particles)->energy_change(law, particles, particle, list, count, to);
}

double mf_move_type_change(const struct pair_law *law, const struct particles *particles,
                           size_t particle, size_t other, const int32_t *list, size_t count) {
    return choose(law, particles)->type_change(law, particles, particle, other, list, count);
}

void mf_move_count_pairs(const struct pair_law *law, const struct particles *particles,
                         const struct neighbours *neighbours, struct pair_sums *sums) {
    choose(law, particles)->count_pairs(law, particles, neighbours, sums);
}
