// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Conformations of a molecule, drawn from what binds its beads.
///
/// The beads are placed one after the other along the bonds. Each is drawn from the length of its
/// bond, an angle and a dihedral, each by its Jacobian times exp(−U/k_B T), and chosen of some such
/// trials by exp(−E/k_B T), where E is that of all other terms that it completes and of the pairs
/// with the three beads before it that are not excluded: what is farther along a chain is screened
/// in a melt (R. Auhl, R. Everaers, G. S. Grest, K. Kremer and S. J. Plimpton, J. Chem. Phys. 119,
/// 12718 (2003), section II). M. N. Rosenbluth and A. W. Rosenbluth, J. Chem. Phys. 23, 356 (1955).
/// Rings are drawn towards where they began as a random walk is that comes back in as many bonds as
/// are left; what is open still, forces close.
#pragma once

#include "forces/molecules.h"

struct growth {
    const struct molecules *molecules;
    const struct pair_law *law; ///< its potential, composition and temperature
    int dimensions;
    double stretch; ///< k_B T times the cosine to the way from the first bead, that is gained by it
    const struct topology_kind *kind;
    struct growth_joint *joint; ///< shape [beads], in the order in which they are placed
    struct growth_term *term;   ///< by which trials are chosen, in that order
    struct growth_draw *draw[BONDED_KINDS][MOLECULES_MAX_GROUPS][1 + TABLE_MAX_CURVES];
};

/// Plan the growth of a kind. Must be cleared, also after a failure. Fails: NO_MEMORY.
enum status mf_molecules_growth_init(struct growth *growth, const struct molecules *molecules,
                                     const struct topology_kind *kind, const struct pair_law *law,
                                     int dimensions) MUST_USE;
void mf_molecules_growth_clear(struct growth *growth);

/// A conformation, from the first bead on. @param[out] place  shape [beads]
/// Tested: test_molecules_growth.
void mf_molecules_growth_draw(const struct growth *growth, uint64_t seed, uint32_t molecule,
                              double (*place)[3]);
