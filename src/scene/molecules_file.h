// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Which molecules a trajectory has: the kinds of a file, for what is measured.
#pragma once

#include "scene/scene_molecules.h"
#include "trajectory/structure.h"

/// Read the "molecules" of a JSON file, which may be a scene or used.json: whatever else it holds
/// but the types of "particles" is left alone; or those of a GROMACS topology (.top, .itp), of a
/// PSF, a GSD, a data file or template of LAMMPS, or of <cg_bonded> of VOTCA's maps (.xml). Groups
/// are those that the kinds name; a kind without "count" has 0.
/// @param[out] types  of beads, in the order of a scene: those of "particles" first; without counts
/// Fails: BAD_INPUT with all faults of the file, IO, NO_MEMORY. Tested: cli/test_measure_molecules.
enum status mf_molecules_file_read(struct scene_molecules *molecules, struct composition *types,
                                   const char *file) MUST_USE;

/// What "particles" of a JSON file say of the masses of these types [u]; NAN: nothing, or that they
/// differ among beads of a type. Those of a reduced file are in the unit that its "units" give, or
/// stand for themselves beside a trajectory in `units` "lj", and are not known beside another.
/// @param[in] units  of the trajectory, as the user gave them, or NULL
/// Fails: as mf_molecules_file_read.
enum status mf_molecules_file_masses(double mass[COMPOSITION_MAX_TYPES],
                                     const struct composition *types, const char *file,
                                     const char *units) MUST_USE;

/// Whether a file lists atoms, as all of these but JSON and maps do: by its name.
bool mf_molecules_file_lists(const char *file);

/// A file that lists all atoms of a trajectory, or those of one molecule, tells what each atom is:
/// its type, its mass, and the molecule that it belongs to.
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
/// Fails: IO, NO_MEMORY; BAD_INPUT for a damaged file, or for atoms of the same ids but not of the
/// same types. Tested: cli/test_measure_listings.
enum status mf_molecules_listing_read(struct molecules_listing *listing, struct topology *molecules,
                                      const char *file, const char *units,
                                      const struct structure *of, bool mapped) MUST_USE;

void mf_molecules_listing_clear(struct molecules_listing *listing);
