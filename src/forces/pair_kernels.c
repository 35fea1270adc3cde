// SPDX-License-Identifier: GPL-3.0-or-later
//
// What pair.h declares: finds the instance of the pair loop that suits a law, the only switch
// between them, and shares the parts of the neighbour list among threads.
#include "pair_kernels.h"

#include "base/parallel.h"
#include "base/simd.h"
#include "forces/many_body_work.h"

double mf_pair_cutoff(const struct pair_law *law) {
    return fmax(law->potential ? law->potential->cutoff : 0, law->omega ? law->omega->cutoff : 0);
}

/// Kernels for the instruction set in use.
static const struct pair_kernels *choose_instruction_set(bool is_double) {
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
    const struct pair_kernels *kernels = choose_instruction_set(law->precision == PAIR_DOUBLE);
    return kernels
        ->all[dimensions - 2][conservative][friction][composition_is_mixed(&law->composition)];
}

size_t mf_pair_held_size(enum pair_precision precision, int terms) {
    const struct pair_kernels *kernels = choose_instruction_set(precision == PAIR_DOUBLE);
    return kernels->held_size + (size_t)terms * kernels->held_term_size;
}

static void clear_forces(void *context, size_t begin, size_t end) {
    struct particles *particles = context;
    memset(particles->kernel_force + begin, 0, (end - begin) * sizeof *particles->kernel_force);
}

/// All axes in one loop, for which a compiler turns whole records.
SIMD_CLONES static void gather_forces(void *context, size_t begin, size_t end) {
    struct particles *particles = context;
    const double(*sum)[4] = (const double(*)[4])particles->kernel_force;
    double *restrict x = particles->force[0], *restrict y = particles->force[1];
    double *restrict z = particles->force[2];
    if (particles->box.dimensions == 2)
        for (size_t k = begin; k < end; k++) {
            x[k] = sum[k][0];
            y[k] = sum[k][1];
        }
    else
        for (size_t k = begin; k < end; k++) {
            x[k] = sum[k][0];
            y[k] = sum[k][1];
            z[k] = sum[k][2];
        }
}

void mf_pair_clear(struct particles *particles) {
    mf_parallel_for(particles->count, particles->threads, clear_forces, particles);
}

void mf_pair_gather(struct particles *particles) {
    mf_parallel_for(particles->count, particles->threads, gather_forces, particles);
}

struct pass {
    pair_kernel kernel;
    const struct pair_law *law;
    struct particles *particles;
    const struct neighbours *neighbours;
    uint64_t step;
    struct pair_sums *part_sums; ///< NULL: not wanted
};

static void pass_part(void *context, int part) {
    const struct pass *pass = context;
    pass->kernel(pass->law, pass->particles, pass->neighbours, part, pass->step,
                 pass->part_sums ? &pass->part_sums[part] : NULL);
}

/// All parts of the list. A part adds to its own particles and to those of the next one.
static void sweep(pair_kernel kernel, const struct pair_law *law, struct particles *particles,
                  const struct neighbours *neighbours, uint64_t step, struct pair_sums *part_sums) {
    struct pass pass = {kernel, law, particles, neighbours, step, part_sums};
    mf_parallel_ring(neighbours->parts, particles->threads, pass_part, &pass);
}

void mf_pair_add(const struct pair_law *given, struct particles *particles,
                 const struct neighbours *neighbours, uint64_t step, enum pair_wants wants,
                 struct pair_sums *sums) {
    const int dimensions = particles->box.dimensions;
    struct pair_sums all = {0}, part_sums[NEIGHBOURS_MAX_PARTS] = {{0}};
    struct pair_sums *wanted = wants == PAIR_FORCES_AND_SUMS ? part_sums : NULL;
    struct pair_law law = *given;
    if (law.many_body && law.potential == NULL)
        law.potential = &law.many_body->nothing;
    const pair_kernel kernel = choose_kernel(&law, dimensions);
    if (kernel)
        sweep(kernel, &law, particles, neighbours, step, wanted);
    if (law.many_body) {
        all.energy = mf_many_body_slopes(law.many_body, particles, step);
        sweep(choose_instruction_set(law.precision == PAIR_DOUBLE)->held[dimensions - 2], &law,
              particles, neighbours, step, wanted);
    }
    for (int p = 0; p < neighbours->parts; p++) {
        all.energy += part_sums[p].energy;
        all.virial += part_sums[p].virial;
    }
    if (sums)
        *sums = wanted ? all : (struct pair_sums){0};
}

void mf_pair_forces(const struct pair_law *law, struct particles *particles,
                    const struct neighbours *neighbours, uint64_t step, enum pair_wants wants,
                    struct pair_sums *sums) {
    mf_pair_clear(particles);
    mf_pair_add(law, particles, neighbours, step, wants, sums);
    mf_pair_gather(particles);
}
