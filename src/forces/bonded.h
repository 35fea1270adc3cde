// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The forces of bonds, angles and dihedrals, of some equal molecules side by side.
///
/// A vector holds one bead of as many molecules, which are its lanes. So terms find their beads
/// where they are for all molecules of a kind, and each bead is read and written once, however many
/// terms it is in.
#pragma once

#include "curves/bonded_kind.h"
#include "system/particles.h"

enum {
    BONDED_LANES = 8,
    BONDED_MAX_BEADS = 64, ///< side by side: their columns stay in the first-level cache
};

/// A vector of each lane.
typedef double bonded_vector[3][BONDED_LANES];

struct bonded_beads {
    _Alignas(MEMORY_ALIGNMENT) bonded_vector position[BONDED_MAX_BEADS]; ///< [λ]
    bonded_vector force[BONDED_MAX_BEADS]; ///< of the terms [k_B T_0/λ]
    const struct box *box;
};

/// What is added over terms.
struct bonded_sums {
    double energy;  ///< [k_B T_0]
    double virial;  ///< Σ r·F [k_B T_0]
    double longest; ///< of the bonds that are longer than their law allows [λ]; 0: none is
    int broken_order, broken; ///< the group of that one
    double transfer[3][3];    ///< Σ r_a F_b [k_B T_0]: forces/transfer.h
};

/// Some terms of a group, in each of the lanes.
struct bonded_terms {
    int order;
    const struct bonded_curve *curve;
    int group;
    int count;
    const int *bead; ///< shape [count, beads of a term]
    int lanes;       ///< that count; those beyond hold any molecules
    bool sums;       ///< whether energy and virial are to be summed
    bool transfer;   ///< whether that is
};

/// Read positions of beads, and begin with no forces.
/// @param[in] place  shape [beads, BONDED_LANES]: of the particles
void mf_bonded_take(struct bonded_beads *beads, const struct particles *particles,
                    const int32_t *place, int count);

/// Add the forces of terms to those of the beads, and their sums. With the nearest images of what
/// is next to each other in a term. The geometry of a straight angle, or of three beads of a
/// dihedral in a line, has no direction, and no force.
void mf_bonded_add(const struct bonded_terms *terms, struct bonded_beads *beads,
                   struct bonded_sums *sums);

/// Add the forces of beads in the lanes that are used to particles->force, or to the sums of the
/// pair kernels: one place for a bead instead of three.
void mf_bonded_give(const struct bonded_beads *beads, struct particles *particles,
                    const int32_t *place, int count, int used);
void mf_bonded_give_sums(const struct bonded_beads *beads, struct particles *particles,
                         const int32_t *place, int count, int used);

/// Σ ∇²U of the beads of all terms, in the lanes that count [k_B T_0/λ²], by differences of their
/// forces. Tested: test_configurational.
double mf_bonded_laplacian(const struct bonded_terms *terms, const struct bonded_beads *beads);

/// Lengths [λ] or angles [rad] of terms of one kind at the present positions, shape [count]: what
/// the laws are given.
/// @param[in] place  shape [count, beads of a term]: of the particles
void mf_bonded_measure(int order, size_t count, const int32_t *place,
                       const struct particles *particles, double *q);
