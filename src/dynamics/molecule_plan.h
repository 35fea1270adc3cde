// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What Monte Carlo moves need to know of a kind of molecules: found once.
#pragma once

#include "forces/molecules.h"

/// Terms of one law that a bead is in.
struct molecule_run {
    int order, group;
    int count;    ///< terms
    size_t first; ///< their beads are term_bead[first …], mf_bonded_kinds[order]->beads each
};

/// What turns about a bead where a bond that is in no ring leaves it: the smaller of both sides.
struct molecule_arm {
    int pivot, first; ///< the bead that stays, and the one bonded to it that moves
    int begin, end;   ///< places in `walk`
    bool outside;     ///< the arm is what is not at begin … end − 1
};

/// A zeroed one is of no molecules.
struct molecule_plan {
    int beads;
    bool joined;   ///< bonds lead from each bead to all others
    bool excluded; ///< no pair of its own beads acts as a pair
    int *walk;     ///< shape [beads]: along the bonds, depth first
    int *parent;   ///< shape [beads]: the bead before it on the way, −1 where the way begins
    int arms;      ///< 0 if the kind is not joined, or a term goes where no bond does
    struct molecule_arm *arm;
    int *run_start; ///< shape [beads + 1]: runs of bead b are run[run_start[b] … run_start[b + 1])
    struct molecule_run *run;
    int *term_bead;
};

/// In a time that grows as the number of beads and terms. Must be cleared. Fails: NO_MEMORY.
/// Tested: test_molecule_plan.
enum status mf_molecule_plan_init(struct molecule_plan *plan,
                                  const struct topology_kind *kind) MUST_USE;
void mf_molecule_plan_clear(struct molecule_plan *plan);

/// Beads of an arm.
static inline int molecule_arm_beads(const struct molecule_plan *plan,
                                     const struct molecule_arm *arm) {
    const int inside = arm->end - arm->begin;
    return arm->outside ? plan->beads - inside : inside;
}

/// Bead n of an arm.
static inline int molecule_arm_bead(const struct molecule_plan *plan,
                                    const struct molecule_arm *arm, int n) {
    if (!arm->outside)
        return plan->walk[arm->begin + n];
    return plan->walk[n < arm->begin ? n : n + arm->end - arm->begin];
}
