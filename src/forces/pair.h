// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The forces between pairs of particles, and one pass over all of them (pair_kernels.c).
///
/// With r_ij = r_i − r_j, r̂ = r_ij / r, v_ij = v_i − v_j, the force on i is
///   F_C = −Φ'(r) r̂,  F_D = −ω(r)² (r̂·v_ij) r̂,  F_R = sqrt(2 k_B T / Δt) ω(r) ζ_ij r̂
/// with ζ_ij = ζ_ji of mean 0 and variance 1. R. D. Groot and P. B. Warren, J. Chem. Phys. 107,
/// 4423 (1997), eqs. 4 to 8; ω² here is γ w_D there, and ζ is uniform as in their section II.
/// Where friction is kept apart (forces/friction.h) ζ is normal.
#pragma once

#include "curves/table.h"
#include "forces/friction.h"
#include "forces/transfer.h"
#include "system/composition.h"
#include "system/neighbours.h"
#include "system/particles.h"

/// Arithmetic of a pair. The state of particles and the sums over pairs are in double precision
/// always.
enum pair_precision {
    PAIR_MIXED,  ///< single, from 32-bit fractions of the box: relative errors of 1e-6 in a force
    PAIR_DOUBLE, ///< double, from double positions; the noise is the same
};

_Static_assert((int)TABLE_MAX_CURVES >= (int)COMPOSITION_MAX_PAIRS,
               "a table holds a curve for each pair type");

/// Distances counted in passing: bin k holds those from low + k width on.
struct pair_histogram {
    double low, width; ///< [λ]
    size_t bins;
    size_t pairs;     ///< pair types of a mixture, to count each apart; 0 or 1: all together
    uint32_t *counts; ///< shape [NEIGHBOURS_MAX_PARTS, pair_histogram_size]
};

/// Numbers of a part: shape [pairs, bins], and a last one for all pairs beyond the bins.
static inline size_t pair_histogram_size(const struct pair_histogram *histogram) {
    return (histogram->pairs > 1 ? histogram->pairs : 1) * histogram->bins + 1;
}

/// What acts between pairs, and what is counted of them. The tables belong to the caller.
struct pair_law {
    struct composition composition; ///< the types of beads of a mixture
    const struct table *potential;  ///< Φ(r), one or for each pair type, or NULL
    const struct table *omega;      ///< ω(r), the same, or NULL
    double temperature;             ///< of the noise [k_B T_0]
    double time_step;               ///< Δt of the noise [τ]
    uint64_t seed;                  ///< key of the noise
    enum pair_precision precision;
    const struct pair_histogram *histogram; ///< of the pairs in range, or NULL
    struct friction *friction; ///< keeps the pairs within the cutoff of ω instead of adding their
                               ///< friction and noise to the forces; NULL: adds them
    struct transfer *transfer; ///< whose parts r F of each pair is added to, or NULL
    /// Local densities for whose energies the forces wait (forces/many_body_work.h), or NULL.
    struct many_body_work *many_body;
};

/// Sums over the pairs of one pass.
struct pair_sums {
    double energy; ///< Σ Φ(r)                                   [k_B T_0]
    double virial; ///< Σ r·F_C, the conservative part alone     [k_B T_0]
};

enum pair_wants { PAIR_FORCES, PAIR_FORCES_AND_SUMS };

/// Largest distance at which a law acts on any pair [λ].
double mf_pair_cutoff(const struct pair_law *law);

/// Replace `force` of all particles by the forces of `law`.
///
/// Reads kernel_place, and kernel_motion if the law has a friction weight; with PAIR_DOUBLE
/// precise_place and precise_motion, which mf_particles_keep_precise must have asked for. The list
/// must be complete for mf_pair_cutoff.
/// @param[in]  step  number of the time step: the counter of the noise
/// @param[out] sums  NULL unless `wants` asks for them
/// Fails: never; a NaN shows in the forces. Threads: particles->threads share
/// the parts of the list, with the same bits for any number. Tested: test_pair_kernels.
void mf_pair_forces(const struct pair_law *law, struct particles *particles,
                    const struct neighbours *neighbours, uint64_t step, enum pair_wants wants,
                    struct pair_sums *sums);

/// @name The same in two parts, between which others may add to the sums of the kernels
/// Empty the sums, particles->kernel_force; add the pairs to them; replace `force` by them.
void mf_pair_clear(struct particles *particles);
void mf_pair_add(const struct pair_law *law, struct particles *particles,
                 const struct neighbours *neighbours, uint64_t step, enum pair_wants wants,
                 struct pair_sums *sums);
void mf_pair_gather(struct particles *particles);
