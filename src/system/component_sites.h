// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Where the sites of components are (system/components.h): a molecule is one site, at the
/// mean place of its beads, which masses do not change; a single bead is one. Without molecules all
/// beads are sites.
///
/// Waves of sites tell the same at q → 0 whichever site of a molecule is taken. The way there
/// differs: a bead at r_i from the mean turns with its molecule, which adds about q²⟨r_i²⟩/3 to S.
#pragma once

#include "system/components.h"
#include "system/particles.h"
#include "system/whole_molecules.h"

struct component_sites {
    struct composition components;
    struct whole_molecules whole;           ///< without molecules all zero
    int kinds;                              ///< of molecules: the first components
    uint32_t single[COMPOSITION_MAX_TYPES]; ///< id of each component's first single bead
    size_t beads;
    uint32_t *place; ///< shape [beads]: of an id among the particles; NULL with molecules
    double *site[3]; ///< shape [sites], component after component [λ]
};

/// Must be cleared, also after a failure. Fails: as mf_components_find; NO_MEMORY.
enum status mf_component_sites_init(struct component_sites *sites, int dimensions,
                                    const struct composition *beads, size_t count,
                                    const struct topology *topology) MUST_USE;
void mf_component_sites_clear(struct component_sites *sites);

/// Find the sites. The particles are joined (mf_particles_join) if there are molecules. Sites may
/// be outside of the box, by the size of a molecule.
/// Tested: test_components, test_kirkwood_buff_waves.
void mf_component_sites_find(struct component_sites *sites, const struct particles *particles);
