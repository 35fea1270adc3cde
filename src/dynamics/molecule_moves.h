// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Metropolis moves of whole molecules and of their arms, and what bonds, angles and
/// dihedrals have to say of a move.
///
/// A molecule is moved by a uniform random vector of a cube; turned about its centre; or one of its
/// arms is turned about the bead that it is bonded to (pivot; M. Lal, Mol. Phys. 17, 57 (1969)), by
/// an angle that is uniform about an axis that is uniform on the sphere. Each is as likely as its
/// way back, and so are the two grounds on which a move is refused before its energy is asked: a
/// bead goes farther than the list of neighbours allows, or a bead of what turns is farther than a
/// quarter of the box from the centre, where nearest images change.
#pragma once

#include "forces/molecules.h"
#include "forces/pair.h"

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

/// In a time that grows as the number of beads and terms. Must be cleared. Fails: NO_MEMORY.
/// Tested: test_molecule_plan.
enum status mf_molecule_plan_init(struct molecule_plan *plan,
                                  const struct topology_kind *kind) MUST_USE;

void mf_molecule_plan_clear(struct molecule_plan *plan);

struct metropolis;

enum molecule_move { MOLECULE_TRANSLATE, MOLECULE_ROTATE, MOLECULE_PIVOT, MOLECULE_MOVES };

/// "translate", "rotate", "pivot".
extern const char *const mf_molecule_move_names[MOLECULE_MOVES];

/// How one kind of moves goes.
struct molecule_tally {
    double step; ///< half edge of the cube [λ], or largest angle [rad]
    uint64_t accepted, tried;
};

/// A zeroed one is of no molecules.
struct molecule_moves {
    const struct molecules *molecules; ///< borrowed; NULL: single beads alone
    struct molecule_plan plan[TOPOLOGY_MAX_KINDS];
    struct molecule_tally tally[MOLECULE_MOVES];
    void *forces;     ///< state of the interaction mf_molecules, for sums
    int32_t *bead_of; ///< shape [particles], by id: its number in its molecule, −1 of a single bead
    // Of one molecule, shape [most beads]:
    int32_t *place;              ///< in the arrays of the particles
    double (*position)[3];       ///< from bead to bead along the bonds [λ]
    int32_t *moved;              ///< places of the beads that a move takes along
    double (*from)[3], (*to)[3]; ///< where to, in the axes of the particles' positions [λ]
    bool *together;              ///< shape [particles], by place: takes part in the move at hand
    int32_t *list;               ///< neighbours of one bead without those
    size_t list_capacity;
};

/// @param[in] molecules  borrowed; their laws may be exchanged
/// @param[in] particles  that have joined them
/// Fails: NO_MEMORY; BAD_INPUT as mf_molecules_check.
enum status mf_molecule_moves_init(struct molecule_moves *moves, const struct molecules *molecules,
                                   const struct particles *particles) MUST_USE;
void mf_molecule_moves_clear(struct molecule_moves *moves);

/// Kind of a molecule.
int mf_molecule_moves_kind(const struct topology *topology, uint32_t molecule);

/// U of the terms of a bead of molecule m of kind number k [k_B T_0]. Infinite where a bond is
/// torn.
double mf_molecule_moves_bead_energy(const struct molecule_moves *moves, int k, uint32_t m,
                                     int bead, const struct particles *particles);

/// Change of U of the terms of particle number k when it goes to `to` [k_B T_0]. Infinite where a
/// bond would break.
double mf_molecule_moves_bead_change(const struct molecule_moves *moves,
                                     struct particles *particles, size_t k, const double to[3]);

/// Try one move of each molecule, in the order in which a sweep takes their first beads. Molecules
/// of one bead are not moved, those that bonds do not join are not turned, and arms are of bonds
/// in no ring. Fails: NO_MEMORY. Tested: physics/test_molecule_moves.
enum status mf_molecule_moves_pass(struct metropolis *metropolis, enum molecule_move move) MUST_USE;

/// Change the step of a kind of moves towards 40 % accepted, by its tally.
void mf_molecule_moves_tune(struct metropolis *metropolis, enum molecule_move move);

/// Add U and Σ r·F of all terms. Fails: NO_MEMORY.
enum status mf_molecule_moves_add_sums(struct metropolis *metropolis,
                                       struct pair_sums *sums) MUST_USE;
