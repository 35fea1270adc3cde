// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Molecules of a data file of LAMMPS (manual, read_data): what its bonds, angles and
/// dihedrals join, with the coefficients that stand there.
#pragma once

#include "curves/bonded_kind.h"
#include "forces/molecules.h"
#include "io/units_scale.h"

enum { LAMMPS_NOTE_SIZE = 256, LAMMPS_MAX_ATOMS = 20000 }; ///< of a molecule

/// Whether a file is one, by its name: "….data", "data.…".
bool mf_lammps_topology_is(const char *file);

/// Whose units the numbers of a file are: those that its first line tells, else "real", and "lj"
/// for a scene without units.
/// @param[in] told  "lj", "real" or "metal", or "": as above
/// Fails: BAD_INPUT for other units, or if both tell another; IO; NO_MEMORY.
enum status mf_lammps_topology_units(const char *file, const char *given, const struct units *units,
                                     const char **style) MUST_USE;

/// Read molecules and single beads. Atoms that terms join are a molecule; molecules with the same
/// types and terms, in the order of their ids, are a kind, "molecule-1" and so on. A type, and a
/// group of terms, is called by its number.
/// @param[in,out] molecules  groups that a scene gives, by their numbers, have its laws; the
/// topology is
///                           not completed
/// @param[in,out] composition  types and counts, to which those of the file are added
/// @param[in] units    λ and k_B T_0; if not known 1 nm and 1 kJ/mol, and for "lj" 1 and 1
/// @param[in] style    of mf_lammps_topology_units
/// @param[in] exclude  of all kinds
/// @param[out] order   shape [atoms], to be freed: molecule after molecule, kind after kind, then
/// single
///                     beads, type after type: the place of each in the order of ids
/// @param[out] note    what is not taken, one line; "" if nothing
/// Fails: BAD_INPUT with file and line for what is not known or cannot be; IO; NO_MEMORY. Tested:
/// cli/test_lammps_topologies.
enum status mf_lammps_topology_read(struct molecules *molecules, struct composition *composition,
                                    const char *file, const struct units *units, const char *style,
                                    int exclude, size_t **order,
                                    char note[LAMMPS_NOTE_SIZE]) MUST_USE;

/// The same order for molecules that a scene tells by itself, as used.json does, if the file has as
/// many of them, of the same types and with as many terms, kind after kind. Fails: BAD_INPUT if it
/// has others, or as mf_lammps_topology_read; IO; NO_MEMORY.
enum status mf_lammps_topology_order(const char *file, const char *style,
                                     const struct topology *topology,
                                     const struct composition *composition,
                                     size_t **order) MUST_USE;
