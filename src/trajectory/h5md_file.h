// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A file of H5MD: its group of particles, what is in it, and its units.
#pragma once

#include "base/status.h"
#include "trajectory/h5md_element.h"
#include "trajectory/trajectory.h"

/// An open file; a struct of zeros is none.
struct h5md_file {
    hid_t file, group;
    uint64_t bytes;     ///< of the file
    bool periodic[3];   ///< along the box's vectors
    double edge_length; ///< unit of the box's edges [nm]
    double mass_unit;   ///< [u]
    struct h5md_element position, velocity, force, image, id, mass, species, edges;
};

/// Open the file of a trajectory and the group of particles that its options name, or its only one;
/// find its units, which become the trajectory's scale: those that the file says, else those that
/// the user tells, else nm, ps and u, which is noted.
/// Fails: BAD_INPUT for what is damaged, no H5MD, or of a shape that does not fit; IO.
/// Tested: test_trajectory_h5md.
enum status mf_h5md_file_open(struct h5md_file *h5md, struct trajectory *trajectory) MUST_USE;

void mf_h5md_file_close(struct h5md_file *h5md);

/// The name of a species: that of the file's enumeration, or its number.
void mf_h5md_file_species(const struct h5md_file *h5md, int64_t species, char name[STRUCTURE_NAME]);

/// What a unit may be of.
enum h5md_kind { H5MD_LENGTH, H5MD_TIME, H5MD_SPEED, H5MD_FORCE, H5MD_MASS };

/// How many nm, ps, nm/ps, kJ/mol/nm or u a unit is. Fails: BAD_INPUT, without a place, for a
/// symbol that is not known, or a unit of something else. Tested: test_trajectory_h5md.
enum status mf_h5md_unit_find(const char *unit, enum h5md_kind kind, double *factor) MUST_USE;

// What GROMACS (2026 and later) adds to H5MD: names, residues, masses of the kinds of molecules and
// how many of each follow each other, in h5md/modules/gromacs_topology; bonds, in connectivity.

/// Give the structure, of as many atoms as positions, what the file has of it. A topology of
/// another number of particles is not used, which the trajectory's note says. Fails: BAD_INPUT for
/// what is damaged; NO_MEMORY. Tested: test_topology_h5md.
enum status mf_h5md_topology_read(const struct h5md_file *h5md,
                                  struct trajectory *trajectory) MUST_USE;

/// The same of bonds, where no topology tells of molecules: these are what bonds join. The atoms
/// stand in the order of their ids if there are ids, which bonds are then told by, or else by
/// places from 0 on. Those that say that they are of another group of particles are none. Fails:
/// BAD_INPUT, NO_MEMORY. Tested: test_topology_h5md.
enum status mf_h5md_topology_bonds(const struct h5md_file *h5md,
                                   struct trajectory *trajectory) MUST_USE;
