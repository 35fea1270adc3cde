// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/pair_memory.h"

#include "base/simd.h"
#include "forces/friction.h"
#include "forces/pair_memory_kernels.h"

const struct pair_memory_kernels *mf_pair_memory_kernels(void) {
    switch (mf_simd_used()) {
#if SIMD_X86
    case SIMD_AVX512:
        return &mf_pair_memory_avx512;
    case SIMD_AVX2:
        return &mf_pair_memory_avx2;
#endif
    default:
        return &mf_pair_memory_portable;
    }
}

void mf_pair_memory_sweep(struct pair_memory *memory, struct particles *particles, uint64_t step,
                          struct transfer *transfer) {
    const struct pair_memory_kernels *kernels = mf_pair_memory_kernels();
    const int threads = particles->threads;
    mf_friction_load_velocities(particles);
    // The parts of the list: even ones, which never meet, then odd ones.
    for (int first = 0; first < 2; first++) {
#pragma omp parallel for schedule(dynamic) num_threads(threads) if (threads > 1)
        for (int p = first; p < memory->parts; p += 2)
            kernels->sweep(memory, particles, step, p, transfer);
    }
    if (transfer)
        mf_transfer_collect(transfer, memory->parts, 1);
    mf_friction_store_velocities(particles);
}
