// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A file of molecules that lists all atoms of a trajectory, or those of one molecule, tells
/// what each atom is: its type, its mass, and the molecule that it belongs to.
#pragma once

#include "forces/molecules.h"
#include "trajectory/structure.h"

struct molecules_listing {
    struct structure structure; ///< the trajectory's, with what the listing knows; no atoms: none
    size_t repeats;             ///< how often it is listed
};

/// Read the molecules' file as a listing, where it is one: a topology of GROMACS, a data file or a
/// template of LAMMPS, a PSF, a GSD. Its atoms must be called as those of the trajectory, where
/// both have names; of fewer atoms it must fit several times, by names. Otherwise there is none.
/// @param[in,out] molecules  each kind of it is there so often more
/// @param[in] units  of a file that says none
/// @param[in] mapped  atoms keep names and molecules: they become beads by a map
/// Fails: IO, NO_MEMORY; BAD_INPUT for a damaged file. Tested: cli/test_measure_listings.
enum status mf_molecules_listing_read(struct molecules_listing *listing, struct topology *molecules,
                                      const char *file, const char *units,
                                      const struct structure *of, bool mapped) MUST_USE;

void mf_molecules_listing_clear(struct molecules_listing *listing);
