// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Rings of molecules, closed by their bonds, and which of them are linked.
///
/// The rings of a kind are a basis of the cycles of its bonds: one for each bond that closes a
/// path along the others. Every other cycle is a sum of these, and so is its linking number.
#pragma once

#include "system/whole_molecules.h"

struct ring {
    int kind, number; ///< which of its kind's
    int64_t molecule; ///< of its kind
    int corners;
    double (*corner)[3]; ///< shape [corners]: whole, from the first on [λ]
    double centre[3];    ///< mean of the corners [λ]
    double radius;       ///< of the farthest corner from there [λ]
    bool chosen;         ///< by mf_rings_choose_linked …
    double anchor[3];    ///< … to be drawn together there [λ]
};

struct rings {
    struct ring_kind {
        int rings;
        int *start;       ///< shape [rings + 1]
        int *bead;        ///< those of ring n in their order: bead[start[n] … start[n + 1])
        int *ring_system; ///< shape [beads]: the same for beads of rings that share beads; −1: in
                          ///< no ring
    } kind[TOPOLOGY_MAX_KINDS];
    struct whole_molecules whole;
    size_t count;        ///< rings of all molecules; 0: nothing else is there
    struct ring *ring;   ///< shape [count]
    double (*corner)[3]; ///< of all rings
    struct ring_place {
        double along; ///< the first axis, in the box [λ]
        size_t ring;
    } * order; ///< shape [count]: growing
};

/// Find the rings of all molecules. Must be cleared, also after a failure. Fails: NO_MEMORY.
enum status mf_rings_init(struct rings *rings, const struct topology *topology) MUST_USE;
void mf_rings_clear(struct rings *rings);

/// Look where the rings are, and choose so many that no two linked ones are left unchosen, and all
/// that close only around the box. Two rings are linked if the bonds of one pierce a surface that
/// the other bounds more often from one side than from the other: their linking number. Rings of
/// one clump are not looked at together.
/// @param[in] second  of two that are linked choose the other one
/// @return number of the chosen. Three dimensions. Tested: physics/test_rings.
size_t mf_rings_choose_linked(struct rings *rings, const struct particles *particles, bool second);

/// Draw each chosen ring, with all of its clump, together to `scale` of its size, at that of its
/// corners which is farthest from what it is linked to: tight rings pass through each other's
/// centres.
void mf_rings_shrink_chosen(const struct rings *rings, struct particles *particles, double scale);
