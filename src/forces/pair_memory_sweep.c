// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/pair_memory.h"

#include "base/parallel.h"
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

struct sweep {
    struct pair_memory *memory;
    const struct particles *particles;
    uint64_t step;
    struct transfer *transfer;
};

static void sweep_part(void *context, int part) {
    const struct sweep *sweep = context;
    mf_pair_memory_kernels()->sweep(sweep->memory, sweep->particles, sweep->step, part,
                                    sweep->transfer);
}

void mf_pair_memory_sweep(struct pair_memory *memory, struct particles *particles, uint64_t step,
                          struct transfer *transfer) {
    struct sweep sweep = {memory, particles, step, transfer};
    mf_friction_load_velocities(particles);
    mf_parallel_ring(memory->parts, particles->threads, sweep_part, &sweep);
    if (transfer)
        mf_transfer_collect(transfer, memory->parts, 1);
    mf_friction_store_velocities(particles);
}
