// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The state of all particles: separate arrays, sorted in space by the neighbour search.
///
/// Masses are 1 [μ]. Particle number k of the arrays changes at every sort; `id` does not.
#pragma once

#include "base/status.h"
#include "system/box.h"

#include <stddef.h>
#include <stdint.h>

/// Vectors of kernels may read this far beyond the last particle.
enum { PARTICLES_PADDING = 16 };

/// What the pair kernels read of a particle, in records of four words: one load a particle.
struct particle_place {
    int32_t fraction[3]; ///< box_fraction
    uint32_t id;
};
struct particle_motion {
    float velocity[3]; ///< [λ/τ]
    uint32_t id;
};

/// The same for the kernels in double precision.
struct particle_precise_place {
    double position[3]; ///< [λ]
    double id;
};
struct particle_precise_motion {
    double velocity[3]; ///< [λ/τ]
    double id;
};

struct particles {
    size_t count;
    struct box box;
    int threads;          ///< that share a loop over the particles: the same bits for any number
    double *position[3];  ///< shape [count] each, wrapped into the box at every sort    [λ]
    double *velocity[3];  ///< shape [count] each                                        [λ/τ]
    double *force[3];     ///< shape [count] each                            [k_B T_0 / λ]
    int32_t *image[3];    ///< boxes crossed: unwrapped x = position + image · length
    uint32_t *id;         ///< 0 … count − 1, as placed
    int32_t *fraction[3]; ///< box_fraction; room for PARTICLES_PADDING more
    struct particle_place *kernel_place;          ///< shape [count]: the same for the pair kernels
    struct particle_motion *kernel_motion;        ///< shape [count]
    struct particle_precise_place *precise_place; ///< shape [count], or NULL without
    struct particle_precise_motion *precise_motion; ///< … mf_particles_keep_precise
    double (*kernel_force)[4];                      ///< shape [count, 4]: sums of the pair kernels
    double *spare;                                  ///< shape [count]: room for permutations
    void *spare_words;                              ///< shape [count]: the same for 32-bit words
    struct particle_motion *spare_motion;           ///< shape [count]
    struct particle_precise_motion *spare_precise_motion; ///< shape [count] or NULL
};

enum status mf_particles_init(struct particles *particles, const struct box *box,
                              size_t count) MUST_USE;
void mf_particles_clear(struct particles *particles);

/// Keep also what the kernels read in double precision, from the next updates on. Fails: NO_MEMORY.
enum status mf_particles_keep_precise(struct particles *particles) MUST_USE;

/// Particles per volume [1/λ^d].
double mf_particles_density(const struct particles *particles);

/// Put every position into [0, length) and count the boxes crossed.
void mf_particles_wrap(struct particles *particles);

/// Refresh `fraction`, `kernel_place` and `precise_place` from `position`.
void mf_particles_update_fractions(struct particles *particles);

/// Write the ids into `kernel_place` and `precise_place`, after the order has changed.
void mf_particles_label_places(struct particles *particles);

/// Refresh `kernel_motion` and `precise_motion`, with velocities predicted by a time `ahead` [τ]:
/// v + ahead · force.
void mf_particles_update_motion(struct particles *particles, double ahead);

/// Reorder all arrays but the forces, which are about to be replaced: new[k] = old[order[k]].
void mf_particles_permute(struct particles *particles, const uint32_t *order);

/// Maxwell velocities at `temperature` [k_B T_0] with zero total momentum; the same for the same
/// seed and ids, whatever the order.
void mf_particles_draw_velocities(struct particles *particles, double temperature, uint64_t seed);

/// Subtract the mean velocity.
void mf_particles_remove_momentum(struct particles *particles);

/// Σ v² of all particles [k_B T_0]; NaN or infinite if anything is.
double mf_particles_square_velocities(const struct particles *particles);

/// Kinetic temperature Σ v² / (d (N − 1)) with the momentum of the centre of mass removed
/// [k_B T_0].
double mf_particles_temperature(const struct particles *particles);

/// Largest force on a particle [k_B T_0 / λ]; NaN if one is.
double mf_particles_largest_force(const struct particles *particles);
