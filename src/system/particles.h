// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The state of all particles: separate arrays, sorted in space by the neighbour search.
///
/// Masses are 1 [μ], unless the particles have the attribute "mass". Particle number k of the
/// arrays changes at every sort; `id` does not. One table in particles.c says of every array how it
/// is allocated, sorted and saved.
#pragma once

#include "base/memory.h"
#include "system/box.h"
#include "system/topology.h"

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

/// What a particle may have besides: an orientation, a radius, a number that an integrator keeps.
/// Nothing is allocated that nobody asks for.
enum { PARTICLES_MAX_ATTRIBUTES = 8, PARTICLES_MAX_COMPONENTS = 4 };
enum particles_type { PARTICLES_DOUBLE, PARTICLES_FLOAT, PARTICLES_WORD };
struct particles_attribute {
    const char *name; ///< as a scene and tables have it
    enum particles_type type;
    int components;
    /// Shape [components][count]: double, float or uint32_t. Sorting exchanges the arrays, so take
    /// them again from here in every step.
    void *value[PARTICLES_MAX_COMPONENTS];
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
    struct particle_motion *kernel_motion;        ///< shape [count]; empty unless has_motion
    struct particle_precise_place *precise_place; ///< shape [count], or NULL without
    struct particle_precise_motion *precise_motion; ///< … mf_particles_keep_precise
    double (*kernel_force)[4];                      ///< shape [count, 4]: sums of the pair kernels
    double *spare;                                  ///< shape [count]: room for permutations
    void *spare_words;                              ///< shape [count]: the same for 32-bit words
    struct particle_motion *spare_motion;           ///< shape [count]
    struct particle_precise_motion *spare_precise_motion; ///< shape [count] or NULL
    bool has_motion;                 ///< since the first mf_particles_update_motion
    const struct topology *topology; ///< molecules that they are, or NULL; borrowed
    uint32_t *place;                 ///< shape [count], of molecules: where each id stands, or NULL
    uint64_t orders;                 ///< changes whenever the order of the particles does
    struct particles_attribute attribute[PARTICLES_MAX_ATTRIBUTES];
    int attributes;
};

enum status mf_particles_init(struct particles *particles, const struct box *box,
                              size_t count) MUST_USE;
void mf_particles_clear(struct particles *particles);

/// Keep also what the kernels read in double precision, from the next updates on. Fails: NO_MEMORY.
enum status mf_particles_keep_precise(struct particles *particles) MUST_USE;

/// Let the particles be molecules: from the next order on `place` is known, and excluded pairs are
/// on no list. NULL, or the topology that they have already, changes nothing.
/// @param[in] topology  of as many particles; lives as long as they do
/// Fails: NO_MEMORY. Tested: test_topology.
enum status mf_particles_join(struct particles *particles,
                              const struct topology *topology) MUST_USE;

/// Give the particles one attribute more, all 0: from now on it is sorted and saved with the rest.
/// @param[in]  attribute  name, type and components; the name lives as long as the particles
/// @param[out] number     its place in `attribute`, which stays
/// Fails: NO_MEMORY; BAD_INPUT if there are PARTICLES_MAX_ATTRIBUTES. Tested: test_attributes.
enum status mf_particles_add_attribute(struct particles *particles,
                                       const struct particles_attribute *attribute,
                                       int *number) MUST_USE;

/// The numbers of an attribute of one double, by its name: shape [count], good until the next sort.
/// NULL if the particles have none of that name.
const double *mf_particles_numbers(const struct particles *particles, const char *name);

/// Masses [μ], shape [count], or NULL: all are 1.
static inline const double *particles_masses(const struct particles *particles) {
    return mf_particles_numbers(particles, "mass");
}

double mf_particles_total_mass(const struct particles *particles);

/// Particles per volume [1/λ^d].
double mf_particles_density(const struct particles *particles);

/// Put every position into [0, length) and count the boxes crossed. False if one is NaN or more
/// than 2¹⁸ boxes away: it stays there.
bool mf_particles_wrap(struct particles *particles);

/// Refresh `fraction`, `kernel_place` and `precise_place` from `position`.
void mf_particles_update_fractions(struct particles *particles);

/// Write the ids into `kernel_place` and `precise_place`, and the places of molecules' beads, after
/// the order has changed.
void mf_particles_label_places(struct particles *particles);

/// In a new order: both of the above, and a copy of the positions, in one pass. Tested:
/// test_neighbours.
/// @param[out] copy  shape [count] for each dimension
void mf_particles_settle(struct particles *particles, double *const copy[3]);

/// Refresh `kernel_motion` and `precise_motion`, with velocities predicted by a time `ahead` [τ]:
/// v + ahead · force.
void mf_particles_update_motion(struct particles *particles, double ahead);

/// Reorder all arrays but the forces, which are about to be replaced: new[k] = old[order[k]].
void mf_particles_permute(struct particles *particles, const uint32_t *order);

/// @name Restart
/// What a checkpoint must keep: positions, velocities, forces, images, ids and all attributes.
enum { PARTICLES_SPANS = 13 + PARTICLES_MAX_ATTRIBUTES * PARTICLES_MAX_COMPONENTS };
size_t mf_particles_spans(struct particles *particles, struct memory_span *spans);

/// How the components of the first velocities are distributed.
enum particles_speeds {
    PARTICLES_MAXWELL, ///< normal, of variance T/m
    PARTICLES_NORMAL,  ///< normal, of variance T/⟨m⟩ whatever the mass
    PARTICLES_UNIFORM, ///< uniform, of that variance
    PARTICLES_SIGNS    ///< sqrt(T/⟨m⟩) with a random sign
};

/// Draw velocities at `temperature` [k_B T_0] with zero total momentum; the same for the same seed
/// and ids, whatever the order. Only Maxwell's are those of equilibrium.
void mf_particles_draw_velocities(struct particles *particles, enum particles_speeds speeds,
                                  double temperature, uint64_t seed);

/// Subtract the velocity of the centre of mass.
void mf_particles_remove_momentum(struct particles *particles);

/// Velocity of the centre of mass along an axis, Σ m v / Σ m [λ/τ].
double mf_particles_mean_velocity(const struct particles *particles, int axis);

/// Σ v² of all particles [λ²/τ²]; NaN or infinite if anything is.
double mf_particles_square_velocities(const struct particles *particles);

/// ½ Σ m v² of all particles [k_B T_0]; NaN or infinite if anything is.
double mf_particles_kinetic_energy(const struct particles *particles);

/// Kinetic temperature Σ m v² / (d (N − 1)) with the motion of the centre of mass removed
/// [k_B T_0].
double mf_particles_temperature(const struct particles *particles);

/// Largest force on a particle [k_B T_0 / λ]; NaN if one is.
double mf_particles_largest_force(const struct particles *particles);
