// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Molecules of a file that lists bonds, angles and dihedrals beside its atoms: PSF, GSD, and
/// LAMMPS's data files and templates.
#pragma once

#include "forces/molecules.h"
#include "trajectory/trajectory.h"

/// Whether a file is one, by its name: "….psf", "….gsd", "….data", "data.…", "….mol", "molecule.…".
bool mf_structure_topology_is(const char *file);

/// Open a file for what it lists, in the units that it says or, if it says none, in those that are
/// given, or in any. Fails as mf_trajectory_open.
enum status mf_structure_topology_open(struct trajectory *trajectory, const char *file,
                                       const char *units) MUST_USE;

/// Read the molecules that terms join; those with the same types and terms, in the order of their
/// atoms, are a kind, "molecule-1" and so on, of which there are as many as the file has. A bead is
/// of the type that its atom is called; a group of terms is called as its type or, where terms have
/// no types, by the names of its atoms, "A-B". Laws have the strength 0.
/// Fails: BAD_INPUT, naming the file: a name that cannot be one of a type or a group, too many of
/// them, kinds of the same beads, a term twice; IO; NO_MEMORY. Tested: test_structure_topology.
enum status mf_structure_topology_read(struct molecules *molecules, struct composition *types,
                                       const char *file) MUST_USE;
