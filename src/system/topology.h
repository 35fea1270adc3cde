// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Molecules: which beads they are made of, what binds these, and which pairs are left to the
/// bonds alone.
///
/// Kinds of molecules are repeated. The ids of their beads follow from the composition: the beads
/// of a type stand molecule after molecule, kind after kind, single beads after them, so that
/// nothing is stored, sorted or saved. A term is a bond, an angle or a dihedral (the list of
/// curves/bonded_kind.h), and belongs to a group, which has a law (forces/molecules.h).
#pragma once

#include "base/status.h"
#include "curves/bonded_kind.h"
#include "system/composition.h"

#include <stddef.h>

enum {
    TOPOLOGY_MAX_KINDS = 16,
    TOPOLOGY_MAX_EXCLUDE = 3,
    TOPOLOGY_NAME_SIZE = 32,
    TOPOLOGY_TERM_SIZE = 64, ///< of its beads as a text
};

struct topology_term {
    int bead[BONDED_MAX_TERM_BEADS]; ///< of the molecule, from 0
    int group;
};

/// A kind of molecule. Owned by the topology once it has been added.
struct topology_kind {
    char name[TOPOLOGY_NAME_SIZE];
    int64_t count; ///< molecules
    int exclude;   ///< pairs of beads at most so many bonds apart do not act as pairs: 0 to 3
    int beads;
    int *type; ///< shape [beads], of the composition
    int terms[BONDED_KINDS];
    struct topology_term *term[BONDED_KINDS]; ///< shape [terms]
    // Found by mf_topology_complete:
    int end[2];      ///< the two beads with one bond, of a chain; else the first and the last
    int64_t first;   ///< number of its first molecule
    uint32_t *id;    ///< shape [beads], of the first molecule
    uint32_t *step;  ///< shape [beads]: from there to the next molecule
    int *near_start; ///< shape [beads + 1]
    int *near; ///< beads excluded from pairs with b: near[near_start[b] … near_start[b + 1])
};

struct topology {
    int kinds;
    struct topology_kind kind[TOPOLOGY_MAX_KINDS];
    int64_t molecules;  ///< of all kinds
    size_t particles;   ///< with single beads
    uint32_t *molecule; ///< shape [particles]: number of the molecule by id; a single bead has one
                        ///< of its own, from `molecules` on
    bool excludes;      ///< any pair
    size_t *excluded_start; ///< shape [particles + 1], by id
    uint32_t *excluded;     ///< ids excluded from pairs with id i: excluded[excluded_start[i] …
                            ///< excluded_start[i + 1])
};

/// Whether a kind or a group can be called so: NAMES_OF_OTHERS.
bool mf_topology_is_name(const char *name);

/// The beads of a term as a text, "1-2-3", from 1 on.
void mf_topology_name_term(const struct topology_term *term, int order,
                           char text[TOPOLOGY_TERM_SIZE]);

/// Whether a kind's terms are of its beads and stand there once.
/// Fails: BAD_INPUT, naming the beads from 1 on: a bead that is not there or twice in a term, a
/// bond that stands there twice, another term twice in a group. Tested: test_topology.
enum status mf_topology_check(const struct topology_kind *kind) MUST_USE;

/// The same of one term, and those of its order before it.
enum status mf_topology_check_term(const struct topology_kind *kind, int order, int n) MUST_USE;

/// How far the terms that there are reach: "exclude" where nobody gives a number.
int mf_topology_reach(const struct topology_kind *kind);

/// The first term two beads of which follow each other in a chain and no bond joins, or NULL.
/// @param[out] order  of the term
/// @param[out] pair   the two beads, from 0
const struct topology_term *mf_topology_unbonded(const struct topology_kind *kind, int *order,
                                                 int pair[2]);

/// The first bead that no bonds join to the first one of its kind, through whichever beads, or −1.
/// Fails: NO_MEMORY. Tested: test_topology.
enum status mf_topology_find_disconnected(const struct topology_kind *kind, int *bead) MUST_USE;

/// How many beads are excluded from pairs with each bead of a kind, in all, if pairs at most
/// `exclude` bonds apart are. Fails: NO_MEMORY. Tested: test_topology.
enum status mf_topology_count_excluded(const struct topology_kind *kind, int exclude,
                                       size_t *count) MUST_USE;

/// Number the beads of all kinds and find what they exclude. The composition holds all beads, those
/// of single ones too. Fails: NO_MEMORY. Tested: test_topology.
enum status mf_topology_complete(struct topology *topology,
                                 const struct composition *composition) MUST_USE;

/// The bonds of each bead of a kind: those of b lead to to[start[b] … start[b + 1]).
struct topology_bonds {
    int *start, *to; ///< both to be freed
};
enum status mf_topology_bonds(const struct topology_kind *kind,
                              struct topology_bonds *bonds) MUST_USE;

/// An order in which a kind's beads are placed so that each follows one that it is bonded to, if
/// there is one. @param[out] order, parent  shape [beads]: the bead that is placed as number n; of
/// each bead the one before it, or −1
void mf_topology_walk(const struct topology_kind *kind, int *order, int *parent);

/// Terms of an order in all molecules.
size_t mf_topology_terms(const struct topology *topology, int order);

/// Free a topology, complete or not; a zeroed one is fine.
void mf_topology_clear(struct topology *topology);
void mf_topology_kind_clear(struct topology_kind *kind);

/// Id of a bead of molecule number m of its kind.
static inline uint32_t topology_id(const struct topology_kind *kind, int64_t m, int bead) {
    return kind->id[bead] + (uint32_t)m * kind->step[bead];
}

/// Beads of a type in a molecule of a kind.
int mf_topology_beads_of(const struct topology_kind *kind, int type);

/// Ordered pairs of beads of two types, a bead of the first with one of the second, that are in one
/// molecule, in all molecules: those that are excluded, or all. Tested: test_topology.
double mf_topology_intramolecular_pairs(const struct topology *topology, const int type[2],
                                        bool excluded);
