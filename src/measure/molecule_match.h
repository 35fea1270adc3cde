// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Which beads of a trajectory are which beads of which molecule.
#pragma once

#include "forces/molecules.h"
#include "trajectory/mapping.h"

struct molecule_match {
    size_t *bead; ///< shape [particles], by the id that the topology gives: number in the mapping
};

/// Find the molecules of `topology`, whose kinds have counts or 0 of unknown ones, among the beads
/// of a mapping, and complete it. The beads of a residue or molecule of the trajectory are one of
/// the kind that has as many of each type; among those of a type the order is that of their first
/// atoms. Where that does not fit all, as of chains of several residues, the beads are taken in the
/// order of their atoms, kind after kind: as many molecules as the file counts, or all of a single
/// kind. What is one bead, and no kind, is a single bead.
/// @param[in] types  of the topology's kinds; its names are those of the mapping's types
/// @param[in] composition  of the mapping
/// Fails: BAD_INPUT, naming the file and the bead that does not fit; NO_MEMORY. Tested:
/// test_molecule_match.
enum status mf_molecule_match(struct molecule_match *match, struct topology *topology,
                              const struct composition *types, const struct mapping *mapping,
                              const struct composition *composition, const char *file) MUST_USE;
void mf_molecule_match_clear(struct molecule_match *match);
