// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What GROMACS (2026 and later) adds to H5MD: names, residues, masses of the kinds of
/// molecules and how many of each follow each other, in h5md/modules/gromacs_topology; bonds, in
/// connectivity.
#pragma once

#include "trajectory/h5md_file.h"

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
