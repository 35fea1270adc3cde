// SPDX-License-Identifier: GPL-3.0-or-later
//
// The only switch between the instances of the pair loop.
#include "pair_kernels.h"

#include "base/simd.h"

double pair_cutoff(const struct pair_law *law) {
    return fmax(law->potential ? law->potential->cutoff : 0, law->weight ? law->weight->cutoff : 0);
}

static pair_kernel choose(const struct pair_law *law, int dimensions, enum pair_wants wants) {
    const int conservative = law->potential != NULL, dissipative = law->weight != NULL;
    switch (simd_used()) {
#if SIMD_X86
    case SIMD_AVX512:
        return pair_avx512[dimensions - 2][conservative][dissipative][wants];
    case SIMD_AVX2:
        return pair_avx2[dimensions - 2][conservative][dissipative][wants];
#endif
    default:
        return pair_portable[dimensions - 2][conservative][dissipative][wants];
    }
}

void pair_forces(const struct pair_law *law, struct particles *particles,
                 const struct neighbours *neighbours, uint64_t step, enum pair_wants wants,
                 struct pair_sums *sums) {
    const pair_kernel kernel = choose(law, particles->box.dimensions, wants);
    memset(particles->kernel_force, 0, particles->count * sizeof *particles->kernel_force);
    if (sums)
        *sums = (struct pair_sums){0};
    if (kernel)
        kernel(law, particles, neighbours, step, sums);
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t k = 0; k < particles->count; k++)
            particles->force[d][k] = particles->kernel_force[k][d];
}
