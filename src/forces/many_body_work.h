// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a pass over pairs with energies of local densities works on (many_body.h).
///
/// The pair loop finds ρ beside Φ, friction and noise, in the same sweep, and holds the pairs with
/// their forces back (many_body_steps.h). Once all densities are known their slopes f'(ρ) are
/// (mf_many_body_slopes), and the forces of the held pairs are completed and given to the
/// particles.
#pragma once

#include "forces/many_body.h"
#include "forces/pair_kernels.h"

/// One density. Arrays of particles are by place, shape [count].
struct many_body_density {
    const struct weight_table *weight;
    double *density; ///< ρ
    double *slope;   ///< f'(ρ) of central beads, else 0
    double *share;   ///< 1 for beads that count, else 0; NULL: all are central, and count
};

struct many_body_work {
    const struct many_body *many_body;
    double cutoff; ///< the largest of all weights [λ]
    struct many_body_density term[MANY_BODY_MAX_TERMS];
    double extreme[MANY_BODY_MAX_TERMS][2]; ///< smallest and largest ρ of central beads so far
    struct table nothing;                   ///< Φ = 0, of scenes without a potential
    void *held;                             ///< batches: struct many_body_batch of the kernels
    size_t held_size, capacity;             ///< of a batch, of all [bytes]
    size_t end[NEIGHBOURS_MAX_PARTS];       ///< of the batches of a part
};

static inline double many_body_cutoff(const struct many_body_work *work) {
    return work ? work->cutoff : 0;
}

/// The first batch of a part, which has two that are not full.
static inline size_t many_body_begin(const struct neighbours *neighbours, int part) {
    return neighbours->part[part].begin / PAIR_BATCH + 2 * (size_t)part;
}

/// Σ f(ρ) of the densities that a sweep has found [k_B T_0], whose slopes are noted. The same bits
/// for any number of threads.
double mf_many_body_slopes(struct many_body_work *work, const struct particles *particles,
                           uint64_t step);
