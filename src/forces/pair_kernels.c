// SPDX-License-Identifier: GPL-3.0-or-later
//
// What pair.h declares: finds the instance of the pair loop that suits a law, the only switch
// between them, and shares the parts of the neighbour list among threads.
#include "pair_kernels.h"

#include "base/parallel.h"
#include "base/simd.h"

double mf_pair_cutoff(const struct pair_law *law) {
    return fmax(law->potential ? law->potential->cutoff : 0, law->omega ? law->omega->cutoff : 0);
}

/// Kernels for the instruction set in use.
static pair_kernels *choose_instruction_set(bool is_double) {
    switch (mf_simd_used()) {
#if SIMD_X86
    case SIMD_AVX512:
        return is_double ? &mf_pair_avx512_double : &mf_pair_avx512;
    case SIMD_AVX2:
        return is_double ? &mf_pair_avx2_double : &mf_pair_avx2;
#endif
    default:
        return is_double ? &mf_pair_portable_double : &mf_pair_portable;
    }
}

/// The kernel of a law; NULL if nothing acts between pairs.
static pair_kernel choose_kernel(const struct pair_law *law, int dimensions) {
    const int conservative = law->potential != NULL;
    const enum pair_friction friction = law->omega == NULL ? PAIR_NO_FRICTION
                                        : law->friction    ? PAIR_KEEPS_FRICTION
                                                           : PAIR_ADDS_FRICTION;
    pair_kernels *kernels = choose_instruction_set(law->precision == PAIR_DOUBLE);
    return (
        *kernels)[dimensions - 2][conservative][friction][composition_is_mixed(&law->composition)];
}

static void clear_forces(void *context, size_t begin, size_t end) {
    struct particles *particles = context;
    memset(particles->kernel_force + begin, 0, (end - begin) * sizeof *particles->kernel_force);
}

static void gather_forces(void *context, size_t begin, size_t end) {
    struct particles *particles = context;
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t k = begin; k < end; k++)
            particles->force[d][k] = particles->kernel_force[k][d];
}

void mf_pair_clear(struct particles *particles) {
    mf_parallel_for(particles->count, particles->threads, clear_forces, particles);
}

void mf_pair_add(const struct pair_law *law, struct particles *particles,
                 const struct neighbours *neighbours, uint64_t step, enum pair_wants wants,
                 struct pair_sums *sums) {
    const pair_kernel kernel = choose_kernel(law, particles->box.dimensions);
    const int parts = kernel ? neighbours->parts : 0, threads = particles->threads;
    struct pair_sums part_sums[NEIGHBOURS_MAX_PARTS] = {{0}};
    // A part adds to its own particles and to those of the next one: even parts never meet.
    for (int first = 0; first < 2; first++) {
#pragma omp parallel for schedule(dynamic) num_threads(threads) if (threads > 1)
        for (int p = first; p < parts; p += 2)
            kernel(law, particles, neighbours, p, step,
                   wants == PAIR_FORCES_AND_SUMS ? &part_sums[p] : NULL);
    }
    mf_parallel_for(particles->count, threads, gather_forces, particles);
    if (sums == NULL)
        return;
    *sums = (struct pair_sums){0};
    for (int p = 0; p < parts; p++) {
        sums->energy += part_sums[p].energy;
        sums->virial += part_sums[p].virial;
    }
}

void mf_pair_forces(const struct pair_law *law, struct particles *particles,
                    const struct neighbours *neighbours, uint64_t step, enum pair_wants wants,
                    struct pair_sums *sums) {
    mf_pair_clear(particles);
    mf_pair_add(law, particles, neighbours, step, wants, sums);
}
