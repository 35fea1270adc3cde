// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Particles that are spread unevenly over the parts of a neighbour list: parts that are full
/// beside parts that are empty, which a uniform fluid never has.
#pragma once

#include "curves/table.h"
#include "forces/pair.h"
#include "system/neighbours.h"

enum uneven_kind {
    UNEVEN_DROPLET,  ///< in vapour
    UNEVEN_FILM,     ///< across the box, in vapour
    UNEVEN_CLUSTERS, ///< of a few dozen beads each, and nothing between them
    UNEVEN_EMPTY,    ///< a dense first part, then parts without a bead
    UNEVEN_TWO,      ///< beads in all
    UNEVEN_KINDS
};

struct uneven {
    struct particles particles;
    struct neighbours neighbours;
    struct table potential;
};

/// Number `number` of the scenes of a kind, in a box of 24 × 8 × 8, listed by one thread.
void uneven_init(struct uneven *uneven, enum uneven_kind kind, uint32_t number);
void uneven_clear(struct uneven *uneven);

/// Leave the fullest part so many places of the list, in steps of 16, more than it fills. One that
/// is too narrow widens when it is built.
void uneven_narrow(struct uneven *uneven, int room);

/// Build the list with so many threads, and again with one: each row has the owner that its
/// particle says, and the forces have the same bits.
void uneven_check_threads(struct uneven *uneven, int threads);

/// Build the list, with one thread: no row of a part lies in the next, seen where that is empty.
/// Returns the number of such parts.
int uneven_check_ends(struct uneven *uneven);
