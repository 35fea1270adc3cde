// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A kind of bonded terms is a record: how many beads, which q and its forces, Jacobian and
/// range, and how it is called. Bond, angle and dihedral are the first three.
///
/// To add one, write its record (angle.c is an example) and a line in BONDED_LIST. Topologies,
/// scenes, observables, targets, inversions, figures and summaries know it by these two. What joins
/// molecules are bonds alone: exclusions, pieces and placement follow them. The number of a kind in
/// the list is its `order` in all of the code, and "terms of an order" are those of one kind.
#pragma once

#include "curves/bonded_law.h"

/// Of each kind, in the order in which they are read, written and numbered: its name, in capitals,
/// too; its number of beads; observable and target of its distribution, what that is of, the head
/// of its column of q and the unit of p.
#define BONDED_LIST(EACH)                                                                          \
    EACH(BOND, bond, 2, bond_lengths, "bond lengths", "r[lambda]", "1/lambda")                     \
    BONDED_LIST_BEYOND_BONDS(EACH)
#define BONDED_LIST_BEYOND_BONDS(EACH)                                                             \
    EACH(ANGLE, angle, 3, bond_angles, "bond angles", "theta[degrees]", "1/degrees")               \
    EACH(DIHEDRAL, dihedral, 4, dihedral_angles, "dihedral angles", "phi[degrees]", "1/degrees")

#define BONDED_NUMBER(NAME, ...) BONDED_##NAME,
enum { BONDED_LIST(BONDED_NUMBER) BONDED_KINDS };
#undef BONDED_NUMBER

enum {
    BONDED_MAX_TERM_BEADS = 4,
    BONDED_MAX_ARMS = BONDED_MAX_TERM_BEADS - 1,
    BONDED_BATCH = 128, ///< lengths or angles that a law is given together
};

#define BONDED_RADIANS (M_PI / 180) ///< of a degree

struct bonded_batch;

struct bonded_kind {
    const char *name;    ///< "angle"
    const char *plural;  ///< "angles": the key of its groups in a scene; the name and s,
                         ///< as tables and figures are called
    const char *article; ///< "an"
    int beads;
    int reach; ///< the most bonds between two of its beads: as far as VOTCA excludes pairs
    /// In a chain the place of each bead after the first, and no more than `reach`; all 0: chains
    /// have no such terms.
    int chain[BONDED_MAX_TERM_BEADS];
    bool spatial; ///< it means nothing in a plane
    // Geometry (curves/bonded_batch.h):
    int arms;
    struct bonded_arm {
        int from, to; ///< beads
    } arm[BONDED_MAX_ARMS];
    void (*measure)(struct bonded_batch *batch); ///< q from the arms [λ] or [rad]
    void (*push)(struct bonded_batch *batch);    ///< forces on the arms, from slope and the arms
    /// ∫ of the Jacobian over a bin that begins at `low`, as far as q can be [λ^d or rad].
    double (*jacobian)(int dimensions, double low, double width);
    // What q is: BONDED_LENGTHS or BONDED_ANGLES.
    bool is_length;
    const char *unit, *density; ///< of q in files, and of p
    double scale;               ///< of that unit
    double low, high;           ///< where q can be, in files
    bool periodic;              ///< its ends are the same, 360 degrees apart
    // Laws, and what is known of all of them.
    const struct bonded_law *const *laws; ///< that a scene can name, NULL-terminated
    const struct bonded_law *table;       ///< the one of them that has points
    /// Deviation below which a group is as good as constrained, a part of the mean length or
    /// degrees; 0: none is. The first of `laws` is then harmonic about "length" or "angle".
    double narrow;
    int64_t fine; ///< bins of what is measured without knowing its width: many divisors
    double cost;  ///< nanoseconds of counting a term
    bool common;  ///< GROMACS and LAMMPS have it, by its name
};

#define BONDED_LENGTHS .is_length = true, .unit = "lambda", .density = "1/lambda", .scale = 1
#define BONDED_ANGLES .unit = "degrees", .density = "1/degrees", .scale = BONDED_RADIANS

#define BONDED_DECLARE(NAME, kind, ...)                                                            \
    extern const struct bonded_kind mf_##kind;                                                     \
    extern const struct bonded_law mf_##kind##_table;
BONDED_LIST(BONDED_DECLARE)
#undef BONDED_DECLARE

/// All of them, by their orders.
extern const struct bonded_kind *const mf_bonded_kinds[BONDED_KINDS];

/// From where on the q of a table may be, which for a circle may begin anywhere.
static inline double bonded_min(int order) {
    return mf_bonded_kinds[order]->periodic ? -DBL_MAX : mf_bonded_kinds[order]->low;
}

/// The kind of which this is the law with points, or NULL.
const struct bonded_kind *mf_bonded_kind_of_table(const struct bonded_law *law);
