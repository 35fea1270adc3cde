// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How molecules are laid out in the lanes of vectors (forces/bonded.h), and shared out among
/// blocks.
///
/// A bundle is a motif in as many molecules of a kind as there are lanes. Where a kind has too few
/// molecules to fill them, its motifs are single terms, and the lanes are some of those of one
/// molecule. Terms of different molecules share no bead: all bundles of a molecule are in one
/// block, and blocks are the same for any number of threads.
#pragma once

#include "forces/bonded.h"
#include "forces/molecules.h"
/// Motifs are the pieces of molecules whose terms are worked on together (forces/bonded.h). A small
/// molecule is one motif: its beads and the terms among them. A large one has several, and a bead
/// where they meet is in both. Or a motif is a single term, which a molecule has many times.
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

enum { MOLECULES_MAX_BLOCKS = 64 };

struct molecules_bundle {
    const struct topology_kind *kind;
    const struct molecules_motif *motif;
    int lanes;
    int64_t molecule; ///< of the first lane, in the sequence of its kind; the next ones follow if
                      ///< the motif has one copy
    int copy;         ///< of the first lane; the next ones follow otherwise
    size_t row;       ///< in `place`
};

struct molecules_layout {
    const struct topology *topology;
    struct molecules_motifs motifs[TOPOLOGY_MAX_KINDS];
    struct molecules_bundle *bundle;
    int blocks;
    size_t start[MOLECULES_MAX_BLOCKS + 1]; ///< where the bundles of a block begin
    uint32_t *sequence; ///< shape [molecules]: those of each kind, by the places of first beads
    uint32_t *bucket;   ///< room for sorting
    int32_t *place;     ///< shape [rows, BONDED_LANES], of the particles
    uint64_t orders;    ///< of the particles, to which the places belong
};

/// Lay out molecules. Their places are not known yet.
/// Fails: NO_MEMORY; the layout is to be cleared in any case. Tested: test_molecules.
enum status mf_molecules_layout_init(struct molecules_layout *layout,
                                     const struct topology *topology,
                                     const struct particles *particles) MUST_USE;
void mf_molecules_layout_clear(struct molecules_layout *layout);

/// Follow the particles into their order, if it is a new one: molecules are put into the order of
/// their first beads, so that what is near in space is near in memory.
void mf_molecules_layout_follow(struct molecules_layout *layout, const struct particles *particles);
