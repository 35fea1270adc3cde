// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Atoms to beads.
#pragma once

#include "base/status.h"
#include "trajectory/frame.h"
#include "trajectory/mapping_plan.h"
#include "trajectory/structure.h"

/// Beads stand in the order of their types, and those of a type in the order of their first atoms.
struct mapping {
    size_t atoms, beads, types;
    char (*type_name)[STRUCTURE_NAME]; ///< shape [types]
    struct mapping_bead {
        size_t first, count; ///< its atoms in `atom`, in the order in which they are made whole
        size_t type;
        bool weighted;   ///< its weights were given, and are not those of masses
        size_t molecule; ///< residue or molecule of its first atom; beads of one may be left out of
                         ///< g(r)
        double mass;     ///< [u]; NAN: not known
    } * bead;            ///< shape [beads]
    size_t *atom;        ///< shape [atoms that are mapped]
    double *weight;      ///< the same: of a mean over the bead's atoms, 1 in all
    struct bytes notes;  ///< lines that tell what was made and what was guessed, a text
    bool broken; ///< a bead is a part of its residue or molecule, or not its centre of mass: bonds
                 ///< of fixed length hold it, and its velocity does not tell the temperature
    bool off_mass; ///< a bead is not its centre of mass: its velocity is not that of its mass
};

/// Find the beads of a plan among atoms. Masses are those of the plan, of the file, or else of
/// elements that the names make likely, which `notes` tell.
/// Fails: BAD_INPUT, naming the plan and the atom or residue: an atom that no entry names, or two;
/// a residue without an atom of the plan, or with other atoms than the first of its name; a mass
/// that is unknown; NO_MEMORY. Tested: test_mapping.
enum status mf_mapping_init(struct mapping *mapping, const struct mapping_plan *plan,
                            const struct structure *structure) MUST_USE;

/// Make every atom a bead of the type that is called as the atom or, in a file that knows but the
/// numbers of types, has that number, from 1 on.
/// @param[in] mass  of each type [u], for atoms whose file says none; NAN: not known
/// @param[in] file  that names the types, for messages
/// Fails: BAD_INPUT for an atom of another type, and for a type without atoms; NO_MEMORY.
/// Tested: cli/test_measure_molecules.
enum status mf_mapping_init_atoms(struct mapping *mapping, const struct structure *structure,
                                  const char *const *types, const double *mass, size_t count,
                                  const char *file) MUST_USE;

/// A step of mf_mapping_init: find types, beads and their atoms, with weights that are 0 or, for
/// centres of geometry, 1/count.
enum status mf_mapping_build(struct mapping *mapping, const struct mapping_plan *plan,
                             const struct structure *structure) MUST_USE;

void mf_mapping_clear(struct mapping *mapping);

/// Centres of beads: R = Σ w_i r_i with w_i = m_i/Σ m or 1/n, V = Σ w_i v_i. Each bead is made
/// whole first: every atom is taken in its image nearest to the atom before, which is right if
/// these two are closer than half the least height of the box. F = Σ f_i, if the frame has forces.
/// @param[out] beads  all zero or of an earlier call; time, step and box are those of the frame
/// Fails: BAD_INPUT if the frame has other atoms; NO_MEMORY. Threads: any number, of other frames.
enum status mf_mapping_apply(const struct mapping *mapping, const struct trajectory_frame *frame,
                             struct trajectory_frame *beads) MUST_USE;
