// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The forces of bonds, angles and dihedrals, some terms of one group at a time.
#pragma once

#include "curves/bonded_law.h"
#include "system/particles.h"

/// Terms that are worked on together: their columns stay in the first-level cache.
enum { BONDED_BATCH = 64 };

/// Column n of a vector along axis d is [d][n].
typedef double bonded_vectors[3][BONDED_BATCH];

/// What is added over terms.
struct bonded_sums {
    double energy;         ///< [k_B T_0]
    double virial;         ///< Σ r·F [k_B T_0]
    double longest;        ///< of the bonds that are longer than their law allows [λ]; 0: none is
    int torn;              ///< the group of that one
    double transfer[3][3]; ///< Σ r_a F_b [k_B T_0]: forces/transfer.h
};

/// Some terms of a group.
struct bonded_terms {
    const struct bonded_curve *curve;
    int group;
    size_t count;         ///< at most BONDED_BATCH
    const int32_t *place; ///< shape [count, beads]: of the particles
    bool transfer;        ///< whether that is to be summed
};

/// Add the forces of terms to particles->force, and their sums. With the nearest images of what is
/// next to each other in a term. The geometry of a straight angle, or of three beads of a dihedral
/// in a line, has no direction, and no force.
void mf_bonded_add_bonds(const struct bonded_terms *terms, struct particles *particles,
                         struct bonded_sums *sums);
void mf_bonded_add_angles(const struct bonded_terms *terms, struct particles *particles,
                          struct bonded_sums *sums);
void mf_bonded_add_dihedrals(const struct bonded_terms *terms, struct particles *particles,
                             struct bonded_sums *sums);

/// Lengths [λ], angles or dihedrals [rad] of terms at the present positions, shape [count]: what
/// the laws are given. Any of the three orders of terms (beads − 2).
void mf_bonded_measure(int order, size_t count, const int32_t *place,
                       const struct particles *particles, double *q);
