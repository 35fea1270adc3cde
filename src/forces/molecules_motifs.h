// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Motifs: the pieces of molecules whose terms are worked on together (forces/bonded.h).
///
/// A small molecule is one motif: its beads and the terms among them. A large one has several, and
/// a bead where they meet is in both. Or a motif is a single term, which a molecule has many times.
#pragma once

#include "forces/bonded.h"
#include "forces/molecules.h"

struct molecules_motif {
    int beads;
    int copies; ///< in a molecule: 1, or as many as there are terms of one group
    int *bead;  ///< of the molecule, shape [copies, beads]
    int terms[BONDED_KINDS][MOLECULES_MAX_GROUPS];
    int *term_bead; ///< numbers in `bead` of a copy: the terms of one group after the other
};

/// The motifs of a kind of molecule. A zeroed one has none.
struct molecules_motifs {
    int count;
    struct molecules_motif *motif;
};

/// Find them: pieces of up to BONDED_MAX_BEADS beads, or single terms.
/// Fails: NO_MEMORY; the motifs are to be cleared in any case. Tested: test_molecules.
enum status mf_molecules_motifs_find(struct molecules_motifs *motifs,
                                     const struct topology_kind *kind, bool single) MUST_USE;
void mf_molecules_motifs_clear(struct molecules_motifs *motifs);
