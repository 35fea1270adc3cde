// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Molecules made whole in a periodic box, along their bonds: each bead at the nearest image
/// from the one that it is bonded to.
#pragma once

#include "system/particles.h"
#include "system/topology.h"

struct whole_molecules {
    const struct topology *topology; ///< borrowed
    size_t max_beads;                ///< of a molecule
    double (*place)[3]; ///< shape [beads] of the last one made: from its first bead [λ]
    int *parent;        ///< shape [kinds, beads]: placed before it and bonded to it, or −1
    int *order;         ///< shape [kinds, beads]: bead that is placed as number n
};

/// Must be cleared, also after a failure. Fails: NO_MEMORY.
enum status mf_whole_molecules_init(struct whole_molecules *whole,
                                    const struct topology *topology) MUST_USE;
void mf_whole_molecules_clear(struct whole_molecules *whole);

/// Find `place` of molecule number m of a kind. The particles are joined (mf_particles_join).
/// Tested: cli and physics test_molecules.
void mf_whole_molecules_make(struct whole_molecules *whole, const struct particles *particles,
                             int kind, int64_t m);

/// Σ R_g² of all beads of molecules, as if of equal masses [λ²]. The particles are joined. Tested:
/// cli/test_molecule_motion.
double mf_whole_molecules_gyration(struct whole_molecules *whole,
                                   const struct particles *particles);
