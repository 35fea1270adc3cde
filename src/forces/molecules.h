// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Bonds, angles and dihedrals of molecules: one more interaction beside the pairs.
///
/// A simulation has molecules if the interaction `mf_molecules` is in its list: its parameters are
/// a struct molecules. Terms are grouped, and each group has a law (curves/bonded_law.h). Angles
/// and dihedrals stay what they are when all lengths grow alike, so the virial is that of the
/// lengths.
#pragma once

#include "curves/bonded_law.h"
#include "forces/interaction.h"
#include "system/placement.h"
#include "system/topology.h"

enum { MOLECULES_MAX_GROUPS = 16 }; ///< of each kind of terms

struct molecules_group {
    char name[TOPOLOGY_NAME_SIZE];
    struct bonded_curve curve;
};

/// Owns the topology and the laws. A zeroed one has none.
struct molecules {
    struct topology topology;
    struct molecules_group group[BONDED_KINDS][MOLECULES_MAX_GROUPS];
    int groups[BONDED_KINDS];
};

void mf_molecules_clear(struct molecules *molecules);

/// The group of that name, or NULL.
struct molecules_group *mf_molecules_group(struct molecules *molecules, int order,
                                           const char *name);

/// Add a group of that name with a law of default parameters, for which there is room. Fails:
/// NO_MEMORY.
enum status mf_molecules_add_group(struct molecules *molecules, int order, const char *name,
                                   const struct bonded_law *law) MUST_USE;

/// Whether molecules go into a box: a term sees the nearest images of its beads, so that a bond, at
/// rest or as long as it can be, is shorter than half of it; dihedrals need three dimensions.
/// Fails: BAD_INPUT, naming the group.
enum status mf_molecules_check(const struct molecules *molecules, const struct box *box) MUST_USE;

/// The molecules among the interactions of a scene, or NULL.
const struct molecules *mf_molecules_find(const struct interaction_choice *interactions, int count);

/// Place all beads: the first one of each molecule, and single beads, as `placement` says of
/// particles, on a lattice or at random; the others where forces/molecules_growth.h draws them.
/// Beads of different molecules may overlap, and rings be linked: mf_relax_molecules parts them.
/// @param[in] law  of pairs, and the temperature
/// Fails: NO_MEMORY, BAD_INPUT as mf_placement_random. Tested: test_molecules_growth.
enum status mf_molecules_place(const struct molecules *molecules, const struct pair_law *law,
                               struct particles *particles, const struct placement *placement,
                               uint64_t seed) MUST_USE;
