// SPDX-License-Identifier: GPL-3.0-or-later
/// @file "molecules": {"file": "topol.top"}: molecules of another program.
#pragma once

#include "scene/scene_molecules.h"

/// Read kinds, groups and types of the file that an object names, by its name a topology of GROMACS
/// or a data file of LAMMPS. The topology is not completed. Faults go to the document. Fails:
/// NO_MEMORY.
/// @param[in,out] molecules  with the groups that the scene or a fit has; those of a data file come
///                           after them
/// @param[in]     scene      the object with the laws of groups
enum status mf_scene_topology_read(struct scene_molecules *molecules, struct json_object *object,
                                   struct json_object *scene, const struct scene_fitted *fitted,
                                   struct composition *composition,
                                   const struct units *units) MUST_USE;
