// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Molecules of a GROMACS topology: [ moleculetype ], [ atoms ], [ bonds ], [ angles ],
/// [ dihedrals ] with their functions (topologies/gromacs_functions.h), parameters beside them or
/// in [ bondtypes ] and the like, and how many there are by [ molecules ].
#pragma once

#include "forces/molecules.h"
#include "io/units_scale.h"

enum { GROMACS_NOTE_SIZE = 256 };

/// What is to be known of a topology.
struct gromacs_note {
    char text[GROMACS_NOTE_SIZE]; ///< what is not taken, one line; "" if nothing
    bool scattered;               ///< [ molecules ] names a kind twice, or in another order
};

/// Read the molecules of a file. A group is the terms of the same parameters, and is called by the
/// types of its first term: "A-B", and "A-B_2" if there is another. Beads are of the types of
/// [ atoms ], "nrexcl" is `exclude`. A group of a table has a law "table" without points, as one
/// that a fit looks for (mf_scene_groups_are_fitted).
/// @param[in,out] molecules  no kinds and groups yet; the topology is not completed
/// @param[in,out] composition  types and counts, to which those of the molecules are added
/// @param[in] units  λ and k_B T_0; if not known 1 nm and 1 kJ/mol; NULL: laws do not matter, as of
/// what is measured. Then terms of any function are taken, and constraints as bonds, each group
/// with a table without points; so are files without [ molecules ], whose kinds have the count 0.
/// Fails: BAD_INPUT with file and line for what is not known or cannot be; IO; NO_MEMORY. What was
/// read before is to be cleared. Tested: cli/test_topologies.
enum status mf_gromacs_topology_read(struct molecules *molecules, struct composition *composition,
                                     const char *file, const struct units *units,
                                     struct gromacs_note *note) MUST_USE;
