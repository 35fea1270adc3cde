// SPDX-License-Identifier: GPL-3.0-or-later
/// @file "particles": {"placement": "file", "file": "conf.gro"}: where the beads of a topology are.
#pragma once

#include "scene/scene.h"

/// Whether a file of coordinates is one of GROMACS or LAMMPS, by its name.
bool mf_scene_coordinates_are_of_engine(const char *file);

/// Read the places, and velocities if there are any, of a .gro file, or of the data file of LAMMPS
/// that the molecules are from, into scene->start: molecule
/// after molecule, kind after kind, then single beads, type after type. With units nm and ps become
/// λ and τ; without, these are 1 nm and 1 ps.
/// Faults go to the document, one line: another number of atoms, another box, a bond that is more
/// than three times as long as at rest, by more than 30 k_B T, or longer than it can be.
/// Fails: NO_MEMORY. Tested: cli/test_topologies.
enum status mf_scene_coordinates_read(struct scene *scene, struct json_object *particles) MUST_USE;

/// A fault for the first bond of a scene's first coordinates that is as long as
/// mf_scene_coordinates_read refuses.
/// @param[in] number  shape [beads]: of each id in the file; NULL: the ids themselves
void mf_scene_coordinates_check_bonds(const struct scene *scene, struct json_object *particles,
                                      const size_t *number);
